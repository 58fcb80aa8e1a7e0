/* Decodes LacedRing's seam sections: which copy of its vertex each corner of a triangle has. C99 or C++; one file
   beside lacedring_decode.h, no allocation. lrcore decodes with the same code. Format: docs/seams-format.md.

   Define LACEDRING_DECODE_IMPLEMENTATION in one .c or .cpp file before including this header, which then adds the
   functions. A program that links lacedring::core has them already.

   A section belongs to a mesh. `triangles` are the slots of the mesh's connectivity stream, three vertices each, in the
   order and with the vertex numbers of that stream. An empty slot is UINT32_MAX three times. Packed streams have no
   empty slots. In lean streams and LR tables, degenerate slots and the second number of a triangle are empty.

       struct lacedring_seams seams;
       if (lacedring_seams_open(words, count, vertex_count, triangle_count, &seams, NULL) != LACEDRING_STATUS_OK) ...
       uint32_t *scratch = malloc(4 * lacedring_seams_scratch(&seams));
       if (lacedring_seams_check(&seams, triangles, scratch, NULL) != LACEDRING_STATUS_OK) ...
       uint32_t *copies = malloc(12 * (size_t)triangle_count);
       lacedring_seams_decode(&seams, triangles, scratch, copies);

   Sections are little-endian 32-bit words, and this file is for little-endian machines. */
#ifndef LACEDRING_SEAMS_H
#define LACEDRING_SEAMS_H

#include "lacedring_decode.h"

