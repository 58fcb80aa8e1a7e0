/* Decodes lean LR index streams: one vertex reference per triangle becomes an index list. C99 or C++, one file, no
   library, no allocation; what lrcore decodes with. docs/lean-format.md has the format.

   In one .c or .cpp file:

       #define LACEDRING_DECODE_IMPLEMENTATION
       #include "lacedring_decode.h"

   and wherever a stream is decoded:

       struct lacedring_lean lean;
       if (lacedring_lean_validate(words, count, &lean, NULL) != LACEDRING_STATUS_OK) ...
       uint32_t *indices = malloc(12 * (size_t)lean.triangles);
       lacedring_lean_triangles_u32(&lean, indices);

   A program that links lacedring::core has these functions already: it includes the file without the macro.

   Streams are little-endian 32-bit words; on a big-endian machine swap the bytes of each first. */
#ifndef LACEDRING_DECODE_H
#define LACEDRING_DECODE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The version of the library that this file is of. */
#define LACEDRING_VERSION_MAJOR 0
#define LACEDRING_VERSION_MINOR 1
#define LACEDRING_VERSION_PATCH 0

#define LACEDRING_LEAN_HEADER_WORDS 8

/* What is wrong with a stream. The comment says what `*where` is then. */
enum lacedring_status {
    LACEDRING_STATUS_OK = 0,
    LACEDRING_STATUS_SHORT,         /* fewer words than a header */
    LACEDRING_STATUS_MAGIC,         /* another kind of data */
    LACEDRING_STATUS_VERSION,       /* the version that it has */
    LACEDRING_STATUS_VERTICES,      /* more vertices than references can name */
    LACEDRING_STATUS_RING_VERTICES, /* more ring vertices than vertices */
    LACEDRING_STATUS_SIZE,          /* not as many words as the header says */
    LACEDRING_STATUS_SLOTS,         /* more slots than 32-bit indices can number */
    LACEDRING_STATUS_CHECKSUM,
    LACEDRING_STATUS_TIP,          /* the slot whose tip is no vertex */
    LACEDRING_STATUS_OPEN_RING,    /* the first vertex of a ring that does not close */
    LACEDRING_STATUS_SHORT_RING,   /* the first vertex of a ring of fewer than three */
    LACEDRING_STATUS_CLOSING_WORD, /* the slot */
    LACEDRING_STATUS_WORD,         /* the slot */
    LACEDRING_STATUS_VERBATIM,     /* which verbatim triangle repeats a vertex, or names none */
    LACEDRING_STATUS_TRIANGLES     /* how many triangles there are, not what the header says */
};

/* A stream in memory, its header read. Holds no copy. Slots are numbered: 2 for each vertex of two-sided rings, 1 for
   each of one-sided rings, then the verbatim triangles. A slot is a triangle, degenerate (its first two vertices equal)
   where it is the second copy of one, a border, or closes a ring. */
struct lacedring_lean {
    const uint32_t* payload; /* the words behind the header */
    uint32_t vertices;       /* of the mesh, used or not */
    uint32_t rings2, rings1; /* vertices of two-sided and of one-sided rings */
    uint32_t verbatim;       /* triangles stored as they are */
    uint32_t triangles;      /* of the mesh: slots that are not degenerate */
};

/* Reads the header and checks sizes only: enough for what was just encoded. `where` may be null. Reads no word beyond
   `count`, whatever the words are. Constant time. */
enum lacedring_status lacedring_lean_open(const uint32_t* words, size_t count, struct lacedring_lean* lean,
                                          uint64_t* where);

/* Checks all that decoders rely on, but for the checksum: rings close, tips are vertices, as many triangles as the
   header says. `lean` was opened. Linear time, no memory. Any words: safe. */
enum lacedring_status lacedring_lean_check(const struct lacedring_lean* lean, uint64_t* where);

/* Open, checksum and check. What it accepts, everything below decodes. */
enum lacedring_status lacedring_lean_validate(const uint32_t* words, size_t count, struct lacedring_lean* lean,
                                              uint64_t* where);

uint32_t lacedring_lean_slots(const struct lacedring_lean* lean);

/* The three vertices of any slot. Constant time, at most four words read. */
void lacedring_lean_slot(const struct lacedring_lean* lean, uint32_t slot, uint32_t triangle[3]);

/* All slots: 3 * lacedring_lean_slots(lean) indices, degenerate triangles among them. Linear time. */
void lacedring_lean_decode(const struct lacedring_lean* lean, uint32_t* indices);

