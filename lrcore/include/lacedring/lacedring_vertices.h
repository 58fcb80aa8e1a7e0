/* Decodes LacedRing's vertex streams into attributes. C99 or C++, one file beside lacedring_decode.h, no allocation;
   what lrcore decodes with. docs/vertex-format.md has the format.

   LACEDRING_DECODE_IMPLEMENTATION, defined in one .c or .cpp file before it is included, adds the functions there. A
   program that links lacedring::core has them already.

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
#define LACEDRING_VERTICES_MAX_COMPONENTS 16u /* integers a vertex */

/* What the integers of a vertex stand for. */
enum lacedring_mapping {
    LACEDRING_MAPPING_INTEGERS,   /* themselves: of 8, 16 or 32 bits, signed or not */
    LACEDRING_MAPPING_LATTICE,    /* integer * step, which is exact: a float */
    LACEDRING_MAPPING_OCTAHEDRAL, /* a unit vector by two integers; a third one is 0 or 1 for a tangent's w of 1 or -1
                                   */
    LACEDRING_MAPPING_FLOATS,     /* the bits of a float, in the order of the numbers */
    LACEDRING_MAPPING_DECIMALS,   /* the float nearest to integer / 10^digits; exceptions are listed */
    LACEDRING_MAPPING_DOUBLES     /* the bits of a double: the higher half as of a float, then the lower half */
};

/* A stream in memory, its header read. Holds no copy. */
struct lacedring_vertices {
    const uint32_t* parameters; /* two words a component */
    const uint32_t* exceptions; /* two words each: which value of the attribute, and the bits of its float */
    const uint32_t* table;      /* where groups of 16 blocks and their blocks begin */
    const uint32_t* data;
    size_t data_words; /* two of padding among them */
    uint32_t vertices;
    uint32_t components; /* integers a vertex */
    uint32_t mapping;    /* enum lacedring_mapping */
    uint32_t type;       /* of the attribute's values: 0 i8, 1 u8, 2 i16, 3 u16, 4 i32, 5 u32, 6 f32, 7 f64 */
    uint32_t normalized; /* integers that stand for 0 to 1, or -1 to 1 */
    uint32_t bits;       /* octahedral: of each of the two integers */
    uint32_t digits;     /* of decimals: behind the point */
    uint32_t most;       /* lattice, octahedral: what is above every integer and its negative */
    uint32_t exception_count;
    uint32_t field_bits; /* of the table's fields */
    float step;          /* of the lattice */
    float largest_error; /* of any value of any vertex; 0: none */
};

/* Reads the header and checks sizes: constant time. */
enum lacedring_status lacedring_vertices_open(const uint32_t* words, size_t count, struct lacedring_vertices* stream,
                                              uint64_t* where);

/* Checks all that decoders promise, but for the checksum: blocks lie where the table says, and no integer is out of the
   range that its component and mapping have. `stream` was opened. Linear time, no memory. Any words: safe. */
enum lacedring_status lacedring_vertices_check(const struct lacedring_vertices* stream, uint64_t* where);

/* Open, checksum and check. */
enum lacedring_status lacedring_vertices_validate(const uint32_t* words, size_t count,
                                                  struct lacedring_vertices* stream, uint64_t* where);

/* Blocks [block, end): the integers of vertices [128 * block, 128 * end), or of those that the last block has. */
void lacedring_vertices_blocks(const struct lacedring_vertices* stream, uint32_t block, uint32_t end, uint32_t* out);

/* All values of the attribute, tightly packed: lacedring_vertices_values of its type a vertex. Linear time. */
void lacedring_vertices_decode(const struct lacedring_vertices* stream, void* out);

/* Values of the attribute a vertex: 3 of a normal, whose components are 2. */
uint32_t lacedring_vertices_values(const struct lacedring_vertices* stream);

/* The unit vector of two octahedral integers of so many bits. The same on every machine. */
void lacedring_octahedral(int32_t x, int32_t y, uint32_t bits, float out[3]);

#ifdef __cplusplus
}
#endif
#endif /* LACEDRING_VERTICES_H */

#if defined(LACEDRING_DECODE_IMPLEMENTATION) && !defined(LACEDRING_VERTICES_IMPLEMENTED)
#define LACEDRING_VERTICES_IMPLEMENTED

#include <math.h>

