/* Decodes LacedRing's storage form of packed streams and vertex streams straight into triangles and attributes, without
   making the resident streams. C99 or C++; one file beside lacedring_decode.h and lacedring_vertices.h, no allocation.
   Format: docs/storage-format.md.

   Define LACEDRING_DECODE_IMPLEMENTATION in one .c or .cpp file before including this header, which then adds the
   functions. A program that links lacedring::core has them already.

       struct lacedring_stored_packed mesh;
       if (lacedring_stored_packed_open(words, count, most_vertices, most_triangles, &mesh, NULL) !=
           LACEDRING_STATUS_OK) ...
       void *scratch = malloc(lacedring_stored_packed_scratch(&mesh));
       uint32_t *triangles = malloc(12 * (size_t)mesh.triangles);
       if (lacedring_stored_packed_decode(&mesh, scratch, triangles, NULL) != LACEDRING_STATUS_OK) ...

       struct lacedring_stored_vertices stored;
       if (lacedring_stored_vertices_open(words, count, mesh.vertices, &stored, NULL) != LACEDRING_STATUS_OK) ...
       void *scratch = malloc(lacedring_stored_vertices_scratch(&stored, mesh.triangles, NULL));
       uint32_t *integers = malloc(4 * (size_t)mesh.vertices * stored.attribute.components);
       if (lacedring_stored_vertices_decode(&stored, triangles, mesh.triangles, NULL, scratch, integers, NULL) !=
           LACEDRING_STATUS_OK) ...
       float *positions = malloc(12 * (size_t)mesh.vertices);
       lacedring_stored_vertices_values(&stored, integers, positions);

   All functions are safe with any words: they read and write only the memory described here, and take time linear in
   the limits that the caller gives. Scratch memory must be aligned as by malloc. Stored words are little-endian, and
   this file is for little-endian machines. */
#ifndef LACEDRING_STORAGE_H
#define LACEDRING_STORAGE_H

#include "lacedring_vertices.h"

#ifdef __cplusplus
extern "C" {
#endif

#define LACEDRING_STORED_HEADER_WORDS 3 /* header of a packed stream in storage form */

/* Position of a decoder in a coded part. */
struct lacedring_coded {
    const uint32_t* symbols; /* words of the part after the first one */
    const uint8_t* bytes;    /* all bytes of the part */
    /* Words of symbols: how many were read, and the number of the last one. */
    uint64_t used, last;
    /* Raw bits: the next one, the end, and the last byte from which 8 bytes can be loaded. */
    uint64_t bit, end, last_byte;
    /* The states that decode the next symbol, and the one after. */
    uint64_t now, next;
};

/* A packed stream in storage form whose header was read. Refers to the caller's words. */
struct lacedring_stored_packed {
    struct lacedring_coded steps;
    const uint32_t* doubles;      /* two words per run */
    uint32_t vertices, triangles; /* of the mesh */
    /* The first `own` triangles are coded; each of the others is a double: it has the vertices of an own triangle. */
    uint32_t own;
    uint32_t runs; /* runs of doubles */
    uint32_t has_flips;
};

/* Reads the header and checks sizes. Returns LACEDRING_STATUS_LIMIT if there are more than most_vertices or
   most_triangles: pass the numbers in the file, or what fits in memory. Linear in the runs of doubles. */
enum lacedring_status lacedring_stored_packed_open(const uint32_t* words, size_t count, uint32_t most_vertices,
                                                   uint32_t most_triangles, struct lacedring_stored_packed* stored,
                                                   uint64_t* where);

/* Bytes of scratch memory for lacedring_stored_packed_decode: 16 per triangle, most of which it never touches, and 1
   per vertex. Returns SIZE_MAX if the number does not fit in size_t. */
size_t lacedring_stored_packed_scratch(const struct lacedring_stored_packed* stored);

/* Decodes the triangles of the packed stream, in its order: 3 * stored->triangles indices. On an error the contents of
   `triangles` are undefined. Linear time, 10 KB of stack. */
enum lacedring_status lacedring_stored_packed_decode(const struct lacedring_stored_packed* stored, void* scratch,
                                                     uint32_t* triangles, uint64_t* where);

/* A vertex stream in storage form whose header was read. Refers to the caller's words. */
struct lacedring_stored_vertices {
    struct lacedring_vertices attribute; /* as from lacedring_vertices_open, without table and data */
    struct lacedring_coded residuals;    /* where the residuals begin */
    /* Where the exceptions begin; set when the integers are decoded. */
    struct lacedring_coded exceptions;
    /* 1: component c has a range, `low[c]` and `range_bits[c]`. 0: all integers of the mapping are valid. */
    uint32_t has_ranges;
    uint32_t low[LACEDRING_VERTICES_MAX_COMPONENTS], range_bits[LACEDRING_VERTICES_MAX_COMPONENTS];
    uint8_t rules[LACEDRING_VERTICES_MAX_COMPONENTS]; /* rule of prediction of each component */
    uint32_t by_normal, error, smooth, fine;          /* parameters of predictions and residuals */
    /* 1: positions predict the integers, two per vertex, as normals (octahedral mapping) or as texture coordinates. */
    uint32_t by_positions;
    /* How the normals of triangles are summed. */
    uint32_t by_angle, by_area, of_vertex;
};

/* Reads the header and checks sizes. `vertices`: number of elements of the attribute (vertices, or copies of vertices).
   Takes time linear in vertices / 65,536. */
enum lacedring_status lacedring_stored_vertices_open(const uint32_t* words, size_t count, uint32_t vertices,
                                                     struct lacedring_stored_vertices* stored, uint64_t* where);

/* The positions that predict an attribute if stored->by_positions is not 0. */
struct lacedring_positions {
    /* Decoded integers of the file's attribute POSITION, three per vertex. Its mapping is lattice or decimals. */
    const uint32_t* integers;
    uint32_t vertices;
    /* For an attribute of copies, the vertex of each copy. Null for an attribute of vertices. */
    const uint32_t* vertex_of;
};

/* Bytes of scratch memory for lacedring_stored_vertices_decode with `triangles` triangles and `positions` (null: none):
   16 per triangle and about 16 per vertex; for normals predicted by positions at least 24 per position or per element
   of the attribute, whichever are more. Returns SIZE_MAX if the number does not fit in size_t. */
size_t lacedring_stored_vertices_scratch(const struct lacedring_stored_vertices* stored, uint32_t triangles,
                                         const struct lacedring_positions* positions);

/* Decodes the integers of the vertex stream, stored->attribute.components per vertex. `triangles`: 3 * triangle_count
   indices of the attribute's elements, in the order of the file. `positions` may be null if stored->by_positions is 0.
   On an error the contents of `integers` are undefined. Linear time, 10 KB of stack. */
enum lacedring_status lacedring_stored_vertices_decode(struct lacedring_stored_vertices* stored,
                                                       const uint32_t* triangles, uint32_t triangle_count,
                                                       const struct lacedring_positions* positions, void* scratch,
                                                       uint32_t* integers, uint64_t* where);

/* Converts decoded integers to all values of the attribute, as lacedring_vertices_decode writes them. */
void lacedring_stored_vertices_values(const struct lacedring_stored_vertices* stored, const uint32_t* integers,
                                      void* out);

#ifdef __cplusplus
}
#endif
#endif /* LACEDRING_STORAGE_H */

#if defined(LACEDRING_DECODE_IMPLEMENTATION) && !defined(LACEDRING_STORAGE_IMPLEMENTED)
#define LACEDRING_STORAGE_IMPLEMENTED

#if defined(__SSE2__) && defined(__GNUC__) && !defined(LACEDRING_PLAIN)
#define LACEDRING_SSE2_
#include <emmintrin.h>
#endif

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__) && !defined(LACEDRING_PLAIN)
#define LACEDRING_COLD_ static __attribute__((noinline))
#else
#define LACEDRING_COLD_ static
#endif

#if defined(__GNUC__) && !defined(LACEDRING_PLAIN)
#define LACEDRING_PREFETCH_(at) __builtin_prefetch(at)
#else
#define LACEDRING_PREFETCH_(at) ((void)(at))
#endif

#define LACEDRING_SCALE_ 32768u /* a model's ranges fill [0, 32768) */
#define LACEDRING_LEAST_STATE_ (UINT64_C(1) << 31)

/* Model of a bit: its probability adapts. */
struct lacedring_bit_model_ {
    /* zero: the range of 0 is [0, zero). seen: bits so far, at most 48. */
    uint16_t zero, seen;
};

/* Model of a symbol, one of 16. */
struct lacedring_symbol_model_ {
    /* For each symbol: where its range begins, and its count. */
    uint16_t begin[17], count[16];
    /* total: sum of the counts. left: symbols until the ranges are recomputed. cycle: symbols from one time to the
       next. */
    uint16_t total, left, cycle;
};

static void lacedring_begin_bits_(struct lacedring_bit_model_* models, size_t count) {
    size_t i;
    for (i = 0; i < count; ++i) {
        models[i].zero = LACEDRING_SCALE_ / 2;
        models[i].seen = 0;
    }
}

/* Computes the ranges from the counts. */
static void lacedring_find_ranges_(struct lacedring_symbol_model_* m) {
    const uint32_t scale = ((LACEDRING_SCALE_ - 16) << 16) / m->total;
    uint32_t i, sum = 0;
    for (i = 0; i < 16; ++i) {
        m->begin[i] = (uint16_t)(i + (((uint64_t)sum * scale) >> 16));
        sum += m->count[i];
    }
    m->begin[16] = LACEDRING_SCALE_;
}

static void lacedring_begin_symbols_(struct lacedring_symbol_model_* models, size_t count) {
    size_t i;
    uint32_t k;
    for (i = 0; i < count; ++i) {
        for (k = 0; k < 16; ++k) models[i].count[k] = 1;
        models[i].total = 16;
        models[i].left = models[i].cycle = 6;
        lacedring_find_ranges_(models + i);
    }
}

/* Halves large counts, recomputes the ranges, and sets the next cycle. */
LACEDRING_COLD_ void lacedring_renew_ranges_(struct lacedring_symbol_model_* m) {
    const uint32_t cycle = m->cycle + m->cycle / 2u;
    uint32_t i;
    if (m->total > 2048) {
        m->total = 0;
        for (i = 0; i < 16; ++i) {
            m->count[i] = (uint16_t)((m->count[i] + 1) / 2);
            m->total = (uint16_t)(m->total + m->count[i]);
        }
    }
    lacedring_find_ranges_(m);
    m->left = m->cycle = (uint16_t)(cycle < 64 ? cycle : 64);
}

