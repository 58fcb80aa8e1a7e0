/* Prints an .lr file of a packed stream (docs/lr-file.md), in storage form or resident, as OBJ. Comments have the name
   and a checksum of each attribute. A corner has the number of its vertex, and the vertex or copy of its texture
   coordinate and normal. */
#define LACEDRING_DECODE_IMPLEMENTATION
#include <stdio.h>
#include <stdlib.h>

#include "lacedring_storage.h"
#include "lacedring_stored_seams.h"

enum { HEADER_WORDS = 8, SECTION_WORDS = 8, PACKED = 7, VERTICES = 8, SEAMS = 9, STORED = 1 };
enum { V_AT_LOWER_EDGE = 1 << 17, OF_COPIES = 1 << 18 }; /* flags of attributes */

/* The sections decoded so far. The mesh has file_words[3] vertices and file_words[5] copies. */
struct mesh {
    uint32_t* triangles; /* three vertices each */
    uint32_t* corners;   /* three copies per triangle; null without seams */
    uint32_t triangle_count;
    uint32_t* vertex_of; /* by copy */
    uint32_t* positions; /* integers for predictions */
    /* triangles or corners, by which the attribute is numbered; null without the attribute */
    const uint32_t *texcoord, *normal;
};

static uint32_t* file_words;
static size_t file_count;

static int fail(const char* what, unsigned status, uint64_t where) {
    fprintf(stderr, "%s: %u at %llu\n", what, status, (unsigned long long)where);
    return 1;
}

/* The words of a section; null if it is beyond the file or damaged. */
static const uint32_t* contents_of(const uint32_t* section, size_t* count) {
    const size_t first = section[2] / 4;
    *count = section[4] / 4 + (section[4] % 4 != 0);
    if (section[3] != 0 || section[5] != 0 || first > file_count || *count > file_count - first) return NULL;
    return lacedring_crc32(file_words + first, section[4]) == section[1] ? file_words + first : NULL;
}

/* Prints an attribute that OBJ has. */
static void print_values(const char* as, const uint8_t* values, size_t size, uint32_t components, int turns_v) {
    size_t i;
    uint32_t c;
    for (i = 0; i < size; i += 4 * (size_t)components) {
        printf("%s", as);
        for (c = 0; c < components; ++c) {
            float value;
            memcpy(&value, values + i + 4 * (size_t)c, 4);
            printf(" %.9g", (double)(turns_v && c == 1 ? 1 - value : value));
        }
        printf("\n");
    }
}

static int is_name(const uint32_t* words, uint32_t bytes, const char* name) {
    return bytes == strlen(name) && memcmp(words, name, bytes) == 0;
}

/* An attribute: the header of its stream, its integers and values. */
struct attribute {
    struct lacedring_vertices stream;
    uint32_t* integers;
    uint8_t* values;
    size_t bytes; /* of the values */
};

static int make_room(struct attribute* a) {
    static const size_t sizes[8] = {1, 1, 2, 2, 4, 4, 4, 8};
    a->bytes = (size_t)a->stream.vertices * lacedring_vertices_values(&a->stream) * sizes[a->stream.type];
    a->integers = malloc(4 * (size_t)a->stream.vertices * a->stream.components + 1);
    a->values = malloc(a->bytes + 1);
    return a->integers != NULL && a->values != NULL ? 0 : fail("no memory", 0, 0);
}

static int read_stored(const uint32_t* words, size_t count, int of_copies, const struct mesh* mesh,
                       struct attribute* a) {
    const uint32_t* triangles = of_copies ? mesh->corners : mesh->triangles;
    struct lacedring_positions positions;
    struct lacedring_stored_vertices s;
    uint64_t where = 0;
    void* scratch;
    enum lacedring_status status =
        lacedring_stored_vertices_open(words, count, file_words[of_copies ? 5 : 3], &s, &where);
    if (status != LACEDRING_STATUS_OK) return fail("attribute", status, where);
    if (s.by_positions && mesh->positions == NULL) return fail("no positions that predict", 0, 0);
    positions.integers = mesh->positions;
    positions.vertices = file_words[3];
    positions.vertex_of = of_copies ? mesh->vertex_of : NULL;
    a->stream = s.attribute;
    scratch = malloc(lacedring_stored_vertices_scratch(&s, mesh->triangle_count, &positions));
    if (make_room(a) != 0 || scratch == NULL) return fail("no memory", 0, 0);
    status =
        lacedring_stored_vertices_decode(&s, triangles, mesh->triangle_count, &positions, scratch, a->integers, &where);
    if (status != LACEDRING_STATUS_OK) return fail("integers", status, where);
    lacedring_stored_vertices_values(&s, a->integers, a->values);
    free(scratch);
    return 0;
}

