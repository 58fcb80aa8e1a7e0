// Decodes vertex streams (docs/vertex-format.md): one invocation decodes a block of 128 vertices, or a single vertex by
// decoding its block up to that vertex. This file needs no other.
//
//     #define LR_VERTEX_WORD(i) words[i]       // word i of the stream
//     #define LR_VERTEX_COMPONENTS 3u          // integers per vertex: a number, or a specialization constant
//     #define LR_VERTEX_PUT(i) ...             // called for each vertex i; its integers are lr_vertex_value[c]
//     #define LR_VERTEX_MAPPING 1u             // optional: the stream's mapping, a number or a specialization constant
//     #include "lacedring_vertices.glsl"
//
//     lr_vertex_block(lr_vertex_layout(), block, 128u);
//
// The stream must be valid (lacedring::validate_vertices); with any other, every loop still ends. lr_vertex_float maps
// an integer to a float, bit for bit like the CPU's decoder. Needs neither 64-bit integers nor doubles. Define
// LR_VERTEX_MAPPING if the mapping is known when the pipeline is created: this removes the code of the other mappings.
// On a device that executes both sides of branches, the code for decimals takes four times as long as all the rest.
#ifndef LACEDRING_VERTICES_GLSL
#define LACEDRING_VERTICES_GLSL

#define LR_VERTEX_HEADER_WORDS 7u
#define LR_VERTEX_BLOCK 128u
#define LR_VERTEX_GROUP 16u
#define LR_MAPPING_LATTICE 1u
#define LR_MAPPING_OCTAHEDRAL 2u
#define LR_MAPPING_FLOATS 3u
#define LR_MAPPING_DECIMALS 4u

struct LrVertexLayout {
    uint vertices;
    uint mapping;
    uint unit;        // lattice: bits of the step as a float; decimals: number of digits
    uint bits;        // octahedral: bits per integer
    uint exceptions;  // number of exceptions, which follow the parameters, two words each
    uint field_bits;
    uint table;  // first word of the table of groups
    uint data;   // first word of the blocks
};

#ifndef LR_VERTEX_MAPPING
#define LR_VERTEX_MAPPING (p.mapping)
#endif

uint lr_vertex_exceptions() { return LR_VERTEX_HEADER_WORDS + 2u * LR_VERTEX_COMPONENTS; }

LrVertexLayout lr_vertex_layout() {
    LrVertexLayout p;
    p.vertices = LR_VERTEX_WORD(1u);
    uint layout_word = LR_VERTEX_WORD(2u);
    p.mapping = layout_word >> 5 & 7u;
    p.bits = layout_word >> 13 & 31u;
    p.field_bits = layout_word >> 18 & 31u;
    p.unit = LR_VERTEX_WORD(4u);
    p.exceptions = LR_VERTEX_WORD(6u);
    p.table = lr_vertex_exceptions() + 2u * p.exceptions;
    uint in_group = LR_VERTEX_BLOCK * LR_VERTEX_GROUP, groups = p.vertices / in_group + (p.vertices % in_group == 0u ? 0u : 1u);
    p.data = p.table + groups * (1u + (15u * p.field_bits + 31u) / 32u);
    return p;
}

// The 32 bits that begin `at` bits after the start of word `base`.
uint lr_vertex_load(uint base, uint at) {
    uint word = base + at / 32u, shift = at & 31u, low = LR_VERTEX_WORD(word) >> shift;
    return shift == 0u ? low : low | LR_VERTEX_WORD(word + 1u) << (32u - shift);
}
uint lr_vertex_take(uint base, inout uint at, uint count) {
    uint value = bitfieldExtract(lr_vertex_load(base, at), 0, int(count));
    at += count;
    return value;
}
uint lr_vertex_quarter(uint x) { return uint(int(x + 2u) >> 2); }

uint lr_vertex_value[LR_VERTEX_COMPONENTS];

