/* Decodes LacedRing's lean and packed streams into index lists. C99 or C++; one file, no library, no allocation. lrcore
   decodes with the same code. Formats: docs/lean-format.md and docs/packed-format.md.

   In one .c or .cpp file:

       #define LACEDRING_DECODE_IMPLEMENTATION
       #include "lacedring_decode.h"

   To decode a stream:

       struct lacedring_lean lean;
       if (lacedring_lean_validate(words, count, &lean, NULL) != LACEDRING_STATUS_OK) ...
       uint32_t *indices = malloc(12 * (size_t)lean.triangles);
       lacedring_lean_triangles_u32(&lean, indices);

   A program that links lacedring::core has these functions already: it includes the file without the macro.

   Streams are little-endian 32-bit words; on a big-endian machine swap the bytes of each word first. */
#ifndef LACEDRING_DECODE_H
#define LACEDRING_DECODE_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Version of the library that this file belongs to. */
#define LACEDRING_VERSION_MAJOR 0
#define LACEDRING_VERSION_MINOR 2
#define LACEDRING_VERSION_PATCH 0

#define LACEDRING_LEAN_HEADER_WORDS 8
#define LACEDRING_PACKED_HEADER_WORDS 4
#define LACEDRING_PACKED_BLOCK 256u /* triangles per block of a packed stream */

/* Why a stream is invalid. "where" in a comment is the value that the function then stores in *where. */
enum lacedring_status {
    LACEDRING_STATUS_OK = 0,
    LACEDRING_STATUS_SHORT,         /* fewer words than the header takes */
    LACEDRING_STATUS_MAGIC,         /* wrong magic word: not this kind of stream */
    LACEDRING_STATUS_VERSION,       /* unsupported version; where: the version */
    LACEDRING_STATUS_VERTICES,      /* more vertices than the format can number */
    LACEDRING_STATUS_RING_VERTICES, /* more ring vertices than vertices */
    LACEDRING_STATUS_SIZE,          /* the number of words contradicts the header */
    LACEDRING_STATUS_SLOTS,         /* more slots than 32-bit indices can number */
    LACEDRING_STATUS_CHECKSUM,
    LACEDRING_STATUS_TIP,          /* a tip is no vertex; where: the slot */
    LACEDRING_STATUS_OPEN_RING,    /* a ring does not close; where: its first vertex */
    LACEDRING_STATUS_SHORT_RING,   /* a ring has < 3 vertices; where: the first one */
    LACEDRING_STATUS_CLOSING_WORD, /* an invalid CLOSE word; where: the slot */
    LACEDRING_STATUS_WORD,         /* a free slot has flags or a wrong tip; where: the slot */
    LACEDRING_STATUS_VERBATIM,     /* verbatim triangle with a bad vertex; where: its number */
    LACEDRING_STATUS_TRIANGLES,    /* wrong count in the header; where: triangles found */
    LACEDRING_STATUS_GROUP,        /* invalid offset, head or padding of a group; where: its first block */
    LACEDRING_STATUS_BLOCK,        /* invalid block; where: the block */
    LACEDRING_STATUS_TURNS,        /* turn bits after the last own triangle; where: own triangles */
    LACEDRING_STATUS_DOUBLES,      /* invalid run of doubles; where: the run */
    LACEDRING_STATUS_HEADER,       /* invalid header; where: its word */
    LACEDRING_STATUS_VERTEX_BLOCK, /* invalid block of vertices; where: the block */
    LACEDRING_STATUS_TRIANGLE,     /* invalid triangle: vertex out of range or repeated; where: its number */
    LACEDRING_STATUS_LIMIT,        /* more elements than allowed; where: how many */
    LACEDRING_STATUS_CODED,        /* a coded part is invalid, or ends too early or late */
    LACEDRING_STATUS_INTEGER,      /* integer out of range; where: the vertex */
    LACEDRING_STATUS_POSITIONS,    /* positions are missing; where: first value without one */
    LACEDRING_STATUS_COPY          /* impossible copy; where: the vertex */
};

/* CRC-32 of bytes, as zlib's crc32(0, bytes, size) returns it: the checksum of each section of an .lr file
   (docs/lr-file.md). Linear time, four bits at a time. */
uint32_t lacedring_crc32(const void* bytes, size_t size);

/* A lean stream whose header was read. Refers to the caller's words. Its slots are: 2 per vertex of two-sided rings,
   then 1 per vertex of one-sided rings, then the verbatim triangles. A slot is a triangle. It is degenerate (its first
   two vertices are equal) if its triangle is stored in another slot, at a border, and where a ring closes. */
struct lacedring_lean {
    const uint32_t* payload; /* words after the header */
    uint32_t vertices;       /* vertices of the mesh, used or not */
    uint32_t rings2, rings1; /* vertices of two-sided and of one-sided rings */
    uint32_t verbatim;       /* triangles stored as three vertices */
    uint32_t triangles;      /* slots that are not degenerate */
};

/* Reads the header and checks sizes only: enough for a stream that was just encoded. `where` may be null. Safe with any
   words. Constant time. */
enum lacedring_status lacedring_lean_open(const uint32_t* words, size_t count, struct lacedring_lean* lean,
                                          uint64_t* where);

/* Checks everything that decoders rely on except the checksum: rings close, tips are vertices, the header has the right
   number of triangles. `lean` comes from lacedring_lean_open. Safe with any words. Linear time, no memory. */
enum lacedring_status lacedring_lean_check(const struct lacedring_lean* lean, uint64_t* where);

/* Opens the stream, checks the checksum, and runs lacedring_lean_check. All functions below decode what it accepts.
   Safe with any words. Linear time. */
enum lacedring_status lacedring_lean_validate(const uint32_t* words, size_t count, struct lacedring_lean* lean,
                                              uint64_t* where);

/* Number of slots. Constant time. */
uint32_t lacedring_lean_slots(const struct lacedring_lean* lean);

/* Decodes the three vertices of one slot. Constant time: reads at most four words. */
void lacedring_lean_slot(const struct lacedring_lean* lean, uint32_t slot, uint32_t triangle[3]);

/* Decodes all slots, degenerate ones included: 3 * lacedring_lean_slots(lean) indices. Linear time. */
void lacedring_lean_decode(const struct lacedring_lean* lean, uint32_t* indices);

/* Decodes the slots that are not degenerate, in slot order: 3 * lean->triangles indices. The 16-bit version requires
   lean->vertices <= 65536. Linear time. */
void lacedring_lean_triangles_u32(const struct lacedring_lean* lean, uint32_t* indices);
void lacedring_lean_triangles_u16(const struct lacedring_lean* lean, uint16_t* indices);

/* A packed stream whose header was read. Refers to the caller's words. */
struct lacedring_packed {
    uint32_t vertices, triangles; /* of the mesh */
    /* The first `own` triangles are stored; each of the others is a double: it has the vertices of an own triangle. */
    uint32_t own;
    uint32_t vertex_bits;    /* bits of a vertex number */
    uint32_t runs;           /* runs of doubles */
    const uint32_t* doubles; /* two words per run */
    const uint32_t* turns;   /* one bit per own triangle */
    const uint32_t* table;   /* word at which each group but the first begins */
    const uint8_t* groups;
    size_t group_bytes;
};

/* As for lean streams. open: reads the header, checks sizes; constant time. check: everything that decoders rely on
   except the checksum; linear time. validate: open, checksum and check. All three are safe with any words. Checking
   takes 15 KB of stack, decoding 18 KB. */
enum lacedring_status lacedring_packed_open(const uint32_t* words, size_t count, struct lacedring_packed* packed,
                                            uint64_t* where);
enum lacedring_status lacedring_packed_check(const struct lacedring_packed* packed, uint64_t* where);
enum lacedring_status lacedring_packed_validate(const uint32_t* words, size_t count, struct lacedring_packed* packed,
                                                uint64_t* where);

/* lacedring_packed_check and lacedring_packed_triangles_u32 in one pass. On an error the contents of `indices` are
   undefined. */
enum lacedring_status lacedring_packed_decode_checked(const struct lacedring_packed* packed, uint32_t* indices,
                                                      uint64_t* where);

/* Decodes all triangles: 3 * packed->triangles indices. The 16-bit version requires packed->vertices <= 65536. Linear
   time. */
void lacedring_packed_triangles_u32(const struct lacedring_packed* packed, uint32_t* indices);
void lacedring_packed_triangles_u16(const struct lacedring_packed* packed, uint16_t* indices);

/* Decodes blocks [block, end): triangles [256 * block, 256 * end), fewer if the last block is not full. */
void lacedring_packed_blocks_u32(const struct lacedring_packed* packed, uint32_t block, uint32_t end,
                                 uint32_t* indices);

/* Decodes one triangle by itself, in a few popcounts. Reads at most 8 words of turns, 12 words of its group's head and
   200 bytes of its record, and for a double about log2(runs) words more. */
void lacedring_packed_triangle(const struct lacedring_packed* packed, uint32_t triangle, uint32_t out[3]);

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

/* CRC-32, four bits at a time: here a small table matters more than speed. `digits`: how many of `bits` to add. */
static uint32_t lacedring_crc_bits_(uint32_t crc, uint32_t bits, int digits) {
    static const uint32_t table[16] = {0x00000000u, 0x1db71064u, 0x3b6e20c8u, 0x26d930acu, 0x76dc4190u, 0x6b6b51f4u,
                                       0x4db26158u, 0x5005713cu, 0xedb88320u, 0xf00f9344u, 0xd6d6a3e8u, 0xcb61b38cu,
                                       0x9b64c2b0u, 0x86d3d2d4u, 0xa00ae278u, 0xbdbdf21cu};
    crc ^= bits;
    while (digits-- > 0) crc = (crc >> 4) ^ table[crc & 15];
    return crc;
}

static uint32_t lacedring_crc_(uint32_t crc, const uint32_t* words, size_t count) {
    size_t i;
    for (i = 0; i < count; ++i) crc = lacedring_crc_bits_(crc, words[i], 8);
    return crc;
}

uint32_t lacedring_crc32(const void* bytes, size_t size) {
    uint32_t crc = UINT32_MAX;
    size_t i;
    for (i = 0; i < size; ++i) crc = lacedring_crc_bits_(crc, ((const uint8_t*)bytes)[i], 2);
    return ~crc;
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

/* A section of rings: vertices [begin, end) with `sides` words each. Its first word is slot `slot`. */
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
            } else if (tip == v || tip == end) { /* a degenerate triangle: must be a free slot */
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
    crc = lacedring_crc_(0xffffffffu, words, LACEDRING_LEAN_HEADER_WORDS - 1); /* all words but the checksum */
    crc = ~lacedring_crc_(crc, lean->payload, count - LACEDRING_LEAN_HEADER_WORDS);
    if (crc != words[LACEDRING_LEAN_HEADER_WORDS - 1]) return lacedring_at_(where, 0, LACEDRING_STATUS_CHECKSUM);
    return lacedring_lean_check(lean, where);
}

/* The vertex after v on its ring: v + 1, or the tip of v's CLOSE word where the ring closes. */
static uint32_t lacedring_next_(const uint32_t* words, uint32_t sides, uint32_t v) {
    uint32_t side;
    words += (size_t)v * sides;
    for (side = 0; side < sides; ++side) {
        if (words[side] & LACEDRING_CLOSE_) return words[side] & LACEDRING_TIP_;
    }
    return v + 1;
}

