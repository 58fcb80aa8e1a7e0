/* Decodes lean streams from standard input: for each, how many words it has, then the words. One line each: its
   triangles, or "no" and what is wrong. */
#define LACEDRING_DECODE_IMPLEMENTATION
#include <stdio.h>
#include <stdlib.h>

#include "lacedring_decode.h"

static int same_in_16_bits(const struct lacedring_lean* lean, const uint32_t* indices) {
    uint16_t* narrow = malloc(6 * (size_t)lean->triangles + 1);
    size_t i;
    int same = narrow != NULL;
    if (same) lacedring_lean_triangles_u16(lean, narrow);
    for (i = 0; same && i < 3 * (size_t)lean->triangles; ++i) same = narrow[i] == indices[i];
    free(narrow);
    return same;
}

/* All slots at once and one by one are the same. */
static int same_by_slots(const struct lacedring_lean* lean) {
    const uint32_t slots = lacedring_lean_slots(lean);
    uint32_t *all = malloc(12 * (size_t)slots + 1), slot, t[3];
    int same = all != NULL;
    if (same) lacedring_lean_decode(lean, all);
    for (slot = 0; same && slot < slots; ++slot) {
        const uint32_t* from = all + 3 * (size_t)slot;
        lacedring_lean_slot(lean, slot, t);
        same = t[0] == from[0] && t[1] == from[1] && t[2] == from[2];
    }
    free(all);
    return same;
}

int main(void) {
    uint32_t count;
    while (fread(&count, sizeof count, 1, stdin) == 1) {
        uint32_t *words = malloc(4 * (size_t)count + 1), *indices;
        struct lacedring_lean lean;
        uint64_t where = 0;
        enum lacedring_status status;
        uint32_t i;
        if (words == NULL || fread(words, 4, count, stdin) != count) return 2;
        status = lacedring_lean_validate(words, count, &lean, &where);
        if (status != LACEDRING_STATUS_OK) {
            printf("no %d %llu\n", (int)status, (unsigned long long)where);
            free(words);
            continue;
        }
        indices = malloc(12 * (size_t)lean.triangles + 1);
        if (indices == NULL) return 2;
        lacedring_lean_triangles_u32(&lean, indices);
        if (!same_by_slots(&lean)) return 3;
        if (lean.vertices <= 65536 && !same_in_16_bits(&lean, indices)) return 4;
        for (i = 0; i < 3 * lean.triangles; ++i) printf("%lu ", (unsigned long)indices[i]);
        printf("\n");
        free(indices);
        free(words);
    }
    return 0;
}
