/* The WebAssembly module of js/src/vertices.js: core.c, and vertex streams and seam sections. */
#include "core.c"
#include "lacedring_seams.h"
#include "lacedring_vertices.h"

static struct lacedring_vertices attribute;

/* Result: values per vertex, their type, whether they are normalized, integers per vertex, their mapping. */
static void describe(const struct lacedring_vertices* stream) {
    result[0] = lacedring_vertices_values(stream);
    result[1] = stream->type;
    result[2] = stream->normalized;
    result[3] = stream->components;
    result[4] = stream->mapping;
}

/* Opens a vertex stream of `vertices` vertices: the end of a section that begins at `contents` and whose CRC is `crc`.
   Refuses streams with less than 8 bits per component and full block, as any block takes more. So the values of full
   blocks are at most 768 times as large as the stream. Result: as describe. */
uint32_t LR_EXPORT(lr_vertices_open)(const uint32_t* words, size_t count, const uint8_t* contents, uint32_t crc,
                                     uint32_t vertices) {
    const uint32_t status = lacedring_vertices_open(words, count, &attribute, LR_WHERE);
    if (status != LACEDRING_STATUS_OK) return status;
    if (attribute.vertices != vertices) return LACEDRING_STATUS_VERTICES;
    if ((uint64_t)8 * attribute.components * (vertices / LACEDRING_VERTICES_BLOCK) >
        (uint64_t)32 * attribute.data_words)
        return LACEDRING_STATUS_SIZE;
    describe(&attribute);
    return checksum_of(words, count, 0, 3, contents, crc);
}

/* Checks the stream opened last, and writes its values. */
uint32_t LR_EXPORT(lr_vertices_decode)(void* out) {
    return lacedring_vertices_decode_checked(&attribute, out, LR_WHERE);
}

/* Decodes the integers of the stream opened last, which lr_vertices_decode accepted. */
void LR_EXPORT(lr_vertices_integers)(uint32_t* out) {
    lacedring_vertices_blocks(&attribute, 0, lacedring_vertex_blocks_(&attribute), out);
}

/* Decodes the slots of the lean stream opened last, which lr_connectivity_decode accepted: three vertices each, or
   UINT32_MAX three times if empty. */
void LR_EXPORT(lr_slots)(uint32_t* out) {
    const uint32_t slots = lacedring_lean_slots(&lean);
    uint32_t slot;
    for (slot = 0; slot < slots; ++slot, out += 3) {
        lacedring_lean_slot(&lean, slot, out);
        if (out[0] == out[1]) out[0] = out[1] = out[2] = UINT32_MAX;
    }
}

static struct lacedring_seams seams;

/* Opens a seam section; `crc` is the CRC of its words. Result: number of copies, bytes of scratch memory. */
uint32_t LR_EXPORT(lr_seams_open)(const uint32_t* words, size_t count, uint32_t crc, uint32_t vertices,
                                  uint32_t slots) {
    const uint32_t status = lacedring_seams_open(words, count, vertices, slots, &seams, LR_WHERE);
    if (status != LACEDRING_STATUS_OK) return status;
    result[0] = seams.copies;
    result[1] = (uint32_t)(4 * lacedring_seams_scratch(&seams));
    return checksum_of(words, count, 1, 1, (const uint8_t*)words, crc);
}

/* Checks the section opened last; writes the copy of each slot's corners, and the vertex of each copy. */
uint32_t LR_EXPORT(lr_seams_decode)(const uint32_t* slots, uint32_t* scratch, uint32_t* copies, uint32_t* vertex_of) {
    return lacedring_seams_decode_checked(&seams, slots, scratch, copies, vertex_of, LR_WHERE);
}

/* out[i] = values[of[i]] for i < count; values have `size` bytes. */
void LR_EXPORT(lr_gather)(const uint8_t* values, uint32_t size, const uint32_t* of, uint32_t count, uint8_t* out) {
    uint32_t i;
#ifndef LACEDRING_TINY
    uint32_t k;
    if (size % 4 == 0) {
        for (i = 0; i < count; ++i) {
            for (k = 0; k < size; k += 4, out += 4) memcpy(out, values + (size_t)of[i] * size + k, 4);
        }
        return;
    }
#endif
    for (i = 0; i < count; ++i, out += size) memcpy(out, values + (size_t)of[i] * size, size);
}