static int read_resident(const uint32_t* words, size_t count, int of_copies, struct attribute* a) {
    uint64_t where = 0;
    const enum lacedring_status status = lacedring_vertices_validate(words, count, &a->stream, &where);
    if (status != LACEDRING_STATUS_OK) return fail("stream", status, where);
    if (a->stream.vertices != file_words[of_copies ? 5 : 3]) return fail("vertices", 0, a->stream.vertices);
    if (make_room(a) != 0) return 1;
    lacedring_vertices_blocks(
        &a->stream, 0, (a->stream.vertices + LACEDRING_VERTICES_BLOCK - 1) / LACEDRING_VERTICES_BLOCK, a->integers);
    lacedring_vertices_decode(&a->stream, a->values);
    return 0;
}

static int print_attribute(const uint32_t* words, size_t count, const uint32_t* section, struct mesh* mesh) {
    const uint32_t name_bytes = section[7];
    const size_t name_words = ((size_t)name_bytes + 7) / 8 * 2;
    const int of_copies = (section[6] & OF_COPIES) != 0;
    const uint32_t* triangles = of_copies ? mesh->corners : mesh->triangles;
    struct attribute a;
    uint32_t of_value;
    size_t i;
    unsigned long sum = 0;
    int is_position;
    if (name_words > count) return fail("a name beyond its section", 0, 0);
    if (triangles == NULL) return fail("copies without seams", 0, 0);
    is_position = is_name(words, name_bytes, "POSITION");
    if (section[0] >> 16 == STORED ? read_stored(words + name_words, count - name_words, of_copies, mesh, &a)
                                   : read_resident(words + name_words, count - name_words, of_copies, &a))
        return 1;
    for (i = 0; i < a.bytes; ++i) sum = (31 * sum + a.values[i]) & 0xffffffffu;
    printf("# %.*s %lu\n", (int)name_bytes, (const char*)words, sum);
    of_value = a.stream.type == 6 ? lacedring_vertices_values(&a.stream) : 0;
    if (is_position && of_value == 3) print_values("v", a.values, a.bytes, 3, 0);
    if (is_name(words, name_bytes, "NORMAL") && of_value == 3) {
        print_values("vn", a.values, a.bytes, 3, 0);
        mesh->normal = triangles;
    }
    if (is_name(words, name_bytes, "TEXCOORD_0") && of_value == 2) {
        print_values("vt", a.values, a.bytes, 2, (section[6] & V_AT_LOWER_EDGE) == 0);
        mesh->texcoord = triangles;
    }
    free(a.values);
    if (is_position && mesh->positions == NULL && a.stream.components == 3 &&
        (a.stream.mapping == LACEDRING_MAPPING_LATTICE || a.stream.mapping == LACEDRING_MAPPING_DECIMALS))
        mesh->positions = a.integers;
    else
        free(a.integers);
    return 0;
}

static int read_stored_triangles(const uint32_t* words, size_t count, struct mesh* mesh) {
    struct lacedring_stored_packed s;
    uint64_t where = 0;
    void* scratch;
    enum lacedring_status status = lacedring_stored_packed_open(words, count, file_words[3], file_words[4], &s, &where);
    if (status != LACEDRING_STATUS_OK) return fail("connectivity", status, where);
    scratch = malloc(lacedring_stored_packed_scratch(&s));
    mesh->triangles = malloc(12 * (size_t)s.triangles + 1);
    mesh->triangle_count = s.triangles;
    if (scratch == NULL || mesh->triangles == NULL) return fail("no memory", 0, 0);
    status = lacedring_stored_packed_decode(&s, scratch, mesh->triangles, &where);
    if (status != LACEDRING_STATUS_OK) return fail("steps", status, where);
    free(scratch);
    return s.vertices == file_words[3] ? 0 : fail("vertices", 0, s.vertices);
}

static int read_resident_triangles(const uint32_t* words, size_t count, struct mesh* mesh) {
    struct lacedring_packed packed;
    uint64_t where = 0;
    const enum lacedring_status status = lacedring_packed_validate(words, count, &packed, &where);
    if (status != LACEDRING_STATUS_OK) return fail("connectivity", status, where);
    if (packed.vertices != file_words[3]) return fail("vertices", 0, packed.vertices);
    mesh->triangles = malloc(12 * (size_t)packed.triangles + 1);
    mesh->triangle_count = packed.triangles;
    if (mesh->triangles == NULL) return fail("no memory", 0, 0);
    lacedring_packed_triangles_u32(&packed, mesh->triangles);
    return 0;
}

static int read_stored_seams(const uint32_t* words, size_t count, struct mesh* mesh) {
    struct lacedring_stored_seams s;
    uint64_t where = 0;
    void* scratch;
    enum lacedring_status status =
        lacedring_stored_seams_open(words, count, file_words[3], mesh->triangle_count, file_words[5], &s, &where);
    if (status != LACEDRING_STATUS_OK) return fail("seams", status, where);
    scratch = malloc(lacedring_stored_seams_scratch(&s));
    mesh->corners = malloc(12 * (size_t)mesh->triangle_count + 1);
    mesh->vertex_of = malloc(4 * (size_t)s.most_copies + 1);
    if (scratch == NULL || mesh->corners == NULL || mesh->vertex_of == NULL) return fail("no memory", 0, 0);
    status = lacedring_stored_seams_decode(&s, mesh->triangles, scratch, mesh->corners, mesh->vertex_of, &where);
    if (status != LACEDRING_STATUS_OK) return fail("copies", status, where);
    free(scratch);
    return s.copies == file_words[5] ? 0 : fail("copies", 0, s.copies);
}