/* Opens a coded part. Returns 0 if it is shorter than its first word says. */
static int lacedring_open_coded_(struct lacedring_coded* d, const uint32_t* words, size_t count) {
    if (count == 0 || words[0] < 4 || words[0] > count - 1) return 0;
    d->symbols = words + 1;
    d->bytes = (const uint8_t*)words;
    d->used = 4;
    d->last = words[0] - 1;
    d->bit = 32 * (1 + (uint64_t)words[0]);
    d->end = 32 * (uint64_t)count;
    d->last_byte = 4 * (uint64_t)count - 8;
    d->now = words[1] | (uint64_t)words[2] << 32;
    d->next = words[3] | (uint64_t)words[4] << 32;
    return 1;
}

/* Were all words and bits used, and are both states as the format prescribes at the end? */
static int lacedring_coded_ends_(const struct lacedring_coded* d) {
    uint32_t last = 0, left;
    if (d->bit > d->end || d->end - d->bit >= 32) return 0;
    left = (uint32_t)(d->end - d->bit);
    if (left > 0) memcpy(&last, d->bytes + (size_t)(d->end / 8 - 4), 4);
    return (left == 0 || last >> (32 - left) == 0) && d->used == d->last + 1 && d->now == LACEDRING_LEAST_STATE_ &&
           d->next == LACEDRING_LEAST_STATE_;
}

/* Removes the decoded symbol with range [begin, begin + size) from the state; `at` is the state modulo
   LACEDRING_SCALE_. After the end of the words, reads the last word again. is_rare: a new word is seldom needed, so a
   branch is fast. */
LACEDRING_HOT_ void lacedring_coded_advance_(struct lacedring_coded* d, uint32_t at, uint32_t begin, uint32_t size,
                                             int is_rare) {
    uint64_t x = size * (d->now >> 15) + at - begin;
    const uint32_t word = d->symbols[(size_t)(d->used < d->last ? d->used : d->last)];
    if (is_rare) {
        if (x < LACEDRING_LEAST_STATE_) {
            x = x << 32 | word;
            ++d->used;
        }
    } else { /* without a branch, which would be unpredictable */
        const uint64_t takes = x < LACEDRING_LEAST_STATE_;
        x = x << (32 * takes) | (word & (0 - takes));
        d->used += takes;
    }
    d->now = d->next;
    d->next = x;
}

/* How fast a bit's probability adapts, by the number of bits seen: 131072 / (2 seen + 3). */
static const uint16_t lacedring_bit_steps_[49] = {
    43690, 26214, 18724, 14563, 11915, 10082, 8738, 7710, 6898, 6241, 5698, 5242, 4854, 4519, 4228, 3971, 3744,
    3542,  3360,  3196,  3048,  2912,  2788,  2674, 2570, 2473, 2383, 2299, 2221, 2148, 2080, 2016, 1956, 1899,
    1846,  1795,  1747,  1702,  1659,  1618,  1579, 1542, 1506, 1472, 1440, 1409, 1379, 1351, 1323};

LACEDRING_HOT_ uint32_t lacedring_coded_bit_(struct lacedring_coded* d, struct lacedring_bit_model_* m) {
    const uint32_t at = (uint32_t)d->now & (LACEDRING_SCALE_ - 1), zero = m->zero, bit = (uint32_t)(at >= zero);
    const uint32_t seen = m->seen < 48 ? m->seen + 1u : 48u;
    const int32_t to = bit ? 32 : (int32_t)LACEDRING_SCALE_ - 32;
    lacedring_coded_advance_(d, at, bit ? zero : 0, bit ? LACEDRING_SCALE_ - zero : zero, 1);
    m->seen = (uint16_t)seen;
    m->zero = (uint16_t)((int32_t)zero + (((to - (int32_t)zero) * (int32_t)lacedring_bit_steps_[seen]) >> 16));
    return bit;
}

/* The symbol whose range contains `at`. */
LACEDRING_HOT_ uint32_t lacedring_find_symbol_(const struct lacedring_symbol_model_* m, uint32_t at) {
#ifdef LACEDRING_SSE2_
    const __m128i most = _mm_set1_epi16((short)at);
    const __m128i low = _mm_loadu_si128((const __m128i*)(const void*)m->begin);
    const __m128i high = _mm_loadu_si128((const __m128i*)(const void*)(m->begin + 8));
    const __m128i above = _mm_packs_epi16(_mm_cmpgt_epi16(low, most), _mm_cmpgt_epi16(high, most));
    return (uint32_t)__builtin_ctz((uint32_t)_mm_movemask_epi8(above) | 0x10000u) - 1;
#else
    /* Compares four 16-bit values in a word: values of `begin` are below 2^15, so the highest bit stays set where `at`
       is not less. */
    const uint64_t all = (at | LACEDRING_SCALE_) * UINT64_C(0x0001000100010001);
    uint64_t four[4], sum = 0;
    uint32_t i;
    memcpy(four, m->begin, sizeof four);
    for (i = 0; i < 4; ++i) sum += (all - four[i]) >> 15 & UINT64_C(0x0001000100010001);
    return (uint32_t)(sum * UINT64_C(0x0001000100010001) >> 48) - 1;
#endif
}

LACEDRING_HOT_ uint32_t lacedring_coded_symbol_(struct lacedring_coded* d, struct lacedring_symbol_model_* m) {
    const uint32_t at = (uint32_t)d->now & (LACEDRING_SCALE_ - 1), symbol = lacedring_find_symbol_(m, at);
    const uint32_t begin = m->begin[symbol];
    lacedring_coded_advance_(d, at, begin, m->begin[symbol + 1] - begin, 0);
    m->count[symbol] = (uint16_t)(m->count[symbol] + 4);
    m->total = (uint16_t)(m->total + 4);
    if (--m->left == 0) lacedring_renew_ranges_(m);
    return symbol;
}

/* Reads `count` raw bits, at most 32. After the end, returns arbitrary bits. */
LACEDRING_HOT_ uint32_t lacedring_coded_raw_(struct lacedring_coded* d, uint32_t count) {
    const uint64_t byte = d->bit >> 3 < d->last_byte ? d->bit >> 3 : d->last_byte, skip = d->bit - 8 * byte;
    uint64_t window;
    memcpy(&window, d->bytes + (size_t)byte, 8);
    d->bit += count;
    return (uint32_t)(window >> (skip < 63 ? skip : 63) & ((UINT64_C(1) << count) - 1));
}

/* Reads a number: a symbol is its number of bits, the bits below the highest are raw. */
static uint32_t lacedring_coded_number_(struct lacedring_coded* d, struct lacedring_symbol_model_* m) {
    uint32_t bits = lacedring_coded_symbol_(d, m);
    if (bits == 15) bits += lacedring_coded_raw_(d, 5);
    if (bits > 32) return 0; /* never written by an encoder */
    return bits < 2 ? bits : UINT32_C(1) << (bits - 1) | lacedring_coded_raw_(d, bits - 1);
}

/* Returns bytes + count * each, or SIZE_MAX if that does not fit in size_t. */
static size_t lacedring_bytes_of_(size_t bytes, uint64_t count, uint32_t each) {
    return count > (SIZE_MAX - bytes) / each ? SIZE_MAX : bytes + (size_t)count * each;
}

/* Packed streams. */

/* Bits of lacedring_steps_::around. Bits 0 to 3: triangles of the vertex so far, at most 9. RING_EDGE: the edge to the
   next vertex has a triangle. */
#define LACEDRING_RING_EDGE_ 16u
/* Flag in an open edge's first vertex: the edge was entered on the right of its ring. */
#define LACEDRING_RIGHT_ 0x80000000u

/* Models of a step: is it a turn, and is it the turn to a + 1. */
struct lacedring_turn_models_ {
    struct lacedring_bit_model_ simple, up;
};

/* The state of docs/storage-format.md, "Steps". */
struct lacedring_steps_ {
    struct lacedring_coded coded;
    uint8_t* around;   /* a byte per vertex, and one more */
    uint32_t* open;    /* open edges, a stack; two words each; UINT32_MAX: removed */
    size_t open_count; /* in words */
    uint32_t vertices, bits;
    /* The edge of the next step, if the next step continues the last one. */
    uint32_t a, b;
    /* goes_on: the next step continues the last one. entered: the last step entered an edge. is_fork: the next step's
       first bit was read already, and is 0. */
    uint32_t goes_on, is_fork, entered;
    uint32_t root_a, root_b, right, flipped, seen;
    /* Index of begins and deeper: `entered` of the last step. Index of flip: `flipped` of the last step. */
    struct lacedring_bit_model_ begins[2], deeper[2], drop, first, flip[2];
    struct lacedring_symbol_model_ tree, fork, tree_size, depth, size[2];
    struct lacedring_turn_models_ turns[1024];
};

enum lacedring_status lacedring_stored_packed_open(const uint32_t* words, size_t count, uint32_t most_vertices,
                                                   uint32_t most_triangles, struct lacedring_stored_packed* s,
                                                   uint64_t* where) {
    struct lacedring_packed p;
    if (count < LACEDRING_STORED_HEADER_WORDS) return lacedring_at_(where, 0, LACEDRING_STATUS_SHORT);
    s->vertices = p.vertices = words[0];
    s->triangles = s->own = p.own = p.triangles = words[1];
    s->runs = p.runs = words[2] & 0x7fffffffu;
    s->has_flips = words[2] >> 31;
    s->doubles = words + LACEDRING_STORED_HEADER_WORDS;
    if (s->vertices > most_vertices) return lacedring_at_(where, s->vertices, LACEDRING_STATUS_LIMIT);
    if (s->own > most_triangles) return lacedring_at_(where, s->own, LACEDRING_STATUS_LIMIT);
    if (s->vertices > UINT32_C(1) << 29) return lacedring_at_(where, 0, LACEDRING_STATUS_VERTICES);
    if (s->own > UINT32_MAX / 3) return lacedring_at_(where, 0, LACEDRING_STATUS_SLOTS);
    count -= LACEDRING_STORED_HEADER_WORDS;
    if (s->runs > 0) {
        if (count < 2 || s->runs > (count - 2) / 2) return lacedring_at_(where, 0, LACEDRING_STATUS_SIZE);
        if (s->doubles[0] > s->own || s->doubles[1] != s->runs)
            return lacedring_at_(where, 0, LACEDRING_STATUS_DOUBLES);
        p.triangles = s->triangles = s->own + s->doubles[0];
        if (s->triangles > most_triangles) return lacedring_at_(where, s->triangles, LACEDRING_STATUS_LIMIT);
        if (s->triangles > UINT32_MAX / 3) return lacedring_at_(where, 0, LACEDRING_STATUS_SLOTS);
        s->doubles += 2;
        count -= 2 + 2 * (size_t)s->runs;
    }
    p.doubles = s->doubles;
    if (lacedring_check_doubles_(&p, where) != LACEDRING_STATUS_OK) return LACEDRING_STATUS_DOUBLES;
    if (!lacedring_open_coded_(&s->steps, s->doubles + 2 * (size_t)s->runs, count))
        return lacedring_at_(where, 0, LACEDRING_STATUS_SIZE);
    return LACEDRING_STATUS_OK;
}