/* The triangles alone, in slot order: 3 * lean->triangles indices; of 16 bits only where lean->vertices <= 65536. */
void lacedring_lean_triangles_u32(const struct lacedring_lean* lean, uint32_t* indices);
void lacedring_lean_triangles_u16(const struct lacedring_lean* lean, uint16_t* indices);

#ifdef __cplusplus
}
#endif
#endif /* LACEDRING_DECODE_H */

#if defined(LACEDRING_DECODE_IMPLEMENTATION) && !defined(LACEDRING_DECODE_IMPLEMENTED)
#define LACEDRING_DECODE_IMPLEMENTED

#ifdef __cplusplus
extern "C" {
#endif

#define LACEDRING_TIP_ 0x1fffffffu
#define LACEDRING_WART_ 0x80000000u
#define LACEDRING_CLOSE_ 0x40000000u
#define LACEDRING_FLIP_ 0x20000000u

static enum lacedring_status lacedring_at_(uint64_t* where, uint64_t value, enum lacedring_status status) {
    if (where != NULL) *where = value;
    return status;
}

/* CRC-32, four bits at a time: a table that is small matters more here than speed. */
static uint32_t lacedring_crc_(uint32_t crc, const uint32_t* words, size_t count) {
    static const uint32_t table[16] = {0x00000000u, 0x1db71064u, 0x3b6e20c8u, 0x26d930acu, 0x76dc4190u, 0x6b6b51f4u,
                                       0x4db26158u, 0x5005713cu, 0xedb88320u, 0xf00f9344u, 0xd6d6a3e8u, 0xcb61b38cu,
                                       0x9b64c2b0u, 0x86d3d2d4u, 0xa00ae278u, 0xbdbdf21cu};
    size_t i;
    int digit;
    for (i = 0; i < count; ++i) {
        crc ^= words[i];
        for (digit = 0; digit < 8; ++digit) crc = (crc >> 4) ^ table[crc & 15];
    }
    return crc;
}

uint32_t lacedring_lean_slots(const struct lacedring_lean* lean) {
    return 2 * lean->rings2 + lean->rings1 + lean->verbatim;
}

enum lacedring_status lacedring_lean_open(const uint32_t* words, size_t count, struct lacedring_lean* lean,
                                          uint64_t* where) {
    uint64_t ring_slots, references;
    if (count < LACEDRING_LEAN_HEADER_WORDS) return lacedring_at_(where, 0, LACEDRING_STATUS_SHORT);
    if (words[0] != 0x4e4c524cu) return lacedring_at_(where, 0, LACEDRING_STATUS_MAGIC);
    if (words[1] != 1) return lacedring_at_(where, words[1], LACEDRING_STATUS_VERSION);
    lean->payload = words + LACEDRING_LEAN_HEADER_WORDS;
    lean->vertices = words[2];
    lean->rings2 = words[3];
    lean->rings1 = words[4];
    lean->verbatim = words[5];
    lean->triangles = words[6];
    if (lean->vertices > LACEDRING_TIP_ + 1) return lacedring_at_(where, 0, LACEDRING_STATUS_VERTICES);
    if ((uint64_t)lean->rings2 + lean->rings1 > lean->vertices)
        return lacedring_at_(where, 0, LACEDRING_STATUS_RING_VERTICES);
    ring_slots = (uint64_t)2 * lean->rings2 + lean->rings1;
    references = ring_slots + (uint64_t)3 * lean->verbatim;
    if (references != count - LACEDRING_LEAN_HEADER_WORDS)
        return lacedring_at_(where, references, LACEDRING_STATUS_SIZE);
    if (ring_slots + lean->verbatim > UINT32_MAX / 3) return lacedring_at_(where, 0, LACEDRING_STATUS_SLOTS);
    return LACEDRING_STATUS_OK;
}

/* One section of rings: vertices begin .. end - 1 with `sides` words each, the first of which is slot `slot`. */
struct lacedring_section_ {
    const uint32_t* words;
    uint32_t begin, end, sides, slot, vertices;
};

static enum lacedring_status lacedring_check_ring_(const struct lacedring_section_* s, uint32_t first, uint32_t last,
                                                   uint64_t* triangles, uint64_t* where) {
    uint32_t v, side, closed = 0;
    if (last - first < 2) return lacedring_at_(where, first, LACEDRING_STATUS_SHORT_RING);
    for (v = first; v <= last; ++v) {
        for (side = 0; side < s->sides; ++side) {
            const size_t i = (size_t)(v - s->begin) * s->sides + side;
            const uint32_t w = s->words[i], tip = w & LACEDRING_TIP_, flags = w & ~LACEDRING_TIP_;
            const uint32_t n = v == last ? first : v + 1, nn = n == last ? first : n + 1;
            const uint32_t end = flags & LACEDRING_WART_ ? nn : n;
            if (flags & LACEDRING_CLOSE_) {
                if (closed || flags != LACEDRING_CLOSE_ || tip != first) {
                    return lacedring_at_(where, s->slot + i, LACEDRING_STATUS_CLOSING_WORD);
                }
                closed = 1;
            } else if (tip == v || tip == end) { /* a free slot, and nothing else */
                if (flags != 0 || tip != (side == 0 ? v : end))
                    return lacedring_at_(where, s->slot + i, LACEDRING_STATUS_WORD);
            } else {
                ++*triangles;
            }
        }
    }
    return LACEDRING_STATUS_OK;
}

static enum lacedring_status lacedring_check_section_(const struct lacedring_section_* s, uint64_t* triangles,
                                                      uint64_t* where) {
    uint32_t v, side, first = s->begin;
    for (v = s->begin; v < s->end; ++v) {
        uint32_t closes = 0;
        for (side = 0; side < s->sides; ++side) {
            const size_t i = (size_t)(v - s->begin) * s->sides + side;
            if ((s->words[i] & LACEDRING_TIP_) >= s->vertices)
                return lacedring_at_(where, s->slot + i, LACEDRING_STATUS_TIP);
            closes |= s->words[i] & LACEDRING_CLOSE_;
        }
        if (closes) {
            const enum lacedring_status status = lacedring_check_ring_(s, first, v, triangles, where);
            if (status != LACEDRING_STATUS_OK) return status;
            first = v + 1;
        }
    }
    return first == s->end ? LACEDRING_STATUS_OK : lacedring_at_(where, first, LACEDRING_STATUS_OPEN_RING);
}

enum lacedring_status lacedring_lean_check(const struct lacedring_lean* lean, uint64_t* where) {
    const uint32_t rings = lean->rings2 + lean->rings1, one = 2 * lean->rings2;
    const struct lacedring_section_ two_sided = {lean->payload, 0, lean->rings2, 2, 0, lean->vertices};
    const struct lacedring_section_ one_sided = {lean->payload + one, lean->rings2, rings, 1, one, lean->vertices};
    const uint32_t* t = lean->payload + one + lean->rings1;
    uint64_t triangles = 0;
    uint32_t i;
    enum lacedring_status status = lacedring_check_section_(&two_sided, &triangles, where);
    if (status == LACEDRING_STATUS_OK) status = lacedring_check_section_(&one_sided, &triangles, where);
    if (status != LACEDRING_STATUS_OK) return status;
    for (i = 0; i < lean->verbatim; ++i, t += 3) {
        if (t[0] >= lean->vertices || t[1] >= lean->vertices || t[2] >= lean->vertices || t[0] == t[1] ||
            t[1] == t[2] || t[2] == t[0]) {
            return lacedring_at_(where, i, LACEDRING_STATUS_VERBATIM);
        }
    }
    triangles += lean->verbatim;
    return triangles == lean->triangles ? LACEDRING_STATUS_OK
                                        : lacedring_at_(where, triangles, LACEDRING_STATUS_TRIANGLES);
}

enum lacedring_status lacedring_lean_validate(const uint32_t* words, size_t count, struct lacedring_lean* lean,
                                              uint64_t* where) {
    const enum lacedring_status status = lacedring_lean_open(words, count, lean, where);
    uint32_t crc;
    if (status != LACEDRING_STATUS_OK) return status;
    crc = lacedring_crc_(0xffffffffu, words, LACEDRING_LEAN_HEADER_WORDS - 1); /* all but the checksum itself */
    crc = ~lacedring_crc_(crc, lean->payload, count - LACEDRING_LEAN_HEADER_WORDS);
    if (crc != words[LACEDRING_LEAN_HEADER_WORDS - 1]) return lacedring_at_(where, 0, LACEDRING_STATUS_CHECKSUM);
    return lacedring_lean_check(lean, where);
}

/* The vertex that follows v on its ring: v's words say so where the ring closes. */
static uint32_t lacedring_next_(const uint32_t* words, uint32_t sides, uint32_t v) {
    uint32_t side;
    words += (size_t)v * sides;
    for (side = 0; side < sides; ++side) {
        if (words[side] & LACEDRING_CLOSE_) return words[side] & LACEDRING_TIP_;
    }
    return v + 1;
}

/* A slot of ring vertex v, whose words are words[v * sides + side]. */
static void lacedring_ring_slot_(const uint32_t* words, uint32_t sides, uint32_t v, uint32_t side, uint32_t out[3]) {
    const uint32_t w = words[(size_t)v * sides + side], tip = w & LACEDRING_TIP_;
    const uint32_t n = lacedring_next_(words, sides, v);
    if (w & LACEDRING_CLOSE_) {
        out[0] = out[1] = side == 0 ? v : n;
        out[2] = side == 0 ? n : v;
    } else {
        const uint32_t end = w & LACEDRING_WART_ ? lacedring_next_(words, sides, n) : n;
        const int reverse = (side != 0) != ((w & LACEDRING_FLIP_) != 0);
        out[0] = reverse ? end : v;
        out[1] = tip;
        out[2] = reverse ? v : end;
    }
}

void lacedring_lean_slot(const struct lacedring_lean* lean, uint32_t slot, uint32_t triangle[3]) {
    const uint32_t two = 2 * lean->rings2;
    if (slot < two) {
        lacedring_ring_slot_(lean->payload, 2, slot / 2, slot % 2, triangle);
    } else if (slot < two + lean->rings1) { /* vertex v >= rings2 has word two + (v - rings2) */
        lacedring_ring_slot_(lean->payload + lean->rings2, 1, slot - lean->rings2, 0, triangle);
    } else {
        const uint32_t* t = lean->payload + two + lean->rings1 + (size_t)3 * (slot - two - lean->rings1);
        triangle[0] = t[0];
        triangle[1] = t[1];
        triangle[2] = t[2];
    }
}

void lacedring_lean_decode(const struct lacedring_lean* lean, uint32_t* indices) {
    const uint32_t* w = lean->payload;
    const uint32_t* one = lean->payload + lean->rings2; /* of ring vertex v: one[v] */
    uint32_t v;
    size_t i;
    for (v = 0; v < lean->rings2; ++v, w += 2, indices += 6) {
        if (((w[0] | w[1]) & ~LACEDRING_TIP_) == 0) { /* nearly always */
            indices[0] = v;
            indices[1] = w[0];
            indices[2] = v + 1;
            indices[3] = v + 1;
            indices[4] = w[1];
            indices[5] = v;
        } else {
            lacedring_ring_slot_(lean->payload, 2, v, 0, indices);
            lacedring_ring_slot_(lean->payload, 2, v, 1, indices + 3);
        }
    }
    for (; v < lean->rings2 + lean->rings1; ++v, ++w, indices += 3) {
        if ((w[0] & ~LACEDRING_TIP_) == 0) {
            indices[0] = v;
            indices[1] = w[0];
            indices[2] = v + 1;
        } else {
            lacedring_ring_slot_(one, 1, v, 0, indices);
        }
    }
    for (i = 0; i < (size_t)3 * lean->verbatim; ++i) indices[i] = w[i];
}

void lacedring_lean_triangles_u32(const struct lacedring_lean* lean, uint32_t* indices) {
    const uint32_t slots = lacedring_lean_slots(lean);
    uint32_t slot, t[3];
    for (slot = 0; slot < slots; ++slot) {
        lacedring_lean_slot(lean, slot, t);
        if (t[0] == t[1]) continue;
        indices[0] = t[0];
        indices[1] = t[1];
        indices[2] = t[2];
        indices += 3;
    }
}

void lacedring_lean_triangles_u16(const struct lacedring_lean* lean, uint16_t* indices) {
    const uint32_t slots = lacedring_lean_slots(lean);
    uint32_t slot, t[3];
    for (slot = 0; slot < slots; ++slot) {
        lacedring_lean_slot(lean, slot, t);
        if (t[0] == t[1]) continue;
        indices[0] = (uint16_t)t[0];
        indices[1] = (uint16_t)t[1];
        indices[2] = (uint16_t)t[2];
        indices += 3;
    }
}

#undef LACEDRING_TIP_
#undef LACEDRING_WART_
#undef LACEDRING_CLOSE_
#undef LACEDRING_FLIP_
#ifdef __cplusplus
}
#endif
#endif /* LACEDRING_DECODE_IMPLEMENTATION */
