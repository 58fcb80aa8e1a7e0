/* Decodes the sections of tests/independent/write_seams.cpp with lacedring_seams.h alone. Exit code 1: copies differ.
 */
#define LACEDRING_DECODE_IMPLEMENTATION
#include <stdio.h>
#include <stdlib.h>

#include "lacedring_seams.h"

static uint32_t* take(size_t count) {
    uint32_t* words = malloc(4 * count + 4);
    if (words == NULL || fread(words, 4, count, stdin) != count) exit(2);
    return words;
}

int main(void) {
    uint32_t head[3], section = 0;
    for (; fread(head, 4, 3, stdin) == 3; ++section) {
        const size_t corners = (size_t)3 * head[1];
        uint32_t *triangles = take(corners), *words = take(head[2]), *sound = take(1);
        struct lacedring_seams seams;
        enum lacedring_status status = lacedring_seams_open(words, head[2], head[0], head[1], &seams, NULL);
        if (status == LACEDRING_STATUS_OK) status = lacedring_seams_checksum(&seams);
        if (status == LACEDRING_STATUS_OK) {
            uint32_t* scratch = malloc(4 * lacedring_seams_scratch(&seams));
            if (scratch == NULL) return 2;
            status = lacedring_seams_check(&seams, triangles, scratch, NULL);
            if (status == LACEDRING_STATUS_OK && *sound) {
                uint32_t *copies = malloc(4 * corners + 4), *wanted = take(corners);
                uint32_t* vertices = malloc(4 * (size_t)seams.copies + 4);
                size_t k;
                if (copies == NULL || vertices == NULL) return 2;
                lacedring_seams_decode(&seams, triangles, scratch, copies);
                if (memcmp(copies, wanted, 4 * corners) != 0) {
                    printf("section %u: other copies\n", (unsigned)section);
                    return 1;
                }
                lacedring_seams_copy_vertices(&seams, triangles, scratch, vertices);
                for (k = 0; k < corners; ++k) {
                    if (copies[k] == UINT32_MAX || vertices[copies[k]] == triangles[k]) continue;
                    printf("section %u: a copy of another vertex\n", (unsigned)section);
                    return 1;
                }
                free(vertices);
                free(copies);
                free(wanted);
            }
            free(scratch);
        }
        if ((status == LACEDRING_STATUS_OK) != (*sound != 0)) {
            printf("section %u: status %d\n", (unsigned)section, (int)status);
            return 1;
        }
        free(triangles);
        free(words);
        free(sound);
    }
    return section > 0 ? 0 : 1;
}
