/* lacedring.h from C99: every function, against the triangle list. Prints what is wrong; exit code 1 then. */

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "lacedring/lacedring.h"

static int failures = 0;
#define CHECK(what)                                   \
    do {                                              \
        if (!(what)) {                                \
            printf("line %d: %s\n", __LINE__, #what); \
            ++failures;                               \
        }                                             \
    } while (0)

struct mesh {
    uint32_t* indices;
    size_t count;
    uint32_t vertices;
};

/* A torus of n by n squares; or, cut open, a square with a border whose last row is missing a triangle; `pinched`: its
   corner vertex is also that of the opposite corner, so that two fans share it. */
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
            if (m.indices[i] == n) m.indices[i] = n * side; /* the corner right above takes the one left below */
        }
    }
    return m;
}

static void turn(uint32_t t[3]) { /* the smallest first */
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

/* Every operator on every corner, against the others and against the decoded triangles. */
static void check_tables(const struct lacedring_stream* stream, const struct mesh* mesh) {
    struct lacedring_tables tables;
    uint32_t t, v, copies = 0, k;
    uint32_t* seen = calloc(stream->vertices, sizeof *seen);
    uint32_t neighbors[64];
    if (stream->format == LACEDRING_FORMAT_LEAN || stream->format == LACEDRING_FORMAT_PACKED) {
        CHECK(lacedring_open_tables(stream, &tables) == LACEDRING_CODE_INVALID_ARGUMENT);
        free(seen);
        return;
    }
    CHECK(lacedring_open_tables(stream, &tables) == LACEDRING_CODE_OK);
    for (t = 0; t < stream->slots; ++t) {
        uint32_t decoded[3], own[3];
        CHECK(lacedring_decode_triangle(stream, t, decoded) == lacedring_is_triangle(&tables, t));
        if (!lacedring_is_triangle(&tables, t)) continue;
        for (k = 0; k < 3; ++k) {
            const uint32_t c = k == 0   ? lacedring_corner_of_triangle(t)
                               : k == 1 ? lacedring_next(lacedring_corner_of_triangle(t))
                                        : lacedring_previous(lacedring_corner_of_triangle(t));
            const uint32_t o = lacedring_opposite(&tables, c);
            CHECK(lacedring_triangle(c) == t);
            CHECK(lacedring_left(&tables, c) == lacedring_opposite(&tables, lacedring_next(c)));
            CHECK(lacedring_right(&tables, c) == lacedring_opposite(&tables, lacedring_previous(c)));
            if (o != LACEDRING_NULL) {
                CHECK(lacedring_opposite(&tables, o) == c);
                CHECK(lacedring_vertex(&tables, lacedring_next(o)) == lacedring_vertex(&tables, lacedring_previous(c)));
            }
            if (lacedring_swing(&tables, c) != LACEDRING_NULL) {
                CHECK(lacedring_vertex(&tables, lacedring_swing(&tables, c)) == lacedring_vertex(&tables, c));
            }
            own[k] = lacedring_vertex(&tables, c);
            ++seen[own[k]];
            own[k] = lacedring_original(&tables, own[k]);
        }
        turn(own);
        turn(decoded);
        CHECK(memcmp(own, decoded, sizeof own) == 0);
    }
    CHECK(lacedring_next(LACEDRING_NULL) == LACEDRING_NULL && lacedring_previous(LACEDRING_NULL) == LACEDRING_NULL);
    CHECK(lacedring_vertex(&tables, LACEDRING_NULL) == LACEDRING_NULL);
    CHECK(lacedring_opposite(&tables, LACEDRING_NULL) == LACEDRING_NULL);
    CHECK(lacedring_corner_of_vertex(&tables, LACEDRING_NULL) == LACEDRING_NULL);
    CHECK(lacedring_valence(&tables, LACEDRING_NULL) == 0 && !lacedring_is_border(&tables, LACEDRING_NULL));
    CHECK(lacedring_neighbors(&tables, LACEDRING_NULL, neighbors, 64) == 0);
    for (v = 0; v < stream->vertices; ++v) {
        const uint32_t c = lacedring_corner_of_vertex(&tables, v);
        const uint32_t edges = lacedring_neighbors(&tables, v, neighbors, 64);
        CHECK((c == LACEDRING_NULL) == (seen[v] == 0));
        if (lacedring_original(&tables, v) != v) ++copies;
        if (c == LACEDRING_NULL) continue;
        CHECK(lacedring_vertex(&tables, c) == v);
        CHECK(edges == lacedring_valence(&tables, v));
        CHECK(edges == seen[v] + (uint32_t)lacedring_is_border(&tables, v));
        neighbors[1] = LACEDRING_NULL;
        CHECK(lacedring_neighbors(&tables, v, neighbors, 1) == edges);
        CHECK(neighbors[1] == LACEDRING_NULL);
    }
    CHECK(stream->vertices == mesh->vertices + copies);
    free(seen);
}

static void check_format(enum lacedring_format format, int cache, const struct mesh* mesh, int pinched) {
    struct lacedring_encode_options options;
    struct lacedring_encoded encoded;
    struct lacedring_stream stream, again;
    struct lacedring_message message;
    uint32_t *wanted, *indices, *blocks;
    uint16_t* narrow;
    uint32_t i, triangles = 0;
    size_t count;
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
    CHECK(encoded.triangle_count == mesh->count / 3 && encoded.degenerate == 0);
    CHECK(lacedring_validate(encoded.words, encoded.word_count, &stream, &message) == LACEDRING_CODE_OK);
    CHECK(lacedring_view(encoded.words, encoded.word_count, &again, NULL) == LACEDRING_CODE_OK);
    CHECK(again.slots == stream.slots && again.triangles == stream.triangles && again.format == format);
    CHECK(stream.format == format && stream.triangles == mesh->count / 3 && stream.vertices == encoded.vertex_count);
    CHECK((stream.vertices > mesh->vertices) == (pinched && format >= LACEDRING_FORMAT_LR));

    count = mesh->count;
    wanted = malloc(4 * count);
    indices = malloc(4 * count);
    blocks = malloc(4 * (count + 3 * LACEDRING_BLOCK));
    narrow = malloc(2 * count);
    CHECK(lacedring_decode_u32(&stream, indices, count - 1) == LACEDRING_CODE_TOO_SMALL);
    CHECK(lacedring_decode_u32(&stream, indices, count) == LACEDRING_CODE_OK);
    CHECK(lacedring_decode_u16(&stream, narrow, count) == LACEDRING_CODE_OK);
    for (i = 0; i < stream.blocks; ++i) {
        uint32_t found = 0;
        CHECK(lacedring_decode_block(&stream, i, blocks + 3 * triangles, 3 * LACEDRING_BLOCK, &found) ==
              LACEDRING_CODE_OK);
        triangles += found;
    }
    CHECK(lacedring_decode_block(&stream, stream.blocks, blocks, 3 * LACEDRING_BLOCK, &i) ==
          LACEDRING_CODE_INVALID_ARGUMENT);
    CHECK(lacedring_decode_block(&stream, 0, blocks, 2, &i) == LACEDRING_CODE_TOO_SMALL);
    CHECK(triangles == stream.triangles);
    for (i = 0; i < count; ++i) CHECK(narrow[i] == indices[i] && blocks[i] == indices[i]);
    for (i = 0, triangles = 0; i < stream.slots; ++i) {
        uint32_t t[3];
        if (!lacedring_decode_triangle(&stream, i, t)) continue;
        CHECK(memcmp(t, indices + 3 * triangles, sizeof t) == 0);
        ++triangles;
    }
    CHECK(triangles == stream.triangles && !lacedring_decode_triangle(&stream, stream.slots, indices));
    /* Each triangle is the one that triangle_order says, its vertices those that vertex_order says. */
    for (i = 0; i < stream.triangles; ++i) {
        uint32_t got[3], want[3], k;
        for (k = 0; k < 3; ++k) got[k] = encoded.vertex_order[indices[3 * i + k]];
        memcpy(want, mesh->indices + 3 * (size_t)encoded.triangle_order[i], sizeof want);
        turn(got);
        turn(want);
        CHECK(memcmp(got, want, sizeof got) == 0);
    }
    for (i = 0; i < count; ++i) indices[i] = encoded.vertex_order[indices[i]];
    memcpy(wanted, mesh->indices, 4 * count);
    sort_triangles(wanted, count / 3);
    sort_triangles(indices, count / 3);
    CHECK(memcmp(wanted, indices, 4 * count) == 0);
    check_tables(&stream, mesh);

    /* What goes wrong. */
    encoded.word_capacity = encoded.word_count - 1;
    CHECK(lacedring_encode(mesh->indices, count, mesh->vertices, &options, &encoded, &message) ==
          LACEDRING_CODE_TOO_SMALL);
    CHECK(encoded.word_count == stream.word_count);
    encoded.words[encoded.word_count / 2] ^= 4;
    message.text[0] = 0;
    CHECK(lacedring_validate(encoded.words, encoded.word_count, &stream, &message) == LACEDRING_CODE_MALFORMED);
    CHECK(message.text[0] != 0);
    free(encoded.words);
    encoded.words = NULL; /* not wanted */
    CHECK(lacedring_encode(mesh->indices, count, mesh->vertices, &options, &encoded, NULL) == LACEDRING_CODE_OK);
    CHECK(lacedring_encode(mesh->indices, count - 1, mesh->vertices, &options, &encoded, &message) ==
          LACEDRING_CODE_INVALID_ARGUMENT);
    CHECK(lacedring_encode(mesh->indices, count, mesh->vertices / 2, NULL, &encoded, &message) ==
          LACEDRING_CODE_MALFORMED);
    options.effort = 10;
    CHECK(lacedring_encode(mesh->indices, count, mesh->vertices, &options, &encoded, &message) ==
          LACEDRING_CODE_INVALID_ARGUMENT);
    options.effort = 1;
    options.threads = -1;
    CHECK(lacedring_encode(mesh->indices, count, mesh->vertices, &options, &encoded, &message) == LACEDRING_CODE_OK);
    options.threads = 3;
    CHECK(lacedring_encode(mesh->indices, count, mesh->vertices, &options, &encoded, &message) == LACEDRING_CODE_OK);
    options.format = 7;
    CHECK(lacedring_encode(mesh->indices, count, mesh->vertices, &options, &encoded, &message) ==
          LACEDRING_CODE_INVALID_ARGUMENT);
    CHECK(lacedring_encode_bounds(7, count, mesh->vertices, &encoded) == LACEDRING_CODE_INVALID_ARGUMENT);
    CHECK(lacedring_encode_bounds(format, count + 1, mesh->vertices, &encoded) == LACEDRING_CODE_INVALID_ARGUMENT);
    free(encoded.vertex_order);
    free(encoded.triangle_order);
    free(wanted);
    free(indices);
    free(blocks);
    free(narrow);
}

int main(void) {
    int kind, code;
    for (kind = 0; kind < 3; ++kind) {
        struct mesh mesh = make_mesh(17, kind == 0, kind == 2);
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
