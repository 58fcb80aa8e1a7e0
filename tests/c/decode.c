/* Decodes lean and packed streams from standard input, each preceded by its number of words. Prints a line for each:
   its triangles, or "no" and the fault. */
#define LACEDRING_DECODE_IMPLEMENTATION
#include <stdio.h>
#include <stdlib.h>

#include "lacedring_decode.h"

/* A stream of either format. */
struct stream {
    int packed;
    struct lacedring_lean lean_view;
    struct lacedring_packed packed_view;
    uint32_t vertices, triangles;
};

static enum lacedring_status validate(const uint32_t* words, size_t count, struct stream* s, uint64_t* where) {
    enum lacedring_status status;
    s->packed = count > 0 && (words[0] & 0xffffffu) == 0x50524cu;
    if (s->packed) {
        status = lacedring_packed_validate(words, count, &s->packed_view, where);
        s->vertices = s->packed_view.vertices;
        s->triangles = s->packed_view.triangles;
    } else {
        status = lacedring_lean_validate(words, count, &s->lean_view, where);
        s->vertices = s->lean_view.vertices;
        s->triangles = s->lean_view.triangles;
    }
    return status;
}

static int same_in_16_bits(const struct stream* s, const uint32_t* indices) {
    uint16_t* narrow = malloc(6 * (size_t)s->triangles + 1);
    size_t i;
    int same = narrow != NULL;
    if (same && s->packed) lacedring_packed_triangles_u16(&s->packed_view, narrow);
    if (same && !s->packed) lacedring_lean_triangles_u16(&s->lean_view, narrow);
    for (i = 0; same && i < 3 * (size_t)s->triangles; ++i) same = narrow[i] == indices[i];
    free(narrow);
    return same;
}

/* Whether triangles decoded one by one equal those decoded at once. */
static int same_one_by_one(const struct stream* s, const uint32_t* triangles) {
    const uint32_t slots = s->packed ? s->triangles : lacedring_lean_slots(&s->lean_view);
    uint32_t *all = malloc(12 * (size_t)slots + 1), slot, t[3];
    const uint32_t* from = s->packed ? triangles : all;
    int same = all != NULL;
    if (same && !s->packed) lacedring_lean_decode(&s->lean_view, all);
    for (slot = 0; same && slot < slots; ++slot, from += 3) {
        if (s->packed) {
            lacedring_packed_triangle(&s->packed_view, slot, t);
        } else {
            lacedring_lean_slot(&s->lean_view, slot, t);
        }
        same = t[0] == from[0] && t[1] == from[1] && t[2] == from[2];
    }
    free(all);
    return same;
}

/* Whether each block decodes to the same triangles, and writes nothing beside them. */
static int same_by_blocks(const struct stream* s, const uint32_t* triangles) {
    uint32_t block, i;
    int same = 1;
    for (block = 0; same && block * LACEDRING_PACKED_BLOCK < s->triangles; ++block) {
        const uint32_t first = block * LACEDRING_PACKED_BLOCK, left = s->triangles - first;
        const uint32_t count = 3 * (left < LACEDRING_PACKED_BLOCK ? left : LACEDRING_PACKED_BLOCK);
        uint32_t* out = malloc(4 * (size_t)count);
        if (out == NULL) return 0;
        lacedring_packed_blocks_u32(&s->packed_view, block, block + 1, out);
        for (i = 0; same && i < count; ++i) same = out[i] == triangles[3 * (size_t)first + i];
        free(out);
    }
    return same;
}

int main(void) {
    uint32_t count;
    while (fread(&count, sizeof count, 1, stdin) == 1) {
        uint32_t *words = malloc(4 * (size_t)count + 1), *indices;
        struct stream s;
        uint64_t where = 0;
        enum lacedring_status status;
        uint32_t i;
        if (words == NULL || fread(words, 4, count, stdin) != count) return 2;
        status = validate(words, count, &s, &where);
        if (status != LACEDRING_STATUS_OK) {
            printf("no %d %llu\n", (int)status, (unsigned long long)where);
            free(words);
            continue;
        }
        indices = malloc(12 * (size_t)s.triangles + 1);
        if (indices == NULL) return 2;
        if (s.packed) {
            lacedring_packed_triangles_u32(&s.packed_view, indices);
        } else {
            lacedring_lean_triangles_u32(&s.lean_view, indices);
        }
        if (!same_one_by_one(&s, indices)) return 3;
        if (s.vertices <= 65536 && !same_in_16_bits(&s, indices)) return 4;
        if (s.packed && !same_by_blocks(&s, indices)) return 5;
        for (i = 0; i < 3 * s.triangles; ++i) printf("%lu ", (unsigned long)indices[i]);
        printf("\n");
        free(indices);
        free(words);
    }
    return 0;
}
