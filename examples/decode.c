/* Prints the mesh of an .lr file (docs/lr-file.md) with a lean stream as OBJ. */
#define LACEDRING_DECODE_IMPLEMENTATION
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "lacedring_decode.h"

static uint32_t* file_words; /* the whole file; sections begin at multiples of eight bytes */
static size_t file_count;

/* The words of section i of one kind: 1 is a lean stream, 2 an attribute. */
static const uint32_t* section(uint32_t i, uint32_t kind, size_t* count) {
    const uint32_t* s = file_words + 8 + (size_t)8 * i; /* kind, CRC-32, offset, size, layout, length of the name */
    if (file_count < 16 + (size_t)8 * i || s[0] != kind) return NULL;
    if (s[3] != 0 || s[5] != 0 || s[2] / 4 > file_count || s[4] / 4 > file_count - s[2] / 4) return NULL;
    *count = s[4] / 4;
    return file_words + s[2] / 4;
}

int main(int argc, char** argv) {
    FILE* file = argc == 2 ? fopen(argv[1], "rb") : NULL;
    struct lacedring_lean lean;
    const uint32_t *words, *positions;
    uint32_t *indices, i, xyz[3];
    float p[3];
    size_t size = 0, count, t;
    if (file == NULL) return fputs("decode FILE.lr\n", stderr), 1;
    while (!feof(file) && !ferror(file)) {
        file_words = realloc(file_words, size + 65536);
        if (file_words == NULL) return 1;
        size += fread((char*)file_words + size, 1, 65536, file);
    }
    fclose(file);
    file_count = size / 4;

    words = section(0, 1, &count);
    if (words == NULL || lacedring_lean_validate(words, count, &lean, NULL) != LACEDRING_STATUS_OK) {
        return fputs("no valid lean stream\n", stderr), 1;
    }
    positions = section(1, 2, &count); /* the name POSITION takes eight bytes */
    if (positions == NULL || memcmp(positions, "POSITION", 8) != 0 || count != 2 + (size_t)3 * lean.vertices) {
        return fputs("no positions of 32-bit floats\n", stderr), 1;
    }
    indices = malloc(12 * (size_t)lean.triangles + 1);
    if (indices == NULL) return 1;
    lacedring_lean_triangles_u32(&lean, indices);
    for (i = 0; i < lean.vertices; ++i) {
        memcpy(xyz, positions + 2 + (size_t)3 * i, sizeof xyz);
        memcpy(p, xyz, sizeof p);
        printf("v %.9g %.9g %.9g\n", p[0], p[1], p[2]);
    }
    for (t = 0; t < lean.triangles; ++t) {
        printf("f %u %u %u\n", indices[3 * t] + 1, indices[3 * t + 1] + 1, indices[3 * t + 2] + 1);
    }
    free(indices);
    free(file_words);
    return 0;
}
