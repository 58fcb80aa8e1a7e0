/* Decodes LacedRing's vertex streams into attributes. C99 or C++; one file beside lacedring_decode.h, no allocation.
   lrcore decodes with the same code. Format: docs/vertex-format.md.

   Define LACEDRING_DECODE_IMPLEMENTATION in one .c or .cpp file before including this header, which then adds the
   functions. A program that links lacedring::core has them already.

       struct lacedring_vertices stream;
       if (lacedring_vertices_validate(words, count, &stream, NULL) != LACEDRING_STATUS_OK) ...
       float *positions = malloc(12 * (size_t)stream.vertices);
       lacedring_vertices_decode(&stream, positions);

   Streams are little-endian 32-bit words, and this file is for little-endian machines. */
#ifndef LACEDRING_VERTICES_H
#define LACEDRING_VERTICES_H

#include "lacedring_decode.h"

#ifdef __cplusplus
extern "C" {
#endif

#define LACEDRING_VERTICES_HEADER_WORDS 7
#define LACEDRING_VERTICES_BLOCK 128u
#define LACEDRING_VERTICES_MAX_COMPONENTS 16u /* integers per vertex */

/* Mapping: what the integers of a vertex stand for. */
enum lacedring_mapping {
    LACEDRING_MAPPING_INTEGERS, /* values: 8, 16 or 32 bits, signed or not */
    LACEDRING_MAPPING_LATTICE,  /* float: integer * step, which is exact */
    /* A unit vector as two integers. A third integer, if any, is 0 for a tangent's w of 1, and 1 for -1. */
    LACEDRING_MAPPING_OCTAHEDRAL,
    LACEDRING_MAPPING_FLOATS,   /* a float's bits, changed to sort like floats */
    LACEDRING_MAPPING_DECIMALS, /* float nearest to integer / 10^digits, or an exception */
    LACEDRING_MAPPING_DOUBLES   /* two integers: upper half as FLOATS, lower half as it is */
};

/* A vertex stream whose header was read. Refers to the caller's words. */
struct lacedring_vertices {
    const uint32_t* parameters; /* two words per component */
    const uint32_t* exceptions; /* two words each: number of the value in the attribute, bits of its float */
    const uint32_t* table;      /* where groups of 16 blocks, and their blocks, begin */
    const uint32_t* data;
    size_t data_words; /* including two of padding */
    uint32_t vertices;
    uint32_t components; /* integers per vertex */
    uint32_t mapping;    /* enum lacedring_mapping */
    uint32_t type;       /* type of a value: 0 i8, 1 u8, 2 i16, 3 u16, 4 i32, 5 u32, 6 f32, 7 f64 */
    uint32_t normalized; /* nonzero: integers stand for 0 to 1, or -1 to 1 */
    uint32_t bits;       /* octahedral: bits of each of the two integers */
    uint32_t digits;     /* decimals: digits after the point */
    uint32_t most;       /* lattice, octahedral: each integer is above -most and below most */
    uint32_t exception_count;
    uint32_t field_bits; /* bits of a field of the table */
    float step;          /* lattice: the step */
    float largest_error; /* largest error of a value; 0: lossless */
};

/* Reads the header and checks sizes only. Safe with any words. Constant time. */
enum lacedring_status lacedring_vertices_open(const uint32_t* words, size_t count, struct lacedring_vertices* stream,
                                              uint64_t* where);

/* Checks everything that decoders rely on except the checksum: blocks lie where the table says, and all integers are in
   the range of their component and mapping. `stream` comes from lacedring_vertices_open. Safe with any words. Linear
   time, no allocation. */
enum lacedring_status lacedring_vertices_check(const struct lacedring_vertices* stream, uint64_t* where);

/* lacedring_vertices_check and lacedring_vertices_decode in one pass. On an error the contents of `out` are
   undefined. */
enum lacedring_status lacedring_vertices_decode_checked(const struct lacedring_vertices* stream, void* out,
                                                        uint64_t* where);

/* Opens the stream, checks the checksum, and runs lacedring_vertices_check. Safe with any words. Linear time. */
enum lacedring_status lacedring_vertices_validate(const uint32_t* words, size_t count,
                                                  struct lacedring_vertices* stream, uint64_t* where);

/* Decodes the integers of blocks [block, end), stream->components per vertex: vertices [128 * block, 128 * end), fewer
   if the last block is not full. */
void lacedring_vertices_blocks(const struct lacedring_vertices* stream, uint32_t block, uint32_t end, uint32_t* out);

/* Decodes all values of the attribute, tightly packed: lacedring_vertices_values(stream) values of stream->type per
   vertex. Linear time. */
void lacedring_vertices_decode(const struct lacedring_vertices* stream, void* out);

/* Number of values per vertex. It differs from stream->components for octahedral streams (one more) and doubles
   (half). */
uint32_t lacedring_vertices_values(const struct lacedring_vertices* stream);

/* Decodes two octahedral integers of `bits` bits each to a unit vector. The result is the same on every machine. */
void lacedring_octahedral(int32_t x, int32_t y, uint32_t bits, float out[3]);

#ifdef __cplusplus
}
#endif
#endif /* LACEDRING_VERTICES_H */

#if defined(LACEDRING_DECODE_IMPLEMENTATION) && !defined(LACEDRING_VERTICES_IMPLEMENTED)
#define LACEDRING_VERTICES_IMPLEMENTED

#include <math.h>
#ifdef LACEDRING_AVX2_
#include <immintrin.h>
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define LACEDRING_VERTICES_GROUP_ 16u /* blocks per group */
#define LACEDRING_VERTICES_MOST_ 24u  /* most zeros of a unary number */

static const double lacedring_powers_[10] = {1, 10, 100, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9};

/* What decoding a block is for. */
enum lacedring_purpose_ { LACEDRING_TO_CHECK_, LACEDRING_TO_INTEGERS_, LACEDRING_TO_VALUES_ };

uint32_t lacedring_vertices_values(const struct lacedring_vertices* stream) {
    if (stream->mapping == LACEDRING_MAPPING_OCTAHEDRAL) return stream->components + 1;
    return stream->mapping == LACEDRING_MAPPING_DOUBLES ? stream->components / 2 : stream->components;
}

LACEDRING_SMALL_ uint32_t lacedring_vertex_blocks_(const struct lacedring_vertices* s) {
    return s->vertices / LACEDRING_VERTICES_BLOCK + (s->vertices % LACEDRING_VERTICES_BLOCK != 0);
}

/* Number of vertices of a block. */
LACEDRING_SMALL_ uint32_t lacedring_vertex_count_(const struct lacedring_vertices* s, uint32_t block) {
    const uint32_t left = s->vertices - block * LACEDRING_VERTICES_BLOCK;
    return left < LACEDRING_VERTICES_BLOCK ? left : LACEDRING_VERTICES_BLOCK;
}

/* Words of a group of the table: where the group begins, then a field for each of its blocks but the first. */
LACEDRING_SMALL_ uint32_t lacedring_vertex_group_(const struct lacedring_vertices* s) {
    return 1 + (15 * s->field_bits + 31) / 32;
}