#ifdef __cplusplus
extern "C" {
#endif

#define LACEDRING_VERTICES_GROUP_ 16u /* blocks */
#define LACEDRING_VERTICES_MOST_ 24u  /* zeros of a unary number */

uint32_t lacedring_vertices_values(const struct lacedring_vertices* stream) {
    if (stream->mapping == LACEDRING_MAPPING_OCTAHEDRAL) return stream->components + 1;
    return stream->mapping == LACEDRING_MAPPING_DOUBLES ? stream->components / 2 : stream->components;
}

LACEDRING_SMALL_ uint32_t lacedring_vertex_blocks_(const struct lacedring_vertices* s) {
    return s->vertices / LACEDRING_VERTICES_BLOCK + (s->vertices % LACEDRING_VERTICES_BLOCK != 0);
}

/* Vertices of a block. */
LACEDRING_SMALL_ uint32_t lacedring_vertex_count_(const struct lacedring_vertices* s, uint32_t block) {
    const uint32_t left = s->vertices - block * LACEDRING_VERTICES_BLOCK;
    return left < LACEDRING_VERTICES_BLOCK ? left : LACEDRING_VERTICES_BLOCK;
}

/* Words of a group of the table: where it begins, then a field for each block but the first. */
LACEDRING_SMALL_ uint32_t lacedring_vertex_group_(const struct lacedring_vertices* s) {
    return 1 + (15 * s->field_bits + 31) / 32;
}

static float lacedring_as_float_(uint32_t bits) {
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

enum lacedring_status lacedring_vertices_open(const uint32_t* words, size_t count, struct lacedring_vertices* s,
                                              uint64_t* where) {
    static const uint8_t mappings[8] = {1, 1, 1, 1, 1, 1, 2 | 4 | 8 | 16, 32}; /* that each type has */
    uint32_t layout, step;
    uint64_t size;
    if (count < LACEDRING_VERTICES_HEADER_WORDS) return lacedring_at_(where, 0, LACEDRING_STATUS_SHORT);
    if (words[0] != 0x3156524cu) return lacedring_at_(where, 0, LACEDRING_STATUS_MAGIC);
    layout = words[2];
    step = words[4];
    s->vertices = words[1];
    s->components = layout & 31;
    s->mapping = layout >> 5 & 7;
    s->type = layout >> 8 & 15;
    s->normalized = layout >> 12 & 1;
    s->bits = layout >> 13 & 31;
    s->field_bits = layout >> 18 & 31;
    s->step = s->mapping == LACEDRING_MAPPING_LATTICE ? lacedring_as_float_(step) : 0.0f;
    s->digits = s->mapping == LACEDRING_MAPPING_DECIMALS ? step : 0;
    s->exception_count = words[6];
    s->largest_error = lacedring_as_float_(words[5]);
    if (layout >> 23 != 0 || s->components == 0 || s->components > LACEDRING_VERTICES_MAX_COMPONENTS || s->type > 7 ||
        (mappings[s->type] >> s->mapping & 1) == 0 || (s->normalized && s->type > 5))
        return lacedring_at_(where, 2, LACEDRING_STATUS_HEADER);
    if (s->mapping == LACEDRING_MAPPING_OCTAHEDRAL
            ? s->bits < 2 || s->bits > 16 || s->components < 2 || s->components > 3
            : s->bits != 0)
        return lacedring_at_(where, 2, LACEDRING_STATUS_HEADER);
    if (s->mapping == LACEDRING_MAPPING_DOUBLES && s->components % 2 != 0)
        return lacedring_at_(where, 2, LACEDRING_STATUS_HEADER);
    /* A step is a normal number with 24 bits to spare above, so that no product is more than a float holds. */
    if (s->mapping == LACEDRING_MAPPING_LATTICE    ? step < 0x00800000u || step >= 0x73800000u
        : s->mapping == LACEDRING_MAPPING_DECIMALS ? step > 9
                                                   : step != 0)
        return lacedring_at_(where, 4, LACEDRING_STATUS_HEADER);
    if (s->mapping == LACEDRING_MAPPING_LATTICE || s->mapping == LACEDRING_MAPPING_OCTAHEDRAL ? words[5] >= 0x7f800000u
                                                                                              : words[5] != 0)
        return lacedring_at_(where, 5, LACEDRING_STATUS_HEADER);
    s->most = s->mapping == LACEDRING_MAPPING_OCTAHEDRAL ? 1u << (s->bits - 1) : 0;
    if (s->mapping == LACEDRING_MAPPING_LATTICE) { /* a float has 24 bits for the step and the integer */
        for (s->most = 1, size = step & 0x007fffffu; s->most < 1u << 23 && !(size & 1); s->most *= 2) size >>= 1;
    }
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
    uint64_t last; /* bit where a load may begin: none reads behind the data */
};

/* At least 57 bits from bit `at` on. */
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

LACEDRING_HOT_ uint32_t lacedring_zeros_(uint64_t bits) { /* below the lowest one; `bits` has one */
#if defined(__GNUC__) && !defined(LACEDRING_PLAIN)
    return (uint32_t)__builtin_ctzll(bits);
#else
    uint32_t n = 0;
    for (; !(bits & 1); bits >>= 1) ++n;
    return n;
#endif
}

/* The bit of the data at which a block begins. */
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

/* How the values of a run of vertices are coded. */
struct lacedring_run_ {
    uint32_t low_bits[LACEDRING_VERTICES_MAX_COMPONENTS];
    uint32_t zero; /* components whose residuals are all 0: a bit each */
    uint32_t axis; /* that the plane gives from the two others; 3: none */
    int32_t slope[2];
};

/* A component's state: its integer, and its last two differences. */
struct lacedring_path_ {
    uint32_t value, d1, d2;
    int32_t alpha, beta;
};

LACEDRING_HOT_ uint32_t lacedring_quarter_(uint32_t x) { /* x + 2, signed, divided by 4 and rounded down */
    return ((x + 2) >> 2 ^ 0x20000000u) - 0x20000000u;
}

/* Decodes `count` vertices; `at` is where their bits begin, and then where they end. Returns what is above the most
   zeros of a unary number, or 0. */
LACEDRING_HOT_ uint32_t lacedring_vertex_run_(const struct lacedring_data_* d, const struct lacedring_run_* run,
                                              struct lacedring_path_* path, uint32_t n, uint32_t count, uint64_t* at,
                                              uint32_t* out) {
    uint32_t i, c, row = 0, bad = 0;
    uint64_t low_at = *at, unary_at, zeros;
    uint32_t seen = 0; /* bits of `zeros` that were read */
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
            residual[c] = (code >> 1) ^ (0u - (code & 1)); /* 0, -1, 1, -2 ... */
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

/* Decodes a block of `count` vertices that begins at bit `at`; then that is where it ends. Returns 0 if it is sound. */
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
        uint64_t window = lacedring_data_at_(d, *at); /* of 57 bits or more; the plane takes 10, a width 9 */
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
            uint64_t code;
            uint32_t ones;
            if (used > 57 - 9) {
                *at += used;
                window = lacedring_data_at_(d, *at);
                used = 0;
            }
            code = window >> used;
            ones = lacedring_zeros_(~code | 16); /* 0: as before, 1: none, 2: one more, 3: one less, 4: given */
            used += ones < 4 ? ones + 1 : 9;
            bad |= (ones == 2 && bits[c] == 31) || (ones == 3 && bits[c] == 0);
            bits[c] = ones == 4 ? (uint32_t)(code >> 4) & 31 : (bits[c] + (ones == 2) - (ones == 3)) & 31;
            run.zero |= (uint32_t)(ones == 1) << c;
            run.low_bits[c] = ones == 1 ? 0 : bits[c];
        }
        *at += used;
        bad |= lacedring_vertex_run_(d, &run, path, n, here, at, out + (size_t)i * n);
    }
    return bad;
}

