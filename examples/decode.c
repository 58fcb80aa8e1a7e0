/* Prints the surface of an .lr file (docs/lr-file.md) as OBJ. Make the file with lacedring encode MESH -o FILE.lr, with
   --resident or without. */
#define LACEDRING_DECODE_IMPLEMENTATION
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "lacedring_storage.h"

enum { PACKED = 7, VERTEX_STREAM = 8 }; /* kinds of sections */

static uint32_t* file_words; /* the whole file; sections begin at multiples of 8 bytes */
static size_t file_count;

static int fail(const char* what) {
    fprintf(stderr, "decode: %s\n", what);
    return 1;
}

/* Finds the first section of a kind. `stored`: whether it is in storage form. Returns null if the file has none that is
   intact. */
static const uint32_t* section(uint32_t kind, size_t* count, int* stored) {
    size_t i;
    for (i = 0; i < file_words[2]; ++i) {
        /* kind and form, CRC-32, offset, size, layout, length of the name */
        const uint32_t* s = file_words + 8 + 8 * i;
        if ((s[0] & 0xffff) != kind) continue;
        *count = s[4] / 4;
        *stored = (int)(s[0] >> 16);
        if (s[3] != 0 || s[5] != 0 || s[2] / 4 > file_count || *count > file_count - s[2] / 4) return NULL;
        /* Nothing else finds changed bits in storage form. */
        return lacedring_crc32(file_words + s[2] / 4, 4 * *count) == s[1] ? file_words + s[2] / 4 : NULL;
    }
    return NULL;
}

/* Returns three vertices per triangle, or null. */
static uint32_t* read_triangles(const uint32_t* words, size_t count, int stored, uint32_t* triangles) {
    const uint32_t most = file_words[4];
    uint32_t* indices;
    if (stored) {
        struct lacedring_stored_packed s;
        void* scratch;
        int failed;
        if (lacedring_stored_packed_open(words, count, file_words[3], most, &s, NULL) != LACEDRING_STATUS_OK)
            return NULL;
        indices = malloc(12 * (size_t)s.triangles + 1);
        scratch = malloc(lacedring_stored_packed_scratch(&s));
        failed = indices == NULL || scratch == NULL || s.vertices != file_words[3] ||
                 lacedring_stored_packed_decode(&s, scratch, indices, NULL) != LACEDRING_STATUS_OK;
        free(scratch);
        *triangles = s.triangles;
        return failed ? NULL : indices;
    } else {
        struct lacedring_packed packed;
        if (lacedring_packed_validate(words, count, &packed, NULL) != LACEDRING_STATUS_OK) return NULL;
        if (packed.vertices != file_words[3] || packed.triangles > most) return NULL;
        indices = malloc(12 * (size_t)packed.triangles + 1);
        if (indices != NULL) lacedring_packed_triangles_u32(&packed, indices);
        *triangles = packed.triangles;
        return indices;
    }
}

static int is_position(const struct lacedring_vertices* v) {
    return v->vertices == file_words[3] && v->type == 6 /* float */ && lacedring_vertices_values(v) == 3;
}

/* Returns three floats per vertex, or null. In storage form the triangles predict them. */
static float* read_positions(const uint32_t* words, size_t count, int stored, const uint32_t* indices,
                             uint32_t triangles) {
    float* positions = malloc(12 * (size_t)file_words[3] + 1);
    if (stored) {
        struct lacedring_stored_vertices s;
        uint32_t* integers;
        void* scratch;
        int failed;
        if (lacedring_stored_vertices_open(words, count, file_words[3], &s, NULL) != LACEDRING_STATUS_OK ||
            !is_position(&s.attribute))
            return NULL;
        integers = malloc(4 * (size_t)file_words[3] * s.attribute.components + 1);
        scratch = malloc(lacedring_stored_vertices_scratch(&s, triangles, NULL));
        failed = positions == NULL || integers == NULL || scratch == NULL ||
                 lacedring_stored_vertices_decode(&s, indices, triangles, NULL, scratch, integers, NULL) !=
                     LACEDRING_STATUS_OK;
        if (!failed) lacedring_stored_vertices_values(&s, integers, positions);
        free(scratch);
        free(integers);
        return failed ? NULL : positions;
    } else {
        struct lacedring_vertices v;
        if (positions == NULL || lacedring_vertices_validate(words, count, &v, NULL) != LACEDRING_STATUS_OK ||
            !is_position(&v))
            return NULL;
        lacedring_vertices_decode(&v, positions);
        return positions;
    }
}

int main(int argc, char** argv) {
    FILE* file = argc == 2 ? fopen(argv[1], "rb") : NULL;
    const uint32_t* words;
    uint32_t *indices, triangles = 0, i;
    float* p;
    size_t size = 0, count = 0, t;
    int stored = 0;
    if (file == NULL) return fail("decode FILE.lr");
    while (!feof(file) && !ferror(file)) {
        file_words = realloc(file_words, size + 65536);
        if (file_words == NULL) return fail("no memory");
        size += fread((char*)file_words + size, 1, 65536, file);
    }
    fclose(file);
    file_count = size / 4;
    if (file_count < 8 || file_words[0] != 0x4c46524c || file_words[1] != 4 ||
        lacedring_crc32(file_words, 28) != file_words[7] || file_words[2] > (file_count - 8) / 8 ||
        lacedring_crc32(file_words + 8, 32 * (size_t)file_words[2]) != file_words[6])
        return fail("no .lr file of version 4, or its header or section table is damaged");

    words = section(PACKED, &count, &stored);
    indices = words == NULL ? NULL : read_triangles(words, count, stored, &triangles);
    if (indices == NULL) return fail("no valid packed stream");
    words = section(VERTEX_STREAM, &count, &stored); /* begins with the name: POSITION, in 8 bytes */
    p = words == NULL || count < 2 || memcmp(words, "POSITION", 8) != 0
            ? NULL
            : read_positions(words + 2, count - 2, stored, indices, triangles);
    if (p == NULL) return fail("no valid positions of 32-bit floats");

    for (i = 0; i < file_words[3]; ++i) {
        printf("v %.9g %.9g %.9g\n", p[3 * (size_t)i], p[3 * (size_t)i + 1], p[3 * (size_t)i + 2]);
    }
    for (t = 0; t < triangles; ++t) {
        printf("f %u %u %u\n", indices[3 * t] + 1, indices[3 * t + 1] + 1, indices[3 * t + 2] + 1);
    }
    free(p);
    free(indices);
    free(file_words);
    return 0;
}