size_t lacedring_stored_packed_scratch(const struct lacedring_stored_packed* s) {
    return lacedring_bytes_of_(lacedring_bytes_of_(16, s->own, 16), s->vertices, 1);
}

/* Counts one more triangle at a vertex. */
LACEDRING_HOT_ uint32_t lacedring_counted_(uint32_t around) {
    return around + ((around & 15) < 9);
}

LACEDRING_HOT_ void lacedring_count_at_(struct lacedring_steps_* w, uint32_t v) {
    w->around[v] = (uint8_t)lacedring_counted_(w->around[v]);
}

LACEDRING_HOT_ void lacedring_mark_edge_(struct lacedring_steps_* w, uint32_t a, uint32_t b) {
    if (a + 1 == b) w->around[a] |= LACEDRING_RING_EDGE_;
}

/* The models of a step across (a, b), by the `around` of a, b and b - 1. */
LACEDRING_HOT_ struct lacedring_turn_models_* lacedring_turn_models_of_(struct lacedring_steps_* w, uint32_t at_a,
                                                                        uint32_t at_b, uint32_t behind_b) {
    return w->turns + (at_a << 4 | (at_b & 15) | (behind_b & LACEDRING_RING_EDGE_) << 5);
}

/* Decodes triangles from i on while each continues the one before by a turn, as most triangles do. Returns the number
   of the first other triangle, at most `end`. */
static uint32_t lacedring_simple_steps_(struct lacedring_steps_* w, uint32_t i, uint32_t end, uint32_t* out) {
    struct lacedring_coded d = w->coded; /* a copy, to stay in registers */
    uint8_t* around = w->around;
    uint32_t a = w->a, b = w->b;
    /* The `around` of a, b and b - 1. Those of a and b are written back when the walk leaves a or b. */
    uint32_t at_a, at_b, behind_b;
    const uint32_t right = 0 - w->right;
    if (w->seen < b + 1) w->seen = b + 1;
    at_a = around[a];
    at_b = around[b];
    behind_b = around[b - 1];
    for (; i < end && b - a > 2; ++i, out += 3) {
        struct lacedring_turn_models_* models = lacedring_turn_models_of_(w, at_a, at_b, behind_b);
        /* Both are loaded before the turn decides which of them is needed. */
        const uint32_t next_a = around[a + 1], next_b = around[b - 2];
        uint32_t up, x, mixed;
        if (!lacedring_coded_bit_(&d, &models->simple)) {
            w->is_fork = 1;
            break;
        }
        up = lacedring_coded_bit_(&d, &models->up);
        at_a = lacedring_counted_(at_a);
        at_b = lacedring_counted_(at_b);
        /* No branches on `up`, as turns are unpredictable. */
        x = up ? a + 1 : b - 1;
        around[up ? a : b] = (uint8_t)(up ? at_a | LACEDRING_RING_EDGE_ : at_b);
        at_a = up ? lacedring_counted_(next_a) : at_a;
        at_b = up ? at_b : lacedring_counted_(behind_b) | LACEDRING_RING_EDGE_;
        behind_b = up ? behind_b : next_b;
        mixed = (x ^ b) & right;
        out[0] = a;
        out[1] = b ^ mixed;
        out[2] = x ^ mixed;
        a = up ? x : a;
        b = up ? b : x;
    }
    around[a] = (uint8_t)at_a;
    around[b] = (uint8_t)at_b;
    w->a = a;
    w->b = b;
    w->coded = d;
    return i;
}

/* Finds the edge of a step that does not continue the step before. Returns 0 if there is none. */
static int lacedring_entry_(struct lacedring_steps_* w) {
    struct lacedring_coded* d = &w->coded;
    uint32_t* edge;
    while (w->open_count > 0 && w->open[w->open_count - 2] == UINT32_MAX) w->open_count -= 2;
    if (w->open_count == 0 || lacedring_coded_bit_(d, w->begins + w->entered)) {
        const uint32_t tree = lacedring_coded_symbol_(d, &w->tree);
        if (tree == 0) {
            w->right ^= 1;
        } else if (tree == 1) {
            w->root_a = w->seen;
            w->root_b = w->seen + lacedring_coded_number_(d, &w->tree_size);
            w->right = 0;
        } else {
            w->root_a = lacedring_coded_raw_(d, w->bits);
            w->root_b = lacedring_coded_raw_(d, w->bits);
            w->right = lacedring_coded_raw_(d, 1);
        }
        w->a = w->root_a;
        w->b = w->root_b;
        return 1;
    }
    if (lacedring_coded_bit_(d, w->deeper + w->entered)) {
        /* Number of edges above the edge on the stack, less 1. */
        const uint32_t above = lacedring_coded_number_(d, &w->depth);
        const size_t depth = 4 + 2 * (size_t)above; /* depth of the edge, in words */
        if (above >= w->open_count / 2 - 1) return 0;
        edge = w->open + (w->open_count - depth);
        if (lacedring_coded_bit_(d, &w->drop)) w->open_count -= depth;
    } else {
        w->open_count -= 2;
        edge = w->open + w->open_count;
    }
    if (edge[0] == UINT32_MAX) return 0;
    w->right = edge[0] >> 31;
    w->a = edge[0] & ~LACEDRING_RIGHT_;
    w->b = edge[1];
    edge[0] = UINT32_MAX;
    return 1;
}

LACEDRING_HOT_ void lacedring_open_edge_(struct lacedring_steps_* w, uint32_t a, uint32_t b) {
    w->open[w->open_count++] = a | w->right << 31;
    w->open[w->open_count++] = b;
}

/* Decodes the third vertex of a step that is not a turn, and opens the edges it enters. The vertex may be out of range.
 */
static uint32_t lacedring_fork_(struct lacedring_steps_* w, uint32_t a, uint32_t b) {
    struct lacedring_coded* d = &w->coded;
    const uint32_t kind = lacedring_coded_symbol_(d, &w->fork), enters = kind & 3;
    uint32_t x, first_a = enters == 1;
    if (kind & 4) {
        const uint32_t size = lacedring_coded_number_(d, w->size + (enters == 3));
        x = kind & 8 ? a + size : b - size;
    } else {
        x = lacedring_coded_raw_(d, w->bits);
    }
    if (enters == 3) { /* usually the smaller part is first */
        const uint32_t p = x > a ? x - a : UINT32_MAX, q = b > x ? b - x : UINT32_MAX;
        first_a = (p <= q) ^ lacedring_coded_bit_(d, &w->first);
    }
    w->entered = enters != 0;
    if (x >= w->vertices) return x; /* the caller refuses it */
    if (first_a && enters == 3) lacedring_open_edge_(w, x, b);
    if (enters & 1) lacedring_open_edge_(w, a, x);
    if (!first_a && (enters & 2)) lacedring_open_edge_(w, x, b);
    return x;
}

/* Decodes a step of any kind. Returns 0 if it is invalid. */
static int lacedring_any_step_(struct lacedring_steps_* w, uint32_t has_flips, uint32_t* out) {
    struct lacedring_coded* d = &w->coded;
    struct lacedring_turn_models_* models;
    uint32_t a, b, x, most;
    if (!w->goes_on && !lacedring_entry_(w)) return 0;
    a = w->a;
    b = w->b;
    if (a >= w->vertices || b >= w->vertices || a == b) return 0;
    if (has_flips) w->flipped = lacedring_coded_bit_(d, w->flip + w->flipped);
    models = lacedring_turn_models_of_(w, w->around[a], w->around[b], w->around[b > 0 ? b - 1 : 0]);
    if (!w->is_fork && lacedring_coded_bit_(d, &models->simple)) {
        const uint32_t up = b - a == 2 || lacedring_coded_bit_(d, &models->up);
        w->goes_on = b - a != 2;
        w->entered = 0;
        x = up ? a + 1 : b - 1;
        w->a = up ? x : a;
        w->b = up ? b : x;
    } else {
        w->goes_on = w->is_fork = 0;
        x = lacedring_fork_(w, a, b);
    }
    if (x >= w->vertices || x == a || x == b) return 0;
    lacedring_count_at_(w, a);
    lacedring_count_at_(w, b);
    lacedring_count_at_(w, x);
    lacedring_mark_edge_(w, a, x);
    lacedring_mark_edge_(w, x, b);
    lacedring_mark_edge_(w, a, b);
    most = a > b ? a : b;
    if (x > most) most = x;
    if (w->seen <= most) w->seen = most + 1;
    out[0] = a;
    out[1] = w->right ^ w->flipped ? x : b;
    out[2] = w->right ^ w->flipped ? b : x;
    return 1;
}