#ifdef __cplusplus
extern "C" {
#endif

#define LACEDRING_SEAMS_HEADER_WORDS 8
#define LACEDRING_SEAMS_BLOCK 512u /* triangles per block; vertices per vertex block */
#define LACEDRING_SEAMS_GROUP 32u  /* blocks per group of a directory */
#define LACEDRING_SEAMS_BACK 64u   /* how far before a triangle its parent may be */
/* A "position" of a vertex is not a point: it numbers the home copies of the vertex along its fan, 0 to its number of
   steps. The last position of a vertex that wraps is home copy 0 again. */
#define LACEDRING_SEAMS_MAX_STEPS 255u
#define LACEDRING_SEAMS_MAX_COPIES 0x3fffffffu
/* Flag of a state: the other bits are the number of a private copy. */
#define LACEDRING_SEAMS_PRIVATE 0x80000000u

/* Contexts of flags. The section's table has a likely value and a run class for each. A comment is the question that
   its context and the uncommented ones below ask. */
enum lacedring_seam_context {
    /* Vertex blocks: does the vertex have steps? One context each for 0, 1 and more steps of the vertex before. */
    LACEDRING_SEAM_V0,
    LACEDRING_SEAM_V1,
    LACEDRING_SEAM_V2,
    LACEDRING_SEAM_MORE, /* more than one step? */
    LACEDRING_SEAM_MANY, /* one more step? */
    LACEDRING_SEAM_WRAP,
    LACEDRING_SEAM_LONE, /* triangle blocks: is the edge to the parent a seam? */
    LACEDRING_SEAM_LEFT0,
    LACEDRING_SEAM_LEFT1,
    LACEDRING_SEAM_LEFT2,
    LACEDRING_SEAM_RIGHT0,
    LACEDRING_SEAM_RIGHT1,
    LACEDRING_SEAM_RIGHT2,
    LACEDRING_SEAM_RIGHT3,
    LACEDRING_SEAM_RIGHT4,
    LACEDRING_SEAM_HALF, /* do the usual ends change? */
    LACEDRING_SEAM_BOTH,
    LACEDRING_SEAM_STEP_L, /* does the corner have this position? */
    LACEDRING_SEAM_LEAVE,
    LACEDRING_SEAM_LAST_R,
    LACEDRING_SEAM_NEXT_R,
    LACEDRING_SEAM_START_L,
    LACEDRING_SEAM_MID_L,
    LACEDRING_SEAM_PLAIN,
    LACEDRING_SEAM_SEAMED,
    LACEDRING_SEAM_SEAMED2,
    LACEDRING_SEAM_MID_R,
    LACEDRING_SEAM_MID_R2,
    LACEDRING_SEAM_NEW_R, /* does it have a new private copy? */
    LACEDRING_SEAM_NEW_L,
    LACEDRING_SEAM_NEW_M,
    LACEDRING_SEAM_HOME, /* does it have any other home copy? */
    LACEDRING_SEAM_CONTEXTS,
    LACEDRING_SEAM_NONE = LACEDRING_SEAM_CONTEXTS
};

/* A section whose header was read. Refers to the caller's words. */
struct lacedring_seams {
    const uint32_t* words;
    size_t count;
    uint32_t vertices, triangles; /* of the mesh */
    uint32_t homes;               /* home copies: numbered first, vertex by vertex */
    uint32_t copies;              /* all copies */
    /* [0]: vertex blocks; [1]: triangle blocks. Widths of the two fields of a directory, in bits; where the directory
       and the blocks begin, in bits from the first word. */
    uint32_t length_bits[2], count_bits[2];
    uint64_t directory[2], blocks[2];
};

/* Reads the header and checks sizes only. Safe with any words. Constant time. */
enum lacedring_status lacedring_seams_open(const uint32_t* words, size_t count, uint32_t vertices, uint32_t triangles,
                                           struct lacedring_seams* seams, uint64_t* where);

/* Number of 32-bit words of scratch memory for lacedring_seams_check: vertices + private copies + 1. */
size_t lacedring_seams_scratch(const struct lacedring_seams* seams);

/* Checks the triangles and everything that decoders rely on except the checksum: blocks lie where the directories say,
   and every corner has a copy of its vertex. `seams` comes from lacedring_seams_open. Safe with any words and
   triangles. Linear time, 26 KB of stack. */
enum lacedring_status lacedring_seams_check(const struct lacedring_seams* seams, const uint32_t* triangles,
                                            uint32_t* scratch, uint64_t* where);

/* Checks the checksum. `seams` comes from lacedring_seams_open. Linear time. */
enum lacedring_status lacedring_seams_checksum(const struct lacedring_seams* seams);

/* Writes seams->vertices + 1 entries. home[v] >> 1 is the first home copy of vertex v; its home copies end before
   home[v + 1] >> 1. home[v] & 1: v wraps, which means that the fan on its left ends in the copy in which it begins.
   Linear time. */
void lacedring_seams_homes(const struct lacedring_seams* seams, uint32_t* home);

/* Writes the copy of each corner, three per slot; UINT32_MAX in empty slots. Fills `home` like lacedring_seams_homes.
   The section must be valid. Linear time, 20 KB of stack. */
void lacedring_seams_decode(const struct lacedring_seams* seams, const uint32_t* triangles, uint32_t* home,
                            uint32_t* copies);

/* Writes the copy of each corner of one block: triangles [512 * block, 512 * block + 512), fewer if the last block is
   not full. `triangles` are those of the block alone. Reads the blocks of their vertices, too. 24 KB of stack. */
void lacedring_seams_block(const struct lacedring_seams* seams, uint32_t block, const uint32_t* triangles,
                           uint32_t* copies);

/* Writes the vertex of each copy: seams->copies entries. Fills `home` like lacedring_seams_homes. Linear time, 26 KB of
   stack. */
void lacedring_seams_copy_vertices(const struct lacedring_seams* seams, const uint32_t* triangles, uint32_t* home,
                                   uint32_t* vertices);

/* lacedring_seams_check (with its `scratch`), lacedring_seams_decode and lacedring_seams_copy_vertices in one pass. On
   an error the contents of `copies` and `vertices` are undefined. */
enum lacedring_status lacedring_seams_decode_checked(const struct lacedring_seams* seams, const uint32_t* triangles,
                                                     uint32_t* scratch, uint32_t* copies, uint32_t* vertices,
                                                     uint64_t* where);

/* Parts of the format that the encoder uses, too. */

/* The corner of `triangle` at `vertex`, or 3 if there is none. */
static inline uint32_t lacedring_seam_corner(const uint32_t triangle[3], uint32_t vertex) {
    return triangle[0] == vertex ? 0u : triangle[1] == vertex ? 1u : triangle[2] == vertex ? 2u : 3u;
}

/* Is the slot empty? */
static inline int lacedring_seam_is_empty(const uint32_t triangle[3]) {
    return triangle[0] == UINT32_MAX;
}

/* Does `other` have two vertices of `triangle`? Sets `pair` to the corners of `triangle` at the first two of them. */
static inline int lacedring_seam_pair(const uint32_t triangle[3], const uint32_t other[3], uint32_t pair[2]) {
    const uint32_t a = lacedring_seam_corner(other, triangle[0]) < 3, b = lacedring_seam_corner(other, triangle[1]) < 3;
    const uint32_t c = lacedring_seam_corner(other, triangle[2]) < 3;
    if (a + b + c < 2) return 0;
    pair[0] = a ? 0 : 1;
    pair[1] = a && b ? 1 : 2;
    return 1;
}

/* Finds the parent of triangle i of a block: the last triangle before it that has two of its vertices, at most
   LACEDRING_SEAMS_BACK before it. Returns how far before it, or 0 if there is none, and sets `pair` to the corners of
   triangle i at these vertices. Triangle i must not be empty. */
static inline uint32_t lacedring_seam_parent(const uint32_t* triangles, uint32_t i, uint32_t pair[2]) {
    const uint32_t* t = triangles + (size_t)3 * i;
    uint32_t back;
    for (back = 1; back <= LACEDRING_SEAMS_BACK && back <= i; ++back) {
        if (lacedring_seam_pair(t, t - (size_t)3 * back, pair)) return back;
    }
    return 0;
}

/* The side of the ring on which a triangle lies: 0 left, 1 right, 2 if it has no ring edge. */
static inline uint32_t lacedring_seam_side(const uint32_t triangle[3]) {
    uint32_t j;
    for (j = 0; j < 3; ++j) {
        const uint32_t a = triangle[j], b = triangle[j < 2 ? j + 1 : 0];
        if (b == a + 1) return 0;
        if (a == b + 1) return 1;
    }
    return 2;
}

#ifdef __cplusplus
}
#endif
#endif /* LACEDRING_SEAMS_H */

#if defined(LACEDRING_DECODE_IMPLEMENTATION) && !defined(LACEDRING_SEAMS_IMPLEMENTED)
#define LACEDRING_SEAMS_IMPLEMENTED