static float lacedring_as_float_(uint32_t bits) {
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* Reads words 2, 4 and 5 of a header. Returns the number of an invalid one, or 0. */
static uint32_t lacedring_vertex_layout_(struct lacedring_vertices* s, uint32_t layout, uint32_t step, uint32_t error) {
    /* For each type, a bit for each mapping it may have. */
    static const uint8_t mappings[8] = {1, 1, 1, 1, 1, 1, 2 | 4 | 8 | 16, 32};
    s->components = layout & 31;
    s->mapping = layout >> 5 & 7;
    s->type = layout >> 8 & 15;
    s->normalized = layout >> 12 & 1;
    s->bits = layout >> 13 & 31;
    s->field_bits = layout >> 18 & 31;
    s->step = s->mapping == LACEDRING_MAPPING_LATTICE ? lacedring_as_float_(step) : 0.0f;
    s->digits = s->mapping == LACEDRING_MAPPING_DECIMALS ? step : 0;
    s->largest_error = lacedring_as_float_(error);
    if (layout >> 23 != 0 || s->components == 0 || s->components > LACEDRING_VERTICES_MAX_COMPONENTS || s->type > 7 ||
        (mappings[s->type] >> s->mapping & 1) == 0 || (s->normalized && s->type > 5))
        return 2;
    if (s->mapping == LACEDRING_MAPPING_OCTAHEDRAL
            ? s->bits < 2 || s->bits > 16 || s->components < 2 || s->components > 3
            : s->bits != 0)
        return 2;
    if (s->mapping == LACEDRING_MAPPING_DOUBLES && s->components % 2 != 0) return 2;
    /* A step is a normal float, and so small that its product with any 24-bit integer is finite. */
    if (s->mapping == LACEDRING_MAPPING_LATTICE    ? step < 0x00800000u || step >= 0x73800000u
        : s->mapping == LACEDRING_MAPPING_DECIMALS ? step > 9
                                                   : step != 0)
        return 4;
    if (s->mapping == LACEDRING_MAPPING_LATTICE || s->mapping == LACEDRING_MAPPING_OCTAHEDRAL ? error >= 0x7f800000u
                                                                                              : error != 0)
        return 5;
    s->most = s->mapping == LACEDRING_MAPPING_OCTAHEDRAL ? 1u << (s->bits - 1) : 0;
    /* Step and integer share the 24 bits of a float's significand, so that their product is exact. */
    if (s->mapping == LACEDRING_MAPPING_LATTICE) {
        uint32_t zeros = step & 0x007fffffu;
        for (s->most = 1; s->most < 1u << 23 && !(zeros & 1); s->most *= 2) zeros >>= 1;
    }
    return 0;
}

enum lacedring_status lacedring_vertices_open(const uint32_t* words, size_t count, struct lacedring_vertices* s,
                                              uint64_t* where) {
    uint32_t wrong;
    uint64_t size;
    if (count < LACEDRING_VERTICES_HEADER_WORDS) return lacedring_at_(where, 0, LACEDRING_STATUS_SHORT);
    if (words[0] != 0x3156524cu) return lacedring_at_(where, 0, LACEDRING_STATUS_MAGIC);
    s->vertices = words[1];
    s->exception_count = words[6];
    wrong = lacedring_vertex_layout_(s, words[2], words[4], words[5]);
    if (wrong != 0) return lacedring_at_(where, wrong, LACEDRING_STATUS_HEADER);
    if (s->mapping != LACEDRING_MAPPING_DECIMALS && s->exception_count != 0)
        return lacedring_at_(where, 6, LACEDRING_STATUS_HEADER);
    size = LACEDRING_VERTICES_HEADER_WORDS + 2 * s->components + (uint64_t)2 * s->exception_count;
    if (size > count) return lacedring_at_(where, size, LACEDRING_STATUS_SIZE);
    s->parameters = words + LACEDRING_VERTICES_HEADER_WORDS;
    s->exceptions = s->parameters + 2 * s->components;
    s->table = words + (size_t)size;
    size += (uint64_t)lacedring_vertex_group_(s) *
            ((lacedring_vertex_blocks_(s) + LACEDRING_VERTICES_GROUP_ - 1) / LACEDRING_VERTICES_GROUP_);
    if (size + 2 > count) return lacedring_at_(where, size, LACEDRING_STATUS_SIZE);
    s->data = words + (size_t)size;
    s->data_words = count - (size_t)size;
    return LACEDRING_STATUS_OK;
}

/* The bits of a stream's data. */
struct lacedring_data_ {
    const uint8_t* bytes;
    uint64_t last; /* last bit at which an 8-byte load may begin */
};

/* Returns at least 57 bits from bit `at` on. */
LACEDRING_HOT_ uint64_t lacedring_data_at_(const struct lacedring_data_* d, uint64_t at) {
    uint64_t value;
    if (at > d->last) at = d->last;
    memcpy(&value, d->bytes + (size_t)(at >> 3), 8);
    return value >> (at & 7);
}

LACEDRING_HOT_ uint32_t lacedring_data_take_(const struct lacedring_data_* d, uint64_t* at, uint32_t count) {
    const uint32_t value = (uint32_t)(lacedring_data_at_(d, *at) & ((UINT64_C(1) << count) - 1));
    *at += count;
    return value;
}

/* Counts the zeros below the lowest set bit of `bits`, which must not be 0. */
LACEDRING_HOT_ uint32_t lacedring_zeros_(uint64_t bits) {
#if defined(__GNUC__) && !defined(LACEDRING_PLAIN)
    return (uint32_t)__builtin_ctzll(bits);
#else
    uint32_t n = 0;
    for (; !(bits & 1); bits >>= 1) ++n;
    return n;
#endif
}

/* The bit of the data where a block begins. */
static uint64_t lacedring_vertex_begin_(const struct lacedring_vertices* s, uint32_t block) {
    const uint32_t width = s->field_bits, k = block % LACEDRING_VERTICES_GROUP_;
    const uint32_t* group = s->table + (size_t)(block / LACEDRING_VERTICES_GROUP_) * lacedring_vertex_group_(s);
    uint64_t field = 0;
    if (k != 0 && width != 0) {
        const uint32_t bit = (k - 1) * width;
        field = group[1 + bit / 32];
        if (bit % 32 + width > 32) field |= (uint64_t)group[2 + bit / 32] << 32;
        field = field >> bit % 32 & ((UINT64_C(1) << width) - 1);
    }
    return 32 * (uint64_t)group[0] + field;
}

/* An integer x of component c is valid if x - low has no bits outside mask[c], and x + more[c] <= most[c]. `low` is the
   first parameter of the component. */
struct lacedring_ranges_ {
    uint32_t mask[LACEDRING_VERTICES_MAX_COMPONENTS];
    uint32_t more[LACEDRING_VERTICES_MAX_COMPONENTS];
    uint32_t most[LACEDRING_VERTICES_MAX_COMPONENTS];
};

/* How the integers of a run of vertices are coded. */
struct lacedring_run_ {
    uint32_t low_bits[LACEDRING_VERTICES_MAX_COMPONENTS];
    uint32_t zero; /* bit c: all residuals of component c are 0 */
    uint32_t axis; /* component that the plane gives from the two others; 3: no plane */
    int32_t slope[2];
};

/* A component's state: its integer, and its last two differences. */
struct lacedring_path_ {
    uint32_t value, d1, d2;
    int32_t alpha, beta;
};

/* x + 2, read as signed, divided by 4 and rounded down. */
LACEDRING_HOT_ uint32_t lacedring_quarter_(uint32_t x) {
    return ((x + 2) >> 2 ^ 0x20000000u) - 0x20000000u;
}

/* Decodes a run of `count` vertices of n components that begins at bit *at; sets *at to its end. Returns nonzero if a
   code is invalid. */
LACEDRING_HOT_ uint32_t lacedring_vertex_run_(const struct lacedring_data_* d, const struct lacedring_run_* run,
                                              struct lacedring_path_* path, uint32_t n, uint32_t count, uint64_t* at,
                                              uint32_t* out) {
    uint32_t i, c, row = 0, bad = 0;
    uint64_t low_at = *at, unary_at, zeros;
    uint32_t seen = 0; /* bits of `zeros` already read */
    uint32_t residual[LACEDRING_VERTICES_MAX_COMPONENTS];
    for (c = 0; c < n; ++c) row += run->low_bits[c];
    unary_at = low_at + (uint64_t)row * count;
    zeros = lacedring_data_at_(d, unary_at);
    for (i = 0; i < count; ++i) {
        uint64_t low = row <= 57 ? lacedring_data_at_(d, low_at) : 0;
        for (c = 0; c < n; ++c) {
            const uint32_t bits = run->low_bits[c];
            uint32_t code, next;
            if (run->zero >> c & 1) {
                residual[c] = 0;
                continue;
            }
            if (row > 57) low = lacedring_data_at_(d, low_at);
            if (seen > 32) {
                unary_at += seen;
                zeros = lacedring_data_at_(d, unary_at);
                seen = 0;
            }
            next = lacedring_zeros_(zeros | UINT64_C(1) << 57);
            bad |= next - seen > LACEDRING_VERTICES_MOST_ || (uint64_t)(next - seen) << bits >> 32 != 0;
            code = (next - seen) << bits | ((uint32_t)low & ((UINT32_C(1) << bits) - 1));
            zeros &= zeros - 1;
            seen = next + 1;
            low >>= bits;
            low_at += bits;
            residual[c] = (code >> 1) ^ (0u - (code & 1)); /* codes 0, 1, 2, 3 are 0, -1, 1, -2 */
        }
        if (n == 3 && run->axis < 3) {
            const uint32_t u = run->axis == 2 ? 0 : run->axis + 1, v = run->axis == 0 ? 2 : run->axis - 1;
            residual[run->axis] +=
                lacedring_quarter_((uint32_t)run->slope[0] * residual[u] + (uint32_t)run->slope[1] * residual[v]);
        }
        for (c = 0; c < n; ++c) {
            struct lacedring_path_* p = path + c;
            const uint32_t step =
                residual[c] + lacedring_quarter_((uint32_t)p->alpha * p->d1 + (uint32_t)p->beta * p->d2);
            p->d2 = p->d1;
            p->d1 = step;
            p->value += step;
            out[c] = p->value;
        }
        out += n;
    }
    *at = unary_at + seen;
    return bad;
}

/* Reads the code of a component's width for a run: *bits is the width of the run before, and becomes that of this run.
   *window has the bits from *at on, of which *used are read. Returns 0 if all residuals of the run are 0. *bad becomes
   nonzero if the width is invalid. */
LACEDRING_HOT_ uint32_t lacedring_next_width_(const struct lacedring_data_* d, uint64_t* at, uint64_t* window,
                                              uint32_t* used, uint32_t* bits, uint32_t* bad) {
    uint64_t code;
    uint32_t ones;
    if (*used > 57 - 9) { /* a code has at most 9 bits */
        *at += *used;
        *window = lacedring_data_at_(d, *at);
        *used = 0;
    }
    code = *window >> *used;
    ones = lacedring_zeros_(~code | 16); /* 0: same width, 1: all 0, 2: one more, 3: one less, 4: given */
    *used += ones < 4 ? ones + 1 : 9;
    *bad |= (ones == 2 && *bits == 31) || (ones == 3 && *bits == 0);
    *bits = ones == 4 ? (uint32_t)(code >> 4) & 31 : (*bits + (ones == 2) - (ones == 3)) & 31;
    return ones != 1;
}

/* Decodes a block of `count` vertices that begins at bit *at; sets *at to its end. Returns nonzero if the block is
   invalid. */
LACEDRING_HOT_ uint32_t lacedring_vertex_block_(const struct lacedring_vertices* s, const struct lacedring_data_* d,
                                                uint32_t n, uint32_t count, uint64_t* at, uint32_t* out) {
    struct lacedring_path_ path[LACEDRING_VERTICES_MAX_COMPONENTS];
    struct lacedring_run_ run;
    uint32_t bits[LACEDRING_VERTICES_MAX_COMPONENTS];
    uint32_t c, i, length, plane_axis = 0, bad = 0;
    int32_t plane[2] = {0, 0};
    for (c = 0; c < n; ++c) {
        const uint32_t said = s->parameters[2 * c + 1];
        uint32_t predictor = said >> 11 & 31;
        if (lacedring_data_take_(d, at, 1)) predictor = lacedring_data_take_(d, at, 5);
        path[c].alpha = (int32_t)(predictor & 7) - 2;
        path[c].beta = (int32_t)(predictor >> 3) - 2;
        path[c].d1 = path[c].d2 = 0;
        bits[c] = said >> 6 & 31;
    }
    length = 4u << lacedring_data_take_(d, at, 2);
    for (c = 0; c < n; ++c) {
        path[c].value = s->parameters[2 * c] + lacedring_data_take_(d, at, s->parameters[2 * c + 1] & 63);
        out[c] = path[c].value;
    }
    run.axis = 3;
    run.slope[0] = run.slope[1] = 0;
    for (i = 1; i < count; i += length) {
        const uint32_t here = count - i < length ? count - i : length;
        uint64_t window = lacedring_data_at_(d, *at); /* 57 bits or more; a plane takes at most 10, a width 9 */
        uint32_t used = 0;
        if (n == 3 && ((i - 1) & 15) == 0) {
            used = window & 1 ? window & 2 ? 10 : 2 : 1;
            if (used == 10) {
                plane_axis = (uint32_t)(window >> 2) & 3;
                plane[0] = (int32_t)(window >> 4 & 7) - 4;
                plane[1] = (int32_t)(window >> 7 & 7) - 4;
                bad |= plane_axis == 3;
            }
            run.axis = used == 1 ? 3 : plane_axis;
            run.slope[0] = plane[0];
            run.slope[1] = plane[1];
        }
        run.zero = 0;
        for (c = 0; c < n; ++c) {
            const uint32_t is_present = lacedring_next_width_(d, at, &window, &used, bits + c, &bad);
            run.zero |= (1 - is_present) << c;
            run.low_bits[c] = is_present ? bits[c] : 0;
        }
        *at += used;
        bad |= lacedring_vertex_run_(d, &run, path, n, here, at, out + (size_t)i * n);
    }
    return bad;
}

#ifdef __wasm_simd128__
/* WebAssembly's vectors have four lanes: one for each component of a stream of at most four. */
typedef uint32_t lacedring_u4_ __attribute__((vector_size(16)));
typedef int32_t lacedring_i4_ __attribute__((vector_size(16)));
#define LACEDRING_EACH_ _Pragma("clang loop unroll(full)") /* lane numbers must be constants */

LACEDRING_HOT_ lacedring_u4_ lacedring_quarters_(lacedring_u4_ x) {
    return (lacedring_u4_)((lacedring_i4_)(x + 2) >> 2);
}

/* Position in the codes of a run. */
struct lacedring_codes_ {
    uint64_t low_at, unary_at;
    uint32_t present; /* bit c: not all residuals of component c are 0 */
    uint32_t width[4], mask[4];
};

/* Reads the codes of the next vertex, however long they are. Returns nonzero if one is invalid. */
static uint32_t lacedring_any_codes_(const struct lacedring_data_* d, struct lacedring_codes_* r, uint32_t n,
                                     uint32_t code[4]) {
    uint32_t c, bad = 0;
    for (c = 0; c < n; ++c) {
        uint32_t zeros;
        code[c] = 0;
        if (!(r->present >> c & 1)) continue;
        zeros = lacedring_zeros_(lacedring_data_at_(d, r->unary_at) | UINT64_C(1) << 57);
        r->unary_at += zeros + 1;
        bad |= zeros > LACEDRING_VERTICES_MOST_ || (uint64_t)zeros << r->width[c] >> 32 != 0;
        code[c] = zeros << r->width[c] | lacedring_data_take_(d, &r->low_at, r->width[c]);
    }
    return bad;
}

/* The last vertex of a block so far, and what is needed to decode the next one. A lane per component. */
struct lacedring_vertex_lanes_ {
    lacedring_u4_ value, d1, d2, alpha, beta;
    lacedring_u4_ slopes, axis;           /* of the plane; `axis` is a mask */
    lacedring_u4_ base, more, over, high; /* largest value - base, and value + more, so far */
};

/* Decodes the next vertex from the codes of its residuals. */
LACEDRING_HOT_ void lacedring_vertex_step_(struct lacedring_vertex_lanes_* p, uint32_t n, uint32_t has_plane,
                                           const uint32_t* code) {
    lacedring_u4_ residual = {0, 0, 0, 0};
    uint32_t c;
    LACEDRING_EACH_ for (c = 0; c < n; ++c) residual[c] = code[c];
    residual = (residual >> 1) ^ (0u - (residual & 1)); /* codes 0, 1, 2, 3 are 0, -1, 1, -2 */
    if (n == 3 && has_plane) {
        const lacedring_u4_ product = p->slopes * residual;
        const lacedring_u4_ sum = product + __builtin_shufflevector(product, product, 1, 2, 0, 3) +
                                  __builtin_shufflevector(product, product, 2, 0, 1, 3);
        residual += lacedring_quarters_(sum) & p->axis;
    }
    residual += lacedring_quarters_(p->alpha * p->d1 + p->beta * p->d2);
    p->d2 = p->d1;
    p->d1 = residual;
    p->value += residual;
    p->over = __builtin_wasm_max_u_i32x4(p->over, p->value - p->base);
    p->high = __builtin_wasm_max_u_i32x4(p->high, p->value + p->more);
}

/* As lacedring_vertex_block_, but also checks `ranges`. Writes up to three integers beyond the block's. */
LACEDRING_HOT_ uint32_t lacedring_vertex_block_4_(const struct lacedring_vertices* s, const struct lacedring_data_* d,
                                                  uint32_t n, uint32_t count, const struct lacedring_ranges_* ranges,
                                                  uint64_t* at, uint32_t* out) {
    struct lacedring_vertex_lanes_ lanes;
    uint32_t bits[4], c, i, k, length, plane = 4 << 4 | 4 << 7, has_plane = 0, bad = 0;
    struct lacedring_codes_ run;
    memset(&lanes, 0, sizeof lanes);
    memset(&run, 0, sizeof run);
    LACEDRING_EACH_ for (c = 0; c < n; ++c) {
        const uint32_t said = s->parameters[2 * c + 1];
        uint32_t predictor = said >> 11 & 31;
        if (lacedring_data_take_(d, at, 1)) predictor = lacedring_data_take_(d, at, 5);
        lanes.alpha[c] = (predictor & 7) - 2;
        lanes.beta[c] = (predictor >> 3) - 2;
        bits[c] = said >> 6 & 31;
        lanes.base[c] = s->parameters[2 * c];
        lanes.more[c] = ranges->more[c];
    }
    length = 4u << lacedring_data_take_(d, at, 2);
    LACEDRING_EACH_ for (c = 0; c < n; ++c) lanes.value[c] =
        lanes.base[c] + lacedring_data_take_(d, at, s->parameters[2 * c + 1] & 63);
    lanes.over = lanes.value - lanes.base;
    lanes.high = lanes.value + lanes.more;
    memcpy(out, &lanes.value, 16);
    out += n;
    for (i = 1; i < count; i += length) {
        const uint32_t here = count - i < length ? count - i : length;
        uint64_t window = lacedring_data_at_(d, *at); /* 57 bits or more; a plane takes at most 10, a width 9 */
        uint32_t used = 0, row = 0, most = LACEDRING_VERTICES_MOST_, is_plain;
        if (n == 3 && ((i - 1) & 15) == 0) {
            used = window & 1 ? window & 2 ? 10 : 2 : 1;
            has_plane = used > 1;
            if (used == 10) plane = (uint32_t)window;
            if (has_plane) {
                const uint32_t of = plane >> 2 & 3;
                bad |= of == 3;
                LACEDRING_EACH_ for (c = 0; c < 3; ++c) {
                    lanes.axis[c] = of == c ? UINT32_MAX : 0;
                    lanes.slopes[c] = of == (c == 0 ? 2 : c - 1)   ? (plane >> 4 & 7) - 4
                                      : of == (c == 2 ? 0 : c + 1) ? (plane >> 7 & 7) - 4
                                                                   : 0;
                }
            }
        }
        run.present = 0;
        LACEDRING_EACH_ for (c = 0; c < n; ++c) {
            const uint32_t is_present = lacedring_next_width_(d, at, &window, &used, bits + c, &bad);
            run.present |= is_present << c;
            run.width[c] = is_present ? bits[c] : 0;
            run.mask[c] = (1u << run.width[c]) - 1;
            row += run.width[c];
            if (UINT32_MAX >> run.width[c] < most) most = UINT32_MAX >> run.width[c];
        }
        *at += used;
        run.low_at = *at;
        run.unary_at = run.low_at + (uint64_t)row * here;
        is_plain = run.present == (1u << n) - 1 && row <= 28 && run.unary_at + 57 * (uint64_t)here <= d->last;
        for (k = 0; k < here;) {
            uint32_t any[4];
            if (is_plain && here - k >= 2) { /* two vertices from two loads */
                uint32_t code[8], end[2] = {0, 0}, v;
                uint64_t low, zeros;
                memcpy(&low, d->bytes + (size_t)(run.low_at >> 3), 8);
                memcpy(&zeros, d->bytes + (size_t)(run.unary_at >> 3), 8);
                low >>= run.low_at & 7;
                zeros = zeros >> (run.unary_at & 7) | UINT64_C(255) << 56;
                LACEDRING_EACH_ for (v = 0; v < 2; ++v) {
                    if (v == 1) end[1] = end[0];
                    LACEDRING_EACH_ for (c = 0; c < n; ++c) {
                        const uint32_t next = lacedring_zeros_(zeros);
                        code[4 * v + c] = (next - end[v]) << run.width[c] | ((uint32_t)low & run.mask[c]);
                        zeros &= zeros - 1;
                        low >>= run.width[c];
                        end[v] = next + 1;
                    }
                }
                /* No unary number has more zeros than `most` if all unary numbers of its vertex together do not. */
                if ((end[0] <= most) & (end[1] - end[0] <= most) & (end[1] <= 56)) {
                    LACEDRING_EACH_ for (v = 0; v < 2; ++v) {
                        lacedring_vertex_step_(&lanes, n, has_plane, code + 4 * v);
                        memcpy(out + v * n, &lanes.value, 16);
                    }
                    out += 2 * n;
                    run.low_at += 2 * row;
                    run.unary_at += end[1];
                    k += 2;
                    continue;
                }
            }
            bad |= lacedring_any_codes_(d, &run, n, any);
            lacedring_vertex_step_(&lanes, n, has_plane, any);
            memcpy(out, &lanes.value, 16);
            out += n;
            ++k;
        }
        *at = run.unary_at;
    }
    LACEDRING_EACH_ for (c = 0; c < n; ++c) bad |=
        (uint32_t)(lanes.over[c] > ranges->mask[c]) | (uint32_t)(lanes.high[c] > ranges->most[c]);
    return bad;
}
#undef LACEDRING_EACH_
#endif

#ifdef LACEDRING_AVX2_
/* Decodes eight blocks at once, one in each lane of a vector. In every block, runs begin at vertices 1 + 4 k. So lanes
   are in step at every fourth vertex even if their runs have different lengths. */
/* Blocks with more components are decoded one by one. */
#define LACEDRING_LANE_COMPONENTS_ 4
typedef __m256i lacedring_lanes_;

/* Data that lanes read. Bit positions count from `bytes`. */
struct lacedring_lane_data_ {
    const int* bytes;
    lacedring_lanes_ last; /* last byte at which a 4-byte load may begin */
};

LACEDRING_WIDE_ LACEDRING_HOT_ lacedring_lanes_ lacedring_lane_all_(uint32_t value) {
    return _mm256_set1_epi32((int)value);
}
LACEDRING_WIDE_ LACEDRING_HOT_ int lacedring_lane_any_(lacedring_lanes_ mask) {
    return _mm256_movemask_ps(_mm256_castsi256_ps(mask));
}
LACEDRING_WIDE_ LACEDRING_HOT_ lacedring_lanes_ lacedring_lane_is_(lacedring_lanes_ a, uint32_t value) {
    return _mm256_cmpeq_epi32(a, lacedring_lane_all_(value));
}
LACEDRING_WIDE_ LACEDRING_HOT_ lacedring_lanes_ lacedring_lane_add_(lacedring_lanes_ a, uint32_t value) {
    return _mm256_add_epi32(a, lacedring_lane_all_(value));
}
LACEDRING_WIDE_ LACEDRING_HOT_ lacedring_lanes_ lacedring_lane_and_(lacedring_lanes_ a, uint32_t value) {
    return _mm256_and_si256(a, lacedring_lane_all_(value));
}

/* Returns at least 25 bits from bit `at` on, followed by zeros. */
LACEDRING_WIDE_ LACEDRING_HOT_ lacedring_lanes_ lacedring_lane_load_(const struct lacedring_lane_data_* d,
                                                                     lacedring_lanes_ at) {
    const lacedring_lanes_ byte = _mm256_min_epu32(_mm256_srli_epi32(at, 3), d->last);
    return _mm256_srlv_epi32(_mm256_i32gather_epi32(d->bytes, byte, 1), lacedring_lane_and_(at, 7));
}

/* Returns 32 bits from bit `at` on. */
LACEDRING_WIDE_ LACEDRING_HOT_ lacedring_lanes_ lacedring_lane_word_(const struct lacedring_lane_data_* d,
                                                                     lacedring_lanes_ at) {
    const lacedring_lanes_ high = lacedring_lane_load_(d, lacedring_lane_add_(at, 16));
    return _mm256_blend_epi16(lacedring_lane_load_(d, at), _mm256_slli_epi32(high, 16), 0xaa);
}

/* Reads unary numbers. `bits` holds the bits at `at` and after, at most 31; a bit is cleared when it is read. `seen` is
   126 + the number of bits read. So if the last bit read is number p, `seen` is the exponent field of the float 2^p. */
struct lacedring_lane_unary_ {
    lacedring_lanes_ at, bits, seen;
};

LACEDRING_WIDE_ LACEDRING_HOT_ void lacedring_lane_reload_(const struct lacedring_lane_data_* d,
                                                           struct lacedring_lane_unary_* u) {
    u->at = _mm256_add_epi32(u->at, lacedring_lane_add_(u->seen, 0u - 126));
    u->bits = lacedring_lane_and_(lacedring_lane_load_(d, u->at), 0x7fffffff);
    u->seen = lacedring_lane_all_(126);
}

/* The current run of each lane. Masks are all ones or 0. */
struct lacedring_lane_runs_ {
    lacedring_lanes_ width[LACEDRING_LANE_COMPONENTS_];
    lacedring_lanes_ present[LACEDRING_LANE_COMPONENTS_]; /* mask: residuals are not all 0 */
    lacedring_lanes_ low_bits[LACEDRING_LANE_COMPONENTS_];
    lacedring_lanes_ low_mask[LACEDRING_LANE_COMPONENTS_];
    lacedring_lanes_ low_from[LACEDRING_LANE_COMPONENTS_]; /* begin of the component's low bits in a vertex's */
    lacedring_lanes_ row;                                  /* number of low bits of a vertex */
    lacedring_lanes_ low_at;
    lacedring_lanes_ fours;      /* groups of four vertices left in the run */
    lacedring_lanes_ plane;      /* last plane given: 2 bits axis, 3 + 3 bits slopes */
    lacedring_lanes_ on_axis[3]; /* mask: the plane gives this component */
    lacedring_lanes_ slope[3];   /* of the other components */
    /* all_present: `present` is set in all lanes and components. planes: some lane has a plane. */
    int all_present, planes;
    /* long_rows, long_low: one load does not hold the low bits of a vertex, or of a component, in some lane. */
    int long_rows, long_low;
};

/* Begins the next run, at vertex `first`, in the lanes whose run has ended. Returns nonzero in lanes with a fault. */
LACEDRING_WIDE_ LACEDRING_HOT_ lacedring_lanes_ lacedring_lane_run_(const struct lacedring_lane_data_* d, uint32_t n,
                                                                    uint32_t first, int checked,
                                                                    lacedring_lanes_ length,
                                                                    struct lacedring_lane_runs_* run,
                                                                    struct lacedring_lane_unary_* unary) {
    /* Tables by the three lowest bits of a width's code: its length without the 5 bits of a given width, the change of
       the width, and a mask: residuals are not all 0. */
    const lacedring_lanes_ code_bits = _mm256_setr_epi32(1, 2, 1, 3, 1, 2, 1, 4);
    const lacedring_lanes_ code_change = _mm256_setr_epi32(0, 0, 0, 1, 0, 0, 0, -1);
    const lacedring_lanes_ code_present = _mm256_setr_epi32(-1, 0, -1, -1, -1, 0, -1, -1);
    const lacedring_lanes_ begins = lacedring_lane_is_(run->fours, 0);
    lacedring_lanes_ at, codes, bits, row = _mm256_setzero_si256(), bad = row;
    uint32_t c;
    lacedring_lane_reload_(d, unary); /* codes follow the unary numbers of the last run */
    at = unary->at;
    codes = unary->bits;
    if (n == 3 && (first & 15) == 1) {
        const lacedring_lanes_ some = lacedring_lane_is_(lacedring_lane_and_(codes, 1), 1);
        const lacedring_lanes_ given = lacedring_lane_is_(lacedring_lane_and_(codes, 3), 3);
        lacedring_lanes_ axis, a, b;
        run->plane = _mm256_blendv_epi8(run->plane, _mm256_srli_epi32(codes, 2), _mm256_and_si256(begins, given));
        axis = lacedring_lane_and_(run->plane, 3);
        a = lacedring_lane_add_(lacedring_lane_and_(_mm256_srli_epi32(run->plane, 2), 7), 0u - 4);
        b = lacedring_lane_add_(lacedring_lane_and_(_mm256_srli_epi32(run->plane, 5), 7), 0u - 4);
        run->planes = 0;
        /* Component c is the plane's u, its v, or its axis. */
        for (c = 0; c < 3; ++c) {
            const lacedring_lanes_ u = lacedring_lane_is_(axis, (c + 2) % 3), v = lacedring_lane_is_(axis, (c + 1) % 3);
            run->slope[c] = _mm256_or_si256(_mm256_and_si256(u, a), _mm256_and_si256(v, b));
            run->on_axis[c] =
                _mm256_blendv_epi8(run->on_axis[c], _mm256_and_si256(some, lacedring_lane_is_(axis, c)), begins);
            run->planes |= lacedring_lane_any_(run->on_axis[c]);
        }
        bad = lacedring_lane_is_(axis, 3);
        bits = _mm256_sub_epi32(lacedring_lane_all_(1), _mm256_add_epi32(some, _mm256_slli_epi32(given, 3)));
        bits = _mm256_and_si256(bits, begins); /* length of the plane's code: 1, 2 or 10 */
        at = _mm256_add_epi32(at, bits);
        codes = _mm256_srlv_epi32(codes, bits);
    }
    run->long_low = 0;
    run->all_present = 255;
    for (c = 0; c < n; ++c) {
        lacedring_lanes_ change, width, given;
        /* A load has 25 bits; a plane takes at most 10, a width 9. */
        if (c % 2 != 0) codes = lacedring_lane_load_(d, at);
        given = lacedring_lane_is_(lacedring_lane_and_(codes, 15), 15);
        change = _mm256_andnot_si256(given, _mm256_permutevar8x32_epi32(code_change, codes));
        width = _mm256_add_epi32(_mm256_blendv_epi8(run->width[c], _mm256_srli_epi32(codes, 4), given), change);
        width = _mm256_blendv_epi8(width, lacedring_lane_and_(width, 31), given);
        width = _mm256_blendv_epi8(run->width[c], width, begins);
        if (checked) bad = _mm256_or_si256(bad, lacedring_lane_and_(width, ~31u));
        run->width[c] = lacedring_lane_and_(width, 31);
        run->present[c] = _mm256_blendv_epi8(run->present[c], _mm256_permutevar8x32_epi32(code_present, codes), begins);
        bits = _mm256_add_epi32(_mm256_permutevar8x32_epi32(code_bits, codes), lacedring_lane_and_(given, 5));
        bits = _mm256_and_si256(bits, begins);
        at = _mm256_add_epi32(at, bits);
        codes = _mm256_srlv_epi32(codes, bits);
        run->all_present &= lacedring_lane_any_(run->present[c]);
        run->low_bits[c] = _mm256_and_si256(run->width[c], run->present[c]);
        run->low_mask[c] = lacedring_lane_add_(_mm256_sllv_epi32(lacedring_lane_all_(1), run->low_bits[c]), UINT32_MAX);
        run->low_from[c] = row;
        run->long_low |= lacedring_lane_any_(_mm256_cmpgt_epi32(run->low_bits[c], lacedring_lane_all_(25)));
        row = _mm256_add_epi32(row, run->low_bits[c]);
    }
    run->row = row;
    run->all_present = run->all_present == 255;
    run->long_rows = lacedring_lane_any_(_mm256_cmpgt_epi32(row, lacedring_lane_all_(25)));
    run->low_at = _mm256_blendv_epi8(run->low_at, at, begins);
    run->fours = _mm256_blendv_epi8(run->fours, _mm256_srli_epi32(length, 2), begins);
    length = _mm256_min_epu32(length, lacedring_lane_all_(LACEDRING_VERTICES_BLOCK - first));
    at = _mm256_add_epi32(at, _mm256_mullo_epi32(row, length));
    unary->at = _mm256_blendv_epi8(unary->at, at, begins);
    return bad;
}

/* Decodes the next residual of component c. all: run->present[c] is set in all lanes. If `checked`, returns nonzero in
   lanes whose code is invalid. */
LACEDRING_WIDE_ LACEDRING_HOT_ lacedring_lanes_ lacedring_lane_residual_(
    const struct lacedring_lane_data_* d, const struct lacedring_lane_runs_* run, uint32_t c, int all, int checked,
    lacedring_lanes_ low, struct lacedring_lane_unary_* unary, lacedring_lanes_* residual) {
    const lacedring_lanes_ one = lacedring_lane_all_(1), bits = run->low_bits[c];
    const lacedring_lanes_ present = all ? lacedring_lane_all_(UINT32_MAX) : run->present[c];
    lacedring_lanes_ rest, zeros, code, bad = _mm256_setzero_si256();
    if (lacedring_lane_any_(_mm256_and_si256(lacedring_lane_is_(unary->bits, 0), present)))
        lacedring_lane_reload_(d, unary);
    rest = lacedring_lane_add_(unary->bits, UINT32_MAX);
    code = _mm256_andnot_si256(rest, unary->bits); /* the lowest set bit, which is exact as a float */
    code = _mm256_srli_epi32(_mm256_castps_si256(_mm256_cvtepi32_ps(code)), 23);
    zeros = _mm256_sub_epi32(_mm256_sub_epi32(code, unary->seen), one);
    unary->seen = _mm256_blendv_epi8(unary->seen, code, present);
    rest = _mm256_and_si256(rest, unary->bits);
    unary->bits = _mm256_blendv_epi8(unary->bits, rest, present);
    if (run->long_low) {
        code = lacedring_lane_word_(d, _mm256_add_epi32(run->low_at, run->low_from[c]));
    } else if (run->long_rows) {
        code = lacedring_lane_load_(d, _mm256_add_epi32(run->low_at, run->low_from[c]));
    } else {
        code = _mm256_srlv_epi32(low, run->low_from[c]);
    }
    code = _mm256_and_si256(code, run->low_mask[c]);
    code = _mm256_or_si256(code, _mm256_sllv_epi32(zeros, bits));
    if (checked) {
        bad = _mm256_srlv_epi32(zeros, _mm256_sub_epi32(lacedring_lane_all_(32), bits));
        bad = _mm256_or_si256(bad, _mm256_cmpgt_epi32(zeros, lacedring_lane_all_(LACEDRING_VERTICES_MOST_)));
        bad = _mm256_and_si256(_mm256_or_si256(bad, _mm256_srai_epi32(zeros, 31)), present);
    }
    code = _mm256_xor_si256(_mm256_srli_epi32(code, 1),
                            _mm256_sub_epi32(_mm256_setzero_si256(), _mm256_and_si256(code, one)));
    *residual = _mm256_and_si256(code, present);
    return bad;
}

/* A component's integer and its last two differences. */
struct lacedring_lane_path_ {
    lacedring_lanes_ value, d1, d2, alpha, beta;
};

LACEDRING_WIDE_ LACEDRING_HOT_ void lacedring_lane_step_(struct lacedring_lane_path_* p, lacedring_lanes_ residual,
                                                         lacedring_lanes_* out) {
    lacedring_lanes_ step = _mm256_add_epi32(_mm256_mullo_epi32(p->alpha, p->d1),
                                             lacedring_lane_add_(_mm256_mullo_epi32(p->beta, p->d2), 2));
    step = _mm256_add_epi32(_mm256_srai_epi32(step, 2), residual);
    p->d2 = p->d1;
    p->d1 = step;
    p->value = _mm256_add_epi32(p->value, step);
    *out = p->value;
}

/* Decodes eight full blocks that begin at bits *at; sets *at to their ends. Lane j of out[k] is integer k of block j.
   Returns nonzero in lanes with a fault. */
LACEDRING_WIDE_ LACEDRING_HOT_ lacedring_lanes_ lacedring_lane_blocks_(const struct lacedring_vertices* s,
                                                                       const struct lacedring_lane_data_* d, uint32_t n,
                                                                       int checked, lacedring_lanes_* at,
                                                                       lacedring_lanes_* out) {
    struct lacedring_lane_path_ path[LACEDRING_LANE_COMPONENTS_];
    lacedring_lanes_ residual[LACEDRING_LANE_COMPONENTS_];
    lacedring_lanes_ bad = _mm256_setzero_si256(), low = bad, length;
    struct lacedring_lane_runs_ run;
    struct lacedring_lane_unary_ unary;
    /* Prefetches the next eight blocks, which are probably about as long as these. */
    const char* ahead = (const char*)d->bytes + ((uint32_t)_mm256_extract_epi32(*at, 7) / 7);
    /* Cache lines to prefetch per four vertices. */
    const uint32_t lines = (uint32_t)_mm256_extract_epi32(*at, 7) / (7 * 64 * 32) + 1;
    uint32_t c, i;
    memset(&run, 0, sizeof run);
    memset(residual, 0, sizeof residual);
    for (c = 0; c < n; ++c) {
        const uint32_t said = s->parameters[2 * c + 1];
        const lacedring_lanes_ code = lacedring_lane_load_(d, *at);
        const lacedring_lanes_ own = lacedring_lane_is_(lacedring_lane_and_(code, 1), 1);
        const lacedring_lanes_ predictor = _mm256_blendv_epi8(lacedring_lane_all_(said >> 11 & 31),
                                                              lacedring_lane_and_(_mm256_srli_epi32(code, 1), 31), own);
        path[c].alpha = lacedring_lane_add_(lacedring_lane_and_(predictor, 7), 0u - 2);
        path[c].beta = lacedring_lane_add_(_mm256_srli_epi32(predictor, 3), 0u - 2);
        *at = _mm256_add_epi32(*at, lacedring_lane_add_(lacedring_lane_and_(own, 5), 1));
        run.width[c] = lacedring_lane_all_(said >> 6 & 31);
        path[c].d1 = path[c].d2 = _mm256_setzero_si256();
    }
    length = _mm256_sllv_epi32(lacedring_lane_all_(4), lacedring_lane_and_(lacedring_lane_load_(d, *at), 3));
    *at = lacedring_lane_add_(*at, 2);
    for (c = 0; c < n; ++c) {
        const uint32_t bits = s->parameters[2 * c + 1] & 63;
        const uint32_t mask = (uint32_t)((UINT64_C(1) << bits) - 1);
        path[c].value =
            lacedring_lane_add_(lacedring_lane_and_(lacedring_lane_word_(d, *at), mask), s->parameters[2 * c]);
        *at = lacedring_lane_add_(*at, bits);
        out[c] = path[c].value;
    }
    unary.at = *at;
    unary.seen = lacedring_lane_all_(126);
    unary.bits = _mm256_setzero_si256();
    run.plane = lacedring_lane_all_(4 << 2 | 4 << 5);
    for (i = 1; i < LACEDRING_VERTICES_BLOCK; ++i) {
        if (i % 4 == 1) {
            if (lacedring_lane_any_(lacedring_lane_is_(run.fours, 0)))
                bad = _mm256_or_si256(bad, lacedring_lane_run_(d, n, i, checked, length, &run, &unary));
            run.fours = lacedring_lane_add_(run.fours, UINT32_MAX);
            for (c = 0; c < lines; ++c, ahead += 64) __builtin_prefetch(ahead);
        }
        if (i % 2 == 1) lacedring_lane_reload_(d, &unary); /* often enough that other reloads are rare */
        if (!run.long_rows) low = lacedring_lane_load_(d, run.low_at);
#define LACEDRING_RESIDUAL_(c, all) \
    bad = _mm256_or_si256(bad, lacedring_lane_residual_(d, &run, c, all, checked, low, &unary, residual + c))
        if (run.all_present) {
            LACEDRING_RESIDUAL_(0, 1);
            if (n > 1) LACEDRING_RESIDUAL_(1, 1);
            if (n > 2) LACEDRING_RESIDUAL_(2, 1);
            if (n > 3) LACEDRING_RESIDUAL_(3, 1);
        } else {
            LACEDRING_RESIDUAL_(0, 0);
            if (n > 1) LACEDRING_RESIDUAL_(1, 0);
            if (n > 2) LACEDRING_RESIDUAL_(2, 0);
            if (n > 3) LACEDRING_RESIDUAL_(3, 0);
        }
#undef LACEDRING_RESIDUAL_
        run.low_at = _mm256_add_epi32(run.low_at, run.row);
        if (n == 3 && run.planes) {
            lacedring_lanes_ more = _mm256_add_epi32(_mm256_mullo_epi32(run.slope[0], residual[0]),
                                                     _mm256_mullo_epi32(run.slope[1], residual[1]));
            more = _mm256_add_epi32(more, _mm256_mullo_epi32(run.slope[2], residual[2]));
            more = _mm256_srai_epi32(lacedring_lane_add_(more, 2), 2);
            residual[0] = _mm256_add_epi32(residual[0], _mm256_and_si256(more, run.on_axis[0]));
            residual[1] = _mm256_add_epi32(residual[1], _mm256_and_si256(more, run.on_axis[1]));
            residual[2] = _mm256_add_epi32(residual[2], _mm256_and_si256(more, run.on_axis[2]));
        }
        out += n;
        lacedring_lane_step_(path, residual[0], out);
        if (n > 1) lacedring_lane_step_(path + 1, residual[1], out + 1);
        if (n > 2) lacedring_lane_step_(path + 2, residual[2], out + 2);
        if (n > 3) lacedring_lane_step_(path + 3, residual[3], out + 3);
    }
    *at = _mm256_add_epi32(unary.at, lacedring_lane_add_(unary.seen, 0u - 126));
    return bad;
}

/* Transposes: writes the eight integers of lane k in `in` to out + k * stride. */
LACEDRING_WIDE_ LACEDRING_HOT_ void lacedring_lane_turn_(const lacedring_lanes_ in[8], uint32_t* out, size_t stride) {
    lacedring_lanes_ two[8], four[8];
    uint32_t k;
    for (k = 0; k < 8; k += 2) {
        two[k] = _mm256_unpacklo_epi32(in[k], in[k + 1]);
        two[k + 1] = _mm256_unpackhi_epi32(in[k], in[k + 1]);
    }
    for (k = 0; k < 8; k += 4) {
        four[k] = _mm256_unpacklo_epi64(two[k], two[k + 2]);
        four[k + 1] = _mm256_unpackhi_epi64(two[k], two[k + 2]);
        four[k + 2] = _mm256_unpacklo_epi64(two[k + 1], two[k + 3]);
        four[k + 3] = _mm256_unpackhi_epi64(two[k + 1], two[k + 3]);
    }
    for (k = 0; k < 4; ++k) {
        const lacedring_lanes_ low = _mm256_permute2x128_si256(four[k], four[k + 4], 0x20);
        const lacedring_lanes_ high = _mm256_permute2x128_si256(four[k], four[k + 4], 0x31);
        _mm256_storeu_si256((lacedring_lanes_*)(void*)(out + k * stride), low);
        _mm256_storeu_si256((lacedring_lanes_*)(void*)(out + (k + 4) * stride), high);
    }
}

/* Converts integers of mappings lattice, floats and decimals to floats, without exceptions. Leaves other integers
   alone. */
LACEDRING_WIDE_ LACEDRING_HOT_ void lacedring_lane_values_(const struct lacedring_vertices* s,
                                                           lacedring_lanes_ rows[8]) {
    uint32_t k;
    if (s->mapping == LACEDRING_MAPPING_LATTICE) {
        const __m256 step = _mm256_set1_ps(s->step);
        for (k = 0; k < 8; ++k) rows[k] = _mm256_castps_si256(_mm256_mul_ps(_mm256_cvtepi32_ps(rows[k]), step));
    } else if (s->mapping == LACEDRING_MAPPING_FLOATS) {
        /* Inverts all bits if the highest one is 0, else the highest one alone. */
        for (k = 0; k < 8; ++k) {
            const lacedring_lanes_ lower = _mm256_cmpgt_epi32(rows[k], lacedring_lane_all_(UINT32_MAX));
            rows[k] = _mm256_xor_si256(rows[k], _mm256_or_si256(lower, lacedring_lane_all_(0x80000000u)));
        }
    } else if (s->mapping == LACEDRING_MAPPING_DECIMALS) {
        const __m256d power = _mm256_set1_pd(lacedring_powers_[s->digits]);
        for (k = 0; k < 8; ++k) {
            const __m256d low = _mm256_cvtepi32_pd(_mm256_castsi256_si128(rows[k]));
            const __m256d high = _mm256_cvtepi32_pd(_mm256_extracti128_si256(rows[k], 1));
            rows[k] = _mm256_castps_si256(_mm256_set_m128(_mm256_cvtpd_ps(_mm256_div_pd(high, power)),
                                                          _mm256_cvtpd_ps(_mm256_div_pd(low, power))));
        }
    }
}

/* Returns nonzero in lanes with an integer out of its range. */
LACEDRING_WIDE_ LACEDRING_HOT_ lacedring_lanes_ lacedring_lane_ranges_(const struct lacedring_vertices* s,
                                                                       const struct lacedring_ranges_* ranges,
                                                                       const lacedring_lanes_* rows) {
    lacedring_lanes_ wrong = _mm256_setzero_si256();
    uint32_t c, k;
    for (c = 0; c < s->components; ++c) {
        const lacedring_lanes_ base = lacedring_lane_all_(s->parameters[2 * c]);
        const lacedring_lanes_ mask = lacedring_lane_all_(ranges->mask[c]);
        const lacedring_lanes_ most = lacedring_lane_all_(ranges->most[c]);
        for (k = c; k < LACEDRING_VERTICES_BLOCK * s->components; k += s->components) {
            const lacedring_lanes_ sum = lacedring_lane_add_(rows[k], ranges->more[c]);
            wrong = _mm256_or_si256(wrong, _mm256_andnot_si256(mask, _mm256_sub_epi32(rows[k], base)));
            wrong = _mm256_or_si256(wrong, _mm256_xor_si256(_mm256_max_epu32(sum, most), most));
        }
    }
    return wrong;
}

/* Decodes eight full blocks whose bits lie within half a gigabyte: lanes have bit positions of 32 bits. */
LACEDRING_WIDE_ LACEDRING_HOT_ uint32_t lacedring_lane_eight_(const struct lacedring_vertices* s,
                                                              const struct lacedring_data_* d,
                                                              enum lacedring_purpose_ purpose,
                                                              const struct lacedring_ranges_* ranges, uint64_t at[8],
                                                              uint32_t* out) {
    /* A lane loads 32 bits, and 64 bits may be read at d->last. */
    const uint64_t base = at[0] / 8, last = (d->last + 32) / 8 - base;
    const size_t stride = (size_t)LACEDRING_VERTICES_BLOCK * s->components;
    struct lacedring_lane_data_ data;
    lacedring_lanes_ lanes, bad, rows[LACEDRING_VERTICES_BLOCK * LACEDRING_LANE_COMPONENTS_];
    uint32_t k, bits[8];
    data.bytes = (const int*)(const void*)(d->bytes + (size_t)base);
    data.last = lacedring_lane_all_(last < INT32_MAX ? (uint32_t)last : INT32_MAX);
    for (k = 0; k < 8; ++k) bits[k] = (uint32_t)(at[k] - 8 * base);
    lanes = _mm256_loadu_si256((const lacedring_lanes_*)(const void*)bits);
    bad = s->components == 3
              ? lacedring_lane_blocks_(s, &data, 3, purpose == LACEDRING_TO_CHECK_, &lanes, rows)
              : lacedring_lane_blocks_(s, &data, s->components, purpose == LACEDRING_TO_CHECK_, &lanes, rows);
    _mm256_storeu_si256((lacedring_lanes_*)(void*)bits, lanes);
    for (k = 0; k < 8; ++k) at[k] = 8 * base + bits[k];
    if (purpose == LACEDRING_TO_CHECK_) bad = _mm256_or_si256(bad, lacedring_lane_ranges_(s, ranges, rows));
    for (k = 0; k < stride; k += 8) {
        if (purpose == LACEDRING_TO_VALUES_) lacedring_lane_values_(s, rows + k);
        lacedring_lane_turn_(rows + k, out + k, stride);
    }
    return lacedring_lane_any_(lacedring_lane_is_(bad, 0)) != 255;
}
LACEDRING_WIDE_ static uint32_t lacedring_vertex_eight_(const struct lacedring_vertices* s,
                                                        const struct lacedring_data_* d,
                                                        enum lacedring_purpose_ purpose,
                                                        const struct lacedring_ranges_* ranges, uint64_t at[8],
                                                        uint32_t* out) {
    if (purpose == LACEDRING_TO_CHECK_) return lacedring_lane_eight_(s, d, LACEDRING_TO_CHECK_, ranges, at, out);
    if (purpose == LACEDRING_TO_VALUES_) return lacedring_lane_eight_(s, d, LACEDRING_TO_VALUES_, ranges, at, out);
    return lacedring_lane_eight_(s, d, LACEDRING_TO_INTEGERS_, ranges, at, out);
}
#endif

static struct lacedring_data_ lacedring_data_of_(const struct lacedring_vertices* s) {
    struct lacedring_data_ d;
    d.bytes = (const uint8_t*)s->data;
    d.last = 32 * (uint64_t)(s->data_words - 2);
    return d;
}

/* Decodes the integers of block `block`, or of eight blocks from there on if they can be decoded at once and end before
   block `end`. Returns the number of blocks. Sets ends[k] to the bit where block k ends, and *bad to nonzero if a block
   is invalid. `ranges` are checked unless null. With LACEDRING_TO_VALUES_, eight blocks are written as values if
   lacedring_in_lanes_. */
static uint32_t lacedring_vertex_some_(const struct lacedring_vertices* s, const struct lacedring_data_* d,
                                       uint32_t block, uint32_t end, enum lacedring_purpose_ purpose,
                                       const struct lacedring_ranges_* ranges, uint64_t ends[8], uint32_t* bad,
                                       uint32_t* out) {
    const uint32_t n = s->components, count = lacedring_vertex_count_(s, block);
    uint32_t i, c;
    ends[0] = lacedring_vertex_begin_(s, block);
#ifdef LACEDRING_AVX2_
    if (n <= LACEDRING_LANE_COMPONENTS_ && end - block >= 8 && lacedring_vertex_count_(s, block + 7) == 128 &&
        ends[0] <= d->last && lacedring_is_wide_()) {
        uint32_t k, near_by = 1;
        for (k = 1; k < 8; ++k) {
            ends[k] = lacedring_vertex_begin_(s, block + k);
            near_by &= ends[k] - ends[0] < UINT32_C(1) << 30;
        }
        if (near_by) {
            *bad = lacedring_vertex_eight_(s, d, purpose, ranges, ends, out);
            return 8;
        }
    }
#else
    (void)end;
    (void)purpose;
#endif
#ifdef __wasm_simd128__
    if (ranges != NULL && n <= 4) {
        *bad = n == 3   ? lacedring_vertex_block_4_(s, d, 3, count, ranges, ends, out)
               : n == 2 ? lacedring_vertex_block_4_(s, d, 2, count, ranges, ends, out)
               : n == 1 ? lacedring_vertex_block_4_(s, d, 1, count, ranges, ends, out)
                        : lacedring_vertex_block_4_(s, d, 4, count, ranges, ends, out);
        return 1;
    }
#endif
    *bad = n == 3   ? lacedring_vertex_block_(s, d, 3, count, ends, out)
           : n == 2 ? lacedring_vertex_block_(s, d, 2, count, ends, out)
                    : lacedring_vertex_block_(s, d, n, count, ends, out);
    for (i = 0; ranges != NULL && i < count; ++i) {
        for (c = 0; c < n; ++c, ++out)
            *bad |= (uint32_t)(((*out - s->parameters[2 * c]) & ~ranges->mask[c]) != 0) |
                    (uint32_t)(*out + ranges->more[c] > ranges->most[c]);
    }
    return 1;
}

/* The most integers that lacedring_vertex_some_ writes: 16 components in one block, or 4 in each of eight blocks. */
#define LACEDRING_SOME_VALUES_ (LACEDRING_VERTICES_BLOCK * 32)

void lacedring_vertices_blocks(const struct lacedring_vertices* s, uint32_t block, uint32_t end, uint32_t* out) {
    const struct lacedring_data_ d = lacedring_data_of_(s);
    while (block < end) {
        uint64_t ends[8];
        uint32_t bad;
        const uint32_t some = lacedring_vertex_some_(s, &d, block, end, LACEDRING_TO_INTEGERS_, NULL, ends, &bad, out);
        out += (size_t)some * LACEDRING_VERTICES_BLOCK * s->components;
        block += some;
    }
}

/* Sets the range of component c by mapping and type: an integer x is in it if x + *more <= *most. */
static void lacedring_vertex_range_(const struct lacedring_vertices* s, uint32_t c, uint32_t* more, uint32_t* most) {
    *more = 0;
    *most = UINT32_MAX;
    if (s->most != 0) { /* lattice, octahedral: -s->most < x < s->most */
        *more = s->most - 1;
        *most = 2 * *more;
        if (s->mapping == LACEDRING_MAPPING_OCTAHEDRAL && c == 2) {
            *more = 0;
            *most = 1;
        }
    } else if (s->mapping == LACEDRING_MAPPING_INTEGERS && s->type < 4) {
        *most = s->type < 2 ? 255 : 65535;
        if (s->type % 2 == 0) *more = *most / 2 + 1;
    }
}

void lacedring_octahedral(int32_t x, int32_t y, uint32_t bits, float out[3]) {
    const int32_t most = (1 << (bits - 1)) - 1, across = x < 0 ? -x : x, up = y < 0 ? -y : y, z = most - across - up;
    double length;
    if (z < 0) { /* the lower half is folded over the edges of the upper one */
        x = x < 0 ? up - most : most - up;
        y = y < 0 ? across - most : most - across;
    }
    length = sqrt((double)x * x + (double)y * y + (double)z * z); /* the root of an exact integer */
    out[0] = (float)(x / length);
    out[1] = (float)(y / length);
    out[2] = (float)(z / length);
}

/* Does decoding eight blocks at once with LACEDRING_TO_VALUES_ write values instead of integers? */
static int lacedring_in_lanes_(const struct lacedring_vertices* s) {
    return s->mapping == LACEDRING_MAPPING_LATTICE || s->mapping == LACEDRING_MAPPING_FLOATS ||
           s->mapping == LACEDRING_MAPPING_DECIMALS;
}

/* Writes the exceptions among values [first, first + count) of the attribute. */
static void lacedring_exceptions_(const struct lacedring_vertices* s, uint64_t first, uint32_t count, uint8_t* out) {
    uint32_t from = 0, to = s->exception_count;
    while (from < to) { /* the first exception at `first` or later */
        const uint32_t middle = from + (to - from) / 2;
        if (s->exceptions[(size_t)2 * middle] < first) {
            from = middle + 1;
        } else {
            to = middle;
        }
    }
    for (; from < s->exception_count && s->exceptions[(size_t)2 * from] - first < count; ++from)
        memcpy(out + 4 * (size_t)(s->exceptions[(size_t)2 * from] - first), s->exceptions + (size_t)2 * from + 1, 4);
}

/* Converts the integers of vertices [first, first + count) to values. Returns where the values end. */
static uint8_t* lacedring_vertex_values_(const struct lacedring_vertices* s, const uint32_t* integers, uint32_t first,
                                         uint32_t count, uint8_t* out) {
    const uint32_t n = s->components;
    uint32_t i, c;
    if (s->mapping == LACEDRING_MAPPING_INTEGERS) {
        const uint32_t size = s->type < 2 ? 1 : s->type < 4 ? 2 : 4;
        for (i = 0; i < count * n; ++i, out += size) memcpy(out, integers + i, size); /* little-endian */
    } else if (s->mapping == LACEDRING_MAPPING_LATTICE) {
        const float step = s->step;
        for (i = 0; i < count * n; ++i, out += 4) {
            const float value = (float)(int32_t)integers[i] * step;
            memcpy(out, &value, 4);
        }
    } else if (s->mapping == LACEDRING_MAPPING_FLOATS) {
        for (i = 0; i < count * n; ++i, out += 4) {
            const uint32_t value = integers[i] ^ (integers[i] & 0x80000000u ? 0x80000000u : UINT32_MAX);
            memcpy(out, &value, 4);
        }
    } else if (s->mapping == LACEDRING_MAPPING_DECIMALS) {
        const double power = lacedring_powers_[s->digits];
        uint8_t* begin = out;
        for (i = 0; i < count * n; ++i, out += 4) {
            const float value = (float)((int32_t)integers[i] / power);
            memcpy(out, &value, 4);
        }
        lacedring_exceptions_(s, (uint64_t)first * n, count * n, begin);
    } else if (s->mapping == LACEDRING_MAPPING_DOUBLES) {
        for (i = 0; i < count * n; i += 2, out += 8) {
            const uint32_t high = integers[i] ^ (integers[i] & 0x80000000u ? 0x80000000u : UINT32_MAX);
            memcpy(out, integers + i + 1, 4);
            memcpy(out + 4, &high, 4);
        }
    } else {
        for (i = 0; i < count; ++i, integers += n) {
            float value[4];
            lacedring_octahedral((int32_t)integers[0], (int32_t)integers[1], s->bits, value);
            value[3] = n == 3 && integers[2] != 0 ? -1.0f : 1.0f;
            for (c = 0; c <= n; ++c, out += 4) memcpy(out, value + c, 4);
        }
    }
    return out;
}

/* Checks all blocks; writes their values if `out` is not null. */
static enum lacedring_status lacedring_vertex_check_(const struct lacedring_vertices* s, uint8_t* out,
                                                     uint64_t* where) {
    const struct lacedring_data_ d = lacedring_data_of_(s);
    const uint32_t blocks = lacedring_vertex_blocks_(s), group_words = lacedring_vertex_group_(s);
    uint32_t block, c, i, some = 0, k = 0, bad = 0, alone = 0, values[LACEDRING_SOME_VALUES_];
    struct lacedring_ranges_ ranges;
    uint64_t end = 0, ends[8];
    for (c = 0; c < s->components; ++c) {
        const uint32_t said = s->parameters[2 * c + 1];
        if (said >> 16 != 0 || (said & 63) > 32)
            return lacedring_at_(where, LACEDRING_VERTICES_HEADER_WORDS + 2 * c + 1, LACEDRING_STATUS_HEADER);
    }
    for (i = 0; i < s->exception_count; ++i) { /* increasing, and numbers of values */
        const uint32_t value = s->exceptions[(size_t)2 * i];
        if (value >= (uint64_t)s->vertices * s->components || (i > 0 && value <= s->exceptions[(size_t)2 * i - 2]))
            return lacedring_at_(where, 6, LACEDRING_STATUS_HEADER);
    }
    for (c = 0; c < s->components; ++c) {
        const uint32_t bits = s->parameters[2 * c + 1] & 63;
        lacedring_vertex_range_(s, c, ranges.more + c, ranges.most + c);
        ranges.mask[c] = (uint32_t)((UINT64_C(1) << bits) - 1);
    }
    for (block = 0; block < blocks; ++block, ++k) {
        uint64_t at;
        if (k == some) {
            k = 0;
            some = lacedring_vertex_some_(s, &d, block, alone ? block + 1 : blocks, LACEDRING_TO_CHECK_, &ranges, ends,
                                          &bad, values);
            alone = some > 1 && bad;
            if (alone)
                some =
                    lacedring_vertex_some_(s, &d, block, block + 1, LACEDRING_TO_CHECK_, &ranges, ends, &bad, values);
        }
        at = lacedring_vertex_begin_(s, block);
        /* A group begins at the next word boundary; the bits between are 0. */
        if (block % LACEDRING_VERTICES_GROUP_ == 0) {
            const uint32_t* group = s->table + (size_t)(block / LACEDRING_VERTICES_GROUP_) * group_words;
            const uint32_t fields = blocks - block < LACEDRING_VERTICES_GROUP_ ? blocks - block - 1 : 15;
            const uint32_t used = fields * s->field_bits;
            if (end % 32 != 0 && lacedring_data_take_(&d, &end, (uint32_t)(32 - end % 32)) != 0)
                return lacedring_at_(where, block - 1, LACEDRING_STATUS_BLOCK);
            for (i = 1; i < group_words; ++i) { /* bits after the fields are 0 */
                const uint32_t below = used > 32 * (i - 1) ? used - 32 * (i - 1) : 0;
                if (below < 32 && group[i] >> below != 0) return lacedring_at_(where, block, LACEDRING_STATUS_GROUP);
            }
            if (at != end) return lacedring_at_(where, block, LACEDRING_STATUS_GROUP);
        }
        if (at != end || end > d.last || bad || ends[k] > d.last)
            return lacedring_at_(where, block, LACEDRING_STATUS_BLOCK);
        if (out != NULL)
            out = lacedring_vertex_values_(s, values + (size_t)k * LACEDRING_VERTICES_BLOCK * s->components,
                                           block * LACEDRING_VERTICES_BLOCK, lacedring_vertex_count_(s, block), out);
        end = ends[k];
    }
    if (end % 32 != 0 && lacedring_data_take_(&d, &end, (uint32_t)(32 - end % 32)) != 0)
        return lacedring_at_(where, blocks - 1, LACEDRING_STATUS_BLOCK);
    if (end != d.last || s->data[s->data_words - 2] != 0 || s->data[s->data_words - 1] != 0)
        return lacedring_at_(where, end / 32, LACEDRING_STATUS_SIZE);
    return LACEDRING_STATUS_OK;
}

enum lacedring_status lacedring_vertices_check(const struct lacedring_vertices* s, uint64_t* where) {
    return lacedring_vertex_check_(s, NULL, where);
}

enum lacedring_status lacedring_vertices_decode_checked(const struct lacedring_vertices* s, void* out,
                                                        uint64_t* where) {
    return lacedring_vertex_check_(s, (uint8_t*)out, where);
}

enum lacedring_status lacedring_vertices_validate(const uint32_t* words, size_t count, struct lacedring_vertices* s,
                                                  uint64_t* where) {
    const enum lacedring_status status = lacedring_vertices_open(words, count, s, where);
    uint32_t crc;
    if (status != LACEDRING_STATUS_OK) return status;
    crc = lacedring_crc_(lacedring_crc_(UINT32_MAX, words, 3), words + 4, count - 4) ^ UINT32_MAX;
    if (crc != words[3]) return lacedring_at_(where, 0, LACEDRING_STATUS_CHECKSUM);
    return lacedring_vertices_check(s, where);
}

void lacedring_vertices_decode(const struct lacedring_vertices* s, void* out) {
    const struct lacedring_data_ d = lacedring_data_of_(s);
    const uint32_t blocks = lacedring_vertex_blocks_(s), whole = s->vertices / LACEDRING_VERTICES_BLOCK;
    const int lanes = lacedring_in_lanes_(s); /* eight blocks at once give values */
    uint32_t block = 0, some = 0, bad, integers[LACEDRING_SOME_VALUES_];
    uint64_t ends[8];
    uint8_t* to = (uint8_t*)out;
    while (block < blocks) {
        uint32_t first, count, *at = integers;
        if (lanes && (uintptr_t)out % 4 == 0) {
            if (some == 8 && block < whole && whole - block < 8) block = whole - 8; /* decodes some blocks again */
            at = (uint32_t*)out + (size_t)block * LACEDRING_VERTICES_BLOCK * s->components;
            to = (uint8_t*)at;
        }
        some = lacedring_vertex_some_(s, &d, block, blocks, LACEDRING_TO_VALUES_, NULL, ends, &bad, at);
        first = block * LACEDRING_VERTICES_BLOCK;
        count = some * LACEDRING_VERTICES_BLOCK;
        if (count > s->vertices - first) count = s->vertices - first;
        if (some > 1 && lanes) {
            if (at == integers) memcpy(to, integers, (size_t)4 * count * s->components);
            lacedring_exceptions_(s, (uint64_t)first * s->components, count * s->components, to);
            to += (size_t)4 * count * s->components;
        } else {
            to = lacedring_vertex_values_(s, at, first, count, to);
        }
        block += some;
    }
}

#undef LACEDRING_VERTICES_GROUP_
#undef LACEDRING_VERTICES_MOST_
#undef LACEDRING_SOME_VALUES_
#undef LACEDRING_LANE_COMPONENTS_
#ifdef __cplusplus
}
#endif
#endif /* LACEDRING_DECODE_IMPLEMENTATION */