enum lacedring_status lacedring_stored_packed_decode(const struct lacedring_stored_packed* s, void* scratch,
                                                     uint32_t* triangles, uint64_t* where) {
    struct lacedring_steps_ w;
    struct lacedring_packed p;
    uint32_t i;
    memset(&w, 0, sizeof w);
    memset(&p, 0, sizeof p);
    w.coded = s->steps;
    w.open = (uint32_t*)scratch;
    w.around = (uint8_t*)scratch + 16 * (size_t)s->own;
    memset(w.around, 0, (size_t)s->vertices + 1);
    w.vertices = s->vertices;
    while (w.bits < 32 && s->vertices >> w.bits != 0) ++w.bits;
    lacedring_begin_bits_(w.begins, 2);
    lacedring_begin_bits_(w.deeper, 2);
    lacedring_begin_bits_(&w.drop, 1);
    lacedring_begin_bits_(&w.first, 1);
    lacedring_begin_bits_(w.flip, 2);
    lacedring_begin_bits_(&w.turns[0].simple, 2 * sizeof w.turns / sizeof w.turns[0]);
    lacedring_begin_symbols_(&w.tree, 1);
    lacedring_begin_symbols_(&w.fork, 1);
    lacedring_begin_symbols_(&w.tree_size, 1);
    lacedring_begin_symbols_(&w.depth, 1);
    lacedring_begin_symbols_(w.size, 2);
    for (i = 0; i < s->own; ++i) {
        if (w.goes_on && !s->has_flips && w.a < w.b && w.b < w.vertices) {
            i = lacedring_simple_steps_(&w, i, s->own, triangles + 3 * (size_t)i);
            if (i == s->own) break;
        }
        if (!lacedring_any_step_(&w, s->has_flips, triangles + 3 * (size_t)i))
            return lacedring_at_(where, i, LACEDRING_STATUS_TRIANGLE);
    }
    if (w.goes_on || !lacedring_coded_ends_(&w.coded)) return lacedring_at_(where, 0, LACEDRING_STATUS_CODED);
    p.triangles = s->triangles;
    p.runs = s->runs;
    p.doubles = s->doubles;
    lacedring_write_doubles_(&p, triangles);
    return LACEDRING_STATUS_OK;
}

/* Vertex streams. */

#define LACEDRING_STORED_PART_ 65536u /* vertices per coded part of blocks */
/* Steps of a residual's expected size, half a bit each. */
#define LACEDRING_STORED_STEPS_ 32u
#define LACEDRING_SOME_VERTICES_ 128u /* vertices per call of lacedring_walk_some_ */
/* States of vertices. */
#define LACEDRING_KNOWN_ 0xfffffffeu
#define LACEDRING_UNSEEN_ UINT32_MAX
/* Flag of a vertex's state: its list has more than one corner. */
#define LACEDRING_MORE_ 0x80000000u

enum { LACEDRING_BY_PARALLELOGRAMS_, LACEDRING_BY_MEAN_, LACEDRING_BY_NEIGHBOR_, LACEDRING_BY_NOTHING_ };

static enum lacedring_status lacedring_stored_header_(struct lacedring_stored_vertices* s, struct lacedring_coded* d,
                                                      uint64_t* where) {
    const uint32_t layout = lacedring_coded_raw_(d, 23), n = layout & 31, mapping = layout >> 5 & 7;
    uint32_t step = 0, error = 0, wrong, c;
    if (mapping == LACEDRING_MAPPING_LATTICE) step = lacedring_coded_raw_(d, 32);
    if (mapping == LACEDRING_MAPPING_DECIMALS) step = lacedring_coded_raw_(d, 4);
    if (mapping == LACEDRING_MAPPING_LATTICE || mapping == LACEDRING_MAPPING_OCTAHEDRAL)
        error = lacedring_coded_raw_(d, 32);
    wrong = lacedring_vertex_layout_(&s->attribute, layout, step, error);
    if (wrong != 0) return lacedring_at_(where, wrong, LACEDRING_STATUS_HEADER);
    s->has_ranges = !lacedring_coded_raw_(d, 1);
    for (c = 0; c < n; ++c) {
        lacedring_coded_raw_(d, 10); /* blocks' first width and usual predictor: unused here */
        if (!s->has_ranges) continue;
        s->low[c] = lacedring_coded_raw_(d, 32);
        s->range_bits[c] = lacedring_coded_raw_(d, 6);
        if (s->range_bits[c] > 32)
            return lacedring_at_(where, LACEDRING_VERTICES_HEADER_WORDS, LACEDRING_STATUS_HEADER);
    }
    for (c = 0; c < n; ++c) s->rules[c] = (uint8_t)lacedring_coded_raw_(d, 2);
    s->by_normal = lacedring_coded_raw_(d, 1);
    s->error = lacedring_coded_raw_(d, 4);
    s->smooth = lacedring_coded_raw_(d, 5);
    s->fine = lacedring_coded_raw_(d, 4);
    s->by_positions = n == 2 && lacedring_coded_raw_(d, 1);
    if (s->by_positions && mapping == LACEDRING_MAPPING_OCTAHEDRAL) {
        s->by_angle = lacedring_coded_raw_(d, 1);
        s->by_area = lacedring_coded_raw_(d, 1);
        s->of_vertex = lacedring_coded_raw_(d, 1);
    }
    if (s->smooth > 16 || (s->by_normal && n != 3))
        return lacedring_at_(where, LACEDRING_VERTICES_HEADER_WORDS, LACEDRING_STATUS_HEADER);
    return d->bit <= d->end ? LACEDRING_STATUS_OK : lacedring_at_(where, 0, LACEDRING_STATUS_CODED);
}

enum lacedring_status lacedring_stored_vertices_open(const uint32_t* words, size_t count, uint32_t vertices,
                                                     struct lacedring_stored_vertices* s, uint64_t* where) {
    uint32_t parts = vertices / LACEDRING_STORED_PART_ + (vertices % LACEDRING_STORED_PART_ != 0);
    size_t at;
    memset(s, 0, sizeof *s);
    s->attribute.vertices = vertices;
    if (count == 0 || words[0] > count - 1 || !lacedring_open_coded_(&s->residuals, words + 1, words[0]))
        return lacedring_at_(where, 0, LACEDRING_STATUS_SIZE);
    for (at = 1 + (size_t)words[0]; parts > 0; --parts) { /* skips the parts of blocks */
        if (at == count || words[at] > count - at - 1) return lacedring_at_(where, at, LACEDRING_STATUS_SIZE);
        at += 1 + (size_t)words[at];
    }
    if (at != count) return lacedring_at_(where, at, LACEDRING_STATUS_SIZE);
    return lacedring_stored_header_(s, &s->residuals, where);
}

/* The models of one component's residuals. */
struct lacedring_residual_models_ {
    struct lacedring_symbol_model_ steps[LACEDRING_STORED_STEPS_], others;
    uint32_t level; /* mean size of the last residuals, in 1/128 bit */
};

/* Decodes residuals, in the order in which vertices become known. */
struct lacedring_residuals_ {
    struct lacedring_coded coded;
    struct lacedring_residual_models_* models;
    uint32_t fine;
};

/* Decodes the n residuals of a vertex, still folded. Uses `d`, which stays in registers, in place of r->coded. */
LACEDRING_HOT_ void lacedring_next_residuals_(struct lacedring_residuals_* r, struct lacedring_coded* d, uint32_t n,
                                              uint32_t* out) {
    /* A symbol stands for a range of numbers: its begin, the raw bits that select a number in it, and a size in 1/128
       bit. */
    static const uint16_t begin[16] = {0, 1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 64, 128, 256, 512, 0};
    static const uint8_t bits[16] = {0, 0, 0, 0, 1, 1, 2, 2, 3, 3, 5, 6, 7, 8, 9, 0};
    static const uint16_t size[16] = {0, 256, 352, 400, 464, 512, 576, 640, 704, 768, 864, 992, 1120, 1248, 1376, 0};
    uint32_t c, before = 0, second = 0; /* levels of the last two residuals */
    for (c = 0; c < n; ++c) {
        struct lacedring_residual_models_* m = r->models + c;
        uint32_t low, symbol, level;
        uint32_t step = c == 0             ? m->level / 64
                        : c == 2 && n == 3 ? (10 * m->level + 3 * (before + second)) / 1024
                                           : (m->level + before) / 128;
        if (step >= LACEDRING_STORED_STEPS_) step = LACEDRING_STORED_STEPS_ - 1;
        low = step > r->fine ? (step - r->fine + 1) / 2 : 0;
        symbol = lacedring_coded_symbol_(d, m->steps + step);
        second = before;
        if (symbol == 15) {
            before = m->level;
            r->coded = *d;
            out[c] = lacedring_coded_number_(&r->coded, &m->others);
            *d = r->coded;
            continue;
        }
        level = size[symbol] + 128 * low;
        before = level > 128 ? level - 128 : 0;
        m->level += (uint32_t)((int32_t)(before - m->level) * 3 >> 4);
        out[c] = ((uint32_t)begin[symbol] << low) + lacedring_coded_raw_(d, bits[symbol] + low);
    }
}

/* The walk has four words per triangle: for each of the three corners its opposite corner, and a fourth that is 0, or,
   if the triangle is complete, 1 or a link with the lowest bit set. A corner is numbered by its word: 4 t + k. */
#define LACEDRING_COMPLETE_ 3u /* the fourth word of a triangle */
#define LACEDRING_NONE_ UINT32_MAX

/* The index of a corner's vertex in an array of three vertices per triangle. */
LACEDRING_HOT_ size_t lacedring_of_corner_(uint32_t corner) {
    return corner - (corner >> 2);
}

/* Corners that wait for an opposite corner. A corner that faces an edge (v, v + 1) is in a table; any other is in a
   list of the edge's smaller vertex. */
struct lacedring_pairs_ {
    const uint32_t* triangles;
    uint32_t* opposite;
    uint32_t* ring; /* per vertex v: a corner that faces edge (v, v + 1) */
    /* For each vertex, the last corner of its circular list. The word `opposite` of a listed corner is the next corner;
       after the last comes the first. */
    uint32_t* last;
};

/* Pairs a corner with the waiting corner of its edge, or makes it wait. */
LACEDRING_HOT_ void lacedring_pair_corner_(const struct lacedring_pairs_* p, uint32_t corner) {
    const uint32_t k = corner & 3, *t = p->triangles + lacedring_of_corner_(corner - k);
    const uint32_t x = t[k == 0 ? 1 : 0], y = t[k == 2 ? 1 : 2], smaller = x < y ? x : y;
    uint32_t* const opposite = p->opposite;
    if (x - y == 1 || y - x == 1) {
        const uint32_t other = p->ring[smaller], is_pair = other != LACEDRING_NONE_; /* unpredictable: no branch */
        opposite[corner] = other;
        opposite[is_pair ? other : corner] = is_pair ? corner : LACEDRING_NONE_;
        p->ring[smaller] = is_pair ? LACEDRING_NONE_ : corner;
    } else {
        const uint32_t last = p->last[smaller];
        p->last[smaller] = corner;
        opposite[corner] = last == LACEDRING_NONE_ ? corner : opposite[last];
        if (last != LACEDRING_NONE_) opposite[last] = corner;
    }
}