// Decodes the first `most` vertices of a block (all if it has fewer).
void lr_vertex_block(LrVertexLayout p, uint block, uint most) {
    const uint n = LR_VERTEX_COMPONENTS;
    uint first = block * LR_VERTEX_BLOCK, count = min(p.vertices - first, LR_VERTEX_BLOCK);
    uint group = p.table + block / LR_VERTEX_GROUP * (1u + (15u * p.field_bits + 31u) / 32u), k = block % LR_VERTEX_GROUP;
    uint base = p.data + LR_VERTEX_WORD(group), at = 0u;
    if (k > 0u) {
        uint field = (k - 1u) * p.field_bits;
        at = lr_vertex_take(group + 1u, field, p.field_bits);
    }
    uint predictor[LR_VERTEX_COMPONENTS], width[LR_VERTEX_COMPONENTS], step1[LR_VERTEX_COMPONENTS], step2[LR_VERTEX_COMPONENTS];
    for (uint c = 0u; c < n; ++c) {
        uint said = LR_VERTEX_WORD(LR_VERTEX_HEADER_WORDS + 2u * c + 1u);
        width[c] = said >> 6 & 31u;
        predictor[c] = said >> 11 & 31u;
        uint own = lr_vertex_take(base, at, 1u);
        uint other = lr_vertex_take(base, at, 5u * own);
        if (own != 0u) predictor[c] = other;
        step1[c] = step2[c] = 0u;
    }
    uint run = 4u << lr_vertex_take(base, at, 2u);
    for (uint c = 0u; c < n; ++c) {
        uint bits = LR_VERTEX_WORD(LR_VERTEX_HEADER_WORDS + 2u * c + 1u) & 63u;
        lr_vertex_value[c] = LR_VERTEX_WORD(LR_VERTEX_HEADER_WORDS + 2u * c) + lr_vertex_take(base, at, bits);
    }
    LR_VERTEX_PUT(first);

    uint last = min(count, most), low_at = 0u, end = 1u;  // end: of the current run
    uint low_bits[LR_VERTEX_COMPONENTS], row = 0u, present = 0u;
    // The plane predictor: its axis (3: none), and two slopes of 3 bits each, biased by 4.
    uint axis = 3u, last_axis = 0u, slopes = 36u, last_slopes = 36u;
    uvec2 zeros = uvec2(0u);
    uint seen = 0u;
    for (uint i = 1u; i < LR_VERTEX_BLOCK; ++i) {
        if (i >= last) break;
        if (i == end) {
            at += seen;  // skip the unary numbers at the end of the previous run
            if (n == 3u && (i - 1u) % 16u == 0u) {
                uint code = lr_vertex_load(base, at);
                axis = 3u;
                if ((code & 1u) == 0u) {
                    at += 1u;
                } else {
                    at += 2u;
                    if ((code & 2u) != 0u) {
                        last_axis = code >> 2 & 3u;
                        last_slopes = code >> 4 & 63u;
                        at += 8u;
                    }
                    axis = last_axis;
                    slopes = last_slopes;
                }
            }
            row = present = 0u;
            for (uint c = 0u; c < n; ++c) {
                uint code = lr_vertex_load(base, at), ones = min(uint(findLSB(~code)), 4u);
                at += min(ones + 1u, 4u);
                if (ones == 2u) width[c] = (width[c] + 1u) & 31u;
                if (ones == 3u) width[c] = (width[c] - 1u) & 31u;
                if (ones == 4u) {
                    width[c] = code >> 4 & 31u;
                    at += 5u;
                }
                if (ones != 1u) present |= 1u << c;
                low_bits[c] = ones == 1u ? 0u : width[c];
                row += low_bits[c];
            }
            low_at = at;
            end = min(i + run, count);
            at += row * (end - i);
            if (end == count) end = LR_VERTEX_BLOCK;  // no run follows
            zeros = uvec2(lr_vertex_load(base, at), lr_vertex_load(base, at + 32u));
            seen = 0u;
        }
        uint low = lr_vertex_load(base, low_at), taken = 0u;
        uint residual[LR_VERTEX_COMPONENTS];
        for (uint c = 0u; c < n; ++c) {
            residual[c] = 0u;
            if ((present >> c & 1u) != 0u) {
                if (taken + low_bits[c] > 32u) {
                    low_at += taken;
                    taken = 0u;
                    low = lr_vertex_load(base, low_at);
                }
                if (seen > 39u) {  // keeps at least 25 bits in `zeros`
                    at += seen;
                    seen = 0u;
                    zeros = uvec2(lr_vertex_load(base, at), lr_vertex_load(base, at + 32u));
                }
                uint z = min(uint(findLSB(zeros.x)), 24u);
                uint code = z << low_bits[c] | bitfieldExtract(low, int(taken), int(low_bits[c]));
                zeros = uvec2(zeros.x >> (z + 1u) | zeros.y << (31u - z), zeros.y >> (z + 1u));
                seen += z + 1u;
                taken += low_bits[c];
                residual[c] = code >> 1 ^ (0u - (code & 1u));
            }
        }
        low_at += taken;
        if (n == 3u && axis < 3u) {
            uint u = axis == 0u ? residual[1] : axis == 1u ? residual[2] : residual[0];
            uint v = axis == 0u ? residual[2] : axis == 1u ? residual[0] : residual[1];
            uint more = lr_vertex_quarter(((slopes & 7u) - 4u) * u + ((slopes >> 3) - 4u) * v);
            for (uint c = 0u; c < n; ++c) residual[c] += c == axis ? more : 0u;
        }
        for (uint c = 0u; c < n; ++c) {
            uint alpha = (predictor[c] & 7u) - 2u, beta = (predictor[c] >> 3) - 2u;
            uint difference = residual[c] + lr_vertex_quarter(alpha * step1[c] + beta * step2[c]);
            step2[c] = step1[c];
            step1[c] = difference;
            lr_vertex_value[c] += difference;
        }
        LR_VERTEX_PUT(first + i);
    }
}

