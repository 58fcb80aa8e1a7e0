/* Decodes vertex streams from standard input, each preceded by its number of words. Prints a line for each: a checksum
   of the decoded bytes, or "no", the fault and its position. */
#define LACEDRING_DECODE_IMPLEMENTATION
#include <stdio.h>
#include <stdlib.h>

#include "lacedring_vertices.h"

static size_t bytes_of(const struct lacedring_vertices* s) {
    static const size_t sizes[8] = {1, 1, 2, 2, 4, 4, 4, 8};
    return (size_t)s->vertices * lacedring_vertices_values(s) * sizes[s->type];
}

/* Whether blocks decoded one by one equal those decoded at once. */
static int same_by_blocks(const struct lacedring_vertices* s) {
    const uint32_t blocks = (s->vertices + LACEDRING_VERTICES_BLOCK - 1) / LACEDRING_VERTICES_BLOCK;
    const size_t size = (size_t)4 * s->vertices * s->components;
    uint32_t *all = malloc(size + 1), *one = malloc(size + 1), block;
    int same = all != NULL && one != NULL;
    if (same) {
        lacedring_vertices_blocks(s, 0, blocks, all);
        for (block = 0; block < blocks; ++block)
            lacedring_vertices_blocks(s, block, block + 1,
                                      one + (size_t)block * LACEDRING_VERTICES_BLOCK * s->components);
        same = memcmp(all, one, size) == 0;
    }
    free(all);
    free(one);
    return same;
}

int main(void) {
    uint32_t count;
    while (fread(&count, sizeof count, 1, stdin) == 1) {
        uint32_t *words = malloc(4 * (size_t)count + 1), sum = 0;
        uint8_t *values, *shifted;
        struct lacedring_vertices s;
        uint64_t where = 0;
        enum lacedring_status status;
        size_t i, size;
        if (words == NULL || fread(words, 4, count, stdin) != count) return 2;
        status = lacedring_vertices_validate(words, count, &s, &where);
        if (status != LACEDRING_STATUS_OK) {
            printf("no %d %llu\n", (int)status, (unsigned long long)where);
            free(words);
            continue;
        }
        size = bytes_of(&s);
        values = malloc(size + 1);
        shifted = malloc(size + 1); /* decoded to where no word may lie */
        if (values == NULL || shifted == NULL) return 2;
        lacedring_vertices_decode(&s, values);
        lacedring_vertices_decode(&s, shifted + 1);
        if (memcmp(values, shifted + 1, size) != 0) return 3;
        if (!same_by_blocks(&s)) return 4;
        for (i = 0; i < size; ++i) sum = 31 * sum + values[i];
        printf("%lu\n", (unsigned long)sum);
        free(words);
        free(values);
        free(shifted);
    }
    return 0;
}