/* Finds the vertices that two triangles share. Bit k: v[k] is in `before`. Bit 3 + k: before[k] is in `v`. */
LACEDRING_HOT_ uint32_t lacedring_shared_(const uint32_t v[3], const uint32_t before[3]) {
#ifdef LACEDRING_SSE2_
    const __m128i now = _mm_set_epi32(0, (int)v[2], (int)v[1], (int)v[0]);
    const __m128i then = _mm_set_epi32(0, (int)before[2], (int)before[1], (int)before[0]);
    const __m128i same = _mm_cmpeq_epi32(now, then);
    const __m128i by_1 = _mm_cmpeq_epi32(now, _mm_shuffle_epi32(then, 0xc9));
    const __m128i by_2 = _mm_cmpeq_epi32(now, _mm_shuffle_epi32(then, 0xd2));
    const __m128i here = _mm_or_si128(_mm_or_si128(by_1, by_2), same);
    const __m128i there =
        _mm_or_si128(_mm_or_si128(_mm_shuffle_epi32(by_1, 0xd2), _mm_shuffle_epi32(by_2, 0xc9)), same);
    return ((uint32_t)_mm_movemask_ps(_mm_castsi128_ps(here)) & 7) |
           ((uint32_t)_mm_movemask_ps(_mm_castsi128_ps(there)) & 7) << 3;
#else
    uint32_t i, shared = 0;
    for (i = 0; i < 3; ++i) {
        shared |= (uint32_t)((v[i] == before[0]) | (v[i] == before[1]) | (v[i] == before[2])) << i;
        shared |= (uint32_t)((before[i] == v[0]) | (before[i] == v[1]) | (before[i] == v[2])) << (3 + i);
    }
    return shared;
#endif
}

/* Fills the words of all triangles, and finds opposite corners. `scratch`: four words per vertex. Returns the number of
   a triangle with a vertex out of range, or `count`. */
LACEDRING_COLD_ uint32_t lacedring_pair_corners_(const uint32_t* triangles, uint32_t count, uint32_t vertices,
                                                 uint32_t* opposite, uint32_t* scratch) {
    struct lacedring_pairs_ p;
    /* For an edge's larger vertex: its smaller vertex, and the corner that waits. */
    uint32_t* edges = scratch + 2 * (size_t)vertices;
    /* Index: three bits. If exactly one of them is 0, its number; else 3. */
    static const uint8_t alone[8] = {3, 3, 3, 2, 3, 1, 0, 3};
    uint32_t i, c, k, v;
    /* The triangle before: its vertices; its corner paired with the triangle before it, or 3; are its vertices
       different. */
    uint32_t before[3] = {0, 0, 0}, paired = 3, is_good = 0;
    p.triangles = triangles;
    p.opposite = opposite;
    p.ring = scratch;
    p.last = scratch + vertices;
    memset(scratch, 0xff, 16 * (size_t)vertices);
    for (i = 0; i <= count; ++i, triangles += 3) {
        uint32_t paired_now = 3, behind = 3, is_good_now = 0;
        c = 4 * i;
        if (i < count) {
            const uint32_t now[3] = {triangles[0], triangles[1], triangles[2]};
            if (now[0] >= vertices || now[1] >= vertices || now[2] >= vertices) return i;
            is_good_now = !((now[0] == now[1]) | (now[1] == now[2]) | (now[2] == now[0]));
            opposite[c] = opposite[c + 1] = opposite[c + 2] = LACEDRING_NONE_;
            opposite[c + LACEDRING_COMPLETE_] = 0;
            if (is_good & is_good_now) {
                const uint32_t shared = lacedring_shared_(now, before), from = alone[shared >> 3];
                k = alone[shared & 7];
                if (k != 3 && from != paired) {
                    paired_now = k;
                    behind = from;
                    opposite[c + k] = c - 4 + from;
                    opposite[c - 4 + from] = c + k;
                }
            }
            before[0] = now[0];
            before[1] = now[1];
            before[2] = now[2];
        }
        if (is_good) { /* corners of the triangle before that are still unpaired: mostly one */
            if (paired + behind <= 3 && paired != 3 && behind != 3) {
                lacedring_pair_corner_(&p, c - 4 + (3 - paired - behind));
            } else {
                for (k = 0; k < 3; ++k) {
                    if (k != paired && k != behind) lacedring_pair_corner_(&p, c - 4 + k);
                }
            }
        }
        paired = paired_now;
        is_good = is_good_now;
    }
    for (v = 0; v < vertices; ++v) {
        const uint32_t last = p.last[v];
        uint32_t next;
        if (last == LACEDRING_NONE_) continue;
        for (c = opposite[last];; c = next) {
            const uint32_t k_of = c & 3, *t = p.triangles + lacedring_of_corner_(c - k_of);
            const uint32_t larger = t[0] ^ t[1] ^ t[2] ^ t[k_of] ^ v;
            uint32_t* edge = edges + 2 * (size_t)larger;
            const uint32_t other = edge[1], is_pair = edge[0] == v;
            next = opposite[c];
            opposite[c] = is_pair ? other : LACEDRING_NONE_;
            opposite[is_pair ? other : c] = is_pair ? c : LACEDRING_NONE_;
            edge[0] = is_pair ? LACEDRING_NONE_ : v;
            edge[1] = c;
            if (c == last) break;
        }
    }
    return count;
}

/* How vertex v becomes known. Predicted by two corners (or by one, given twice): x and y are the other two vertices of
   the corner's triangle, z is the vertex of its opposite corner. As a start: x[0] is LACEDRING_NONE_, and y[0] is the
   vertex it comes from. */
struct lacedring_visit_ {
    uint32_t v, x[2], y[2], z[2];
};

/* The walk that finds the order of vertices (docs/storage-format.md, "The order of vertices"). */
struct lacedring_walk_ {
    const uint32_t* of; /* vertices of triangles, three each */
    /* Opposite corners. When a corner was looked across, its word becomes the next corner of the vertex's list. */
    uint32_t* opposite;
    /* For each vertex: LACEDRING_KNOWN_, LACEDRING_UNSEEN_, or the first corner of its list, with LACEDRING_MORE_ if it
       has more. */
    uint32_t* state;
    /* Queues of vertices that wait, with one corner and with more. */
    const uint32_t *one, *two;
    uint32_t *one_end, *two_end;
    /* A stack of complete triangles that were not yet looked across, linked by their fourth words. */
    uint32_t pending;
    /* The next triangle that may begin a component, and the number of triangles. */
    uint32_t triangle, triangles;
    /* The next vertex that may have no triangle, and the number of vertices. */
    uint32_t vertex, vertices;
    uint32_t last; /* the vertex that became known last */
};

/* Marks a triangle complete, and puts it on the stack. */
LACEDRING_HOT_ void lacedring_complete_(struct lacedring_walk_* w, uint32_t triangle) {
    w->opposite[triangle + LACEDRING_COMPLETE_] = w->pending | 1;
    w->pending = triangle;
}

/* Looks across a corner of a complete triangle. If the opposite corner's vertex is known, its triangle becomes
   complete; else that corner is put in front of the vertex's list. */
LACEDRING_HOT_ void lacedring_look_across_(struct lacedring_walk_* w, uint32_t corner) {
    uint32_t* opposite = w->opposite;
    const uint32_t across = opposite[corner], k = across & 3, triangle = across - k;
    uint32_t v, state;
    if (across == LACEDRING_NONE_) return;
    v = w->of[lacedring_of_corner_(across)];
    state = w->state[v];
    if (state == LACEDRING_KNOWN_) {
        if (!opposite[triangle + LACEDRING_COMPLETE_]) lacedring_complete_(w, triangle);
    } else { /* no branches: they would be unpredictable */
        const uint32_t is_first = state == LACEDRING_UNSEEN_, is_second = !(state & LACEDRING_MORE_);
        const uint32_t* next = opposite + triangle;
        opposite[corner] = is_first ? LACEDRING_NONE_ : state & ~LACEDRING_MORE_;
        w->state[v] = is_first ? across : across | LACEDRING_MORE_;
        *(is_first ? w->one_end : w->two_end) = v;
        w->one_end += is_first;
        w->two_end += is_second;
        LACEDRING_PREFETCH_(opposite + next[k == 2 ? 0 : k + 1]); /* these will be looked at next */
        LACEDRING_PREFETCH_(opposite + next[k == 0 ? 2 : k - 1]);
    }
}

/* The next corner of a vertex's list, or LACEDRING_NONE_. The entry of the opposite corner, which is not needed any
   more, stores it. */
LACEDRING_HOT_ uint32_t lacedring_corner_behind_(const struct lacedring_walk_* w, uint32_t corner) {
    return w->opposite[w->opposite[corner]];
}

/* Sets x, y and z of prediction i from a corner. */
LACEDRING_HOT_ void lacedring_predict_by_(const struct lacedring_walk_* w, uint32_t corner, uint32_t i,
                                          struct lacedring_visit_* visit) {
    const uint32_t k = corner & 3, *t = w->of + lacedring_of_corner_(corner - k);
    visit->x[i] = t[k == 2 ? 0 : k + 1];
    visit->y[i] = t[k == 0 ? 2 : k - 1];
    visit->z[i] = w->of[lacedring_of_corner_(w->opposite[corner])];
}

/* Makes vertex v known as a start that comes from `from`. */
LACEDRING_HOT_ struct lacedring_visit_* lacedring_start_(struct lacedring_walk_* w, uint32_t v, uint32_t from,
                                                         struct lacedring_visit_* visit) {
    visit->v = v;
    visit->x[0] = LACEDRING_NONE_;
    visit->y[0] = from;
    w->state[v] = LACEDRING_KNOWN_;
    return visit + 1;
}