// The bits of the float nearest to value / 10^digits. Uses long division, as float arithmetic would round twice.
uint lr_vertex_decimal(uint value, uint digits) {
    uint sign = value & 0x80000000u, number = sign != 0u ? 0u - value : value, divisor = 1u;
    for (uint k = 0u; k < 9u; ++k) divisor *= k < digits ? 10u : 1u;
    if (number == 0u) return 0u;
    uint quotient = number / divisor, rest = number % divisor;
    int exponent = 0;  // power of two of the quotient's lowest bit
    if (quotient >= 1u << 25) {  // more bits than needed: the lowest only decide whether there is a rest
        uint shift = uint(findMSB(quotient)) - 24u;
        if (bitfieldExtract(quotient, 0, int(shift)) != 0u) rest = 1u;
        quotient >>= shift;
        exponent = int(shift);
    }
    for (uint k = 0u; k < 64u; ++k) {
        if (quotient >= 1u << 24) break;
        rest *= 2u;
        quotient = quotient * 2u + (rest >= divisor ? 1u : 0u);
        if (rest >= divisor) rest -= divisor;
        --exponent;
    }
    uint odd = quotient >> 1 & 1u, half_way = quotient & 1u;  // round 25 bits to 24, ties to even
    quotient = (quotient >> 1) + (half_way != 0u && (rest != 0u || odd != 0u) ? 1u : 0u);
    return sign | (uint(exponent + 1 + 150) << 23) + quotient - (1u << 23);
}

// The bits of the float that an integer maps to, for lattices, floats and decimals. at: LR_VERTEX_COMPONENTS * vertex +
// component.
uint lr_vertex_float(LrVertexLayout p, uint at, uint value) {
    if (LR_VERTEX_MAPPING == LR_MAPPING_LATTICE) return floatBitsToUint(float(int(value)) * uintBitsToFloat(p.unit));
    if (LR_VERTEX_MAPPING == LR_MAPPING_DECIMALS) {
        uint low = 0u, high = p.exceptions;  // binary search for the first exception at or after `at`
        for (uint k = 0u; k < 32u; ++k) {
            if (low >= high) break;
            uint middle = low + (high - low) / 2u;
            if (LR_VERTEX_WORD(lr_vertex_exceptions() + 2u * middle) < at) {
                low = middle + 1u;
            } else {
                high = middle;
            }
        }
        uint word = lr_vertex_exceptions() + 2u * low;
        if (low < p.exceptions && LR_VERTEX_WORD(word) == at) return LR_VERTEX_WORD(word + 1u);
        return lr_vertex_decimal(value, p.unit);
    }
    return value ^ ((value & 0x80000000u) != 0u ? 0x80000000u : 0xffffffffu);
}

// The direction of two octahedral integers, as exact integers; not of unit length.
ivec3 lr_vertex_direction(LrVertexLayout p, uint x, uint y) {
    int most = (1 << (p.bits - 1u)) - 1;
    ivec2 v = ivec2(int(x), int(y)), size = abs(v);
    int z = most - size.x - size.y;
    if (z < 0) v = mix(most - size.yx, size.yx - most, lessThan(v, ivec2(0)));
    return ivec3(v, z);
}

#endif