#ifdef __cplusplus
extern "C" {
#endif

#define LACEDRING_SEAM_MOST_ (1u << 24) /* runs and unary numbers are below it */
#define LACEDRING_SEAM_CORNERS_ (3 * LACEDRING_SEAMS_BLOCK)

/* Returns 32 bits of the section from bit `at` on, with zeros after its end. */
LACEDRING_SMALL_ uint32_t lacedring_seam_window_(const struct lacedring_seams* s, uint64_t at) {
    const uint64_t word = at / 32;
    uint64_t bits = word < s->count ? s->words[(size_t)word] : 0;
    if (word + 1 < s->count) bits |= (uint64_t)s->words[(size_t)word + 1] << 32;
    return (uint32_t)(bits >> at % 32);
}

LACEDRING_SMALL_ uint32_t lacedring_seam_field_(const struct lacedring_seams* s, uint64_t at, uint32_t bits) {
    return (uint32_t)(lacedring_seam_window_(s, at) & ((UINT64_C(1) << bits) - 1));
}

/* Reads a block's bits. */
struct lacedring_seam_reader_ {
    const struct lacedring_seams* seams;
    uint64_t at, end;
    uint32_t copies; /* copies made by the block, from the directory */
    uint32_t bad;    /* nonzero: a code is invalid, or reaches beyond the block */
    int32_t run[8];  /* per run class: likely values left in the run; -1: not read yet */
};

/* Opens a vertex block (kind 0) or a triangle block (kind 1). Returns the number of copies that the blocks before it
   make. */
static uint32_t lacedring_seam_open_(const struct lacedring_seams* s, uint32_t kind, uint32_t block,
                                     struct lacedring_seam_reader_* r) {
    const uint32_t length = s->length_bits[kind], count = s->count_bits[kind], group = block / LACEDRING_SEAMS_GROUP;
    const uint32_t size = length + count, first = group * LACEDRING_SEAMS_GROUP;
    uint64_t at = s->directory[kind] + (uint64_t)first * size + (uint64_t)64 * group;
    uint64_t begin = group > 0 ? lacedring_seam_window_(s, at - 64) : 0;
    uint32_t i, before = group > 0 ? lacedring_seam_window_(s, at - 32) : 0;
    for (i = first; i < block; ++i, at += size) {
        begin += lacedring_seam_field_(s, at, length);
        before += lacedring_seam_field_(s, at + length, count);
    }
    r->seams = s;
    r->at = s->blocks[kind] + begin;
    r->end = r->at + lacedring_seam_field_(s, at, length);
    r->copies = lacedring_seam_field_(s, at + length, count);
    r->bad = 0;
    for (i = 0; i < 8; ++i) r->run[i] = -1;
    return before;
}

LACEDRING_SMALL_ uint32_t lacedring_seam_take_(struct lacedring_seam_reader_* r, uint32_t bits) {
    const uint32_t value = lacedring_seam_field_(r->seams, r->at, bits);
    if (r->end - r->at < bits) {
        r->bad = 1;
        r->at = r->end;
        return 0;
    }
    r->at += bits;
    return value;
}

static uint32_t lacedring_seam_unary_(struct lacedring_seam_reader_* r) {
    uint32_t ones = 0, some;
    do {
        some = lacedring_ones_(lacedring_seam_window_(r->seams, r->at));
        if (r->end - r->at < (uint64_t)some + (some < 32) || ones >= LACEDRING_SEAM_MOST_) {
            r->bad = 1;
            r->at = r->end;
            return 0;
        }
        ones += some;
        r->at += some;
    } while (some == 32);
    ++r->at;
    return ones;
}

/* Reads an exponential Golomb code. */
static uint32_t lacedring_seam_golomb_(struct lacedring_seam_reader_* r, uint32_t order) {
    const uint32_t width = lacedring_seam_unary_(r) + order;
    if (width > 31) {
        r->bad = 1;
        return 0;
    }
    return (1u << width | lacedring_seam_take_(r, width)) - (1u << order);
}

/* Reads a run of class k. Returns INT32_MAX for an endless run, and on an error. */
static int32_t lacedring_seam_run_(struct lacedring_seam_reader_* r, uint32_t k) {
    uint32_t run;
    if (r->at == r->end) return INT32_MAX;
    if (k < 7) {
        run = lacedring_seam_unary_(r);
        if (run < LACEDRING_SEAM_MOST_) run = run << (k - 1) | lacedring_seam_take_(r, k - 1);
    } else {
        if (lacedring_seam_take_(r, 1) == 0) return INT32_MAX;
        run = lacedring_seam_golomb_(r, 5);
    }
    if (run >= LACEDRING_SEAM_MOST_) r->bad = 1;
    return r->bad ? INT32_MAX : (int32_t)run;
}

/* Reads the flag of a context. */
LACEDRING_SMALL_ uint32_t lacedring_seam_flag_(struct lacedring_seam_reader_* r, uint32_t context) {
    const uint32_t entry = r->seams->words[4 + context / 8] >> 4 * (context % 8), likely = entry & 1,
                   k = entry >> 1 & 7;
    if (k == 0) return r->at == r->end ? likely : lacedring_seam_take_(r, 1);
    if (r->run[k] < 0) r->run[k] = lacedring_seam_run_(r, k);
    return likely ^ (uint32_t)(--r->run[k] < 0);
}

LACEDRING_SMALL_ uint32_t lacedring_seam_block_count_(uint32_t elements) {
    return elements / LACEDRING_SEAMS_BLOCK + (elements % LACEDRING_SEAMS_BLOCK != 0);
}

/* Number of elements (vertices or triangles) of a block. */
LACEDRING_SMALL_ uint32_t lacedring_seam_block_size_(uint32_t elements, uint32_t block) {
    const uint32_t left = elements - block * LACEDRING_SEAMS_BLOCK;
    return left < LACEDRING_SEAMS_BLOCK ? left : LACEDRING_SEAMS_BLOCK;
}

enum lacedring_status lacedring_seams_open(const uint32_t* words, size_t count, uint32_t vertices, uint32_t triangles,
                                           struct lacedring_seams* s, uint64_t* where) {
    static const uint32_t most[2] = {17, 11}; /* most bits of a block's count of copies */
    uint64_t at = 32 * LACEDRING_SEAMS_HEADER_WORDS, copies;
    uint32_t kind;
    struct lacedring_seam_reader_ r;
    if (count < LACEDRING_SEAMS_HEADER_WORDS) return lacedring_at_(where, 0, LACEDRING_STATUS_SHORT);
    if (words[0] != 0x3153524cu) return lacedring_at_(where, 0, LACEDRING_STATUS_MAGIC);
    s->words = words;
    s->count = count;
    s->vertices = vertices;
    s->triangles = triangles;
    s->homes = words[2];
    if (s->homes < vertices || s->homes - vertices > (uint64_t)3 * triangles || s->homes > LACEDRING_SEAMS_MAX_COPIES)
        return lacedring_at_(where, 2, LACEDRING_STATUS_HEADER);
    for (kind = 0; kind < 2; ++kind) {
        const uint32_t blocks = lacedring_seam_block_count_(kind ? triangles : vertices);
        s->length_bits[kind] = words[3] >> 16 * kind & 255;
        s->count_bits[kind] = words[3] >> (16 * kind + 8) & 255;
        if (s->length_bits[kind] > 20 || s->count_bits[kind] > most[kind])
            return lacedring_at_(where, 3, LACEDRING_STATUS_HEADER);
        s->directory[kind] = at;
        at += (uint64_t)blocks * (s->length_bits[kind] + s->count_bits[kind]);
        if (blocks > 0) at += (uint64_t)64 * ((blocks - 1) / LACEDRING_SEAMS_GROUP);
    }
    copies = s->homes;
    if (at > (uint64_t)32 * count) return lacedring_at_(where, 0, LACEDRING_STATUS_SIZE);
    for (kind = 0; kind < 2; ++kind) {
        const uint32_t blocks = lacedring_seam_block_count_(kind ? triangles : vertices);
        s->blocks[kind] = at;
        if (blocks == 0) continue;
        copies = (kind ? s->homes : vertices) + (uint64_t)lacedring_seam_open_(s, kind, blocks - 1, &r) + r.copies;
        if (kind == 0 && copies != s->homes) return lacedring_at_(where, 2, LACEDRING_STATUS_HEADER);
        if (copies > LACEDRING_SEAMS_MAX_COPIES || copies - s->homes > (uint64_t)3 * triangles)
            return lacedring_at_(where, 0, LACEDRING_STATUS_SIZE);
        at = r.end;
    }
    s->copies = (uint32_t)copies;
    if ((at + 31) / 32 != count) return lacedring_at_(where, 0, LACEDRING_STATUS_SIZE);
    if (at % 32 != 0 && words[count - 1] >> at % 32 != 0) return lacedring_at_(where, 0, LACEDRING_STATUS_SIZE);
    return LACEDRING_STATUS_OK;
}

size_t lacedring_seams_scratch(const struct lacedring_seams* s) {
    return (size_t)s->vertices + 1 + (s->copies - s->homes);
}

/* Decodes the homes of a block's `count` vertices to home[0 .. count], as lacedring_seams_homes. `first`: home copies
   before them. */
static void lacedring_seam_vertices_(struct lacedring_seam_reader_* r, uint32_t first, uint32_t count, uint32_t* home) {
    uint32_t i, before = 0;
    for (i = 0; i < count; ++i) {
        uint32_t steps = 0, wrap = 0;
        if (lacedring_seam_flag_(r, LACEDRING_SEAM_V0 + before)) {
            steps = 1 + lacedring_seam_flag_(r, LACEDRING_SEAM_MORE);
            if (steps > 1) {
                while (steps < LACEDRING_SEAMS_MAX_STEPS && lacedring_seam_flag_(r, LACEDRING_SEAM_MANY)) ++steps;
                wrap = lacedring_seam_flag_(r, LACEDRING_SEAM_WRAP);
            }
        }
        home[i] = 2 * first + wrap;
        first += steps + 1 - wrap;
        before = steps < 2 ? steps : 2;
    }
    home[count] = 2 * first;
}

static void lacedring_seam_vertex_block_(const struct lacedring_seams* s, uint32_t block, uint32_t* home) {
    struct lacedring_seam_reader_ r;
    const uint32_t before = lacedring_seam_open_(s, 0, block, &r);
    lacedring_seam_vertices_(&r, block * LACEDRING_SEAMS_BLOCK + before, lacedring_seam_block_size_(s->vertices, block),
                             home);
}

void lacedring_seams_homes(const struct lacedring_seams* s, uint32_t* home) {
    const uint32_t blocks = lacedring_seam_block_count_(s->vertices);
    uint32_t block;
    home[0] = 0;
    for (block = 0; block < blocks; ++block)
        lacedring_seam_vertex_block_(s, block, home + (size_t)block * LACEDRING_SEAMS_BLOCK);
}

/* State of decoding a block of triangles. For each corner: home[v] of its vertex v (lacedring_seams_homes); the number
   of v's steps; and the corner's state, a position of v, or LACEDRING_SEAMS_PRIVATE with the number of a private copy.
   For each triangle: its side, 0 left or 1 right. */
struct lacedring_seam_walk_ {
    struct lacedring_seam_reader_ r;
    const uint32_t* triangles;
    uint32_t count;
    uint32_t made; /* private copies made by all blocks so far */
    uint32_t home[LACEDRING_SEAM_CORNERS_], steps[LACEDRING_SEAM_CORNERS_], state[LACEDRING_SEAM_CORNERS_];
    uint8_t side[LACEDRING_SEAMS_BLOCK];
};

LACEDRING_SMALL_ void lacedring_seam_set_home_(struct lacedring_seam_walk_* w, uint32_t k, const uint32_t home[2]) {
    w->home[k] = home[0];
    w->steps[k] = (home[1] >> 1) - (home[0] >> 1) - 1 + (home[0] & 1);
}

/* The home copy at position `state` of corner k's vertex, counted from the vertex's first. Returns a private state
   unchanged. */
LACEDRING_SMALL_ uint32_t lacedring_seam_copy_(const struct lacedring_seam_walk_* w, uint32_t k, uint32_t state) {
    return (w->home[k] & 1) != 0 && state == w->steps[k] ? 0 : state;
}

/* A question about a corner (docs/seams-format.md): is its state position `at`, or a new private copy? */
struct lacedring_seam_question_ {
    uint32_t at, at_context; /* at_context LACEDRING_SEAM_NONE: position not asked */
    uint32_t new_context;
    uint32_t new_first; /* nonzero: the new copy is asked before the position */
};

/* Reads the answer to question q: the state of corner k. `current` is a state whose copy the corner does not have, or
   UINT32_MAX. */
static uint32_t lacedring_seam_choose_(struct lacedring_seam_walk_* w, uint32_t k, uint32_t current,
                                       struct lacedring_seam_question_ q) {
    const uint32_t homes = w->steps[k] + 1 - (w->home[k] & 1);
    uint32_t out[2] = {UINT32_MAX, UINT32_MAX}; /* excluded home copies, in increasing order */
    uint32_t left = homes, made;
    if (current < LACEDRING_SEAMS_PRIVATE) {
        out[0] = lacedring_seam_copy_(w, k, current);
        --left;
    }
    made = q.new_first && lacedring_seam_flag_(&w->r, q.new_context);
    if (!made && q.at_context != LACEDRING_SEAM_NONE) {
        const uint32_t copy = lacedring_seam_copy_(w, k, q.at);
        if (copy != out[0]) {
            if (lacedring_seam_flag_(&w->r, q.at_context)) return q.at;
            out[1] = copy < out[0] ? out[0] : copy;
            if (copy < out[0]) out[0] = copy;
            --left;
        }
    }
    if (made || (!q.new_first && lacedring_seam_flag_(&w->r, q.new_context)))
        return LACEDRING_SEAMS_PRIVATE | w->made++;
    if (left > 0 && lacedring_seam_flag_(&w->r, LACEDRING_SEAM_HOME)) {
        uint32_t bits = 0, index;
        while (((left - 1) >> bits) != 0) ++bits;
        index = lacedring_seam_take_(&w->r, bits);
        if (index >= left) w->r.bad = 1;
        if (index >= out[0]) ++index;
        if (index >= out[1]) ++index;
        return index < homes ? index : 0;
    } else {
        const uint32_t back = lacedring_seam_golomb_(&w->r, 2);
        if (back >= w->made) {
            w->r.bad = 1;
            return 0;
        }
        return LACEDRING_SEAMS_PRIVATE | (w->made - 1 - back);
    }
}

/* An end of the edge that a triangle shares with its parent. */
struct lacedring_seam_end_ {
    uint32_t corner; /* number of the corner in the block */
    uint32_t state;  /* state of the vertex in the parent */
    uint32_t far;    /* position where the fan ends */
    /* Class x of docs/seams-format.md. State at `far`: 0 if the vertex has no steps, else 1. On the right: else 2. On
       the left: 2 if enough triangles follow to reach `far` by steps, else 3. */
    uint32_t type;
};

/* The q of docs/seams-format.md: counts the triangles in a row, from the corner's on, that have its vertex, up to 3.
   Triangles after the block count as having it. */
static uint32_t lacedring_seam_length_(const struct lacedring_seam_walk_* w, uint32_t corner) {
    const uint32_t vertex = w->triangles[corner];
    uint32_t i = corner / 3 + 1, length = 1;
    for (; length < 3 && (i >= w->count || lacedring_seam_corner(w->triangles + (size_t)3 * i, vertex) < 3); ++i)
        ++length;
    return length;
}

/* The end at corner j of the edge that triangle i shares with its parent, `back` triangles before. `other` is the
   corner at the other end. */
static struct lacedring_seam_end_ lacedring_seam_end_of_(const struct lacedring_seam_walk_* w, uint32_t i,
                                                         uint32_t back, uint32_t j, uint32_t other) {
    const uint32_t* t = w->triangles + (size_t)3 * i;
    const uint32_t* p = t - (size_t)3 * back;
    const uint32_t vertex = t[j], in_parent = lacedring_seam_corner(p, vertex), k = 3 * i + j;
    const uint32_t steps = w->steps[k], side = w->side[i];
    const uint32_t precedes = p[in_parent > 0 ? in_parent - 1 : 2] == t[other];
    struct lacedring_seam_end_ e;
    e.corner = k;
    e.state = w->state[3 * (i - back) + in_parent];
    e.far = (side == 0) == precedes ? 0 : steps;
    if (side == 0) {
        const uint32_t left = e.state >= LACEDRING_SEAMS_PRIVATE ? 0
                              : e.far > e.state                  ? e.far - e.state
                                                                 : e.state - e.far;
        e.type = left == 0 ? steps > 0 : left < lacedring_seam_length_(w, k) ? 2 : 3;
    } else {
        const uint32_t there = lacedring_seam_copy_(w, k, e.state) == lacedring_seam_copy_(w, k, e.far);
        e.type = !there ? 2 : steps > 0;
    }
    return e;
}

/* Returns the question about the new copy at end e of the shared edge. */
static struct lacedring_seam_question_ lacedring_seam_change_(const struct lacedring_seam_walk_* w, uint32_t side,
                                                              const struct lacedring_seam_end_* e) {
    struct lacedring_seam_question_ q = {e->far, LACEDRING_SEAM_STEP_L, LACEDRING_SEAM_NEW_L, 0};
    if (side == 0) {
        if (e->state < LACEDRING_SEAMS_PRIVATE) {
            q.at = e->far > e->state ? e->state + 1 : e->state - 1;
            if (e->far == e->state) q.at = w->steps[e->corner] == 0 ? 0 : e->far == 0 ? 1 : e->far - 1;
        }
    } else if (e->type < 2) {
        q.at_context = LACEDRING_SEAM_NONE;
        q.new_context = LACEDRING_SEAM_LEAVE;
    } else {
        q.at_context = lacedring_seam_length_(w, e->corner) == 1 ? LACEDRING_SEAM_LAST_R : LACEDRING_SEAM_NEXT_R;
        q.new_context = LACEDRING_SEAM_NEW_R;
    }
    return q;
}

/* Reads the state of an end that changes. */
static uint32_t lacedring_seam_read_change_(struct lacedring_seam_walk_* w, uint32_t side,
                                            const struct lacedring_seam_end_* e) {
    return lacedring_seam_choose_(w, e->corner, e->state, lacedring_seam_change_(w, side, e));
}

/* Finds the ends of the edge to the parent. *a is the end of the smaller class; it is asked about first. Returns the
   context of the flag that says whether the edge is a seam. */
static uint32_t lacedring_seam_ends_(const struct lacedring_seam_walk_* w, uint32_t i, uint32_t back,
                                     const uint32_t pair[2], struct lacedring_seam_end_* a,
                                     struct lacedring_seam_end_* b) {
    *a = lacedring_seam_end_of_(w, i, back, pair[0], pair[1]);
    *b = lacedring_seam_end_of_(w, i, back, pair[1], pair[0]);
    if (b->type < a->type) {
        const struct lacedring_seam_end_ swap = *a;
        *a = *b;
        *b = swap;
    }
    if (w->side[i] == 0)
        return a->type == 0                   ? LACEDRING_SEAM_LONE
               : a->type == 2 || a->type == 3 ? LACEDRING_SEAM_LEFT2
               : b->type < 3                  ? LACEDRING_SEAM_LEFT0
                                              : LACEDRING_SEAM_LEFT1;
    return a->type == 1 || b->type == 1                ? LACEDRING_SEAM_RIGHT0
           : a->type == 2                              ? LACEDRING_SEAM_RIGHT4
           : b->type == 0                              ? LACEDRING_SEAM_RIGHT1
           : lacedring_seam_length_(w, a->corner) == 1 ? LACEDRING_SEAM_RIGHT2
                                                       : LACEDRING_SEAM_RIGHT3;
}

/* Reads whether the edge to the parent is a seam, which of its ends change, and the state of both ends. */
static void lacedring_seam_spoke_(struct lacedring_seam_walk_* w, uint32_t i, uint32_t back, const uint32_t pair[2]) {
    const uint32_t side = w->side[i];
    struct lacedring_seam_end_ a, b;
    const uint32_t context = lacedring_seam_ends_(w, i, back, pair, &a, &b);
    uint32_t usual, a_changes = 0, b_changes = 0;
    if (lacedring_seam_flag_(&w->r, context)) {
        /* The usual change is b alone if `lone`, else both ends. */
        const uint32_t lone = context == LACEDRING_SEAM_LONE;
        usual = lacedring_seam_flag_(&w->r, a.type == 0 ? LACEDRING_SEAM_HALF : LACEDRING_SEAM_BOTH);
        if (usual) {
            a_changes = !lone;
            b_changes = 1;
        } else {
            const uint32_t a_alone = lacedring_seam_take_(&w->r, 1);
            a_changes = a_alone || lone;
            b_changes = !a_alone;
        }
    }
    w->state[a.corner] = a_changes ? lacedring_seam_read_change_(w, side, &a) : a.state;
    w->state[b.corner] = b_changes ? lacedring_seam_read_change_(w, side, &b) : b.state;
}

/* The question about corner j of triangle i, which is not in the parent. If there is a parent, the states of the two
   other corners are known. */
static struct lacedring_seam_question_ lacedring_seam_start_(const struct lacedring_seam_walk_* w, uint32_t i,
                                                             uint32_t j, uint32_t has_parent) {
    const uint32_t* t = w->triangles + (size_t)3 * i;
    const uint32_t k = 3 * i + j, steps = w->steps[k];
    const uint32_t before = lacedring_seam_corner(t, t[j] - 1), after = lacedring_seam_corner(t, t[j] + 1);
    struct lacedring_seam_question_ q = {0, 0, LACEDRING_SEAM_NEW_L, 0};
    if (before == 3 && after < 3) q.at = steps;
    if (w->side[i] == 0) {
        q.at_context = before == 3 && after == 3 && steps > 0 ? LACEDRING_SEAM_MID_L : LACEDRING_SEAM_START_L;
    } else {
        uint32_t n;
        q.at_context = steps > 0 ? LACEDRING_SEAM_MID_R2 : LACEDRING_SEAM_MID_R;
        q.new_context = steps > 0 ? LACEDRING_SEAM_NEW_M : LACEDRING_SEAM_NEW_R;
        for (n = 0; n < 2 && has_parent; ++n) {
            /* There is no seam along the ring edge to this neighbor if the neighbor has its outermost home copy. */
            const uint32_t neighbor = n == 0 ? before : after, o = 3 * i + neighbor;
            if (neighbor == 3) continue;
            if (lacedring_seam_copy_(w, o, w->state[o]) == lacedring_seam_copy_(w, o, n == 0 ? w->steps[o] : 0)) {
                q.at = n == 0 ? 0 : steps;
                q.at_context = LACEDRING_SEAM_PLAIN;
                q.new_context = LACEDRING_SEAM_NEW_R;
                q.new_first = 0;
                break;
            }
            q.at = n == 0 ? steps : 0;
            q.at_context = LACEDRING_SEAM_LEAVE;
            q.new_context = steps > 0 ? LACEDRING_SEAM_SEAMED2 : LACEDRING_SEAM_SEAMED;
            q.new_first = 1;
        }
    }
    return q;
}

/* Decodes the states of all triangles of the block. */
static void lacedring_seam_triangles_(struct lacedring_seam_walk_* w) {
    uint32_t i, j;
    for (i = 0; i < w->count; ++i) {
        uint32_t pair[2] = {3, 3}, back, side;
        if (lacedring_seam_is_empty(w->triangles + (size_t)3 * i)) continue;
        back = lacedring_seam_parent(w->triangles, i, pair);
        side = lacedring_seam_side(w->triangles + (size_t)3 * i);
        w->side[i] = (uint8_t)(side < 2 ? side : back > 0 ? w->side[i - back] : 0);
        if (back > 0) lacedring_seam_spoke_(w, i, back, pair);
        for (j = 0; j < 3; ++j) {
            if (j == pair[0] || j == pair[1]) continue;
            w->state[3 * i + j] =
                lacedring_seam_choose_(w, 3 * i + j, UINT32_MAX, lacedring_seam_start_(w, i, j, back > 0));
        }
    }
}

/* Opens a triangle block. The caller then sets the homes of its corners. */
static void lacedring_seam_walk_begin_(const struct lacedring_seams* s, uint32_t block, const uint32_t* triangles,
                                       struct lacedring_seam_walk_* w) {
    w->made = lacedring_seam_open_(s, 1, block, &w->r);
    w->triangles = triangles;
    w->count = lacedring_seam_block_size_(s->triangles, block);
}

/* Decodes the copies of the corners of an opened block whose homes are set. */
static void lacedring_seam_walk_end_(const struct lacedring_seams* s, struct lacedring_seam_walk_* w,
                                     uint32_t* copies) {
    uint32_t k;
    lacedring_seam_triangles_(w);
    for (k = 0; k < 3 * w->count; ++k) {
        const uint32_t state = w->state[k];
        if (w->triangles[k] == UINT32_MAX) {
            copies[k] = UINT32_MAX;
            continue;
        }
        copies[k] = state >= LACEDRING_SEAMS_PRIVATE ? s->homes + (state - LACEDRING_SEAMS_PRIVATE)
                                                     : (w->home[k] >> 1) + lacedring_seam_copy_(w, k, state);
    }
}

/* Sets the homes of the block's corners. */
static void lacedring_seam_gather_(struct lacedring_seam_walk_* w, const uint32_t* home) {
    uint32_t k;
    for (k = 0; k < 3 * w->count; ++k) {
        if (w->triangles[k] != UINT32_MAX) lacedring_seam_set_home_(w, k, home + w->triangles[k]);
    }
}

void lacedring_seams_decode(const struct lacedring_seams* s, const uint32_t* triangles, uint32_t* home,
                            uint32_t* copies) {
    const uint32_t blocks = lacedring_seam_block_count_(s->triangles);
    uint32_t block;
    struct lacedring_seam_walk_ w;
    lacedring_seams_homes(s, home);
    for (block = 0; block < blocks; ++block) {
        const size_t first = (size_t)block * LACEDRING_SEAM_CORNERS_;
        lacedring_seam_walk_begin_(s, block, triangles + first, &w);
        lacedring_seam_gather_(&w, home);
        lacedring_seam_walk_end_(s, &w, copies + first);
    }
}

void lacedring_seams_block(const struct lacedring_seams* s, uint32_t block, const uint32_t* triangles,
                           uint32_t* copies) {
    uint32_t k, n, home[LACEDRING_SEAMS_BLOCK + 1];
    uint8_t is_set[LACEDRING_SEAM_CORNERS_] = {0};
    struct lacedring_seam_walk_ w;
    lacedring_seam_walk_begin_(s, block, triangles, &w);
    for (k = 0; k < 3 * w.count; ++k) {
        const uint32_t wanted = triangles[k] / LACEDRING_SEAMS_BLOCK;
        if (is_set[k] || triangles[k] == UINT32_MAX) continue;
        lacedring_seam_vertex_block_(s, wanted, home);
        for (n = k; n < 3 * w.count; ++n) {
            if (triangles[n] / LACEDRING_SEAMS_BLOCK != wanted) continue;
            is_set[n] = 1;
            lacedring_seam_set_home_(&w, n, home + triangles[n] % LACEDRING_SEAMS_BLOCK);
        }
    }
    lacedring_seam_walk_end_(s, &w, copies);
}

/* Writes the vertex of each home copy. */
static void lacedring_seam_home_vertices_(const struct lacedring_seams* s, const uint32_t* home, uint32_t* vertices) {
    uint32_t v, k;
    for (v = 0; v < s->vertices; ++v) {
        for (k = home[v] >> 1; k < home[v + 1] >> 1; ++k) vertices[k] = v;
    }
}

void lacedring_seams_copy_vertices(const struct lacedring_seams* s, const uint32_t* triangles, uint32_t* home,
                                   uint32_t* vertices) {
    const uint32_t blocks = lacedring_seam_block_count_(s->triangles);
    uint32_t block, k, copies[LACEDRING_SEAM_CORNERS_];
    struct lacedring_seam_walk_ w;
    lacedring_seams_homes(s, home);
    lacedring_seam_home_vertices_(s, home, vertices);
    for (block = 0; block < blocks; ++block) {
        lacedring_seam_walk_begin_(s, block, triangles + (size_t)block * LACEDRING_SEAM_CORNERS_, &w);
        if (w.r.copies == 0) continue; /* the block makes no private copy */
        lacedring_seam_gather_(&w, home);
        lacedring_seam_walk_end_(s, &w, copies);
        for (k = 0; k < 3 * w.count; ++k) {
            if (copies[k] != UINT32_MAX) vertices[copies[k]] = w.triangles[k];
        }
    }
}

/* Checks triangles and blocks; writes the copies of the corners if `copies` is not null. */
static enum lacedring_status lacedring_seam_check_(const struct lacedring_seams* s, const uint32_t* triangles,
                                                   uint32_t* scratch, uint32_t* copies, uint64_t* where) {
    const uint32_t blocks[2] = {lacedring_seam_block_count_(s->vertices), lacedring_seam_block_count_(s->triangles)};
    uint32_t *home = scratch, *owner = scratch + (size_t)s->vertices + 1; /* the vertex of each private copy */
    uint32_t block, k, own[LACEDRING_SEAM_CORNERS_];
    uint64_t i, end = s->blocks[0], made = 0;
    struct lacedring_seam_walk_ w;
    for (i = 0; i < s->triangles; ++i) {
        const uint32_t* t = triangles + (size_t)(3 * i);
        if ((t[0] & t[1] & t[2]) == UINT32_MAX) continue;
        if (t[0] >= s->vertices || t[1] >= s->vertices || t[2] >= s->vertices || t[0] == t[1] || t[1] == t[2] ||
            t[2] == t[0])
            return lacedring_at_(where, i, LACEDRING_STATUS_TRIANGLE);
    }
    home[0] = 0;
    for (block = 0; block < blocks[0]; ++block) {
        const uint32_t first = block * LACEDRING_SEAMS_BLOCK, count = lacedring_seam_block_size_(s->vertices, block);
        struct lacedring_seam_reader_ r;
        const uint32_t before = lacedring_seam_open_(s, 0, block, &r);
        if (before != made || r.at != end || first + made > s->homes)
            return lacedring_at_(where, block, LACEDRING_STATUS_VERTEX_BLOCK);
        lacedring_seam_vertices_(&r, first + before, count, home + first);
        if (r.bad || r.at != r.end) return lacedring_at_(where, block, LACEDRING_STATUS_VERTEX_BLOCK);
        made = (home[first + count] >> 1) - first - count;
        end = r.end;
    }
    if (made != s->homes - s->vertices || end != s->blocks[1])
        return lacedring_at_(where, blocks[0] - 1, LACEDRING_STATUS_VERTEX_BLOCK);
    made = 0;
    for (block = 0; block < blocks[1]; ++block) {
        uint32_t* of_block = copies == NULL ? own : copies + (size_t)block * LACEDRING_SEAM_CORNERS_;
        lacedring_seam_walk_begin_(s, block, triangles + (size_t)block * LACEDRING_SEAM_CORNERS_, &w);
        if (w.made != made || w.r.at != end) return lacedring_at_(where, block, LACEDRING_STATUS_BLOCK);
        lacedring_seam_gather_(&w, home);
        lacedring_seam_walk_end_(s, &w, of_block);
        if (w.r.bad || w.r.at != w.r.end || w.made > s->copies - s->homes)
            return lacedring_at_(where, block, LACEDRING_STATUS_BLOCK);
        for (k = (uint32_t)made; k < w.made; ++k) owner[k] = UINT32_MAX;
        for (k = 0; k < 3 * w.count; ++k) { /* a private copy belongs to one vertex */
            uint32_t* of;
            if (of_block[k] < s->homes || of_block[k] == UINT32_MAX) continue;
            of = owner + (of_block[k] - s->homes);
            if (*of == UINT32_MAX) *of = w.triangles[k];
            if (*of != w.triangles[k]) return lacedring_at_(where, block, LACEDRING_STATUS_BLOCK);
        }
        made = w.made;
        end = w.r.end;
    }
    if (made != s->copies - s->homes) return lacedring_at_(where, blocks[1] - 1, LACEDRING_STATUS_BLOCK);
    return LACEDRING_STATUS_OK;
}

enum lacedring_status lacedring_seams_check(const struct lacedring_seams* s, const uint32_t* triangles,
                                            uint32_t* scratch, uint64_t* where) {
    return lacedring_seam_check_(s, triangles, scratch, NULL, where);
}

enum lacedring_status lacedring_seams_decode_checked(const struct lacedring_seams* s, const uint32_t* triangles,
                                                     uint32_t* scratch, uint32_t* copies, uint32_t* vertices,
                                                     uint64_t* where) {
    const enum lacedring_status status = lacedring_seam_check_(s, triangles, scratch, copies, where);
    if (status != LACEDRING_STATUS_OK) return status;
    lacedring_seam_home_vertices_(s, scratch, vertices);
    if (s->copies > s->homes)
        memcpy(vertices + s->homes, scratch + (size_t)s->vertices + 1, 4 * (size_t)(s->copies - s->homes));
    return LACEDRING_STATUS_OK;
}

enum lacedring_status lacedring_seams_checksum(const struct lacedring_seams* s) {
    const uint32_t crc = lacedring_crc_(UINT32_MAX, s->words + 2, s->count - 2) ^ UINT32_MAX;
    return crc == s->words[1] ? LACEDRING_STATUS_OK : LACEDRING_STATUS_CHECKSUM;
}

#undef LACEDRING_SEAM_MOST_
#undef LACEDRING_SEAM_CORNERS_
#ifdef __cplusplus
}
#endif
#endif /* LACEDRING_DECODE_IMPLEMENTATION */