/* Finds the next vertices, up to most + 2. Returns their number; 0: all are known. */
LACEDRING_COLD_ uint32_t lacedring_walk_some_(struct lacedring_walk_* begin, struct lacedring_visit_* visits,
                                              uint32_t most) {
    struct lacedring_walk_ walk = *begin, *w = &walk; /* a copy, to stay in registers */
    struct lacedring_visit_* visit = visits;
    uint32_t c, i, k, second;
    for (;;) {
        uint32_t v = LACEDRING_NONE_;
        while (w->pending != LACEDRING_NONE_) {
            c = w->pending;
            w->pending = w->opposite[c + LACEDRING_COMPLETE_];
            w->pending -= w->pending != LACEDRING_NONE_;
            for (k = 0; k < 3; ++k) lacedring_look_across_(w, c + k);
        }
        if (visit >= visits + most) break;
        if (w->two < w->two_end) {
            v = *w->two++;
        } else {
            while (w->one < w->one_end && v == LACEDRING_NONE_) {
                v = *w->one++;
                if (w->state[v] == LACEDRING_KNOWN_) v = LACEDRING_NONE_;
            }
        }
        if (v != LACEDRING_NONE_) {
            c = w->state[v] & ~LACEDRING_MORE_;
            second = lacedring_corner_behind_(w, c);
            visit->v = w->last = v;
            lacedring_predict_by_(w, c, 0, visit);
            lacedring_predict_by_(w, second != LACEDRING_NONE_ ? second : c, 1, visit);
            ++visit;
            w->state[v] = LACEDRING_KNOWN_;
            for (i = c; i != LACEDRING_NONE_; i = lacedring_corner_behind_(w, i))
                w->opposite[i | LACEDRING_COMPLETE_] = 1;
            for (;;) {
                k = c & 3;
                lacedring_look_across_(w, k == 2 ? c - 2 : c + 1);
                lacedring_look_across_(w, k == 0 ? c + 2 : c - 1);
                if (second == LACEDRING_NONE_) break;
                c = second;
                second = lacedring_corner_behind_(w, c);
            }
        } else if (w->triangle < w->triangles) { /* starts at this triangle if it is not complete */
            const uint32_t *t = w->of + 3 * (size_t)w->triangle, next = 4 * w->triangle++;
            uint32_t from = LACEDRING_NONE_;
            if (w->opposite[next + LACEDRING_COMPLETE_] || t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
            for (k = 0; k < 3; ++k) {
                if (w->state[t[k]] == LACEDRING_KNOWN_) from = t[k];
            }
            for (k = 0; k < 3; ++k) {
                if (w->state[t[k]] == LACEDRING_KNOWN_) continue;
                visit = lacedring_start_(w, t[k], from == LACEDRING_NONE_ ? w->last : from, visit);
                w->last = from = t[k];
            }
            lacedring_complete_(w, next);
        } else if (w->vertex < w->vertices) {
            v = w->vertex++;
            if (w->state[v] == LACEDRING_KNOWN_) continue;
            visit = lacedring_start_(w, v, w->last, visit);
            w->last = v;
        } else {
            break;
        }
    }
    *begin = walk;
    return (uint32_t)(visit - visits);
}

/* "Places" are the positions less the least coordinates, scaled to 20 bits, so that products of three are exact as
 * doubles. */
struct lacedring_places_ {
    const struct lacedring_positions* positions;
    uint32_t low[3], shift;
};

static void lacedring_scale_places_(const struct lacedring_positions* positions, struct lacedring_places_* out) {
    uint32_t c, v, extent = 0;
    out->positions = positions;
    for (c = 0; c < 3; ++c) {
        int32_t low = INT32_MAX, high = INT32_MIN;
        for (v = 0; v < positions->vertices; ++v) {
            const int32_t x = (int32_t)positions->integers[3 * (size_t)v + c];
            low = x < low ? x : low;
            high = x > high ? x : high;
        }
        out->low[c] = (uint32_t)low;
        extent |= (uint32_t)high - (uint32_t)low;
    }
    for (out->shift = 0; extent >> out->shift >= 1u << 20;) ++out->shift;
}

/* Sets out to the scaled position of element `value` of the attribute. */
LACEDRING_HOT_ void lacedring_place_(const struct lacedring_places_* p, uint32_t value, double out[3]) {
    const uint32_t* of = p->positions->vertex_of;
    const uint32_t* at = p->positions->integers + 3 * (size_t)(of != NULL ? of[value] : value);
    uint32_t c;
    for (c = 0; c < 3; ++c) out[c] = (int32_t)((at[c] - p->low[c]) >> p->shift);
}

/* Square of a vector's length, with components below 2^53. Rounds each component to a float first: its square is then
   exact, and fused multiply-add changes nothing. */
LACEDRING_HOT_ double lacedring_square_(const double v[3]) {
    const double x = (double)(float)v[0], y = (double)(float)v[1], z = (double)(float)v[2];
    return x * x + y * y + z * z;
}

LACEDRING_HOT_ void lacedring_cross_(const double a[3], const double b[3], double out[3]) {
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

LACEDRING_HOT_ double lacedring_dot_(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Predicts the texture coordinates of v by continuing the map of triangle (x, y, z): folds triangle (x, y, v) into its
   plane, where v = x + along (y - x) - across (z - x), with `along` and `across` in 1/65536. */
LACEDRING_HOT_ void lacedring_extend_(const struct lacedring_places_* p, const double v[3], uint32_t x, uint32_t y,
                                      uint32_t z, const uint32_t* values, uint32_t out[2]) {
    const double most = 1 << 20;
    double origin[3], edge[3], to_v[3], to_z[3], cross[3], height;
    int64_t along = 65536, across = 65536; /* a parallelogram, if x, y, z are collinear */
    uint32_t c;
    lacedring_place_(p, x, origin);
    lacedring_place_(p, y, edge);
    lacedring_place_(p, z, to_z);
    for (c = 0; c < 3; ++c) {
        edge[c] -= origin[c];
        to_z[c] -= origin[c];
        to_v[c] = v[c] - origin[c];
    }
    lacedring_cross_(edge, to_z, cross);
    height = lacedring_square_(cross);
    if (height > 0) {
        double heights, sum;
        lacedring_cross_(edge, to_v, cross);
        heights = 65536 * sqrt(lacedring_square_(cross) / height) + 0.5;
        across = (int64_t)(heights < most ? heights : most);
        sum = (double)(65536 * (int64_t)lacedring_dot_(edge, to_v) + across * (int64_t)lacedring_dot_(edge, to_z));
        sum /= lacedring_dot_(edge, edge);
        along = (int64_t)(sum < -most ? -most : sum > most ? most : sum);
    }
    for (c = 0; c < 2; ++c) {
        const uint32_t from = values[2 * (size_t)x + c];
        const int64_t to_y = (int32_t)(values[2 * (size_t)y + c] - from);
        out[c] = from + (uint32_t)((along * to_y - across * (int32_t)(values[2 * (size_t)z + c] - from) + 32768) >> 16);
    }
}

/* Adds the prediction by places to the difference of a vertex: two integers. */
LACEDRING_HOT_ void lacedring_add_place_(const struct lacedring_places_* p, const struct lacedring_visit_* visit,
                                         const uint32_t* differences, uint32_t* values) {
    const size_t at = 2 * (size_t)visit->v;
    uint32_t base[2] = {0, 0}, other[2], c;
    if (visit->x[0] != LACEDRING_NONE_) {
        double v[3];
        lacedring_place_(p, visit->v, v);
        lacedring_extend_(p, v, visit->x[0], visit->y[0], visit->z[0], values, base);
        if (visit->x[0] != visit->x[1] || visit->y[0] != visit->y[1] || visit->z[0] != visit->z[1]) {
            lacedring_extend_(p, v, visit->x[1], visit->y[1], visit->z[1], values, other);
            for (c = 0; c < 2; ++c) base[c] += (uint32_t)(((int64_t)(int32_t)(other[c] - base[c]) + 1) >> 1);
        }
    } else if (visit->y[0] != LACEDRING_NONE_) {
        for (c = 0; c < 2; ++c)
            base[c] = values[2 * (size_t)visit->y[0] + c] - differences[2 * (size_t)visit->y[0] + c];
    }
    for (c = 0; c < 2; ++c) values[at + c] = differences[at + c] + base[c];
}

/* Turns residuals into integers. */
struct lacedring_predictor_ {
    const struct lacedring_stored_vertices* s;
    uint32_t* integers;
    /* For each integer, its difference from the parallelogram prediction; null: not needed. */
    uint32_t* errors;
    uint32_t is_plain; /* all components are predicted by parallelograms */
    /* Null, or the places that predict: then `integers` are differences from predictions by places. */
    const struct lacedring_places_* places;
    uint32_t* values;
};

LACEDRING_HOT_ uint32_t lacedring_unfold_(uint32_t code) {
    return code >> 1 ^ (0u - (code & 1));
}

/* x / 2^bits, rounded to the nearest integer, halves up. Right shifts keep the sign. */
LACEDRING_HOT_ uint32_t lacedring_rounded_(int64_t x, uint32_t bits) {
    return (uint32_t)((x + ((int64_t)1 << (bits - 1))) >> bits);
}

/* Adds the cross product (y - x) x (z - x) to a normal, modulo 2^64. */
LACEDRING_HOT_ void lacedring_add_normal_(const uint32_t* x, const uint32_t* y, const uint32_t* z, uint64_t normal[3]) {
    uint64_t a[3], b[3];
    uint32_t c;
    for (c = 0; c < 3; ++c) {
        a[c] = (uint64_t)(int64_t)(int32_t)(y[c] - x[c]);
        b[c] = (uint64_t)(int64_t)(int32_t)(z[c] - x[c]);
    }
    normal[0] += a[1] * b[2] - a[2] * b[1];
    normal[1] += a[2] * b[0] - a[0] * b[2];
    normal[2] += a[0] * b[1] - a[1] * b[0];
}

/* A component of a normal divided by 2^shift, times a difference clamped to 16 bits. */
LACEDRING_HOT_ int32_t lacedring_slope_(uint64_t normal, uint32_t shift, uint32_t difference) {
    const int32_t x = (int32_t)difference, cut = x > 32767 ? 32767 : x < -32767 ? -32767 : x;
    return (int32_t)((int64_t)normal >> shift) * cut;
}

/* Number of bits of x, which is not 0. */
LACEDRING_HOT_ uint32_t lacedring_width_(uint64_t x) {
#if defined(__GNUC__) && !defined(LACEDRING_PLAIN)
    return 64 - (uint32_t)__builtin_clzll(x);
#else
    uint32_t n = 0;
    for (; x != 0; x >>= 1) ++n;
    return n;
#endif
}

/* Decodes three integers by the normal. The component in which the normal is largest comes last: it is predicted on the
   plane through the prediction. */
LACEDRING_HOT_ void lacedring_by_normal_(const uint64_t normal[3], const uint32_t* moved, const uint32_t* residual,
                                         uint32_t* out) {
    static const uint8_t next[3] = {1, 2, 0};
    uint64_t size[3];
    uint32_t c, k, u, w, width, shift, up, across[2];
    int32_t nk;
    for (c = 0; c < 3; ++c) size[c] = normal[c] >> 63 ? 0 - normal[c] : normal[c];
    k = size[1] > size[0];
    k = size[2] > size[k] ? 2 : k;
    u = next[k];
    w = next[u];
    across[0] = lacedring_unfold_(residual[0]);
    across[1] = lacedring_unfold_(residual[1]);
    out[u] = moved[u] + across[0];
    out[w] = moved[w] + across[1];
    width = lacedring_width_(size[k] | 1);
    shift = width > 14 ? width - 14 : 0;
    nk = (int32_t)((int64_t)normal[k] >> shift);
    up = (uint32_t)((lacedring_slope_(normal[u], shift, across[0]) + lacedring_slope_(normal[w], shift, across[1])) /
                    (nk == 0 ? 1 : nk)); /* if nk is 0, so are the others */
    out[k] = moved[k] - up + lacedring_unfold_(residual[2]);
}

/* Predicts a vertex and sets its integers and errors. */
LACEDRING_HOT_ void lacedring_predict_(const struct lacedring_predictor_* p, uint32_t n,
                                       const struct lacedring_visit_* visit, const uint32_t* residual) {
    const uint32_t* a[3] = {p->integers + (size_t)visit->x[0] * n, p->integers + (size_t)visit->y[0] * n,
                            p->integers + (size_t)visit->z[0] * n};
    const uint32_t* b[3] = {p->integers + (size_t)visit->x[1] * n, p->integers + (size_t)visit->y[1] * n,
                            p->integers + (size_t)visit->z[1] * n};
    const size_t at = (size_t)visit->v * n;
    uint32_t plain[LACEDRING_VERTICES_MAX_COMPONENTS], moved[LACEDRING_VERTICES_MAX_COMPONENTS], c;
    uint32_t* out = p->integers + at;
    for (c = 0; c < n; ++c) {
        const uint32_t first = a[0][c] + a[1][c] - a[2][c];
        plain[c] = moved[c] = first + lacedring_rounded_((int32_t)(b[0][c] + b[1][c] - b[2][c] - first), 1);
    }
    if (!p->is_plain) {
        for (c = 0; c < n; ++c) {
            const uint32_t rule = p->s->rules[c];
            const int32_t to_mean = (int32_t)(a[0][c] + a[1][c] + b[0][c] + b[1][c] - 4 * plain[c]);
            if (rule == LACEDRING_BY_MEAN_) moved[c] += lacedring_rounded_(to_mean, 2);
            if (rule == LACEDRING_BY_NEIGHBOR_) moved[c] = a[0][c];
            if (rule == LACEDRING_BY_NOTHING_) moved[c] = 0;
        }
    } else if (p->s->smooth != 0 || p->errors != NULL) {
        for (c = 0; c < n; ++c) {
            int64_t move = (int32_t)(a[0][c] + a[1][c] + b[0][c] + b[1][c] - 4 * plain[c]);
            move *= p->s->smooth;
            if (p->errors != NULL) {
                const uint32_t of[4] = {visit->x[0], visit->y[0], visit->x[1], visit->y[1]};
                uint32_t i;
                for (i = 0; i < 4; ++i) move += (int64_t)(int32_t)p->errors[(size_t)of[i] * n + c] * p->s->error;
            }
            moved[c] += lacedring_rounded_(move, 6);
        }
    }
    if (n == 3 && p->s->by_normal) {
        uint64_t normal[3] = {0, 0, 0};
        lacedring_add_normal_(a[0], a[1], a[2], normal);
        lacedring_add_normal_(b[0], b[1], b[2], normal);
        lacedring_by_normal_(normal, moved, residual, out);
    } else {
        for (c = 0; c < n; ++c) out[c] = moved[c] + lacedring_unfold_(residual[c]);
    }
    for (c = 0; c < n && p->errors != NULL; ++c) p->errors[at + c] = out[c] - plain[c];
}

/* Decodes all integers. lacedring_integers_ passes n up to 3 as a constant, so that the compiler unrolls loops. */
LACEDRING_HOT_ void lacedring_integers_n_(const struct lacedring_predictor_* p, struct lacedring_walk_* walk,
                                          struct lacedring_residuals_* residuals, uint32_t n) {
    struct lacedring_visit_ visits[LACEDRING_SOME_VERTICES_];
    struct lacedring_coded d = residuals->coded;
    uint32_t i, c, count, residual[LACEDRING_VERTICES_MAX_COMPONENTS];
    while ((count = lacedring_walk_some_(walk, visits, LACEDRING_SOME_VERTICES_ - 2)) > 0) {
        for (i = 0; i < count; ++i) {
            const struct lacedring_visit_* visit = visits + i;
            lacedring_next_residuals_(residuals, &d, n, residual);
            if (visit->x[0] != LACEDRING_NONE_) {
                lacedring_predict_(p, n, visit, residual);
            } else {
                const uint32_t from = visit->y[0];
                for (c = 0; c < n; ++c)
                    p->integers[(size_t)visit->v * n + c] =
                        (from == LACEDRING_NONE_ ? 0 : p->integers[(size_t)from * n + c]) +
                        lacedring_unfold_(residual[c]);
            }
            if (n == 2 && p->places != NULL) lacedring_add_place_(p->places, visit, p->integers, p->values);
        }
    }
    residuals->coded = d;
}

LACEDRING_COLD_ void lacedring_integers_(const struct lacedring_predictor_* p, struct lacedring_walk_* walk,
                                         struct lacedring_residuals_* residuals, uint32_t n) {
    if (n == 1) {
        lacedring_integers_n_(p, walk, residuals, 1);
    } else if (n == 2) {
        lacedring_integers_n_(p, walk, residuals, 2);
    } else if (n == 3) {
        lacedring_integers_n_(p, walk, residuals, 3);
    } else {
        lacedring_integers_n_(p, walk, residuals, n);
    }
}

/* Steps of the table of angles, up to 45 degrees. */
#define LACEDRING_TANGENTS_ 4096
#define LACEDRING_HALF_TURN_ 16384 /* half a turn, in units of angles */

/* Fills the table: the angles with tangents i / LACEDRING_TANGENTS_, rounded. */
static void lacedring_angles_(uint16_t* out) {
    const double step = 1.0 / LACEDRING_TANGENTS_;
    double angle = 0;
    uint32_t i;
    for (i = 0; i <= LACEDRING_TANGENTS_; ++i) {
        /* The tangent of the angle to the next entry. */
        const double d = step / (1 + (double)i * (i + 1) * step * step), square = d * d;
        out[i] = (uint16_t)(angle * LACEDRING_HALF_TURN_ / 3.14159265358979323846 + 0.5);
        angle += d * (1 - square * (1.0 / 3 - square * (1.0 / 5)));
    }
}

/* Adds the normal of each triangle, weighted, to the sums of its three vertices: three components each. */
static void lacedring_sum_normals_(const struct lacedring_stored_vertices* s, const struct lacedring_places_* p,
                                   const uint32_t* triangles, uint32_t count, const uint32_t* vertex_of,
                                   const uint16_t* angles, uint64_t* sums) {
    uint32_t i, c, k;
    for (i = 0; i < count; ++i, triangles += 3) {
        double at[3][3], a[3], b[3], normal[3], cosine[3], length, ab;
        for (k = 0; k < 3; ++k) lacedring_place_(p, triangles[k], at[k]);
        for (c = 0; c < 3; ++c) {
            a[c] = at[1][c] - at[0][c];
            b[c] = at[2][c] - at[1][c];
        }
        lacedring_cross_(a, b, normal);
        length = lacedring_square_(normal);
        length = sqrt(length < 1 ? 1 : length);
        ab = lacedring_dot_(a, b);
        cosine[0] = lacedring_dot_(a, a) + ab; /* cosines scaled so that `length` is the sine */
        cosine[1] = -ab;
        cosine[2] = lacedring_dot_(b, b) + ab;
        if (!s->by_area) {
            const double by = 32768 / length;
            for (c = 0; c < 3; ++c) normal[c] = (double)(int32_t)(normal[c] * by);
        }
        for (k = 0; k < 3; ++k) {
            uint64_t* sum = sums + 3 * (size_t)(vertex_of != NULL ? vertex_of[triangles[k]] : triangles[k]);
            int32_t weight = 1;
            if (s->by_angle) {
                const double x = cosine[k] < 0 ? -cosine[k] : cosine[k], most = x > length ? x : length;
                weight = angles[(uint32_t)(LACEDRING_TANGENTS_ * (x > length ? length : x) / most + 0.5)];
                if (x < length) weight = LACEDRING_HALF_TURN_ / 2 - weight;
                if (cosine[k] < 0) weight = LACEDRING_HALF_TURN_ - weight;
            }
            for (c = 0; c < 3; ++c) sum[c] += (uint64_t)((int64_t)normal[c] * weight);
        }
    }
}

/* Octahedral integers of the direction of a sum. */
static void lacedring_base_(const uint64_t sum[3], int32_t most, int32_t out[2]) {
    uint64_t size[3];
    double all;
    uint32_t c, width;
    for (c = 0; c < 3; ++c) size[c] = sum[c] >> 63 ? 0 - sum[c] : sum[c];
    width = lacedring_width_(size[0] | size[1] | size[2] | 1);
    for (c = 0; c < 3; ++c) size[c] >>= width > 32 ? width - 32 : 0;
    all = (double)(int64_t)(size[0] + size[1] + size[2]);
    out[0] = out[1] = 0;
    if (all == 0) return;
    for (c = 0; c < 2; ++c) out[c] = (int32_t)(most * (double)(int64_t)size[c] / all + 0.5);
    if (sum[2] >> 63) {
        const int32_t x = out[0];
        out[0] = most - out[1];
        out[1] = most - x;
    }
    for (c = 0; c < 2; ++c) {
        if (sum[c] >> 63) out[c] = -out[c];
    }
}

/* Turns a point of the octahedral square over, which moves the lower half to the middle. It is its own inverse. */
static void lacedring_turn_over_(uint32_t* x, uint32_t* y, uint32_t most) {
    const uint32_t left = *x >> 31, below = *y >> 31;
    const uint32_t across = most + 1 - (below ? 0 - *y : *y), up = most + 1 - (left ? 0 - *x : *x);
    *x = left ? 0 - across : across;
    *y = below ? 0 - up : up;
}

/* Turns differences into normals: adds the octahedral integers of the surface's normals. */
LACEDRING_COLD_ void lacedring_add_normals_(const struct lacedring_stored_vertices* s,
                                            const struct lacedring_positions* positions, const uint32_t* triangles,
                                            uint32_t count, void* scratch, uint32_t* integers) {
    const uint32_t values = s->attribute.vertices, most = (1u << (s->attribute.bits - 1)) - 1;
    const uint32_t* vertex_of = s->of_vertex ? positions->vertex_of : NULL;
    const size_t sum_count = vertex_of != NULL ? positions->vertices : values;
    uint64_t* sums = (uint64_t*)(void*)((uint8_t*)scratch + (32 - ((uintptr_t)scratch & 31)));
    uint16_t* angles = (uint16_t*)(void*)(sums + 3 * sum_count);
    struct lacedring_places_ places;
    uint32_t i;
    lacedring_scale_places_(positions, &places);
    memset(sums, 0, 24 * sum_count);
    if (s->by_angle) lacedring_angles_(angles);
    lacedring_sum_normals_(s, &places, triangles, count, vertex_of, angles, sums);
    for (i = 0; i < values; ++i, integers += 2) {
        int32_t base[2];
        uint32_t x, y, is_down;
        lacedring_base_(sums + 3 * (size_t)(vertex_of != NULL ? vertex_of[i] : i), (int32_t)most, base);
        x = (uint32_t)base[0];
        y = (uint32_t)base[1];
        is_down = (x >> 31 ? 0 - x : x) + (y >> 31 ? 0 - y : y) > most;
        if (is_down) lacedring_turn_over_(&x, &y, most);
        integers[0] += x;
        integers[1] += y;
        if (is_down) lacedring_turn_over_(integers, integers + 1, most);
    }
}

size_t lacedring_stored_vertices_scratch(const struct lacedring_stored_vertices* s, uint32_t triangles,
                                         const struct lacedring_positions* positions) {
    const uint32_t n = s->attribute.components, vertices = s->attribute.vertices;
    const uint32_t each = 16 + (s->error != 0 ? 4 * n : 0) + (s->by_positions ? 8 : 0);
    const size_t begin = 32 + n * sizeof(struct lacedring_residual_models_);
    const size_t walk = lacedring_bytes_of_(lacedring_bytes_of_(begin, triangles, 16), vertices, each);
    uint32_t sums = vertices;
    size_t normals;
    if (!s->by_positions) return walk;
    if (positions != NULL && positions->vertices > sums) sums = positions->vertices;
    normals = lacedring_bytes_of_(32 + 2 * (LACEDRING_TANGENTS_ + 1), sums, 24);
    return walk > normals ? walk : normals;
}

/* Does each of `values` elements have a position? If not, sets *where to the first without one. */
static int lacedring_have_places_(const struct lacedring_positions* positions, uint32_t values, uint64_t* where) {
    uint32_t i = 0;
    if (positions != NULL && positions->vertex_of == NULL && positions->vertices == values) return 1;
    if (positions != NULL && positions->vertex_of != NULL) {
        while (i < values && positions->vertex_of[i] < positions->vertices) ++i;
        if (i == values) return 1;
    }
    if (where != NULL) *where = i;
    return 0;
}

/* Reads the exceptions; writes them to the float values if `out` is not null. Returns 0 if one is invalid. */
static int lacedring_stored_exceptions_(const struct lacedring_stored_vertices* s, struct lacedring_coded* d,
                                        uint32_t count, uint8_t* out) {
    const uint64_t values = (uint64_t)s->attribute.vertices * s->attribute.components;
    struct lacedring_symbol_model_ distance;
    struct lacedring_bit_model_ same;
    uint32_t i, last = 0x80000000u; /* -0, the usual exception */
    uint64_t at = 0;
    lacedring_begin_symbols_(&distance, 1);
    lacedring_begin_bits_(&same, 1);
    for (i = 0; i < count; ++i, ++at) {
        at += lacedring_coded_number_(d, &distance);
        if (at >= values || at > UINT32_MAX || d->bit > d->end) return 0;
        if (lacedring_coded_bit_(d, &same)) last = lacedring_coded_raw_(d, 32);
        if (out != NULL) memcpy(out + 4 * (size_t)at, &last, 4);
    }
    return 1;
}

/* Checks that integers are in the ranges of their components and mapping. */
static enum lacedring_status lacedring_stored_ranges_(const struct lacedring_stored_vertices* s,
                                                      const uint32_t* integers, uint64_t* where) {
    const uint32_t n = s->attribute.components;
    struct lacedring_ranges_ r;
    uint32_t c, v, is_any = !s->has_ranges;
    for (c = 0; c < n; ++c) {
        lacedring_vertex_range_(&s->attribute, c, r.more + c, r.most + c);
        r.mask[c] = s->has_ranges ? (uint32_t)((UINT64_C(1) << s->range_bits[c]) - 1) : UINT32_MAX;
        is_any &= r.most[c] == UINT32_MAX;
    }
    for (v = 0; v < s->attribute.vertices && !is_any; ++v) {
        uint32_t bad = 0;
        for (c = 0; c < n; ++c, ++integers)
            bad |=
                (uint32_t)(((*integers - s->low[c]) & ~r.mask[c]) != 0) | (uint32_t)(*integers + r.more[c] > r.most[c]);
        if (bad) return lacedring_at_(where, v, LACEDRING_STATUS_INTEGER);
    }
    return LACEDRING_STATUS_OK;
}

enum lacedring_status lacedring_stored_vertices_decode(struct lacedring_stored_vertices* s, const uint32_t* triangles,
                                                       uint32_t triangle_count,
                                                       const struct lacedring_positions* positions, void* scratch,
                                                       uint32_t* integers, uint64_t* where) {
    const uint32_t n = s->attribute.components, vertices = s->attribute.vertices;
    struct lacedring_residuals_ residuals;
    struct lacedring_walk_ w;
    struct lacedring_predictor_ p;
    struct lacedring_places_ places;
    struct lacedring_coded d;
    uint32_t* words;
    uint32_t c, i;
    if (s->by_positions && !lacedring_have_places_(positions, vertices, where)) return LACEDRING_STATUS_POSITIONS;
    if (triangle_count >= (1u << 29) - 1) return lacedring_at_(where, triangle_count, LACEDRING_STATUS_LIMIT);
    w.of = triangles;
    w.opposite = (uint32_t*)(void*)((uint8_t*)scratch + (32 - ((uintptr_t)scratch & 31)));
    words = w.opposite + 4 * (size_t)triangle_count;
    i = lacedring_pair_corners_(triangles, triangle_count, vertices, w.opposite, words);
    if (i < triangle_count) return lacedring_at_(where, i, LACEDRING_STATUS_TRIANGLE);

    w.state = words;
    w.one = w.one_end = w.state + vertices;
    w.two = w.two_end = w.state + 2 * (size_t)vertices;
    memset(w.state, 0xff, 4 * (size_t)vertices);
    words += 4 * (size_t)vertices;
    w.pending = w.last = LACEDRING_NONE_;
    w.triangle = w.vertex = 0;
    w.triangles = triangle_count;
    w.vertices = vertices;
    p.s = s;
    p.integers = integers;
    p.is_plain = 1;
    for (c = 0; c < n; ++c) p.is_plain &= s->rules[c] == LACEDRING_BY_PARALLELOGRAMS_;
    p.errors = NULL;
    if (s->error != 0) {
        p.errors = words;
        memset(words, 0, 4 * (size_t)vertices * n);
        words += (size_t)vertices * n;
    }
    p.places = NULL;
    p.values = integers;
    if (s->by_positions && s->attribute.mapping != LACEDRING_MAPPING_OCTAHEDRAL) {
        lacedring_scale_places_(positions, &places);
        p.places = &places;
        p.integers = words;
        words += 2 * (size_t)vertices;
    }
    residuals.coded = s->residuals;
    residuals.models = (struct lacedring_residual_models_*)(void*)words;
    residuals.fine = s->fine;
    for (c = 0; c < n; ++c) {
        lacedring_begin_symbols_(residuals.models[c].steps, LACEDRING_STORED_STEPS_);
        lacedring_begin_symbols_(&residuals.models[c].others, 1);
        residuals.models[c].level = 0;
    }
    lacedring_integers_(&p, &w, &residuals, n);
    d = residuals.coded;
    if (s->attribute.mapping == LACEDRING_MAPPING_DECIMALS) {
        s->attribute.exception_count = lacedring_coded_raw_(&d, 32);
        s->exceptions = d;
        if (d.bit > d.end || !lacedring_stored_exceptions_(s, &d, s->attribute.exception_count, NULL))
            return lacedring_at_(where, 0, LACEDRING_STATUS_CODED);
    }
    if (!lacedring_coded_ends_(&d)) return lacedring_at_(where, 0, LACEDRING_STATUS_CODED);
    if (s->by_positions && s->attribute.mapping == LACEDRING_MAPPING_OCTAHEDRAL)
        lacedring_add_normals_(s, positions, triangles, triangle_count, scratch, integers);
    return lacedring_stored_ranges_(s, integers, where);
}

void lacedring_stored_vertices_values(const struct lacedring_stored_vertices* s, const uint32_t* integers, void* out) {
    const uint32_t n = s->attribute.components, vertices = s->attribute.vertices;
    struct lacedring_vertices plain = s->attribute;
    struct lacedring_coded exceptions = s->exceptions;
    uint8_t* to = (uint8_t*)out;
    uint32_t first;
    plain.exception_count = 0;
    for (first = 0; first < vertices; first += LACEDRING_VERTICES_BLOCK) {
        const uint32_t left = vertices - first;
        to = lacedring_vertex_values_(&plain, integers + (size_t)first * n, first,
                                      left < LACEDRING_VERTICES_BLOCK ? left : LACEDRING_VERTICES_BLOCK, to);
        if (left <= LACEDRING_VERTICES_BLOCK) break;
    }
    if (s->attribute.exception_count != 0)
        lacedring_stored_exceptions_(s, &exceptions, s->attribute.exception_count, (uint8_t*)out);
}

#undef LACEDRING_SSE2_
#undef LACEDRING_PREFETCH_
#undef LACEDRING_COLD_
#undef LACEDRING_SCALE_
#undef LACEDRING_LEAST_STATE_
#undef LACEDRING_RING_EDGE_
#undef LACEDRING_RIGHT_
#undef LACEDRING_STORED_PART_
#undef LACEDRING_STORED_STEPS_
#undef LACEDRING_SOME_VERTICES_
#undef LACEDRING_NONE_
#undef LACEDRING_TANGENTS_
#undef LACEDRING_HALF_TURN_
#undef LACEDRING_KNOWN_
#undef LACEDRING_UNSEEN_
#undef LACEDRING_MORE_
#undef LACEDRING_COMPLETE_
#ifdef __cplusplus
}
#endif
#endif /* LACEDRING_DECODE_IMPLEMENTATION */