/* Decodes a slot of ring vertex v: its word is words[v * sides + side]. */
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
    const uint32_t* one = lean->payload + lean->rings2; /* one[v]: word of one-sided ring vertex v */
    uint32_t v;
    size_t i;
    for (v = 0; v < lean->rings2; ++v, w += 2, indices += 6) {
        if (((w[0] | w[1]) & ~LACEDRING_TIP_) == 0) { /* no flags: nearly always */
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

/* Packed streams: docs/packed-format.md. */

/* Flag. In header word 1: the stream has doubles. In a run: its doubles have the opposite orientation. */
#define LACEDRING_DOUBLES_ 0x80000000u
#define LACEDRING_PACKED_GROUP_ 16u
#define LACEDRING_PACKED_MAX_RECORD_ 160u
#define LACEDRING_PACKED_PART_ 64u

enum {
    LACEDRING_SPLIT_,
    LACEDRING_BESIDE_,
    LACEDRING_START_,
    LACEDRING_FAR_,
    LACEDRING_JUMP_,
    LACEDRING_TURN_,
    LACEDRING_FLIPS_,
    LACEDRING_NO_EVENT_
};

/* For functions that run for every event. Compilers keep their state in registers only if they are inlined. */
#if defined(__GNUC__) && defined(__OPTIMIZE__) && !defined(__OPTIMIZE_SIZE__) && !defined(LACEDRING_PLAIN)
#define LACEDRING_HOT_ static inline __attribute__((always_inline))
#else
#define LACEDRING_HOT_ static
#endif

/* For functions that take less code inlined than called on most machines, though compilers estimate otherwise.
   LACEDRING_TINY: not inlined, for the smallest WebAssembly module, where calls are short. */
#if defined(__GNUC__) && !defined(LACEDRING_TINY)
#define LACEDRING_SMALL_ static inline __attribute__((always_inline))
#else
#define LACEDRING_SMALL_ static
#endif

/* Counts the ones below the lowest zero of `bits`, which must have a zero. */
LACEDRING_HOT_ uint32_t lacedring_ones_(uint64_t bits) {
#if defined(__GNUC__) && !defined(LACEDRING_PLAIN)
    return (uint32_t)__builtin_ctzll(~bits);
#else
    uint32_t n = 0;
    for (; bits & 1; bits >>= 1) ++n;
    return n;
#endif
}

LACEDRING_HOT_ uint32_t lacedring_popcount_(uint32_t bits) {
#if defined(__wasm__) && !defined(LACEDRING_PLAIN)
    return (uint32_t)__builtin_popcount(bits);
#endif
    bits -= (bits >> 1) & 0x55555555u;
    bits = (bits & 0x33333333u) + ((bits >> 2) & 0x33333333u);
    return (((bits + (bits >> 4)) & 0x0f0f0f0fu) * 0x01010101u) >> 24;
}

/* Reads bits [at, end) of the groups. Bits after `end` read as ones. No byte outside the groups is read. */
struct lacedring_bits_ {
    const uint8_t* groups;
    size_t bytes; /* bytes of the groups */
    uint64_t at, end;
};

/* Returns at least 57 bits of the groups from bit `at` on, whether or not they belong to the current record. */
LACEDRING_HOT_ uint64_t lacedring_load_(const struct lacedring_bits_* r, uint64_t at) {
    const uint64_t byte = at >> 3;
    uint64_t value = 0;
    if (byte + 8 <= r->bytes) {
        memcpy(&value, r->groups + (size_t)byte, 8);
    } else if (byte < r->bytes) {
        memcpy(&value, r->groups + (size_t)byte, r->bytes - (size_t)byte);
    }
    return value >> (at & 7);
}

/* Returns the next 57 bits or more. */
LACEDRING_HOT_ uint64_t lacedring_window_(const struct lacedring_bits_* r) {
    const uint64_t at = r->at < r->end ? r->at : r->end, left = r->end - at;
    const uint64_t value = lacedring_load_(r, at);
    return left < 64 ? value | UINT64_MAX << left : value;
}

/* Reads `count` bits, at most 32. */
LACEDRING_HOT_ uint32_t lacedring_take_(struct lacedring_bits_* r, uint32_t count) {
    const uint32_t value = (uint32_t)(lacedring_window_(r) & ((UINT64_C(1) << count) - 1));
    r->at += count;
    return value;
}

/* Reads ones and a zero; returns the number of ones. If there are `limit` ones, no zero follows them. */
LACEDRING_SMALL_ uint32_t lacedring_unary_(struct lacedring_bits_* r, uint32_t limit) {
    const uint32_t ones = lacedring_ones_(lacedring_window_(r) & ~(UINT64_C(1) << limit));
    r->at += ones + (ones < limit);
    return ones;
}

/* Reads an exponential Golomb code. */
LACEDRING_HOT_ uint32_t lacedring_golomb_(struct lacedring_bits_* r, uint32_t order) {
    const uint32_t low = lacedring_unary_(r, 31 - order) + order;
    return (lacedring_take_(r, low) | UINT32_C(1) << low) - (UINT32_C(1) << order);
}

/* Reads a Golomb-Rice code with `low` low bits. Returns UINT32_MAX if it has more than 31 ones. */
LACEDRING_HOT_ uint32_t lacedring_rice_(struct lacedring_bits_* r, uint32_t low) {
    const uint64_t window = lacedring_window_(r);
    const uint32_t ones = lacedring_ones_(window & ~(UINT64_C(1) << 32));
    if (ones == 32) return UINT32_MAX;
    r->at += ones + 1 + low;
    return (ones << low) + ((uint32_t)(window >> (ones + 1)) & ((UINT32_C(1) << low) - 1));
}

/* A group's head. */
struct lacedring_group_ {
    uint64_t own, entries, kinds, offsets, steps; /* bits of the groups where these begin */
    uint64_t records, end;                        /* bytes of the groups: after the head, after the records */
    uint32_t first, blocks;                       /* its first block, and how many */
    uint32_t step, offset_bits, entry_bits, has_kinds, gap_bits, wart_bits, split_order, count_order;
};

/* A record: its bits, its triangles and their turns, and its entry (a, b). */
struct lacedring_record_ {
    struct lacedring_bits_ bits;
    const uint32_t* turns;
    uint32_t first, triangles;
    uint32_t a, b, reversed;
};

enum { LACEDRING_RECORD_, LACEDRING_PARTED_, LACEDRING_PLAIN_ };

struct lacedring_block_ {
    struct lacedring_record_ record; /* its record; the first one if parted */
    uint64_t begin;                  /* byte of the groups where it begins */
    uint32_t bytes, kind;            /* bytes: length of all its records */
};

LACEDRING_SMALL_ uint32_t lacedring_blocks_of_(uint32_t triangles) {
    return triangles / LACEDRING_PACKED_BLOCK + (triangles % LACEDRING_PACKED_BLOCK != 0);
}

static struct lacedring_bits_ lacedring_bits_at_(const struct lacedring_packed* p, uint64_t byte, uint32_t bytes) {
    struct lacedring_bits_ r;
    r.groups = p->groups;
    r.bytes = p->group_bytes;
    r.at = 8 * byte;
    r.end = r.at + (uint64_t)8 * bytes;
    return r;
}

LACEDRING_SMALL_ void lacedring_take_entry_(const struct lacedring_packed* p, struct lacedring_bits_* r, uint32_t* a,
                                            uint32_t* b, uint32_t* reversed) {
    *a = lacedring_take_(r, p->vertex_bits);
    *b = lacedring_take_(r, p->vertex_bits);
    *reversed = lacedring_take_(r, 1);
}

static uint32_t lacedring_take_at_(const struct lacedring_packed* p, uint64_t bit, uint32_t count) {
    struct lacedring_bits_ r = lacedring_bits_at_(p, 0, 0);
    r.at = bit;
    r.end = bit + count;
    return count == 0 ? 0 : lacedring_take_(&r, count);
}

/* Bytes of the group's records before those of its block k. */
LACEDRING_SMALL_ uint32_t lacedring_offset_(const struct lacedring_packed* p, const struct lacedring_group_* g,
                                            uint32_t k) {
    const uint32_t bits = g->offset_bits;
    if (k == 0) return 0;
    return k * g->step + lacedring_take_at_(p, g->offsets + (uint64_t)(k - 1) * bits, bits) -
           (UINT32_C(1) << bits >> 1);
}

/* Reads the head of the group that holds `block`. Returns 0 if the head is invalid. */
static int lacedring_open_group_(const struct lacedring_packed* p, uint32_t block, struct lacedring_group_* g) {
    const uint32_t group = block / LACEDRING_PACKED_GROUP_;
    const uint32_t left = lacedring_blocks_of_(p->own) - group * LACEDRING_PACKED_GROUP_;
    const uint64_t begin = (uint64_t)32 * (group == 0 ? 0 : p->table[group - 1]);
    const uint32_t head = lacedring_take_at_(p, begin, 32);
    uint32_t owns;
    g->first = group * LACEDRING_PACKED_GROUP_;
    g->blocks = left < LACEDRING_PACKED_GROUP_ ? left : LACEDRING_PACKED_GROUP_;
    g->step = head & 0xfff;
    g->offset_bits = head >> 12 & 31;
    g->entry_bits = head >> 17 & 15;
    g->gap_bits = head >> 21 & 7;
    g->wart_bits = head >> 24 & 7;
    g->split_order = head >> 27 & 3;
    g->count_order = head >> 29 & 3;
    g->has_kinds = head >> 31;
    g->own = begin + 32;
    g->entries = g->own + g->blocks - 1;
    owns = lacedring_take_at_(p, g->own, g->blocks - 1);
    g->kinds = g->entries + (uint64_t)(1 + lacedring_popcount_(owns)) * (2 * p->vertex_bits + 1);
    g->offsets = g->kinds + (g->has_kinds ? 2 * g->blocks : 0);
    g->steps = g->offsets + (uint64_t)g->blocks * g->offset_bits;
    g->records = (g->steps + (uint64_t)(g->blocks - 1) * g->entry_bits + 7) / 8;
    g->end = g->records + lacedring_offset_(p, g, g->blocks);
    return g->offset_bits <= 16 && g->entry_bits <= 12 && (g->blocks > 1 || g->entry_bits == 0);
}

/* Largest size, in bytes, of one record of a parted block. */
#define LACEDRING_PACKED_MAX_PART_ 200u

/* Finds kind, record and entry of block `block`, which group g holds. */
static void lacedring_block_of_(const struct lacedring_packed* p, const struct lacedring_group_* g, uint32_t block,
                                struct lacedring_block_* b) {
    const uint32_t k = block - g->first, left = p->own - block * LACEDRING_PACKED_BLOCK;
    const uint32_t offset = lacedring_offset_(p, g, k);
    const uint32_t own = lacedring_take_at_(p, g->own, k); /* own bits of blocks 1 to k */
    uint32_t from = k;
    struct lacedring_bits_ entry = lacedring_bits_at_(p, 0, 0);
    struct lacedring_record_* r = &b->record;
    b->kind = LACEDRING_RECORD_;
    if (g->has_kinds) b->kind = lacedring_take_at_(p, g->kinds + 2 * k, 2);
    b->begin = g->records + offset;
    b->bytes = lacedring_offset_(p, g, k + 1) - offset;
    r->first = block * LACEDRING_PACKED_BLOCK;
    r->triangles = left < LACEDRING_PACKED_BLOCK ? left : LACEDRING_PACKED_BLOCK;
    r->turns = p->turns + r->first / 32;
    r->bits = lacedring_bits_at_(p, b->begin, b->bytes);
    entry.at = g->entries + (uint64_t)lacedring_popcount_(own) * (2 * p->vertex_bits + 1);
    entry.end = entry.at + 2 * p->vertex_bits + 1;
    lacedring_take_entry_(p, &entry, &r->a, &r->b, &r->reversed);
    while (from > 0 && !(own >> (from - 1) & 1)) --from;
    if (from < k) {
        const uint32_t span = r->b - r->a,
                       step = lacedring_take_at_(p, g->steps + (uint64_t)(k - 1) * g->entry_bits, g->entry_bits);
        r->a += (k - from) * (LACEDRING_PACKED_BLOCK / 2) + step - (UINT32_C(1) << g->entry_bits >> 1);
        r->b = r->a + span - (k - from) * LACEDRING_PACKED_BLOCK;
    }
    if (b->kind == LACEDRING_PARTED_) { /* its first record */
        r->bits = lacedring_bits_at_(p, b->begin + 4, lacedring_take_at_(p, 8 * b->begin, 8));
        if (r->triangles > LACEDRING_PACKED_PART_) r->triangles = LACEDRING_PACKED_PART_;
    }
}

/* Finds record `part` of a parted block. */
static void lacedring_part_(const struct lacedring_packed* p, const struct lacedring_block_* b, uint32_t part,
                            struct lacedring_record_* r) {
    struct lacedring_bits_ lengths = lacedring_bits_at_(p, b->begin, 4);
    uint64_t byte = b->begin + 4;
    uint32_t i, first = b->record.first + part * LACEDRING_PACKED_PART_, left = p->own - first;
    *r = b->record;
    if (part == 0) return;
    for (i = 0; i < part; ++i) byte += lacedring_take_(&lengths, 8);
    r->bits = lacedring_bits_at_(p, byte, lacedring_take_(&lengths, 8));
    r->first = first;
    r->triangles = left < LACEDRING_PACKED_PART_ ? left : LACEDRING_PACKED_PART_;
    r->turns += part * LACEDRING_PACKED_PART_ / 32;
    lacedring_take_entry_(p, &r->bits, &r->a, &r->b, &r->reversed);
}

/* Reads triangle i of a plain block. */
LACEDRING_SMALL_ void lacedring_plain_(const struct lacedring_packed* p, const struct lacedring_block_* b, uint32_t i,
                                       uint32_t triangle[3]) {
    struct lacedring_bits_ bits = lacedring_bits_at_(p, b->begin, b->bytes);
    bits.at += (uint64_t)3 * i * p->vertex_bits;
    triangle[0] = lacedring_take_(&bits, p->vertex_bits);
    triangle[1] = lacedring_take_(&bits, p->vertex_bits);
    triangle[2] = lacedring_take_(&bits, p->vertex_bits);
}

/* An event. Its code determines which of the other fields are set. */
struct lacedring_event_ {
    uint32_t triangle; /* in the record; UINT32_MAX: invalid event */
    uint32_t code, choice, v, w, reversed;
    /* Bit of the groups where the bits of FLIPS begin. */
    uint64_t flips;
};

/* Reads an event. On entry, e->triangle is the triangle from which its gap counts. */
static void lacedring_read_event_(const struct lacedring_packed* p, const struct lacedring_group_* g,
                                  struct lacedring_record_* r, struct lacedring_event_* e) {
    struct lacedring_bits_* bits = &r->bits;
    const uint32_t gap = lacedring_rice_(bits, g->gap_bits);
    e->triangle = gap < LACEDRING_PACKED_BLOCK ? e->triangle + gap : UINT32_MAX;
    e->code = lacedring_unary_(bits, LACEDRING_NO_EVENT_);
    if (e->triangle >= r->triangles || e->code == LACEDRING_NO_EVENT_) {
        e->triangle = UINT32_MAX;
        e->code = LACEDRING_TURN_;
    }
    switch (e->code) {
        case LACEDRING_SPLIT_:
            e->v = 3 + lacedring_golomb_(bits, g->split_order);
            if (e->v >> 30 != 0) e->triangle = UINT32_MAX; /* so that no count overflows */
            break;
        case LACEDRING_JUMP_:
            e->v = 2 + lacedring_golomb_(bits, 1);
            if (e->v >> 30 != 0) e->triangle = UINT32_MAX;
            e->choice = lacedring_take_(bits, 1);
            e->w = e->choice ? 1 + lacedring_golomb_(bits, 2) : 0;
            break;
        case LACEDRING_FAR_:
            e->choice = lacedring_take_(bits, 2);
            e->v = lacedring_take_(bits, p->vertex_bits);
            e->w = e->choice == 3 ? 1 + lacedring_golomb_(bits, 2) : 0;
            break;
        case LACEDRING_BESIDE_:
            e->choice = lacedring_take_(bits, 3);
            e->v = lacedring_golomb_(bits, 1);
            e->w = lacedring_take_(bits, p->vertex_bits);
            /* The format's limit, for readers that load fewer bits at once. */
            if (e->v >> 30 != 0) e->triangle = UINT32_MAX;
            break;
        case LACEDRING_START_:
            e->choice = lacedring_unary_(bits, 3);
            if (e->choice == 3) {
                lacedring_take_entry_(p, bits, &e->v, &e->w, &e->reversed);
            } else {
                e->v = e->choice == 2 ? lacedring_golomb_(bits, 2) : 1;
                e->w = e->choice == 0 ? 0 : 2 + lacedring_golomb_(bits, 2);
            }
            break;
        case LACEDRING_FLIPS_:
            e->flips = bits->at;
            bits->at += r->triangles;
            break;
        default:
            break;
    }
}

/* The state of docs/packed-format.md, "Events": the edge that was entered, and the polygon that began last outside of
   all scopes. */
struct lacedring_state_ {
    uint32_t a, b, reversed, begun_a, begun_b, begun_reversed, finished;
};

/* Applies a START or BESIDE event. inside: a scope is open, so that begun stays. */
static void lacedring_begin_(struct lacedring_state_* s, const struct lacedring_event_* e, int inside) {
    uint32_t a = s->begun_a, b = s->begun_b;
    if (e->code == LACEDRING_BESIDE_) {
        const uint32_t step = e->v & 1 ? ~(e->v >> 1) : e->v >> 1;
        static const uint8_t counts_a[4] = {1, 0, 1, 0};
        const uint32_t from = e->choice >> 1;
        const uint32_t near = (from == 0 ? s->b : from == 1 ? s->a : from == 2 ? a : b) + step;
        s->reversed ^= e->choice & 1;
        a = counts_a[from] ? near : e->w;
        b = counts_a[from] ? e->w : near;
    } else if (e->choice == 3) {
        a = e->v;
        b = e->w;
        s->reversed = e->reversed;
    } else if (e->choice == 0) {
        s->reversed = !s->begun_reversed;
    } else {
        a = b + e->v;
        b = a + e->w;
        s->reversed = e->choice == 1 ? 0 : s->begun_reversed;
    }
    s->a = a;
    s->b = b;
    s->finished = 0;
    if (inside) return;
    s->begun_a = a;
    s->begun_b = b;
    s->begun_reversed = s->reversed;
}

/* Number of triangles from edge (a, b) on until the polygon is finished. UINT32_MAX if b - a is 1 already, as finishing
   is tested only after a turn. */
LACEDRING_HOT_ uint32_t lacedring_left_(uint32_t a, uint32_t b) {
    return b - a == 1 ? UINT32_MAX : b - a - 1;
}

/* The polygon is finished and no event begins the next one: begins it after the polygon that began last, with the same
   size. */
static void lacedring_repeat_(struct lacedring_state_* s, int inside) {
    const uint32_t size = s->begun_b - s->begun_a;
    s->a = s->begun_b + 1;
    s->b = s->a + size;
    s->finished = 0;
    if (inside) return;
    s->begun_a = s->a;
    s->begun_b = s->b;
}

/* Applies an event that gives its triangle's third vertex, and returns this vertex. Sets s to the next edge, and `rest`
   to the edge that is entered after *count more triangles. *count = 0: no such edge. */
LACEDRING_HOT_ uint32_t lacedring_third_(struct lacedring_state_* s, const struct lacedring_event_* e, uint32_t turn,
                                         uint32_t rest[2], uint32_t* count) {
    const uint32_t a = s->a, b = s->b;
    const uint32_t x = e->code == LACEDRING_FAR_ ? e->v : turn ? a + e->v : b - e->v;
    const int both = e->code == LACEDRING_SPLIT_ || (e->code == LACEDRING_JUMP_ && e->choice);
    const uint32_t enters = e->code == LACEDRING_FAR_ ? e->choice : both ? 3 : turn ? 2 : 1;
    *count = e->code == LACEDRING_SPLIT_ ? e->v - 1 : e->w;
    rest[0] = turn ? x : a;
    rest[1] = turn ? b : x;
    if (enters == 3 ? !turn : enters == 2) {
        s->a = x;
    } else {
        s->b = x;
    }
    s->finished = enters == 0;
    return x;
}

LACEDRING_HOT_ void lacedring_put_(uint32_t* out, uint32_t a, uint32_t x, uint32_t b, uint32_t reversed) {
    out[0] = a;
    out[1] = reversed ? x : b;
    out[2] = reversed ? b : x;
}

/* Number of turns that are 1 among triangles [begin, end). */
static uint32_t lacedring_ups_(const uint32_t* turns, uint32_t begin, uint32_t end) {
    uint32_t ups = 0, i;
    for (i = begin / 32; i < (end + 31) / 32; ++i) {
        uint32_t word = turns[i];
        if (i == begin / 32) word &= UINT32_MAX << begin % 32;
        if (i == end / 32) word &= (UINT32_C(1) << end % 32) - 1;
        ups += lacedring_popcount_(word);
    }
    return ups;
}

/* A record is decoded in two passes. The first reads its events and warts, and makes a list of pieces: runs of
   triangles that follow from a state by their turns alone. The second writes the pieces, and over them the third
   vertices that events give, and the warts. It writes eight triangles at a time with AVX2, four with vectors of 16
   bytes, else one. */
#if defined(__GNUC__) && defined(__OPTIMIZE__) && !defined(__OPTIMIZE_SIZE__) && !defined(LACEDRING_PLAIN)
#define LACEDRING_VECTORS_ 1
/* Not on Windows, where GCC does not align the stack for such vectors. */
#if defined(__x86_64__) && !defined(_WIN32) && (defined(__clang__) || __GNUC__ >= 12)
#define LACEDRING_AVX2_ 1
#define LACEDRING_WIDE_ __attribute__((target("avx2,bmi,bmi2,popcnt")))
/* Zen 1 and Zen 2 have all of these, but their pdep takes hundreds of cycles. */
LACEDRING_SMALL_ int lacedring_is_wide_(void) {
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2") &&
           __builtin_cpu_supports("popcnt") && !__builtin_cpu_is("znver1") && !__builtin_cpu_is("znver2");
}
#endif
#endif

#define LACEDRING_WORDS_ (LACEDRING_PACKED_BLOCK / 64 + 1)

#ifdef __OPTIMIZE_SIZE__
/* For small code, triangles are written in one pass. */
struct lacedring_turns_ {
    const uint32_t* words;
};
struct lacedring_pieces_ {
    /* [i]: triangles i - 1 and i cannot be a wart. */
    uint8_t barred[LACEDRING_PACKED_BLOCK + 1];
    uint32_t* out;
};
#else
/* The turns of a record, followed by zeros. */
struct lacedring_turns_ {
    uint64_t words[LACEDRING_WORDS_];
    /* [i]: number of ones in words before word i. */
    uint32_t before[LACEDRING_WORDS_];
};

/* Triangle i of a piece, with `ups` turns of 1 before it in the record, is entered across (base + ups, base + ups +
   span - i). */
#define LACEDRING_PIECES_ (LACEDRING_PACKED_BLOCK + 10)
struct lacedring_pieces_ {
    uint32_t begin[LACEDRING_PIECES_], base[LACEDRING_PIECES_], span[LACEDRING_PIECES_];
    uint32_t reversed[LACEDRING_PIECES_];           /* all ones, or 0 */
    uint32_t mixed;                                 /* nonzero: pieces differ in `reversed` */
    uint64_t begins[LACEDRING_WORDS_];              /* bit i: a piece begins at triangle i */
    uint64_t thirds[LACEDRING_WORDS_];              /* bit i: an event gives triangle i's third vertex */
    uint32_t warts[LACEDRING_PACKED_BLOCK / 8 + 1]; /* bit k < 9 of word j: triangle 8 j + k - 1 is a T0 */
};

#endif

#ifdef __OPTIMIZE_SIZE__
LACEDRING_SMALL_ uint32_t lacedring_turn_(const struct lacedring_turns_* t, uint32_t i) {
    return t->words[i / 32] >> i % 32 & 1;
}

static uint32_t lacedring_barred_(const struct lacedring_pieces_* p, uint32_t i) {
    return p->barred[i];
}
#else
/* Returns 1 if triangles i - 1 and i cannot be a wart. */
LACEDRING_HOT_ uint32_t lacedring_barred_(const struct lacedring_pieces_* p, uint32_t i) {
    return (p->begins[i / 64] | p->thirds[i / 64]) >> i % 64 & 1;
}

/* Byte k of the result is the number of ones in bytes 0 to k. */
LACEDRING_HOT_ uint64_t lacedring_counts_(uint64_t bits) {
    bits -= (bits >> 1) & UINT64_C(0x5555555555555555);
    bits = (bits & UINT64_C(0x3333333333333333)) + ((bits >> 2) & UINT64_C(0x3333333333333333));
    return ((bits + (bits >> 4)) & UINT64_C(0x0f0f0f0f0f0f0f0f)) * UINT64_C(0x0101010101010101);
}

/* Counts ones. wide: the processor has an instruction for it. */
LACEDRING_HOT_ uint32_t lacedring_count_(uint64_t bits, int wide) {
#ifdef LACEDRING_AVX2_
    if (wide) return (uint32_t)__builtin_popcountll(bits);
#elif defined(__wasm__) && !defined(LACEDRING_PLAIN)
    return (uint32_t)__builtin_popcountll(bits);
#endif
    (void)wide;
    return (uint32_t)(lacedring_counts_(bits) >> 56);
}

LACEDRING_HOT_ void lacedring_load_turns_(struct lacedring_turns_* t, const uint32_t* turns, uint32_t triangles,
                                          int wide) {
    uint32_t i, ups = 0;
    memset(t->words, 0, sizeof t->words);
    if (triangles > LACEDRING_PACKED_BLOCK - 32) {
        memcpy(t->words, turns, LACEDRING_PACKED_BLOCK / 8);
    } else {
        memcpy(t->words, turns, (size_t)4 * ((triangles + 31) / 32));
    }
    for (i = 0; i < LACEDRING_WORDS_; ++i) {
        t->before[i] = ups;
        ups += lacedring_count_(t->words[i], wide);
    }
}

LACEDRING_SMALL_ uint32_t lacedring_turn_(const struct lacedring_turns_* t, uint32_t i) {
    return (uint32_t)(t->words[i / 64] >> i % 64) & 1;
}

/* Number of turns that are 1 before triangle i of the record. */
LACEDRING_HOT_ uint32_t lacedring_ups_before_(const struct lacedring_turns_* t, uint32_t i, int wide) {
    return t->before[i / 64] + lacedring_count_(t->words[i / 64] & ((UINT64_C(1) << i % 64) - 1), wide);
}
#endif

/* Prefetches a cache line or two of the next block's output. */
#if defined(__GNUC__) && !defined(LACEDRING_PLAIN)
#define LACEDRING_AHEAD_(out) __builtin_prefetch((const void*)((uintptr_t)(out) + 12 * LACEDRING_PACKED_BLOCK), 1)
#else
#define LACEDRING_AHEAD_(out) (void)0
#endif

/* Writes triangles [i, end) of a piece one by one. `a` is that of triangle i, `span` is b - a + i. Returns a of
   triangle `end`. */
LACEDRING_HOT_ uint32_t lacedring_write_(const struct lacedring_turns_* turns, uint32_t i, uint32_t end, uint32_t a,
                                         uint32_t span, uint32_t reversed, uint32_t* out) {
    for (; i < end; ++i) {
        const uint32_t up = lacedring_turn_(turns, i), b = a + span - i;
        lacedring_put_(out + (size_t)3 * i, a, up ? a + 1 : b - 1, b, reversed);
        a += up;
    }
    return a;
}

#ifndef __OPTIMIZE_SIZE__

/* Table entry to write four triangles at once: index j is a + add[j], plus b - a where mask[j] is all ones. After the
   four, a grows by `ups`, and b - a shrinks by four whatever the turns. */
struct lacedring_nibble_ {
    uint32_t add[12], mask[12], ups[4], unused[4];
};

/* Before triangle k of four, a has grown by UP and b by UP - k. ABX and AXB: order of the fields. */
#define LACEDRING_BIT_(bits, k) (((bits) >> (k)) & 1u)
#define LACEDRING_UP_(bits, k)                                                       \
    ((LACEDRING_BIT_(bits, 0) & ((k) > 0)) + (LACEDRING_BIT_(bits, 1) & ((k) > 1)) + \
     (LACEDRING_BIT_(bits, 2) & ((k) > 2)))
#define LACEDRING_B_(bits, k) (LACEDRING_UP_(bits, k) - (k))
#define LACEDRING_X_(bits, k) (LACEDRING_UP_(bits, k) + (LACEDRING_BIT_(bits, k) ? 1u : 0u - (k)-1u))
#define LACEDRING_XM_(bits, k) (LACEDRING_BIT_(bits, k) ? 0u : UINT32_MAX)
#define LACEDRING_ABX_(bits, k) LACEDRING_UP_(bits, k), LACEDRING_B_(bits, k), LACEDRING_X_(bits, k)
#define LACEDRING_AXB_(bits, k) LACEDRING_UP_(bits, k), LACEDRING_X_(bits, k), LACEDRING_B_(bits, k)
#define LACEDRING_ABXM_(bits, k) 0u, UINT32_MAX, LACEDRING_XM_(bits, k)
#define LACEDRING_AXBM_(bits, k) 0u, LACEDRING_XM_(bits, k), UINT32_MAX
#define LACEDRING_FOUR_(of, bits) \
    { of(bits, 0u), of(bits, 1u), of(bits, 2u), of(bits, 3u) }
#define LACEDRING_UPS_(bits) LACEDRING_UP_(bits, 3u) + LACEDRING_BIT_(bits, 3)
#define LACEDRING_NIBBLE_(adds, masks, bits)                                                            \
    {                                                                                                   \
        LACEDRING_FOUR_(adds, bits), LACEDRING_FOUR_(masks, bits),                                      \
            {LACEDRING_UPS_(bits), LACEDRING_UPS_(bits), LACEDRING_UPS_(bits), LACEDRING_UPS_(bits)}, { \
            0, 0, 0, 0                                                                                  \
        }                                                                                               \
    }
#define LACEDRING_NIBBLES_(adds, masks)                                                                             \
    {                                                                                                               \
        LACEDRING_NIBBLE_(adds, masks, 0u), LACEDRING_NIBBLE_(adds, masks, 1u), LACEDRING_NIBBLE_(adds, masks, 2u), \
            LACEDRING_NIBBLE_(adds, masks, 3u), LACEDRING_NIBBLE_(adds, masks, 4u),                                 \
            LACEDRING_NIBBLE_(adds, masks, 5u), LACEDRING_NIBBLE_(adds, masks, 6u),                                 \
            LACEDRING_NIBBLE_(adds, masks, 7u), LACEDRING_NIBBLE_(adds, masks, 8u),                                 \
            LACEDRING_NIBBLE_(adds, masks, 9u), LACEDRING_NIBBLE_(adds, masks, 10u),                                \
            LACEDRING_NIBBLE_(adds, masks, 11u), LACEDRING_NIBBLE_(adds, masks, 12u),                               \
            LACEDRING_NIBBLE_(adds, masks, 13u), LACEDRING_NIBBLE_(adds, masks, 14u),                               \
            LACEDRING_NIBBLE_(adds, masks, 15u)                                                                     \
    }
#ifdef LACEDRING_VECTORS_
typedef uint32_t lacedring_four_ __attribute__((vector_size(16)));
__attribute__((aligned(128)))
#endif
static const struct lacedring_nibble_ lacedring_nibbles_[2][16] = {LACEDRING_NIBBLES_(LACEDRING_ABX_, LACEDRING_ABXM_),
                                                                   LACEDRING_NIBBLES_(LACEDRING_AXB_, LACEDRING_AXBM_)};

/* As lacedring_write_, but four at a time while they fit before `limit`: those after `end` are written again later. */
LACEDRING_HOT_ void lacedring_write_four_(const struct lacedring_turns_* turns, uint32_t i, uint32_t end,
                                          uint32_t limit, uint32_t a, uint32_t span, uint32_t reversed, uint32_t* out) {
    const struct lacedring_nibble_* table = lacedring_nibbles_[reversed];
    const uint32_t room = limit < 4 ? 0 : limit - 3 < end ? limit - 3 : end;
    uint32_t left = span - i;
    uint32_t* to = out + (size_t)3 * i;
#ifdef LACEDRING_VECTORS_
    const lacedring_four_ four = {4, 4, 4, 4};
    lacedring_four_ as = {a, a, a, a}, spans = {left, left, left, left}, sum;
#else
    uint32_t as[1], sums[12], j; /* a local array, so that compilers use vectors */
    as[0] = a;
#endif
    for (; i < room; i += 4, to += 12) {
        const struct lacedring_nibble_* n;
        uint32_t now;
        LACEDRING_AHEAD_(to);
        memcpy(&now, (const uint8_t*)turns->words + i / 8, 4);
        n = &table[now >> i % 8 & 15];
#ifdef LACEDRING_VECTORS_
        {
            const lacedring_four_* of = (const lacedring_four_*)(const void*)n;
            sum = (spans & of[3]) + of[0] + as;
            memcpy(to, &sum, 16);
            sum = (spans & of[4]) + of[1] + as;
            memcpy(to + 4, &sum, 16);
            sum = (spans & of[5]) + of[2] + as;
            memcpy(to + 8, &sum, 16);
            as += of[6];
            spans -= four;
        }
#else
        for (j = 0; j < 12; ++j) sums[j] = as[0] + n->add[j] + (left & n->mask[j]);
        memcpy(to, sums, sizeof sums);
        as[0] += n->ups[0];
        left -= 4;
#endif
    }
    lacedring_write_(turns, i, end, as[0], span, reversed, out);
}
#endif

#ifdef LACEDRING_AVX2_
typedef uint32_t lacedring_eight_ __attribute__((vector_size(32)));
typedef int32_t lacedring_signed_eight_ __attribute__((vector_size(32)));
typedef char lacedring_bytes_ __attribute__((vector_size(32)));
typedef float lacedring_floats_ __attribute__((vector_size(32)));

/* Table entry of eight bits: lane k is the number of ones below bit k, and its sign bit is bit k. */
struct lacedring_octet_ {
    uint32_t before[8];
};
#define LACEDRING_OCTET_(a, b, c, d, e, f, g, h)                                                                    \
    {                                                                                                               \
        {                                                                                                           \
            a *LACEDRING_SIGN_, b *LACEDRING_SIGN_ + a, c *LACEDRING_SIGN_ + a + b, d *LACEDRING_SIGN_ + a + b + c, \
                e *LACEDRING_SIGN_ + a + b + c + d, f *LACEDRING_SIGN_ + a + b + c + d + e,                         \
                g *LACEDRING_SIGN_ + a + b + c + d + e + f, h *LACEDRING_SIGN_ + a + b + c + d + e + f + g          \
        }                                                                                                           \
    }
#define LACEDRING_SIGN_ 0x80000000u
/* LACEDRING_OCTETS_n_ lists the table entries whose n highest bits are given. */
#define LACEDRING_OCTETS_7_(of, b, c, d, e, f, g, h) of(0, b, c, d, e, f, g, h), of(1, b, c, d, e, f, g, h)
#define LACEDRING_OCTETS_6_(of, c, d, e, f, g, h) \
    LACEDRING_OCTETS_7_(of, 0, c, d, e, f, g, h), LACEDRING_OCTETS_7_(of, 1, c, d, e, f, g, h)
#define LACEDRING_OCTETS_5_(of, d, e, f, g, h) \
    LACEDRING_OCTETS_6_(of, 0, d, e, f, g, h), LACEDRING_OCTETS_6_(of, 1, d, e, f, g, h)
#define LACEDRING_OCTETS_4_(of, e, f, g, h) \
    LACEDRING_OCTETS_5_(of, 0, e, f, g, h), LACEDRING_OCTETS_5_(of, 1, e, f, g, h)
#define LACEDRING_OCTETS_3_(of, f, g, h) LACEDRING_OCTETS_4_(of, 0, f, g, h), LACEDRING_OCTETS_4_(of, 1, f, g, h)
#define LACEDRING_OCTETS_2_(of, g, h) LACEDRING_OCTETS_3_(of, 0, g, h), LACEDRING_OCTETS_3_(of, 1, g, h)
#define LACEDRING_OCTETS_1_(of, h) LACEDRING_OCTETS_2_(of, 0, h), LACEDRING_OCTETS_2_(of, 1, h)
static const struct lacedring_octet_ lacedring_octets_[256]
    __attribute__((aligned(64))) = {LACEDRING_OCTETS_1_(LACEDRING_OCTET_, 0), LACEDRING_OCTETS_1_(LACEDRING_OCTET_, 1)};
#define LACEDRING_COUNTS_4_(n) n, n + 1, n + 1, n + 2
#define LACEDRING_COUNTS_16_(n) \
    LACEDRING_COUNTS_4_(n), LACEDRING_COUNTS_4_(n + 1), LACEDRING_COUNTS_4_(n + 1), LACEDRING_COUNTS_4_(n + 2)
#define LACEDRING_COUNTS_64_(n) \
    LACEDRING_COUNTS_16_(n), LACEDRING_COUNTS_16_(n + 1), LACEDRING_COUNTS_16_(n + 1), LACEDRING_COUNTS_16_(n + 2)
static const uint32_t lacedring_octet_counts_[256] = {LACEDRING_COUNTS_64_(0), LACEDRING_COUNTS_64_(1),
                                                      LACEDRING_COUNTS_64_(1), LACEDRING_COUNTS_64_(2)};

#define LACEDRING_PERMUTE_(v, from) \
    ((lacedring_eight_)__builtin_ia32_permvarsi256((lacedring_signed_eight_)(v), (lacedring_signed_eight_)(from)))
/* Per lane: w if the sign bit of `sign` is set, else v. */
#define LACEDRING_BLEND_(v, w, sign)                                                              \
    ((lacedring_eight_)__builtin_ia32_blendvps256((lacedring_floats_)(v), (lacedring_floats_)(w), \
                                                  (lacedring_floats_)(sign)))

/* Sign-extends eight bytes to eight lanes. */
LACEDRING_WIDE_ LACEDRING_HOT_ lacedring_eight_ lacedring_widen_(uint64_t bytes) {
#ifdef __clang__
    typedef signed char lacedring_few_ __attribute__((vector_size(8)));
    return (lacedring_eight_) __builtin_convertvector((lacedring_few_)bytes, lacedring_signed_eight_);
#else
    typedef char lacedring_few_ __attribute__((vector_size(16)));
    typedef uint64_t lacedring_two_ __attribute__((vector_size(16)));
    const lacedring_two_ two = {bytes, 0};
    return (lacedring_eight_)__builtin_ia32_pmovsxbd256((lacedring_few_)two);
#endif
}

/* Transposes three vectors, in which lane k belongs to triangle k, to the 24 indices in order: first within each half
   of a vector, then the halves. */
LACEDRING_WIDE_ LACEDRING_HOT_ void lacedring_mix_(lacedring_eight_ a, lacedring_eight_ b, lacedring_eight_ x,
                                                   lacedring_eight_ to[3]) {
    lacedring_eight_ q0, q1, q2;
    a = __builtin_shufflevector(a, a, 0, 3, 2, 1, 4, 7, 6, 5);
    b = __builtin_shufflevector(b, b, 1, 0, 3, 2, 5, 4, 7, 6);
    x = __builtin_shufflevector(x, x, 2, 1, 0, 3, 6, 5, 4, 7);
    q0 = __builtin_shufflevector(a, b, 0, 9, 2, 3, 4, 13, 6, 7);
    q1 = __builtin_shufflevector(b, x, 0, 9, 2, 3, 4, 13, 6, 7);
    q2 = __builtin_shufflevector(x, a, 0, 9, 2, 3, 4, 13, 6, 7);
    q0 = __builtin_shufflevector(q0, x, 0, 1, 10, 3, 4, 5, 14, 7);
    q1 = __builtin_shufflevector(q1, a, 0, 1, 10, 3, 4, 5, 14, 7);
    q2 = __builtin_shufflevector(q2, b, 0, 1, 10, 3, 4, 5, 14, 7);
    to[0] = __builtin_shufflevector(q0, q1, 0, 1, 2, 3, 8, 9, 10, 11);
    to[1] = (lacedring_eight_)__builtin_ia32_pblendd256((lacedring_signed_eight_)q2, (lacedring_signed_eight_)q0, 0xf0);
    to[2] = __builtin_shufflevector(q1, q2, 4, 5, 6, 7, 12, 13, 14, 15);
}

/* As lacedring_nibble_, for eight triangles and in bytes. A byte below 128 is added to a; a byte 136 + d stands for b +
   d. Then a and b grow by grow_a and grow_b. */
struct lacedring_eighth_ {
    uint8_t add[24];
    uint32_t grow_a, grow_b;
};
#define LACEDRING_OF_ABX_(k, up, ups) (ups), (ups) + 136 - k, (up) ? (ups) + 1 : (ups) + 135 - k
#define LACEDRING_OF_AXB_(k, up, ups) (ups), (up) ? (ups) + 1 : (ups) + 135 - k, (ups) + 136 - k
#define LACEDRING_RUN_(of, a, b, c, d, e, f, g, h)                                \
    {                                                                             \
        {of(0, a, 0),                                                             \
         of(1, b, a),                                                             \
         of(2, c, a + b),                                                         \
         of(3, d, a + b + c),                                                     \
         of(4, e, a + b + c + d),                                                 \
         of(5, f, a + b + c + d + e),                                             \
         of(6, g, a + b + c + d + e + f),                                         \
         of(7, h, a + b + c + d + e + f + g)},                                    \
            a + b + c + d + e + f + g + h, 0u - 8 + a + b + c + d + e + f + g + h \
    }
#define LACEDRING_RUN_ABX_(a, b, c, d, e, f, g, h) LACEDRING_RUN_(LACEDRING_OF_ABX_, a, b, c, d, e, f, g, h)
#define LACEDRING_RUN_AXB_(a, b, c, d, e, f, g, h) LACEDRING_RUN_(LACEDRING_OF_AXB_, a, b, c, d, e, f, g, h)
static const struct lacedring_eighth_ lacedring_eighths_[2][256] __attribute__((aligned(64))) = {
    {LACEDRING_OCTETS_1_(LACEDRING_RUN_ABX_, 0), LACEDRING_OCTETS_1_(LACEDRING_RUN_ABX_, 1)},
    {LACEDRING_OCTETS_1_(LACEDRING_RUN_AXB_, 0), LACEDRING_OCTETS_1_(LACEDRING_RUN_AXB_, 1)}};

/* Eight indices from eight bytes of lacedring_eighth_::add. `b` is 8 less than the edge's b. */
LACEDRING_WIDE_ LACEDRING_HOT_ lacedring_eight_ lacedring_sum_(const uint8_t* add, lacedring_eight_ a,
                                                               lacedring_eight_ b) {
    uint64_t bytes;
    lacedring_eight_ all;
    memcpy(&bytes, add, 8);
    all = lacedring_widen_(bytes);
    return LACEDRING_BLEND_(a, b, all) + (all & 15);
}

/* As lacedring_write_four_ with `triangles` as the limit, but eight at a time. */
LACEDRING_WIDE_ static void lacedring_write_run_(const struct lacedring_turns_* turns, uint32_t i, uint32_t end,
                                                 uint32_t triangles, uint32_t a, uint32_t span, uint32_t reversed,
                                                 uint32_t* out) {
    const lacedring_eight_ zero = {0, 0, 0, 0, 0, 0, 0, 0};
    lacedring_eight_ as = zero + a, bs = zero + (a + span - i - 8), to[3];
    for (out += (size_t)3 * i;; i += 8, out += 24) {
        const struct lacedring_eighth_* n;
        uint32_t now;
        memcpy(&now, (const uint8_t*)turns->words + i / 8, 4);
        n = &lacedring_eighths_[reversed][now >> i % 8 & 255];
        to[0] = lacedring_sum_(n->add, as, bs);
        to[1] = lacedring_sum_(n->add + 8, as, bs);
        to[2] = lacedring_sum_(n->add + 16, as, bs);
        as += n->grow_a;
        bs += n->grow_b;
        LACEDRING_AHEAD_(out);
        LACEDRING_AHEAD_(out + 16);
        if (i + 8 > triangles) break;
        memcpy(out, &to[0], 32);
        memcpy(out + 8, &to[1], 32);
        memcpy(out + 16, &to[2], 32);
        if (i + 8 >= end) return;
    }
    memcpy(out, to, (size_t)12 * (triangles - i));
}

/* Writes a record that is one piece. Returns 0 if b - a is too small at a wart. */
LACEDRING_WIDE_ static int lacedring_write_one_(const struct lacedring_turns_* turns, const struct lacedring_pieces_* p,
                                                uint32_t triangles, uint32_t* out) {
    const uint32_t reversed = p->reversed[0] & 1;
    uint32_t k, good = 1;
    lacedring_write_run_(turns, 0, triangles, triangles, p->base[0], p->span[0], reversed, out);
    for (k = 0; 8 * k < triangles; ++k) {
        uint32_t warts;
        for (warts = p->warts[k] >> 1 & 255; warts != 0; warts &= warts - 1) {
            const uint32_t i = 8 * k + lacedring_ones_(~warts & (warts - 1)), up = lacedring_turn_(turns, i);
            const uint32_t a = p->base[0] + lacedring_ups_before_(turns, i, 1), b = a + p->span[0] - i;
            const uint32_t inner = up ? a + 1 : b - 1;
            good &= b - a >= 4;
            out[3 * i + 2 - reversed] = up ? a + 2 : b - 2;
            if (i + 1 < triangles) lacedring_put_(out + 3 * i + 3, inner - 1, inner, inner + 1, reversed);
        }
    }
    return (int)good;
}

/* Writes the triangles of a record, with warts, eight at a time, even of different pieces. Lane k of a vector belongs
   to triangle k until lacedring_mix_. way: 0 if no piece is reversed, 1 if all are, 2 if some are. Returns nonzero
   lanes where b - a is too small for a wart. */
LACEDRING_WIDE_ LACEDRING_HOT_ lacedring_eight_ lacedring_write_eights_(const uint8_t* turns,
                                                                        const struct lacedring_pieces_* pieces,
                                                                        uint32_t triangles, uint32_t* out, int way) {
    const lacedring_eight_ seven = {7, 7, 7, 7, 7, 7, 7, 7}, one = {1, 1, 1, 1, 1, 1, 1, 1}, three = one + one + one;
    const lacedring_eight_ t2_bits = {1, 2, 4, 8, 16, 32, 64, 128}, t0_bits = t2_bits * 2;
    const uint8_t* begin = (const uint8_t*)pieces->begins;
    const uint32_t* warts = pieces->warts;
    lacedring_eight_ numbers = {0, 1, 2, 3, 4, 5, 6, 7}, ups = one - one, bad = ups, to[3];
    size_t piece = (size_t)0 - 1;
    for (;; out += 24, triangles -= 8) {
        const uint32_t now = *turns++, begins = *begin++;
        lacedring_eight_ a, b, x, span, which, up, t0, t2, step, swap;
        piece += begins & 1;
        memcpy(&which, &lacedring_octets_[begins >> 1], 32);
        memcpy(&up, &lacedring_octets_[now], 32);
        memcpy(&a, pieces->base + piece, 32);
        memcpy(&span, pieces->span + piece, 32);
        a = LACEDRING_PERMUTE_(a, which) + (ups + (up & seven));
        span = LACEDRING_PERMUTE_(span, which) - numbers;
        ups += lacedring_octet_counts_[now];
        numbers += seven + one;
        t0 = (lacedring_eight_)(((one * 0 + *warts) & t0_bits) == t0_bits);
        t2 = (lacedring_eight_)(((one * 0 + *warts++) & t2_bits) == t2_bits);
        b = a + span;
        bad |= t0 & (lacedring_eight_)(span <= three);
        /* Distance of x from a (turn 1) or from b (turn 0): 2 at a wart's T0; 0 at a wart's T2, whose entry edge is
           (x - 1, x + 1); else 1. */
        step = one - t0 + t2;
        x = LACEDRING_BLEND_(b - step, a + step, up);
        a = LACEDRING_BLEND_(a, x - one, t2);
        b = LACEDRING_BLEND_(b, x + one, t2);
        if (way == 1) {
            swap = b;
            b = x;
            x = swap;
        } else if (way == 2) {
            memcpy(&swap, pieces->reversed + piece, 32);
            swap = LACEDRING_PERMUTE_(swap, which) & (b ^ x);
            b ^= swap;
            x ^= swap;
        }
        piece += (uint32_t)__builtin_popcount(begins >> 1);
        lacedring_mix_(a, b, x, to);
        LACEDRING_AHEAD_(out);
        LACEDRING_AHEAD_(out + 16);
        if (triangles < 8) break;
        memcpy(out, &to[0], 32);
        memcpy(out + 8, &to[1], 32);
        memcpy(out + 16, &to[2], 32);
        if (triangles == 8) return bad;
    }
    memcpy(out, to, (size_t)12 * triangles);
    return bad;
}

/* Writes a record of several pieces. Returns 0 if b - a is too small at a wart. */
LACEDRING_WIDE_ static int lacedring_write_wide_(const uint8_t* turns, const struct lacedring_pieces_* pieces,
                                                 uint32_t triangles, uint32_t* out) {
    lacedring_eight_ bad;
    uint64_t any[4];
    if (pieces->mixed) {
        bad = lacedring_write_eights_(turns, pieces, triangles, out, 2);
    } else if (pieces->reversed[0]) {
        bad = lacedring_write_eights_(turns, pieces, triangles, out, 1);
    } else {
        bad = lacedring_write_eights_(turns, pieces, triangles, out, 0);
    }
    memcpy(any, &bad, 32);
    return (any[0] | any[1] | any[2] | any[3]) == 0;
}
#endif

struct lacedring_scope_ {
    uint32_t end, a, b, reversed;
};

/* A record whose events are being read. */
struct lacedring_decoder_ {
    struct lacedring_state_ s;
    const struct lacedring_turns_* turns;
    uint32_t i, ups, triangles, piece;
    struct lacedring_pieces_* pieces;
    struct lacedring_scope_* scope; /* the innermost open scope; scope 0 never ends */
};

LACEDRING_HOT_ int lacedring_inside_(const struct lacedring_decoder_* d) {
    return d->scope->end != UINT32_MAX;
}

/* Begins a piece at triangle d->i, whose state does not follow by turns. */
LACEDRING_HOT_ void lacedring_begin_piece_(struct lacedring_decoder_* d) {
    struct lacedring_pieces_* p = d->pieces;
#ifdef __OPTIMIZE_SIZE__
    p->barred[d->i] = 1;
#else
    if (p->begin[d->piece] != d->i) ++d->piece;
    p->begin[d->piece] = d->i;
    p->base[d->piece] = d->s.a - d->ups;
    p->span[d->piece] = d->s.b - d->s.a + d->i;
    p->reversed[d->piece] = 0 - d->s.reversed;
    p->mixed |= p->reversed[0] ^ p->reversed[d->piece];
    p->begins[d->i / 64] |= UINT64_C(1) << d->i % 64;
#endif
}

/* Advances by turns to triangle `target`, and closes the scopes that end at or before it. Returns 0 if the record is
   invalid. */
LACEDRING_HOT_ int lacedring_advance_(struct lacedring_decoder_* d, uint32_t target, int wide) {
    (void)wide;
    for (;;) {
        const uint32_t stop = d->scope->end < target ? d->scope->end : target;
        while (d->i < stop) {
            uint32_t left, end = stop, ups;
            if (d->s.finished) {
                if (lacedring_inside_(d)) return 0;
                lacedring_repeat_(&d->s, 0);
                lacedring_begin_piece_(d);
            }
            left = lacedring_left_(d->s.a, d->s.b);
            if (end - d->i > left) end = d->i + left;
#ifdef __OPTIMIZE_SIZE__
            ups = lacedring_write_(d->turns, d->i, end, d->s.a, d->s.b - d->s.a + d->i, d->s.reversed, d->pieces->out) -
                  d->s.a;
#else
            ups = lacedring_ups_before_(d->turns, end, wide) - d->ups;
            d->ups += ups;
#endif
            d->s.a += ups;
            d->s.b -= end - d->i - ups;
            d->i = end;
            d->s.finished = d->s.b - d->s.a == 1;
            /* Either turn would describe a corridor's last triangle, so the format prescribes one. */
            if (d->s.finished &
                (lacedring_turn_(d->turns, end - 1) == (end > 1 ? lacedring_turn_(d->turns, end - 2) : UINT32_C(1))))
                return 0;
        }
        if (d->scope->end != d->i) return 1;
        d->s.a = d->scope->a;
        d->s.b = d->scope->b;
        d->s.reversed = d->scope->reversed;
        d->s.finished = 0;
        --d->scope;
        lacedring_begin_piece_(d);
    }
}

#ifndef __OPTIMIZE_SIZE__
/* Finds the set bit of `bits` that has `rank` set bits below it. `counts` is lacedring_counts_(bits). */
LACEDRING_HOT_ uint32_t lacedring_select_(uint64_t bits, uint64_t counts, uint32_t rank) {
    static const uint8_t of_four[16][4] = {
        {0, 0, 0, 0}, {0, 0, 0, 0}, {1, 0, 0, 0}, {0, 1, 0, 0}, {2, 0, 0, 0}, {0, 2, 0, 0}, {1, 2, 0, 0}, {0, 1, 2, 0},
        {3, 0, 0, 0}, {0, 3, 0, 0}, {1, 3, 0, 0}, {0, 1, 3, 0}, {2, 3, 0, 0}, {0, 2, 3, 0}, {1, 2, 3, 0}, {0, 1, 2, 3}};
    static const uint8_t count[16] = {0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4};
    const uint64_t each = UINT64_C(0x0101010101010101), high = each << 7;
    const uint64_t below = (((rank * each) | high) - counts) & high; /* marks the bytes that lie before it */
    const uint32_t byte = (uint32_t)(((below >> 7) * each) >> 56);
    const uint32_t in_byte = (uint32_t)(bits >> (8 * byte)) & 0xff,
                   left = rank - ((uint32_t)((counts << 8) >> (8 * byte)) & 0xff);
    const uint32_t low = count[in_byte & 15], upper = left >= low; /* no branch: it would be unpredictable */
    return 8 * byte + 4 * upper + of_four[in_byte >> 4 * upper & 15][left - (low & (0 - upper))];
}
#endif

/* Makes triangle i the T0 of a wart, and the next one its T2. Returns 0 if b - a is too small. */
LACEDRING_HOT_ int lacedring_write_wart_(const struct lacedring_decoder_* d, uint32_t i, uint32_t* out) {
    const uint32_t up = lacedring_turn_(d->turns, i), a = out[3 * i];
    const uint32_t reversed = out[3 * i + 1] == (up ? a + 1 : out[3 * i + 2] - 1), b = out[3 * i + 1 + reversed];
    const uint32_t inner = up ? a + 1 : b - 1;
    if (b - a < 4) return 0;
    out[3 * i + 2 - reversed] = up ? a + 2 : b - 2;
    if (i + 1 < d->triangles) lacedring_put_(out + 3 * i + 3, inner - 1, inner, inner + 1, reversed);
    return 1;
}

/* Reads the warts and writes them over the triangles. Returns 0 if one is where none may be, or if there are fewer than
   `least`. */
LACEDRING_HOT_ int lacedring_warts_(const struct lacedring_decoder_* d, struct lacedring_bits_ bits, uint32_t low,
                                    uint32_t least, uint32_t* out) {
    uint32_t i = 0, warts = 0, last = UINT32_MAX - 1;
#ifndef __OPTIMIZE_SIZE__
    uint64_t candidates = 0, counts = 0;
    uint32_t word = 0, count = 0, rank = 0;
#endif
    for (;; ++warts) {
        uint32_t gap = lacedring_rice_(&bits, low);
        if (gap == UINT32_MAX) return bits.at <= bits.end && bits.end - bits.at < 8 && warts >= least;
        if (bits.at > bits.end) return 0;
#ifdef __OPTIMIZE_SIZE__
        for (;; ++i) {
            if (i >= d->triangles) return 0;
            if (i + 1 < d->triangles && lacedring_turn_(d->turns, i) != lacedring_turn_(d->turns, i + 1)) continue;
            if (gap-- == 0) break;
        }
        ++i;
#else
        for (rank += gap; rank >= count; ++word) { /* until `word` holds candidate `rank` */
            uint64_t turns;
            rank -= count;
            if (64 * word >= d->triangles) return 0;
            turns = d->turns->words[word];
            candidates = ~(turns ^ (turns >> 1 | d->turns->words[word + 1] << 63));
            if (d->triangles - 64 * word <= 64) {
                const uint32_t left = d->triangles - 64 * word - 1;
                candidates = (candidates | UINT64_C(1) << left) & UINT64_MAX >> (63 - left);
            }
            counts = lacedring_counts_(candidates);
            count = (uint32_t)(counts >> 56);
        }
        i = 64 * word - 63 + lacedring_select_(candidates, counts, rank++);
#endif
        /* i is the T2; it may be after the last triangle. */
        if (i == last + 1 || lacedring_barred_(d->pieces, i) || !lacedring_write_wart_(d, i - 1, out)) return 0;
        last = i;
    }
}

#ifdef LACEDRING_AVX2_
/* Reads the warts into p->warts: first a bit for each rank among the candidates, then these bits are spread to the
   candidates of 64 triangles at a time. */
LACEDRING_WIDE_ static int lacedring_warts_wide_(const struct lacedring_decoder_* d, const struct lacedring_bits_* bits,
                                                 uint32_t low, uint32_t least) {
    uint64_t ranks[LACEDRING_WORDS_ + 1] = {0, 0, 0, 0, 0, 0}, bad = 0, last = 0, bars, at = bits->at;
    const uint64_t end = bits->end, *turns = d->turns->words;
    struct lacedring_pieces_* p = d->pieces;
    uint32_t word, rank = 0, count = 0, warts = 0;
    for (;; ++warts, ++rank) {
        const uint64_t window = lacedring_load_(bits, at);
        const uint32_t ones = lacedring_ones_(window & ~(UINT64_C(1) << 32));
        if (ones >= end - at || ones == 32) break;
        rank += (ones << low) + ((uint32_t)(window >> (ones + 1)) & ((UINT32_C(1) << low) - 1));
        at += ones + 1 + low;
        if (at > end || rank >= LACEDRING_PACKED_BLOCK) return 0;
        ranks[rank / 64] |= UINT64_C(1) << rank % 64;
    }
    if (end - at >= 8 || warts < least) return 0;
    bars = p->begins[0] | p->thirds[0];
    for (word = 0; 64 * word < d->triangles; ++word) {
        uint64_t candidates = ~(turns[word] ^ (turns[word] >> 1 | turns[word + 1] << 63)), t0;
        const uint64_t here = ranks[count / 64] >> count % 64 | ranks[count / 64 + 1] << 1 << (63 - count % 64);
        lacedring_eight_ groups;
        if (d->triangles <= 64 * word + 64) {
            const uint32_t left = d->triangles - 64 * word - 1;
            candidates = (candidates | UINT64_C(1) << left) & UINT64_MAX >> (63 - left);
        }
        t0 = __builtin_ia32_pdep_di(here, candidates);
        count += (uint32_t)__builtin_popcountll(candidates);
        bad |= (last >> 63 | t0 << 1) & (bars | t0);
        bars = p->begins[word + 1] | p->thirds[word + 1];
        bad |= t0 >> 63 & bars;
        groups = lacedring_widen_(t0) * 2 | (lacedring_widen_(t0 << 8 | last >> 56) >> 7 & 1);
        memcpy(p->warts + 8 * word, &groups, 32);
        last = t0;
    }
    p->warts[8 * word] = (uint32_t)(last >> 63);
    return bad == 0 && rank <= count;
}
#endif

#ifndef __OPTIMIZE_SIZE__
/* Writes the pieces in order. */
LACEDRING_HOT_ void lacedring_write_pieces_(const struct lacedring_turns_* turns, const struct lacedring_pieces_* p,
                                            uint32_t triangles, uint32_t* out) {
    uint32_t k;
    for (k = 0; p->begin[k] < triangles; ++k) {
        const uint32_t a = p->base[k] + lacedring_ups_before_(turns, p->begin[k], 0);
        lacedring_write_four_(turns, p->begin[k], p->begin[k + 1], triangles, a, p->span[k], p->reversed[k] & 1, out);
    }
}

/* Reads a SPLIT, as nearly all events are, from one load. Returns its size; returns 0 and reads nothing if the next
   event is another one or takes more bits. */
LACEDRING_HOT_ uint32_t lacedring_read_split_(struct lacedring_bits_* r, uint32_t low, uint32_t order, uint32_t* gap) {
    const uint64_t at = r->at;
    uint64_t window;
    uint32_t ones, first, bits, size;
    if ((size_t)(at >> 3) + 8 > r->bytes) return 0;
    memcpy(&window, r->groups + (at >> 3), 8);
    window >>= at & 7;
    ones = first = lacedring_ones_(window & ~(UINT64_C(1) << 32));
    *gap = (ones << low) + ((uint32_t)(window >> (ones + 1)) & ((UINT32_C(1) << low) - 1));
    bits = ones + low + 1;
    window >>= bits;
    ones = lacedring_ones_((window >> 1) & 0xff);
    bits += 2 * ones + 2 + order;
    size = (uint32_t)(window >> (ones + 2)) & ((UINT32_C(1) << (ones + order)) - 1);
    size += (UINT32_C(1) << (ones + order)) - (UINT32_C(1) << order) + 3;
    if ((window & 1) != 0 || bits > 57 || ones > 7 || first > 31 || at + bits > r->end) return 0;
    r->at = at + bits;
    return size;
}
#endif

/* Decodes a record. explicit_entry: its own bits begin with its entry. wide: with AVX2. Returns 0 if it is invalid;
   some of `out` is not written then. Safe with any words: nothing but the stream is read, and nothing but the record's
   triangles is written. Their vertices may be out of range. */
LACEDRING_HOT_ int lacedring_expand_(const struct lacedring_packed* p, const struct lacedring_group_* g,
                                     struct lacedring_record_* r, int explicit_entry, uint32_t* out, int wide) {
    struct lacedring_decoder_ d;
    struct lacedring_scope_ scopes[LACEDRING_PACKED_BLOCK];
    struct lacedring_turns_ turns;
    struct lacedring_pieces_ pieces;
#ifndef __OPTIMIZE_SIZE__
    struct {
        uint32_t at, x;
    } thirds[LACEDRING_PACKED_BLOCK];
    uint32_t third_count = 0;
#endif
    uint32_t k, events = 0, at = 0, least;
    uint64_t flips = UINT64_MAX;
    const int empty = r->bits.at == r->bits.end && !explicit_entry;
    scopes[0].end = UINT32_MAX;
#ifdef __OPTIMIZE_SIZE__
    memset(pieces.barred, 0, sizeof pieces.barred);
    pieces.out = out;
    turns.words = r->turns;
#else
    memset(pieces.begins, 0, sizeof pieces.begins);
    memset(pieces.thirds, 0, sizeof pieces.thirds);
    pieces.begin[0] = pieces.mixed = 0;
    pieces.reversed[0] = 0 - r->reversed;
    lacedring_load_turns_(&turns, r->turns, r->triangles, wide);
#endif
    d.s.a = d.s.begun_a = r->a;
    d.s.b = d.s.begun_b = r->b;
    d.s.reversed = d.s.begun_reversed = r->reversed;
    d.s.finished = 0;
    d.turns = &turns;
    d.i = d.ups = d.piece = 0;
    d.triangles = r->triangles;
    d.pieces = &pieces;
    d.scope = scopes;
    lacedring_begin_piece_(&d);
    if (!empty) events = lacedring_golomb_(&r->bits, g->count_order);
    for (k = 0;; ++k) {
        struct lacedring_event_ e = {0, 0, 0, 0, 0, 0, 0};
        e.triangle = d.triangles;
        if (k < events) {
#ifdef __OPTIMIZE_SIZE__
            e.triangle = at;
            lacedring_read_event_(p, g, r, &e);
            if (e.triangle < at || e.triangle == UINT32_MAX || r->bits.at > r->bits.end) return 0;
#else
            uint32_t gap;
            e.v = lacedring_read_split_(&r->bits, g->gap_bits, g->split_order, &gap);
            if (e.v != 0) {
                e.triangle = at + gap;
                if (e.triangle >= d.triangles) return 0;
            } else {
                /* A separate copy, so that the compiler keeps `e` in registers. */
                struct lacedring_event_ read = {0, 0, 0, 0, 0, 0, 0};
                read.triangle = at;
                lacedring_read_event_(p, g, r, &read);
                e = read;
                if (e.triangle < at || e.triangle == UINT32_MAX || r->bits.at > r->bits.end) return 0;
            }
#endif
        }
        if (!lacedring_advance_(&d, e.triangle, wide)) return 0;
        if (k == events) break;
        at = d.i;
        if (e.code == LACEDRING_TURN_) {
            d.s.reversed ^= 1;
        } else if (e.code == LACEDRING_FLIPS_) {
            if (k != 0 || e.triangle != 0) return 0;
            flips = e.flips;
        } else if (e.code == LACEDRING_START_ || e.code == LACEDRING_BESIDE_) {
#ifdef __OPTIMIZE_SIZE__
            lacedring_begin_(&d.s, &e, lacedring_inside_(&d));
#else
            struct lacedring_state_ s = d.s;
            lacedring_begin_(&s, &e, lacedring_inside_(&d));
            d.s = s;
#endif
        } else {
            const uint32_t turn = lacedring_turn_(&turns, d.i);
            uint32_t rest[2], count, a, b, x;
            if (d.s.finished) {
                if (lacedring_inside_(&d)) return 0;
                lacedring_repeat_(&d.s, 0);
                lacedring_begin_piece_(&d);
            }
            if (e.code == LACEDRING_FAR_ && e.choice != 3 && turn) return 0; /* an unused turn must be 0 */
            a = d.s.a;
            b = d.s.b;
            x = lacedring_third_(&d.s, &e, turn, rest, &count);
#ifdef __OPTIMIZE_SIZE__
            pieces.barred[d.i] = 1;
            lacedring_put_(out + 3 * d.i, a, x, b, d.s.reversed);
#else
            (void)a;
            (void)b;
            pieces.thirds[d.i / 64] |= UINT64_C(1) << d.i % 64;
            thirds[third_count].at = 3 * d.i + 2 - d.s.reversed;
            thirds[third_count++].x = x;
#endif
            ++d.i;
            d.ups += turn;
            if (count >= d.triangles - d.i) { /* edge `rest` is not entered in this record */
                if (e.code != LACEDRING_SPLIT_ && count > 0) return 0;
                if (count > 0 && lacedring_inside_(&d)) return 0;
            } else if (count > 0) {
                if (d.scope->end < d.i + count) return 0;
                ++d.scope;
                d.scope->end = d.i + count;
                d.scope->a = rest[0];
                d.scope->b = rest[1];
                d.scope->reversed = d.s.reversed;
            }
            ++at; /* the next gap counts from here */
        }
        lacedring_begin_piece_(&d);
    }
    least = !explicit_entry && events == 0;
#ifndef __OPTIMIZE_SIZE__
    pieces.begin[d.piece + 1] = d.triangles;
#ifdef LACEDRING_AVX2_
    if (wide) {
        if (!lacedring_warts_wide_(&d, &r->bits, g->wart_bits, least && !empty)) return 0;
        if (!(d.piece == 0 ? lacedring_write_one_(&turns, &pieces, d.triangles, out)
                           : lacedring_write_wide_((const uint8_t*)r->turns, &pieces, d.triangles, out)))
            return 0;
    } else
#endif
        lacedring_write_pieces_(&turns, &pieces, d.triangles, out);
    for (k = 0; k < third_count; ++k) out[thirds[k].at] = thirds[k].x;
#endif
    if (!wide && !empty && !lacedring_warts_(&d, r->bits, g->wart_bits, least, out)) return 0;
    if (flips != UINT64_MAX) {
        struct lacedring_bits_ bits = r->bits;
        uint32_t i;
        bits.at = flips;
        for (i = 0; i < d.triangles; ++i, out += 3) {
            const uint32_t b = out[1];
            if (!lacedring_take_(&bits, 1)) continue;
            out[1] = out[2];
            out[2] = b;
        }
    }
    return 1;
}

#ifdef LACEDRING_AVX2_
LACEDRING_WIDE_ static int lacedring_expand_wide_(const struct lacedring_packed* p, const struct lacedring_group_* g,
                                                  struct lacedring_record_* r, int explicit_entry, uint32_t* out) {
    return lacedring_expand_(p, g, r, explicit_entry, out, 1);
}
#endif

static int lacedring_expand_record_(const struct lacedring_packed* p, const struct lacedring_group_* g,
                                    struct lacedring_record_* r, int explicit_entry, uint32_t* out) {
#ifdef LACEDRING_AVX2_
    if (lacedring_is_wide_()) return lacedring_expand_wide_(p, g, r, explicit_entry, out);
#endif
    return lacedring_expand_(p, g, r, explicit_entry, out, 0);
}

static int lacedring_expand_block_(const struct lacedring_packed* p, const struct lacedring_group_* g,
                                   struct lacedring_block_* b, uint32_t* out) {
    uint32_t i, left = p->own - b->record.first;
    if (left > LACEDRING_PACKED_BLOCK) left = LACEDRING_PACKED_BLOCK;
    if (b->kind == LACEDRING_PLAIN_) {
        for (i = 0; i < left; ++i) lacedring_plain_(p, b, i, out + (size_t)3 * i);
        return 1;
    }
    if (b->kind == LACEDRING_RECORD_) return lacedring_expand_record_(p, g, &b->record, 0, out);
    for (i = 0; i * LACEDRING_PACKED_PART_ < left; ++i) {
        struct lacedring_record_ r;
        lacedring_part_(p, b, i, &r);
        if (!lacedring_expand_record_(p, g, &r, i > 0, out + (size_t)3 * i * LACEDRING_PACKED_PART_)) return 0;
    }
    return 1;
}

enum lacedring_status lacedring_packed_open(const uint32_t* words, size_t count, struct lacedring_packed* p,
                                            uint64_t* where) {
    uint64_t turns, groups, left;
    if (count < LACEDRING_PACKED_HEADER_WORDS) return lacedring_at_(where, 0, LACEDRING_STATUS_SHORT);
    if ((words[0] & 0xffffffu) != 0x50524cu) return lacedring_at_(where, 0, LACEDRING_STATUS_MAGIC);
    if (words[0] != 0x3250524cu) /* the first version had a K here */
        return lacedring_at_(where, words[0] >> 24 == 'K' ? 1 : (words[0] >> 24) - '0', LACEDRING_STATUS_VERSION);
    p->vertices = words[1] & ~LACEDRING_DOUBLES_;
    p->own = p->triangles = words[2];
    p->runs = 0;
    if (p->vertices > UINT32_C(1) << 29) return lacedring_at_(where, 0, LACEDRING_STATUS_VERTICES);
    if (p->own > UINT32_MAX / 3) return lacedring_at_(where, 0, LACEDRING_STATUS_SLOTS);
    for (p->vertex_bits = 1; p->vertex_bits < 31 && p->vertices > UINT32_C(1) << p->vertex_bits;) ++p->vertex_bits;
    turns = ((uint64_t)p->own + 31) / 32;
    groups = ((uint64_t)lacedring_blocks_of_(p->own) + LACEDRING_PACKED_GROUP_ - 1) / LACEDRING_PACKED_GROUP_;
    groups -= groups > 0; /* table entries: all groups but the first */
    left = count - LACEDRING_PACKED_HEADER_WORDS;
    if (turns + groups > left) return lacedring_at_(where, turns + groups, LACEDRING_STATUS_SIZE);
    left -= turns + groups;
    p->turns = words + LACEDRING_PACKED_HEADER_WORDS;
    p->table = p->turns + turns;
    p->doubles = p->table + groups;
    if (words[1] & LACEDRING_DOUBLES_) {
        if (left < 2 || p->doubles[1] > (left - 2) / 2) return lacedring_at_(where, 0, LACEDRING_STATUS_SIZE);
        p->runs = p->doubles[1];
        if (p->runs == 0 || p->doubles[0] > p->own) return lacedring_at_(where, 0, LACEDRING_STATUS_DOUBLES);
        p->triangles += p->doubles[0];
        p->doubles += 2;
        left -= 2 + (uint64_t)2 * p->runs;
    }
    if (p->triangles > UINT32_MAX / 3) return lacedring_at_(where, 0, LACEDRING_STATUS_SLOTS);
    p->groups = (const uint8_t*)(p->doubles + (size_t)2 * p->runs);
    p->group_bytes = (size_t)(4 * left);
    return LACEDRING_STATUS_OK;
}

/* Checks what readers ignore: padding bits, turns of plain blocks, unused fields of a head, and the lengths of records.
   Returns 0 if they are not as the format prescribes. */
static int lacedring_unused_clear_(const struct lacedring_packed* p, const struct lacedring_group_* g,
                                   const struct lacedring_block_* b) {
    uint32_t i, left = p->own - b->record.first, used = 4;
    const uint32_t k = b->record.first / LACEDRING_PACKED_BLOCK - g->first, plain = b->kind == LACEDRING_PLAIN_;
    const uint32_t own = k > 0 && lacedring_take_at_(p, g->own + k - 1, 1);
    const uint32_t step =
        k > 0 ? lacedring_take_at_(p, g->steps + (uint64_t)(k - 1) * g->entry_bits, g->entry_bits) : 0;
    const uint8_t* bytes = p->groups + b->begin;
    if (left > LACEDRING_PACKED_BLOCK) left = LACEDRING_PACKED_BLOCK;
    if ((own || plain) && step != 0) return 0;
    if (plain) {
        const uint32_t bits = 3 * left * p->vertex_bits;
        if (own || b->bytes != (bits + 7) / 8) return 0;
        if (k == 0 && (b->record.a | b->record.b | b->record.reversed)) return 0;
        for (i = 0; i < (left + 31) / 32; ++i) {
            if (b->record.turns[i] != 0) return 0;
        }
        return bits % 8 == 0 || bytes[bits / 8] >> bits % 8 == 0xff >> bits % 8;
    }
    if (b->kind == LACEDRING_RECORD_) return b->bytes <= LACEDRING_PACKED_MAX_RECORD_;
    if (b->kind != LACEDRING_PARTED_ || b->bytes < 4) return 0;
    for (i = 0; i < 4; ++i) {
        if (bytes[i] > LACEDRING_PACKED_MAX_PART_ || (i * LACEDRING_PACKED_PART_ >= left && bytes[i] != 0)) return 0;
        used += bytes[i];
    }
    return used == b->bytes;
}

/* The triangle after the last one of a run of doubles. */
static uint32_t lacedring_run_end_(const struct lacedring_packed* p, uint32_t run) {
    return run + 1 < p->runs ? p->doubles[(size_t)2 * run + 2] : p->triangles;
}

/* Checks that runs of doubles follow each other and repeat own triangles. */
static enum lacedring_status lacedring_check_doubles_(const struct lacedring_packed* p, uint64_t* where) {
    uint32_t i;
    for (i = 0; i < p->runs; ++i) {
        const uint32_t *run = p->doubles + (size_t)2 * i, from = run[1] & ~LACEDRING_DOUBLES_;
        const uint32_t run_end = lacedring_run_end_(p, i);
        if ((i == 0 && run[0] != p->own) || run[0] >= run_end || from >= p->own || run_end - run[0] > p->own - from)
            return lacedring_at_(where, i, LACEDRING_STATUS_DOUBLES);
    }
    return LACEDRING_STATUS_OK;
}

/* Do `count` triangles have three different vertices each, all below `vertices`? */
LACEDRING_SMALL_ int lacedring_have_vertices_(const uint32_t* t, uint32_t count, uint32_t vertices) {
#if defined(__wasm_simd128__) && defined(LACEDRING_VECTORS_)
    lacedring_four_ most = {0, 0, 0, 0}, equal = most;
    for (; count >= 4; count -= 4, t += 12) {
        /* a to c are indices 0 to 11. Each is compared to the next index of its triangle. */
        lacedring_four_ a, b, c;
        memcpy(&a, t, 16);
        memcpy(&b, t + 4, 16);
        memcpy(&c, t + 8, 16);
        most = __builtin_wasm_max_u_i32x4(__builtin_wasm_max_u_i32x4(most, a), __builtin_wasm_max_u_i32x4(b, c));
        equal |= (lacedring_four_)(a == __builtin_shufflevector(a, b, 1, 2, 0, 4));
        equal |=
            (lacedring_four_)(b == __builtin_shufflevector(__builtin_shufflevector(a, b, 5, 3, 7, 3), c, 0, 1, 2, 4));
        equal |= (lacedring_four_)(c == __builtin_shufflevector(b, c, 2, 6, 7, 5));
    }
    equal |= (lacedring_four_)(most >= vertices);
    if (equal[0] | equal[1] | equal[2] | equal[3]) return 0;
#endif
    for (; count > 0; --count, t += 3) {
        if (t[0] >= vertices || t[1] >= vertices || t[2] >= vertices || t[0] == t[1] || t[1] == t[2] || t[2] == t[0])
            return 0;
    }
    return 1;
}

/* Checks all blocks; writes the own triangles if `out` is not null. */
static enum lacedring_status lacedring_check_packed_(const struct lacedring_packed* p, uint32_t* out, uint64_t* where) {
    struct lacedring_group_ g;
    struct lacedring_block_ b;
    uint32_t room[3 * LACEDRING_PACKED_BLOCK], block, blocks = lacedring_blocks_of_(p->own), i, left, plain = 0;
    uint32_t* indices = out != NULL ? out : room;
    uint64_t end = 0;
    if (lacedring_check_doubles_(p, where) != LACEDRING_STATUS_OK) return LACEDRING_STATUS_DOUBLES;
    for (block = 0; block < blocks; ++block) {
        if (block % LACEDRING_PACKED_GROUP_ == 0) {
            const uint64_t begin = (uint64_t)4 * (block == 0 ? 0 : p->table[block / LACEDRING_PACKED_GROUP_ - 1]);
            if (begin != end || !lacedring_open_group_(p, block, &g) || g.end > p->group_bytes)
                return lacedring_at_(where, block, LACEDRING_STATUS_GROUP);
            i = (uint32_t)((g.steps + (uint64_t)(g.blocks - 1) * g.entry_bits) % 8);
            if (i != 0 && p->groups[g.records - 1] >> i != 0xff >> i)
                return lacedring_at_(where, block, LACEDRING_STATUS_GROUP);
            for (end = g.end; end % 4 != 0; ++end) {
                if (p->groups[end] != 0) return lacedring_at_(where, block, LACEDRING_STATUS_GROUP);
            }
            plain = 0;
        }
        left = p->own - block * LACEDRING_PACKED_BLOCK;
        if (left > LACEDRING_PACKED_BLOCK) left = LACEDRING_PACKED_BLOCK;
        lacedring_block_of_(p, &g, block, &b);
        if (block == g.first) plain = b.kind == LACEDRING_PLAIN_;
        if (block > g.first && lacedring_take_at_(p, g.own + block - g.first - 1, 1)) plain = 0;
        /* `plain`: the group's first block has no entry, so that no block may continue from it. */
        if (b.begin + b.bytes > p->group_bytes || !lacedring_unused_clear_(p, &g, &b) ||
            (plain && b.kind != LACEDRING_PLAIN_) || !lacedring_expand_block_(p, &g, &b, indices))
            return lacedring_at_(where, block, LACEDRING_STATUS_BLOCK);
        if (!lacedring_have_vertices_(indices, left, p->vertices))
            return lacedring_at_(where, block, LACEDRING_STATUS_BLOCK);
        if (out != NULL) indices += (size_t)3 * LACEDRING_PACKED_BLOCK;
    }
    if (p->own % 32 != 0 && p->turns[p->own / 32] >> (p->own % 32) != 0)
        return lacedring_at_(where, p->own, LACEDRING_STATUS_TURNS);
    if (end != p->group_bytes) return lacedring_at_(where, end, LACEDRING_STATUS_SIZE);
    return LACEDRING_STATUS_OK;
}

enum lacedring_status lacedring_packed_check(const struct lacedring_packed* p, uint64_t* where) {
    return lacedring_check_packed_(p, NULL, where);
}

/* Writes triangle `of`, with the opposite orientation if `turned` is nonzero. */
static void lacedring_double_(const uint32_t* of, uint32_t turned, uint32_t* out) {
    const uint32_t b = of[1], c = of[2];
    out[0] = of[0];
    out[1] = turned ? c : b;
    out[2] = turned ? b : c;
}

/* Writes the doubles, which follow the stream's own triangles. */
static void lacedring_write_doubles_(const struct lacedring_packed* p, uint32_t* triangles) {
    uint32_t run, i;
    for (run = 0; run < p->runs; ++run) {
        const uint32_t* r = p->doubles + (size_t)2 * run;
        const uint32_t end = lacedring_run_end_(p, run), from = r[1] & ~LACEDRING_DOUBLES_;
        for (i = r[0]; i < end; ++i)
            lacedring_double_(triangles + (size_t)3 * (from + (i - r[0])), r[1] & LACEDRING_DOUBLES_,
                              triangles + (size_t)3 * i);
    }
}

enum lacedring_status lacedring_packed_decode_checked(const struct lacedring_packed* p, uint32_t* indices,
                                                      uint64_t* where) {
    const enum lacedring_status status = lacedring_check_packed_(p, indices, where);
    if (status == LACEDRING_STATUS_OK) lacedring_write_doubles_(p, indices);
    return status;
}

enum lacedring_status lacedring_packed_validate(const uint32_t* words, size_t count, struct lacedring_packed* p,
                                                uint64_t* where) {
    const enum lacedring_status status = lacedring_packed_open(words, count, p, where);
    uint32_t crc;
    if (status != LACEDRING_STATUS_OK) return status;
    crc = lacedring_crc_(0xffffffffu, words, LACEDRING_PACKED_HEADER_WORDS - 1);
    crc = ~lacedring_crc_(crc, words + LACEDRING_PACKED_HEADER_WORDS, count - LACEDRING_PACKED_HEADER_WORDS);
    if (crc != words[LACEDRING_PACKED_HEADER_WORDS - 1]) return lacedring_at_(where, 0, LACEDRING_STATUS_CHECKSUM);
    return lacedring_packed_check(p, where);
}

/* Decodes the own triangles of blocks [block, end). */
LACEDRING_SMALL_ void lacedring_own_blocks_(const struct lacedring_packed* p, uint32_t block, uint32_t end,
                                            uint32_t* indices) {
    struct lacedring_group_ g;
    struct lacedring_block_ b;
    if (block >= end) return;
    lacedring_open_group_(p, block, &g);
    for (; block < end; ++block, indices += (size_t)3 * LACEDRING_PACKED_BLOCK) {
        if (block % LACEDRING_PACKED_GROUP_ == 0) lacedring_open_group_(p, block, &g);
        lacedring_block_of_(p, &g, block, &b);
        lacedring_expand_block_(p, &g, &b, indices);
    }
}

/* Number of the run that holds a double. Binary search. */
static uint32_t lacedring_run_of_(const struct lacedring_packed* p, uint32_t triangle) {
    uint32_t low = 0, high = p->runs;
    while (high - low > 1) {
        const uint32_t middle = low + (high - low) / 2;
        if (p->doubles[(size_t)2 * middle] <= triangle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

/* Decodes triangles [t, end), all of them doubles. */
LACEDRING_SMALL_ void lacedring_double_triangles_(const struct lacedring_packed* p, uint32_t t, uint32_t end,
                                                  uint32_t* out) {
    /* Fewer triangles of a block than this are read one by one, without decoding the block. */
    enum { kFew = 8 };
    uint32_t block[3 * LACEDRING_PACKED_BLOCK], held = UINT32_MAX, run = lacedring_run_of_(p, t);
    for (; t < end; ++run) {
        const uint32_t* r = p->doubles + (size_t)2 * run;
        const uint32_t run_end = lacedring_run_end_(p, run), stop = run_end < end ? run_end : end;
        for (; t < stop; ++t, out += 3) {
            const uint32_t of = (r[1] & ~LACEDRING_DOUBLES_) + (t - r[0]), i = of % LACEDRING_PACKED_BLOCK;
            if (of / LACEDRING_PACKED_BLOCK != held && stop - t >= kFew && LACEDRING_PACKED_BLOCK - i >= kFew) {
                held = of / LACEDRING_PACKED_BLOCK;
                lacedring_own_blocks_(p, held, held + 1, block);
            }
            if (of / LACEDRING_PACKED_BLOCK == held) {
                lacedring_double_(block + (size_t)3 * i, r[1] & LACEDRING_DOUBLES_, out);
            } else {
                lacedring_packed_triangle(p, t, out);
            }
        }
    }
}

void lacedring_packed_blocks_u32(const struct lacedring_packed* p, uint32_t block, uint32_t end, uint32_t* indices) {
    const uint32_t own = lacedring_blocks_of_(p->own);
    lacedring_own_blocks_(p, block, end < own ? end : own, indices);
    if (p->own < p->triangles && block < end) {
        const uint64_t first = (uint64_t)block * LACEDRING_PACKED_BLOCK, last = (uint64_t)end * LACEDRING_PACKED_BLOCK;
        const uint32_t begin = p->own < first ? (uint32_t)first : p->own;
        const uint32_t stop = last < p->triangles ? (uint32_t)last : p->triangles;
        if (begin < stop) lacedring_double_triangles_(p, begin, stop, indices + (size_t)3 * (begin - (size_t)first));
    }
}

void lacedring_packed_triangles_u32(const struct lacedring_packed* p, uint32_t* indices) {
    lacedring_packed_blocks_u32(p, 0, lacedring_blocks_of_(p->triangles), indices);
}

void lacedring_packed_triangles_u16(const struct lacedring_packed* p, uint16_t* indices) {
    uint32_t block[3 * LACEDRING_PACKED_BLOCK], b, i, count;
    for (b = 0; b < lacedring_blocks_of_(p->triangles); ++b) {
        lacedring_packed_blocks_u32(p, b, b + 1, block);
        count = p->triangles - b * LACEDRING_PACKED_BLOCK;
        if (count > LACEDRING_PACKED_BLOCK) count = LACEDRING_PACKED_BLOCK;
        for (i = 0; i < 3 * count; ++i) *indices++ = (uint16_t)block[i];
    }
}

/* Advances the state from triangle *at to triangle `to` by turns alone. */
static void lacedring_skip_(struct lacedring_state_* s, const uint32_t* turns, uint32_t* at, uint32_t to, int inside) {
    uint32_t left = s->finished ? 0 : lacedring_left_(s->a, s->b), ups;
    if (to - *at > left) { /* skips whole polygons */
        const uint32_t size = s->begun_b - s->begun_a, each = lacedring_left_(s->begun_a, s->begun_b);
        const uint32_t behind = to - *at - left, whole = (behind - 1) / each;
        s->begun_a += whole * (size + 1);
        s->begun_b += whole * (size + 1);
        lacedring_repeat_(s, inside);
        *at = to - (behind - whole * each);
        left = each;
    }
    ups = lacedring_ups_(turns, *at, to);
    s->a += ups;
    s->b -= to - *at - ups;
    if (to > *at) s->finished = to - *at == left;
    *at = to;
}

/* Decodes triangle i of a record by itself, in a few popcounts. */
static void lacedring_seek_(const struct lacedring_packed* p, const struct lacedring_group_* g,
                            struct lacedring_record_* r, uint32_t i, uint32_t t[3]) {
    struct lacedring_state_ s;
    struct lacedring_event_ e = {0, 0, 0, 0, 0, 0, 0};
    uint32_t at = 0, skip = 0, k, events = 0, flip = 0, turn = r->turns[i / 32] >> (i % 32) & 1, x, rest[2], count;
    int inside = 0;
    s.a = s.begun_a = r->a;
    s.b = s.begun_b = r->b;
    s.reversed = s.begun_reversed = r->reversed;
    s.finished = 0;
    if (r->bits.at < r->bits.end) events = lacedring_golomb_(&r->bits, g->count_order);
    for (k = 0; k < events; ++k) {
        uint32_t here;
        lacedring_read_event_(p, g, r, &e);
        here = e.triangle;
        if (e.code == LACEDRING_SPLIT_ || e.code == LACEDRING_FAR_ || e.code == LACEDRING_JUMP_) ++e.triangle;
        if (here > i || here < skip) continue;
        lacedring_skip_(&s, r->turns, &at, here, inside);
        if (e.code == LACEDRING_TURN_) {
            s.reversed ^= 1;
        } else if (e.code == LACEDRING_FLIPS_) {
            struct lacedring_bits_ bits = r->bits;
            bits.at = e.flips + i;
            flip = lacedring_take_(&bits, 1);
        } else if (e.code == LACEDRING_START_ || e.code == LACEDRING_BESIDE_) {
            lacedring_begin_(&s, &e, inside);
        } else {
            uint32_t a, b;
            if (s.finished) lacedring_repeat_(&s, inside);
            a = s.a;
            b = s.b;
            x = lacedring_third_(&s, &e, r->turns[here / 32] >> (here % 32) & 1, rest, &count);
            if (here == i) {
                lacedring_put_(t, a, x, b, s.reversed ^ flip);
                return;
            }
            at = here + 1;
            if (count == 0 || count >= r->triangles - at) continue; /* opens no scope */
            if (i - at >= count) {                                  /* i is after the scope */
                at += count;
                skip = at;
                s.a = rest[0];
                s.b = rest[1];
                s.finished = 0;
            } else {
                inside = 1;
            }
        }
    }
    lacedring_skip_(&s, r->turns, &at, i, inside);
    if (s.finished) lacedring_repeat_(&s, inside);
    x = turn ? s.a + 1 : s.b - 1;
    {
        /* Is i the T0 of a wart, or the T2 of one at i - 1? Warts are stored as ranks among the candidates. */
        uint32_t rank = 0, seen = 0, gap, word;
        const uint32_t before = i > 0 && (r->turns[(i - 1) / 32] >> ((i - 1) % 32) & 1) == turn;
        const uint32_t here = i + 1 == r->triangles || (r->turns[(i + 1) / 32] >> ((i + 1) % 32) & 1) == turn;
        if ((before || here) && r->bits.at < r->bits.end) {
            for (word = 0; 32 * word < i; ++word) {
                const uint32_t next = 32 * (word + 1) < r->triangles ? r->turns[word + 1] << 31 : 0;
                uint32_t candidates = ~(r->turns[word] ^ (r->turns[word] >> 1 | next));
                if (i - 32 * word < 32) candidates &= (UINT32_C(1) << (i - 32 * word)) - 1;
                rank += lacedring_popcount_(candidates);
            }
            while ((gap = lacedring_rice_(&r->bits, g->wart_bits)) != UINT32_MAX && r->bits.at <= r->bits.end) {
                seen += gap + 1; /* the wart's rank + 1 */
                if (seen > rank) {
                    if (here && seen == rank + 1) x = turn ? s.a + 2 : s.b - 2;
                    break;
                }
                if (before && seen == rank) {
                    const uint32_t inner = turn ? s.a : s.b;
                    s.a = inner - 1;
                    x = inner;
                    s.b = inner + 1;
                    break;
                }
            }
        }
    }
    lacedring_put_(t, s.a, x, s.b, s.reversed ^ flip);
}

void lacedring_packed_triangle(const struct lacedring_packed* p, uint32_t triangle, uint32_t out[3]) {
    struct lacedring_group_ g;
    struct lacedring_block_ b;
    uint32_t i, turned = 0;
    if (triangle >= p->own) {
        const uint32_t* run = p->doubles + (size_t)2 * lacedring_run_of_(p, triangle);
        triangle = (run[1] & ~LACEDRING_DOUBLES_) + (triangle - run[0]);
        turned = run[1] & LACEDRING_DOUBLES_;
    }
    i = triangle % LACEDRING_PACKED_BLOCK;
    lacedring_open_group_(p, triangle / LACEDRING_PACKED_BLOCK, &g);
    lacedring_block_of_(p, &g, triangle / LACEDRING_PACKED_BLOCK, &b);
    if (b.kind == LACEDRING_PLAIN_) {
        lacedring_plain_(p, &b, i, out);
    } else if (b.kind == LACEDRING_RECORD_) {
        lacedring_seek_(p, &g, &b.record, i, out);
    } else {
        struct lacedring_record_ r;
        lacedring_part_(p, &b, i / LACEDRING_PACKED_PART_, &r);
        lacedring_seek_(p, &g, &r, i % LACEDRING_PACKED_PART_, out);
    }
    lacedring_double_(out, turned, out);
}

#undef LACEDRING_TIP_
#undef LACEDRING_WART_
#undef LACEDRING_CLOSE_
#undef LACEDRING_FLIP_
#undef LACEDRING_DOUBLES_
#undef LACEDRING_PACKED_GROUP_
#undef LACEDRING_PACKED_MAX_RECORD_
#undef LACEDRING_PACKED_PART_
#undef LACEDRING_PACKED_MAX_PART_
#undef LACEDRING_VECTORS_
#undef LACEDRING_WORDS_
#undef LACEDRING_PIECES_
#undef LACEDRING_AHEAD_
#undef LACEDRING_BIT_
#undef LACEDRING_UP_
#undef LACEDRING_B_
#undef LACEDRING_X_
#undef LACEDRING_XM_
#undef LACEDRING_ABX_
#undef LACEDRING_AXB_
#undef LACEDRING_ABXM_
#undef LACEDRING_AXBM_
#undef LACEDRING_FOUR_
#undef LACEDRING_UPS_
#undef LACEDRING_NIBBLE_
#undef LACEDRING_NIBBLES_
#undef LACEDRING_OCTET_
#undef LACEDRING_SIGN_
#undef LACEDRING_OCTETS_7_
#undef LACEDRING_OCTETS_6_
#undef LACEDRING_OCTETS_5_
#undef LACEDRING_OCTETS_4_
#undef LACEDRING_OCTETS_3_
#undef LACEDRING_OCTETS_2_
#undef LACEDRING_OCTETS_1_
#undef LACEDRING_COUNTS_4_
#undef LACEDRING_COUNTS_16_
#undef LACEDRING_COUNTS_64_
#undef LACEDRING_PERMUTE_
#undef LACEDRING_BLEND_
#undef LACEDRING_OF_ABX_
#undef LACEDRING_OF_AXB_
#undef LACEDRING_RUN_
#undef LACEDRING_RUN_ABX_
#undef LACEDRING_RUN_AXB_
#ifdef __cplusplus
}
#endif
#endif /* LACEDRING_DECODE_IMPLEMENTATION */