static int read_resident_seams(const uint32_t* words, size_t count, struct mesh* mesh) {
    struct lacedring_seams s;
    uint64_t where = 0;
    uint32_t* scratch;
    enum lacedring_status status = lacedring_seams_open(words, count, file_words[3], mesh->triangle_count, &s, &where);
    if (status == LACEDRING_STATUS_OK) status = lacedring_seams_checksum(&s);
    if (status != LACEDRING_STATUS_OK) return fail("seams", status, where);
    scratch = malloc(4 * lacedring_seams_scratch(&s));
    mesh->corners = malloc(12 * (size_t)mesh->triangle_count + 1);
    mesh->vertex_of = malloc(4 * (size_t)s.copies + 1);
    if (scratch == NULL || mesh->corners == NULL || mesh->vertex_of == NULL) return fail("no memory", 0, 0);
    status = lacedring_seams_check(&s, mesh->triangles, scratch, &where);
    if (status != LACEDRING_STATUS_OK) return fail("copies", status, where);
    lacedring_seams_decode(&s, mesh->triangles, scratch, mesh->corners);
    lacedring_seams_copy_vertices(&s, mesh->triangles, scratch, mesh->vertex_of);
    free(scratch);
    return s.copies == file_words[5] ? 0 : fail("copies", 0, s.copies);
}

static void print_corner(const struct mesh* mesh, size_t c) {
    printf(" %lu", (unsigned long)mesh->triangles[c] + 1);
    if (mesh->texcoord != NULL || mesh->normal != NULL) printf("/");
    if (mesh->texcoord != NULL) printf("%lu", (unsigned long)mesh->texcoord[c] + 1);
    if (mesh->normal != NULL) printf("/%lu", (unsigned long)mesh->normal[c] + 1);
}

int main(int argc, char** argv) {
    FILE* file = argc == 2 ? fopen(argv[1], "rb") : NULL;
    struct mesh mesh;
    uint32_t i;
    size_t size = 0, count, t;
    memset(&mesh, 0, sizeof mesh);
    if (file == NULL) return fail("storage FILE.lr", 0, 0);
    while (!feof(file) && !ferror(file)) {
        file_words = realloc(file_words, size + 65536);
        if (file_words == NULL) return fail("no memory", 0, 0);
        size += fread((char*)file_words + size, 1, 65536, file);
    }
    fclose(file);
    file_count = size / 4;
    if (file_count < HEADER_WORDS || file_words[1] != 4 || lacedring_crc32(file_words, 28) != file_words[7] ||
        file_words[2] > (file_count - HEADER_WORDS) / SECTION_WORDS ||
        lacedring_crc32(file_words + HEADER_WORDS, 32 * (size_t)file_words[2]) != file_words[6])
        return fail("no .lr file of version 4, or its header or section table is damaged", 0, 0);
    for (i = 0; i < file_words[2]; ++i) { /* connectivity, seams, POSITION, other attributes */
        const uint32_t* section = file_words + HEADER_WORDS + (size_t)SECTION_WORDS * i;
        const uint32_t* words = contents_of(section, &count);
        int failed = 0;
        if (words == NULL) return fail("a section beyond the file, or damaged", 0, i);
        /* Each section is in storage form, or resident where that is smaller. */
        if ((section[0] & 0xffff) == PACKED && mesh.triangles == NULL)
            failed = section[0] >> 16 == STORED ? read_stored_triangles(words, count, &mesh)
                                                : read_resident_triangles(words, count, &mesh);
        else if ((section[0] & 0xffff) == SEAMS && mesh.triangles != NULL && mesh.corners == NULL)
            failed = section[0] >> 16 == STORED ? read_stored_seams(words, count, &mesh)
                                                : read_resident_seams(words, count, &mesh);
        else if ((section[0] & 0xffff) == VERTICES && mesh.triangles != NULL)
            failed = print_attribute(words, count, section, &mesh);
        if (failed) return 1;
    }
    if (mesh.triangles == NULL) return fail("no packed stream", 0, 0);
    for (t = 0; t < mesh.triangle_count; ++t) {
        printf("f");
        print_corner(&mesh, 3 * t);
        print_corner(&mesh, 3 * t + 1);
        print_corner(&mesh, 3 * t + 2);
        printf("\n");
    }
    free(mesh.triangles);
    free(mesh.corners);
    free(mesh.vertex_of);
    free(mesh.positions);
    free(file_words);
    return 0;
}