static uint32_t lacedring_vertex_any_block_(const struct lacedring_vertices* s, const struct lacedring_data_* d,
                                            uint32_t block, uint64_t* at, uint32_t* out) {
    const uint32_t count = lacedring_vertex_count_(s, block);
    if (s->components == 3) return lacedring_vertex_block_(s, d, 3, count, at, out);
    if (s->components == 2) return lacedring_vertex_block_(s, d, 2, count, at, out);
    return lacedring_vertex_block_(s, d, s->components, count, at, out);
}

static struct lacedring_data_ lacedring_data_of_(const struct lacedring_vertices* s) {
    struct lacedring_data_ d;
    d.bytes = (const uint8_t*)s->data;
    d.last = 32 * (uint64_t)(s->data_words - 2);
    return d;
}

void lacedring_vertices_blocks(const struct lacedring_vertices* s, uint32_t block, uint32_t end, uint32_t* out) {
    const struct lacedring_data_ d = lacedring_data_of_(s);
    for (; block < end; ++block) {
        uint64_t at = lacedring_vertex_begin_(s, block);
        lacedring_vertex_any_block_(s, &d, block, &at, out);
        out += (size_t)LACEDRING_VERTICES_BLOCK * s->components;
    }
}

/* Is an integer one that its mapping and type have? */
static int lacedring_vertex_fits_(const struct lacedring_vertices* s, uint32_t c, uint32_t value) {
    const int32_t i = (int32_t)value;
    if (s->mapping == LACEDRING_MAPPING_LATTICE) return (uint32_t)(i < 0 ? 0u - value : value) < s->most;
    if (s->mapping == LACEDRING_MAPPING_OCTAHEDRAL)
        return c == 2 ? value <= 1 : (uint32_t)(i < 0 ? 0u - value : value) < s->most;
    if (s->mapping != LACEDRING_MAPPING_INTEGERS) return 1;
    switch (s->type) {
        case 0:
            return i >= -128 && i <= 127;
        case 1:
            return value <= 255;
        case 2:
            return i >= -32768 && i <= 32767;
        case 3:
            return value <= 65535;
        default:
            return 1;
    }
}

