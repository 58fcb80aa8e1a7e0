/* Prints the surface of an .lr file (docs/lr-file.md) as OBJ. Make the file with lacedring encode --resident MESH -o
   FILE.lr. */
#define LACEDRING_DECODE_IMPLEMENTATION
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "lacedring_vertices.h"

static uint32_t* file_words; /* the whole file; sections begin at multiples of 8 bytes */
static size_t file_count;

/* The words of the first section of a kind: 7 is a packed stream, 8 an attribute as a vertex stream. */
static const uint32_t* section(uint32_t kind, size_t* count) {
    const uint32_t* s = file_words + 8; /* kind, CRC-32, offset, size, layout, length of the name */
    uint32_t left = file_count < 8 ? 0 : file_words[2];
    while (left > 0 && file_count >= (size_t)(s - file_words) + 8 && s[0] != kind) s += 8, --left;
    if (left == 0 || file_count < (size_t)(s - file_words) + 8) return NULL;
    if (s[3] != 0 || s[5] != 0 || s[2] / 4 > file_count || s[4] / 4 > file_count - s[2] / 4) return NULL;
    *count = s[4] / 4;
    return file_words + s[2] / 4;
}

int main(int argc, char** argv) {
    FILE* file = argc == 2 ? fopen(argv[1], "rb") : NULL;
    struct lacedring_packed packed;
    struct lacedring_vertices positions;
    const uint32_t* words;
    uint32_t *indices, i;
    float* p;
    size_t size = 0, count, t;
    if (file == NULL) return fputs("decode FILE.lr\n", stderr), 1;
    while (!feof(file) && !ferror(file)) {
        file_words = realloc(file_words, size + 65536);
        if (file_words == NULL) return 1;
        size += fread((char*)file_words + size, 1, 65536, file);
    }
    fclose(file);
    file_count = size / 4;

    words = section(7, &count);
    if (words == NULL || lacedring_packed_validate(words, count, &packed, NULL) != LACEDRING_STATUS_OK) {
        return fputs("no valid packed stream\n", stderr), 1;
    }
    words = section(8, &count); /* begins with the name: POSITION, in 8 bytes */
    if (words == NULL || count < 2 || memcmp(words, "POSITION", 8) != 0 ||
        lacedring_vertices_validate(words + 2, count - 2, &positions, NULL) != LACEDRING_STATUS_OK ||
        positions.vertices != packed.vertices || positions.type != 6 || lacedring_vertices_values(&positions) != 3) {
        return fputs("no valid positions of 32-bit floats\n", stderr), 1;
    }
    indices = malloc(12 * (size_t)packed.triangles + 1);
    p = malloc(12 * (size_t)positions.vertices + 1);
    if (indices == NULL || p == NULL) return 1;
    lacedring_packed_triangles_u32(&packed, indices);
    lacedring_vertices_decode(&positions, p);
    for (i = 0; i < positions.vertices; ++i) {
        printf("v %.9g %.9g %.9g\n", p[3 * (size_t)i], p[3 * (size_t)i + 1], p[3 * (size_t)i + 2]);
    }
    for (t = 0; t < packed.triangles; ++t) {
        printf("f %u %u %u\n", indices[3 * t] + 1, indices[3 * t + 1] + 1, indices[3 * t + 2] + 1);
    }
    free(p);
    free(indices);
    free(file_words);
    return 0;
}
