/* The WebAssembly module of js/src/lacedring.js: vertices.c, and the decoders of the storage form. */
#include "lacedring_storage.h"
#include "lacedring_stored_seams.h"
#include "vertices.c"

static struct lacedring_stored_packed stored_packed;
static struct lacedring_stored_vertices stored_vertices;
static struct lacedring_stored_seams stored_seams;
static struct lacedring_positions positions;

/* Opens a packed stream in storage form. Result: vertices, triangles, bytes of scratch memory. */
uint32_t LR_EXPORT(lr_stored_packed_open)(const uint32_t* words, size_t count, uint32_t most_vertices,
                                          uint32_t most_triangles) {
    const uint32_t status =
        lacedring_stored_packed_open(words, count, most_vertices, most_triangles, &stored_packed, LR_WHERE);
    result[0] = stored_packed.vertices;
    result[1] = stored_packed.triangles;
    result[2] = (uint32_t)lacedring_stored_packed_scratch(&stored_packed);
    return status;
}

uint32_t LR_EXPORT(lr_stored_packed_decode)(void* scratch, uint32_t* triangles) {
    return lacedring_stored_packed_decode(&stored_packed, scratch, triangles, LR_WHERE);
}

/* Opens a seam section in storage form. Result: entries of vertex_of, bytes of scratch memory. */
uint32_t LR_EXPORT(lr_stored_seams_open)(const uint32_t* words, size_t count, uint32_t vertices, uint32_t slots,
                                         uint32_t most_copies) {
    const uint32_t status =
        lacedring_stored_seams_open(words, count, vertices, slots, most_copies, &stored_seams, LR_WHERE);
    result[0] = stored_seams.most_copies;
    result[1] = (uint32_t)lacedring_stored_seams_scratch(&stored_seams);
    return status;
}

/* As lr_seams_decode. Result: number of copies. */
uint32_t LR_EXPORT(lr_stored_seams_decode)(const uint32_t* slots, void* scratch, uint32_t* copies,
                                           uint32_t* vertex_of) {
    const uint32_t status = lacedring_stored_seams_decode(&stored_seams, slots, scratch, copies, vertex_of, LR_WHERE);
    result[0] = stored_seams.copies;
    return status;
}

/* Opens a vertex stream in storage form. `integers`: decoded POSITION of `vertices` vertices, for prediction, or null;
   `vertex_of`: the vertex of each of `values` copies, or null if the stream is of vertices. Result: as describe, then
   bytes of scratch memory. Returns LACEDRING_STATUS_POSITIONS if the positions are needed and null. */
uint32_t LR_EXPORT(lr_stored_vertices_open)(const uint32_t* words, size_t count, uint32_t values, uint32_t triangles,
                                            const uint32_t* integers, uint32_t vertices, const uint32_t* vertex_of) {
    const uint32_t status = lacedring_stored_vertices_open(words, count, values, &stored_vertices, LR_WHERE);
    if (status != LACEDRING_STATUS_OK) return status;
    positions.integers = integers;
    positions.vertices = vertices;
    positions.vertex_of = vertex_of;
    describe(&stored_vertices.attribute);
    result[5] = (uint32_t)lacedring_stored_vertices_scratch(&stored_vertices, triangles, &positions);
    return stored_vertices.by_positions && integers == NULL ? LACEDRING_STATUS_POSITIONS : LACEDRING_STATUS_OK;
}

/* Decodes the integers and the values of the stream opened last. `count`: number of triangles. */
uint32_t LR_EXPORT(lr_stored_vertices_decode)(const uint32_t* triangles, uint32_t count, void* scratch,
                                              uint32_t* integers, void* out) {
    const uint32_t status =
        lacedring_stored_vertices_decode(&stored_vertices, triangles, count, &positions, scratch, integers, LR_WHERE);
    if (status == LACEDRING_STATUS_OK) lacedring_stored_vertices_values(&stored_vertices, integers, out);
    return status;
}