enum lacedring_status lacedring_vertices_check(const struct lacedring_vertices* s, uint64_t* where) {
    const struct lacedring_data_ d = lacedring_data_of_(s);
    const uint32_t blocks = lacedring_vertex_blocks_(s), group_words = lacedring_vertex_group_(s);
    uint32_t block, c, i, values[LACEDRING_VERTICES_BLOCK * LACEDRING_VERTICES_MAX_COMPONENTS];
    uint64_t end = 0;
    for (c = 0; c < s->components; ++c) {
        const uint32_t said = s->parameters[2 * c + 1];
        if (said >> 16 != 0 || (said & 63) > 32)
            return lacedring_at_(where, LACEDRING_VERTICES_HEADER_WORDS + 2 * c + 1, LACEDRING_STATUS_HEADER);
    }
    for (i = 0; i < s->exception_count; ++i) { /* in order, and of the attribute */
        const uint32_t value = s->exceptions[(size_t)2 * i];
        if (value >= (uint64_t)s->vertices * s->components || (i > 0 && value <= s->exceptions[(size_t)2 * i - 2]))
            return lacedring_at_(where, 6, LACEDRING_STATUS_HEADER);
    }
    for (block = 0; block < blocks; ++block) {
        const uint32_t count = lacedring_vertex_count_(s, block);
        uint64_t at = lacedring_vertex_begin_(s, block);
        if (block % LACEDRING_VERTICES_GROUP_ == 0) { /* at the next word, behind zeros */
            const uint32_t* group = s->table + (size_t)(block / LACEDRING_VERTICES_GROUP_) * group_words;
            const uint32_t fields = blocks - block < LACEDRING_VERTICES_GROUP_ ? blocks - block - 1 : 15;
            const uint32_t used = fields * s->field_bits;
            if (end % 32 != 0 && lacedring_data_take_(&d, &end, (uint32_t)(32 - end % 32)) != 0)
                return lacedring_at_(where, block - 1, LACEDRING_STATUS_BLOCK);
            for (i = 1; i < group_words; ++i) { /* no bits behind the fields */
                const uint32_t below = used > 32 * (i - 1) ? used - 32 * (i - 1) : 0;
                if (below < 32 && group[i] >> below != 0) return lacedring_at_(where, block, LACEDRING_STATUS_GROUP);
            }
            if (at != end) return lacedring_at_(where, block, LACEDRING_STATUS_GROUP);
        }
        if (at != end || end > d.last) return lacedring_at_(where, block, LACEDRING_STATUS_BLOCK);
        if (lacedring_vertex_any_block_(s, &d, block, &at, values) != 0 || at > d.last)
            return lacedring_at_(where, block, LACEDRING_STATUS_BLOCK);
        for (i = 0; i < count; ++i) {
            for (c = 0; c < s->components; ++c) {
                const uint32_t value = values[i * s->components + c], bits = s->parameters[2 * c + 1] & 63;
                if ((bits < 32 && (value - s->parameters[2 * c]) >> bits != 0) || !lacedring_vertex_fits_(s, c, value))
                    return lacedring_at_(where, block, LACEDRING_STATUS_BLOCK);
            }
        }
        end = at;
    }
    if (end % 32 != 0 && lacedring_data_take_(&d, &end, (uint32_t)(32 - end % 32)) != 0)
        return lacedring_at_(where, blocks - 1, LACEDRING_STATUS_BLOCK);
    if (end != d.last || s->data[s->data_words - 2] != 0 || s->data[s->data_words - 1] != 0)
        return lacedring_at_(where, end / 32, LACEDRING_STATUS_SIZE);
    return LACEDRING_STATUS_OK;
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

void lacedring_octahedral(int32_t x, int32_t y, uint32_t bits, float out[3]) {
    const int32_t most = (1 << (bits - 1)) - 1, across = x < 0 ? -x : x, up = y < 0 ? -y : y, z = most - across - up;
    double length;
    if (z < 0) { /* the lower half is folded over the edges of the upper one */
        x = x < 0 ? up - most : most - up;
        y = y < 0 ? across - most : most - across;
    }
    length = sqrt((double)x * x + (double)y * y + (double)z * z); /* the root of an integer */
    out[0] = (float)(x / length);
    out[1] = (float)(y / length);
    out[2] = (float)(z / length);
}

/* Writes decimals: `count` values from value `first` of the attribute on. */
static void lacedring_decimals_(const struct lacedring_vertices* s, const uint32_t* integers, uint64_t first,
                                uint32_t count, uint8_t* out) {
    static const double powers[10] = {1, 10, 100, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9};
    uint32_t i, from = 0, to = s->exception_count;
    for (i = 0; i < count; ++i) {
        const float value = (float)((int32_t)integers[i] / powers[s->digits]);
        memcpy(out + (size_t)4 * i, &value, 4);
    }
    while (from < to) { /* the first exception that is not before */
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

/* Writes the values of `count` vertices, from vertex `first` on, whose integers are given. */
static uint8_t* lacedring_vertex_values_(const struct lacedring_vertices* s, const uint32_t* integers, uint32_t first,
                                         uint32_t count, uint8_t* out) {
    const uint32_t n = s->components;
    uint32_t i, c;
    if (s->mapping == LACEDRING_MAPPING_INTEGERS) {
        const uint32_t size = s->type < 2 ? 1 : s->type < 4 ? 2 : 4;
        for (i = 0; i < count * n; ++i, out += size) memcpy(out, integers + i, size); /* little-endian */
    } else if (s->mapping == LACEDRING_MAPPING_LATTICE) {
        for (i = 0; i < count * n; ++i, out += 4) {
            const float value = (float)(int32_t)integers[i] * s->step;
            memcpy(out, &value, 4);
        }
    } else if (s->mapping == LACEDRING_MAPPING_FLOATS) {
        for (i = 0; i < count * n; ++i, out += 4) {
            const uint32_t value = integers[i] ^ (integers[i] & 0x80000000u ? 0x80000000u : UINT32_MAX);
            memcpy(out, &value, 4);
        }
    } else if (s->mapping == LACEDRING_MAPPING_DECIMALS) {
        lacedring_decimals_(s, integers, (uint64_t)first * n, count * n, out);
        out += (size_t)4 * count * n;
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

void lacedring_vertices_decode(const struct lacedring_vertices* s, void* out) {
    const struct lacedring_data_ d = lacedring_data_of_(s);
    uint32_t block, integers[LACEDRING_VERTICES_BLOCK * LACEDRING_VERTICES_MAX_COMPONENTS];
    uint8_t* to = (uint8_t*)out;
    for (block = 0; block < lacedring_vertex_blocks_(s); ++block) {
        uint64_t at = lacedring_vertex_begin_(s, block);
        lacedring_vertex_any_block_(s, &d, block, &at, integers);
        to = lacedring_vertex_values_(s, integers, block * LACEDRING_VERTICES_BLOCK, lacedring_vertex_count_(s, block),
                                      to);
    }
}

#undef LACEDRING_VERTICES_GROUP_
#undef LACEDRING_VERTICES_MOST_
#ifdef __cplusplus
}
#endif
#endif /* LACEDRING_DECODE_IMPLEMENTATION */
