/* Prints the surface of an .lr file in storage form (docs/lr-file.md) as OBJ: what lacedring encode --storage MESH -o
   FILE.lr writes. Attributes have their names and sums in comments. */
#define LACEDRING_DECODE_IMPLEMENTATION
#include <stdio.h>
#include <stdlib.h>

#include "lacedring_storage.h"

enum { HEADER_WORDS = 8, SECTION_WORDS = 8, PACKED = 7, VERTICES = 8, STORED = 1 };

static uint32_t* file_words;
static size_t file_count;

static int fail(const char* what, int status, uint64_t where) {
    fprintf(stderr, "%s: %d at %llu\n", what, status, (unsigned long long)where);
    return 1;
}

/* The words of a section; null: it lies beyond the file. */
static const uint32_t* contents_of(const uint32_t* section, size_t* count) {
    const size_t first = section[2] / 4;
    *count = (section[4] + 3) / 4;
    if (section[3] != 0 || section[5] != 0 || first > file_count || *count > file_count - first) return NULL;
    return file_words + first;
}

static int print_attribute(const uint32_t* words, size_t count, uint32_t name_bytes, const uint32_t* triangles,
                           uint32_t triangle_count) {
    static const size_t sizes[8] = {1, 1, 2, 2, 4, 4, 4, 8};
    const size_t name_words = ((size_t)name_bytes + 7) / 8 * 2;
    struct lacedring_stored_vertices s;
    uint64_t where = 0;
    enum lacedring_status status;
    uint32_t* integers;
    uint8_t* values;
    void* scratch;
    size_t size, i;
    unsigned long sum = 0;
    if (name_words > count) return fail("a name beyond its section", 0, 0);
    status = lacedring_stored_vertices_open(words + name_words, count - name_words, file_words[3], &s, &where);
    if (status != LACEDRING_STATUS_OK) return fail("attribute", status, where);
    size = (size_t)file_words[3] * lacedring_vertices_values(&s.attribute) * sizes[s.attribute.type];
    scratch = malloc(lacedring_stored_vertices_scratch(&s, triangle_count, NULL));
    integers = malloc(4 * (size_t)file_words[3] * s.attribute.components + 1);
    values = malloc(size + 1);
    if (scratch == NULL || integers == NULL || values == NULL) return fail("no memory", 0, 0);
    status = lacedring_stored_vertices_decode(&s, triangles, triangle_count, NULL, scratch, integers, &where);
    if (status != LACEDRING_STATUS_OK) return fail("integers", status, where);
    lacedring_stored_vertices_values(&s, integers, values);
    for (i = 0; i < size; ++i) sum = (31 * sum + values[i]) & 0xffffffffu;
    printf("# %.*s %lu\n", (int)name_bytes, (const char*)words, sum);
    if (name_bytes == 8 && memcmp(words, "POSITION", 8) == 0 && s.attribute.type == 6) {
        for (i = 0; i < size; i += 12) {
            float p[3];
            memcpy(p, values + i, 12);
            printf("v %.9g %.9g %.9g\n", (double)p[0], (double)p[1], (double)p[2]);
        }
    }
    free(scratch);
    free(integers);
    free(values);
    return 0;
}

int main(int argc, char** argv) {
    FILE* file = argc == 2 ? fopen(argv[1], "rb") : NULL;
    struct lacedring_stored_packed mesh;
    uint32_t *triangles = NULL, i;
    uint64_t where = 0;
    size_t size = 0, count, t;
    if (file == NULL) return fail("storage FILE.lr", 0, 0);
    while (!feof(file) && !ferror(file)) {
        file_words = realloc(file_words, size + 65536);
        if (file_words == NULL) return fail("no memory", 0, 0);
        size += fread((char*)file_words + size, 1, 65536, file);
    }
    fclose(file);
    file_count = size / 4;
    if (file_count < HEADER_WORDS || file_words[2] > (file_count - HEADER_WORDS) / SECTION_WORDS)
        return fail("no .lr file", 0, 0);
    for (i = 0; i < file_words[2]; ++i) {
        const uint32_t* section = file_words + HEADER_WORDS + (size_t)SECTION_WORDS * i;
        const uint32_t* words = contents_of(section, &count);
        if (words == NULL) return fail("a section beyond the file", 0, i);
        if (section[0] == (PACKED | STORED << 16) && triangles == NULL) { /* it comes before attributes */
            void* scratch;
            enum lacedring_status status =
                lacedring_stored_packed_open(words, count, file_words[3], file_words[4], &mesh, &where);
            if (status != LACEDRING_STATUS_OK) return fail("connectivity", status, where);
            scratch = malloc(lacedring_stored_packed_scratch(&mesh));
            triangles = malloc(12 * (size_t)mesh.triangles + 1);
            if (scratch == NULL || triangles == NULL) return fail("no memory", 0, 0);
            status = lacedring_stored_packed_decode(&mesh, scratch, triangles, &where);
            if (status != LACEDRING_STATUS_OK) return fail("steps", status, where);
            free(scratch);
        } else if (section[0] == (VERTICES | STORED << 16) && triangles != NULL) {
            if (print_attribute(words, count, section[7], triangles, mesh.triangles) != 0) return 1;
        }
    }
    if (triangles == NULL) return fail("no stored packed stream", 0, 0);
    for (t = 0; t < mesh.triangles; ++t)
        printf("f %lu %lu %lu\n", (unsigned long)triangles[3 * t] + 1, (unsigned long)triangles[3 * t + 1] + 1,
               (unsigned long)triangles[3 * t + 2] + 1);
    free(triangles);
    free(file_words);
    return 0;
}
