/* Calls every function of lacedring.h from C99 and compares the results with the triangle list. Prints each failed
   check with its function and mesh; the exit code is then 1. */

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "lacedring/lacedring.h"

static int failures = 0;
static const char *format_name = "no format", *mesh_name = "no mesh";
#define CHECK(what)                                                                                 \
    do {                                                                                            \
        if (!(what)) {                                                                              \
            printf("%s, %s, %s, line %d: %s\n", __func__, format_name, mesh_name, __LINE__, #what); \
            ++failures;                                                                             \
        }                                                                                           \
    } while (0)

struct mesh {
    uint32_t* indices;
    size_t count;
    uint32_t vertices;
};

/* closed: a torus of n by n squares. Otherwise n by n squares without the last triangle; with `pinched`, two opposite
   corners of the grid are the same vertex, which then has two fans. */
static struct mesh make_mesh(uint32_t n, int closed, int pinched) {
    struct mesh m;
    uint32_t x, y;
    const uint32_t side = closed ? n : n + 1;
    m.vertices = side * side;
    m.indices = malloc(sizeof(uint32_t) * 6 * n * n);
    m.count = 0;
    for (y = 0; y < n; ++y) {
        for (x = 0; x < n; ++x) {
            const uint32_t a = y * side + x, b = y * side + (x + 1) % side;
            const uint32_t c = (y + 1) % side * side + x, d = (y + 1) % side * side + (x + 1) % side;
            const uint32_t square[6] = {a, b, d, a, d, c};
            memcpy(m.indices + m.count, square, sizeof square);
            m.count += 6;
        }
    }
    if (!closed) m.count -= 3;
    if (pinched) {
        size_t i;
        for (i = 0; i < m.count; ++i) {
            if (m.indices[i] == n) m.indices[i] = n * side; /* the right upper corner becomes the left lower */
        }
    }
    return m;
}

/* Rotates the smallest vertex to the front. */
static void turn(uint32_t t[3]) {
    while (t[0] > t[1] || t[0] > t[2]) {
        const uint32_t first = t[0];
        t[0] = t[1];
        t[1] = t[2];
        t[2] = first;
    }
}

static int compare(const void* a, const void* b) {
    return memcmp(a, b, 3 * sizeof(uint32_t));
}

static void sort_triangles(uint32_t* indices, size_t triangles) {
    size_t i;
    for (i = 0; i < triangles; ++i) turn(indices + 3 * i);
    qsort(indices, triangles, 3 * sizeof *indices, compare);
}

static void check_corner_operators(const struct lacedring_tables* tables, uint32_t t, uint32_t c) {
    const uint32_t o = lacedring_opposite(tables, c);
    CHECK(lacedring_triangle(c) == t);
    CHECK(lacedring_left(tables, c) == lacedring_opposite(tables, lacedring_next(c)));
    CHECK(lacedring_right(tables, c) == lacedring_opposite(tables, lacedring_previous(c)));
    if (o != LACEDRING_NULL) {
        CHECK(lacedring_opposite(tables, o) == c);
        CHECK(lacedring_vertex(tables, lacedring_next(o)) == lacedring_vertex(tables, lacedring_previous(c)));
    }
    if (lacedring_swing(tables, c) != LACEDRING_NULL) {
        CHECK(lacedring_vertex(tables, lacedring_swing(tables, c)) == lacedring_vertex(tables, c));
    }
}

/* The vertices of each triangle's corners are those that lacedring_decode_triangle gives. Counts corners by vertex. */
static void check_triangles(const struct lacedring_stream* stream, const struct lacedring_tables* tables,
                            uint32_t* corners_at) {
    uint32_t t, k;
    for (t = 0; t < stream->slots; ++t) {
        uint32_t decoded[3], own[3];
        CHECK(lacedring_decode_triangle(stream, t, decoded) == lacedring_is_triangle(tables, t));
        if (!lacedring_is_triangle(tables, t)) continue;
        for (k = 0; k < 3; ++k) {
            const uint32_t c = k == 0   ? lacedring_corner_of_triangle(t)
                               : k == 1 ? lacedring_next(lacedring_corner_of_triangle(t))
                                        : lacedring_previous(lacedring_corner_of_triangle(t));
            check_corner_operators(tables, t, c);
            own[k] = lacedring_vertex(tables, c);
            ++corners_at[own[k]];
            own[k] = lacedring_original(tables, own[k]);
        }
        turn(own);
        turn(decoded);
        CHECK(memcmp(own, decoded, sizeof own) == 0);
    }
}

static void check_null_corner(const struct lacedring_tables* tables) {
    uint32_t neighbors[64];
    CHECK(lacedring_next(LACEDRING_NULL) == LACEDRING_NULL && lacedring_previous(LACEDRING_NULL) == LACEDRING_NULL);
    CHECK(lacedring_vertex(tables, LACEDRING_NULL) == LACEDRING_NULL);
    CHECK(lacedring_opposite(tables, LACEDRING_NULL) == LACEDRING_NULL);
    CHECK(lacedring_corner_of_vertex(tables, LACEDRING_NULL) == LACEDRING_NULL);
    CHECK(lacedring_valence(tables, LACEDRING_NULL) == 0 && !lacedring_is_border(tables, LACEDRING_NULL));
    CHECK(lacedring_neighbors(tables, LACEDRING_NULL, neighbors, 64) == 0);
}

static void check_vertex_operators(const struct lacedring_tables* tables, uint32_t v, uint32_t corners) {
    uint32_t neighbors[64];
    const uint32_t c = lacedring_corner_of_vertex(tables, v);
    const uint32_t edges = lacedring_neighbors(tables, v, neighbors, 64);
    CHECK((c == LACEDRING_NULL) == (corners == 0));
    if (c == LACEDRING_NULL) return;
    CHECK(lacedring_vertex(tables, c) == v);
    CHECK(edges == lacedring_valence(tables, v));
    CHECK(edges == corners + (uint32_t)lacedring_is_border(tables, v));
    /* A shorter buffer gets its size, and the same count is returned. */
    neighbors[1] = LACEDRING_NULL;
    CHECK(lacedring_neighbors(tables, v, neighbors, 1) == edges);
    CHECK(neighbors[1] == LACEDRING_NULL);
}

/* Every operator on every corner and vertex of LR tables; other formats have none. */
static void check_tables(const struct lacedring_stream* stream, const struct mesh* mesh) {
    struct lacedring_tables tables;
    uint32_t v, copies = 0;
    uint32_t* corners_at;
    if (stream->format == LACEDRING_FORMAT_LEAN || stream->format == LACEDRING_FORMAT_PACKED) {
        CHECK(lacedring_open_tables(stream, &tables) == LACEDRING_CODE_INVALID_ARGUMENT);
        return;
    }
    CHECK(lacedring_open_tables(stream, &tables) == LACEDRING_CODE_OK);
    corners_at = calloc(stream->vertices, sizeof *corners_at);
    check_triangles(stream, &tables, corners_at);
    check_null_corner(&tables);
    for (v = 0; v < stream->vertices; ++v) {
        check_vertex_operators(&tables, v, corners_at[v]);
        if (lacedring_original(&tables, v) != v) ++copies;
    }
    CHECK(stream->vertices == mesh->vertices + copies);
    free(corners_at);
}

static void check_validate(const struct lacedring_encoded* encoded, const struct lacedring_encode_options* options,
                           const struct mesh* mesh, int pinched, struct lacedring_stream* stream) {
    struct lacedring_stream again;
    struct lacedring_message message;
    CHECK(encoded->triangle_count == mesh->count / 3 && encoded->degenerate == 0);
    CHECK(lacedring_validate(encoded->words, encoded->word_count, stream, &message) == LACEDRING_CODE_OK);
    CHECK(lacedring_view(encoded->words, encoded->word_count, &again, NULL) == LACEDRING_CODE_OK);
    CHECK(again.slots == stream->slots && again.triangles == stream->triangles && again.format == stream->format);
    CHECK((int)stream->format == (int)options->format);
    CHECK(stream->triangles == mesh->count / 3 && stream->vertices == encoded->vertex_count);
    CHECK((stream->vertices > mesh->vertices) == (pinched && stream->format >= LACEDRING_FORMAT_LR));
}

/* 32-bit and 16-bit indices, blocks and single triangles are the same. */
static void check_decoding(const struct lacedring_stream* stream, uint32_t* indices, size_t count) {
    uint32_t i, triangles = 0;
    uint32_t* blocks = malloc(4 * (count + 3 * LACEDRING_BLOCK));
    uint16_t* narrow = malloc(2 * count);
    CHECK(lacedring_decode_u32(stream, indices, count - 1) == LACEDRING_CODE_TOO_SMALL);
    CHECK(lacedring_decode_u32(stream, indices, count) == LACEDRING_CODE_OK);
    CHECK(lacedring_decode_u16(stream, narrow, count) == LACEDRING_CODE_OK);
    for (i = 0; i < stream->blocks; ++i) {
        uint32_t found = 0;
        CHECK(lacedring_decode_block(stream, i, blocks + 3 * triangles, 3 * LACEDRING_BLOCK, &found) ==
              LACEDRING_CODE_OK);
        triangles += found;
    }
    CHECK(triangles == stream->triangles);
    for (i = 0; i < count; ++i) CHECK(narrow[i] == indices[i] && blocks[i] == indices[i]);
    CHECK(lacedring_decode_block(stream, stream->blocks, blocks, 3 * LACEDRING_BLOCK, &i) ==
          LACEDRING_CODE_INVALID_ARGUMENT);
    CHECK(lacedring_decode_block(stream, 0, blocks, 2, &i) == LACEDRING_CODE_TOO_SMALL);
    for (i = 0, triangles = 0; i < stream->slots; ++i) {
        uint32_t t[3];
        if (!lacedring_decode_triangle(stream, i, t)) continue;
        CHECK(memcmp(t, indices + 3 * triangles, sizeof t) == 0);
        ++triangles;
    }
    CHECK(triangles == stream->triangles && !lacedring_decode_triangle(stream, stream->slots, blocks));
    free(blocks);
    free(narrow);
}

/* Each decoded triangle is the one of triangle_order, with vertices by vertex_order, and together they are the mesh. */
static void check_orders(const struct lacedring_encoded* encoded, const struct mesh* mesh, uint32_t* indices) {
    uint32_t i, k;
    uint32_t* wanted = malloc(4 * mesh->count);
    for (i = 0; i < mesh->count / 3; ++i) {
        uint32_t got[3], want[3];
        for (k = 0; k < 3; ++k) got[k] = encoded->vertex_order[indices[3 * i + k]];
        memcpy(want, mesh->indices + 3 * (size_t)encoded->triangle_order[i], sizeof want);
        turn(got);
        turn(want);
        CHECK(memcmp(got, want, sizeof got) == 0);
    }
    for (i = 0; i < mesh->count; ++i) indices[i] = encoded->vertex_order[indices[i]];
    memcpy(wanted, mesh->indices, 4 * mesh->count);
    sort_triangles(wanted, mesh->count / 3);
    sort_triangles(indices, mesh->count / 3);
    CHECK(memcmp(wanted, indices, 4 * mesh->count) == 0);
    free(wanted);
}

/* A buffer that is too small, and a damaged stream. Leaves encoded->words null. */
static void check_damage(const struct mesh* mesh, const struct lacedring_encode_options* options,
                         struct lacedring_encoded* encoded) {
    struct lacedring_stream stream;
    struct lacedring_message message;
    const size_t words = encoded->word_count;
    encoded->word_capacity = words - 1;
    CHECK(lacedring_encode(mesh->indices, mesh->count, mesh->vertices, options, encoded, &message) ==
          LACEDRING_CODE_TOO_SMALL);
    CHECK(encoded->word_count == words);
    encoded->words[words / 2] ^= 4;
    message.text[0] = 0;
    CHECK(lacedring_validate(encoded->words, words, &stream, &message) == LACEDRING_CODE_MALFORMED);
    CHECK(message.text[0] != 0);
    free(encoded->words);
    encoded->words = NULL;
}

/* Meshes and options that are refused or accepted; encoded->words is null, so that only sizes are returned. */
static void check_arguments(const struct mesh* mesh, struct lacedring_encode_options options,
                            struct lacedring_encoded* encoded) {
    struct lacedring_message message;
    const size_t count = mesh->count;
    const enum lacedring_format format = options.format;
    CHECK(lacedring_encode(mesh->indices, count, mesh->vertices, &options, encoded, NULL) == LACEDRING_CODE_OK);
    CHECK(lacedring_encode(mesh->indices, count - 1, mesh->vertices, &options, encoded, &message) ==
          LACEDRING_CODE_INVALID_ARGUMENT);
    CHECK(lacedring_encode(mesh->indices, count, mesh->vertices / 2, NULL, encoded, &message) ==
          LACEDRING_CODE_MALFORMED);
    options.effort = 10;
    CHECK(lacedring_encode(mesh->indices, count, mesh->vertices, &options, encoded, &message) ==
          LACEDRING_CODE_INVALID_ARGUMENT);
    options.effort = 1;
    options.threads = -1;
    CHECK(lacedring_encode(mesh->indices, count, mesh->vertices, &options, encoded, &message) == LACEDRING_CODE_OK);
    options.threads = 3;
    CHECK(lacedring_encode(mesh->indices, count, mesh->vertices, &options, encoded, &message) == LACEDRING_CODE_OK);
    options.format = 7;
    CHECK(lacedring_encode(mesh->indices, count, mesh->vertices, &options, encoded, &message) ==
          LACEDRING_CODE_INVALID_ARGUMENT);
    CHECK(lacedring_encode_bounds(7, count, mesh->vertices, encoded) == LACEDRING_CODE_INVALID_ARGUMENT);
    CHECK(lacedring_encode_bounds(format, count + 1, mesh->vertices, encoded) == LACEDRING_CODE_INVALID_ARGUMENT);
}

static void check_format(enum lacedring_format format, int cache, const struct mesh* mesh, int pinched) {
    static const char* const names[] = {"lean", "packed", "lr", "lr-compact"};
    struct lacedring_encode_options options;
    struct lacedring_encoded encoded;
    struct lacedring_stream stream;
    struct lacedring_message message;
    uint32_t* indices = malloc(4 * mesh->count);
    format_name = names[format];
    lacedring_default_options(&options);
    CHECK(options.format == LACEDRING_FORMAT_PACKED && options.effort == 6 && options.threads == 1);
    options.format = format;
    options.cache = cache;
    options.effort = 1;
    memset(&encoded, 0, sizeof encoded);
    CHECK(lacedring_encode_bounds(format, mesh->count, mesh->vertices, &encoded) == LACEDRING_CODE_OK);
    encoded.words = malloc(4 * encoded.word_capacity);
    encoded.vertex_order = malloc(4 * encoded.vertex_capacity);
    encoded.triangle_order = malloc(4 * encoded.triangle_capacity);
    CHECK(lacedring_encode(mesh->indices, mesh->count, mesh->vertices, &options, &encoded, &message) ==
          LACEDRING_CODE_OK);
    check_validate(&encoded, &options, mesh, pinched, &stream);
    check_decoding(&stream, indices, mesh->count);
    check_orders(&encoded, mesh, indices);
    check_tables(&stream, mesh);
    check_damage(mesh, &options, &encoded);
    check_arguments(mesh, options, &encoded);
    free(encoded.vertex_order);
    free(encoded.triangle_order);
    free(indices);
}

int main(void) {
    int kind, code;
    for (kind = 0; kind < 3; ++kind) {
        static const char* const names[] = {"torus", "square", "pinched square"};
        struct mesh mesh = make_mesh(17, kind == 0, kind == 2);
        mesh_name = names[kind];
        check_format(LACEDRING_FORMAT_LEAN, 0, &mesh, kind == 2);
        check_format(LACEDRING_FORMAT_PACKED, 0, &mesh, kind == 2);
        check_format(LACEDRING_FORMAT_PACKED, 1, &mesh, kind == 2);
        check_format(LACEDRING_FORMAT_LR, 0, &mesh, kind == 2);
        check_format(LACEDRING_FORMAT_LR_COMPACT, 0, &mesh, kind == 2);
        free(mesh.indices);
    }
    for (code = LACEDRING_CODE_OK; code <= LACEDRING_CODE_OUT_OF_MEMORY; ++code) {
        CHECK(strcmp(lacedring_code_string(code), "unknown code") != 0);
    }
    printf("%d failures\n", failures);
    return failures == 0 ? 0 : 1;
}
