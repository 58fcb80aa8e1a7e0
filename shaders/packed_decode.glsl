// Random access to the packed stream: any triangle of a block, or a block corridor by corridor.
// Format: lrcore/packed/packed_format.h, the only other file that an engine needs with this one; docs/packed-format.md.
//
// Before including it, say where the stream's words are:
//     #define LR_PACKED_WORD(i) words[i]
// Then, for triangle in [0, triangles):
//     uvec3 indices = lr_packed_triangle(lr_packed_layout(), triangle);
// The stream must be valid (lr::validate_packed).
#ifndef LACEDRING_PACKED_DECODE_GLSL
#define LACEDRING_PACKED_DECODE_GLSL

#include "lrcore/packed/packed_format.h"

struct LrPackedLayout {
    uint triangles;
    uint directory;  // first word of it
    uint records;    // first byte of them
    uint vertex_bits;
    uint gap_bits;
};

LrPackedLayout lr_packed_layout() {
    LrPackedLayout p;
    p.triangles = LR_PACKED_WORD(LR_PACKED_WORD_TRIANGLES);
    p.directory = LR_PACKED_HEADER_WORDS + (p.triangles + 31u) / 32u;
    uint blocks = (p.triangles + LR_PACKED_BLOCK - 1u) / LR_PACKED_BLOCK;
    uint rest = blocks % LR_PACKED_GROUP;
    p.records = 4u * (p.directory + blocks / LR_PACKED_GROUP * LR_PACKED_GROUP_WORDS +
                      (rest == 0u ? 0u : 1u + (rest + 3u) / 4u));
    p.vertex_bits = LR_PACKED_WORD(LR_PACKED_WORD_WIDTHS) & 0xffu;
    p.gap_bits = LR_PACKED_WORD(LR_PACKED_WORD_WIDTHS) >> 8;
    return p;
}

// A record and what its reader knows. `at` and `end` are bits of the stream.
struct LrPackedReader {
    uint at, end;
    uint first, triangles;  // of the mesh, in the record
    bool plain;
    uint a, b, begun_a, begun_b;
    bool reversed, begun_reversed, finished;
    uint event, code;  // the next event's triangle, from the record's first
    uint top, depth;
    uvec2 stack[LR_PACKED_STACK];
};

// Triangles that belong together: from the i-th of the record `count` that turn, or (kind) one with its third vertex, or
// a wart's two.
#define LR_PACKED_RUN 0u
#define LR_PACKED_ONE 1u
#define LR_PACKED_PAIR 2u
struct LrPackedPiece {
    uint kind, count;
    uint a, b, x;
    bool reversed;
};

uint lr_packed_record_bytes(LrPackedLayout p, uint length) {
    if (length <= LR_PACKED_MAX_RECORD) return length;
    if (length < LR_PACKED_PLAIN) return 8u * (length - LR_PACKED_MAX_RECORD);
    return 3u * LR_PACKED_BLOCK / 8u * p.vertex_bits;
}

// 32 bits from bit `at` on.
uint lr_packed_bits(uint at) {
    uint word = at >> 5, shift = at & 31u;
    uint low = LR_PACKED_WORD(word) >> shift;
    return shift == 0u ? low : low | LR_PACKED_WORD(word + 1u) << (32u - shift);
}
// The same, with ones behind the record.
uint lr_packed_window(LrPackedReader r) {
    uint left = r.end - min(r.at, r.end);
    uint bits = lr_packed_bits(min(r.at, r.end));
    return left < 32u ? bits | 0xffffffffu << left : bits;
}
uint lr_packed_ones(uint window) { return window == 0xffffffffu ? 32u : uint(findLSB(~window)); }

uint lr_packed_take(inout LrPackedReader r, uint count) {
    uint value = lr_packed_window(r) & ((1u << count) - 1u);
    r.at += count;
    return value;
}
uint lr_packed_unary(inout LrPackedReader r, uint limit) {
    uint ones = min(lr_packed_ones(lr_packed_window(r)), limit);
    r.at += ones + (ones < limit ? 1u : 0u);
    return ones;
}
uint lr_packed_golomb(inout LrPackedReader r, uint order) {
    uint low = lr_packed_unary(r, 31u - order) + order;
    return (lr_packed_take(r, low) | 1u << low) - (1u << order);
}

void lr_packed_next_event(LrPackedLayout p, inout LrPackedReader r) {
    uint high = lr_packed_ones(lr_packed_window(r));
    if (high > LR_PACKED_BLOCK >> LR_PACKED_MIN_GAP_BITS || r.at + high >= r.end) {
        r.event = 0xffffffffu;
        r.code = LR_PACKED_TURN;
        return;
    }
    r.at += high + 1u;
    uint window = lr_packed_window(r);
    r.event += (high << p.gap_bits) + (window & ((1u << p.gap_bits) - 1u));
    r.code = min(lr_packed_ones(window >> p.gap_bits), LR_PACKED_TURN);
    r.at += p.gap_bits + r.code + (r.code < LR_PACKED_TURN ? 1u : 0u);
}

// The record that holds a triangle of the mesh.
LrPackedReader lr_packed_open(LrPackedLayout p, uint triangle) {
    LrPackedReader r;
    uint block = triangle / LR_PACKED_BLOCK, member = block % LR_PACKED_GROUP;
    uint group = p.directory + block / LR_PACKED_GROUP * LR_PACKED_GROUP_WORDS;
    uint offset = LR_PACKED_WORD(group);
    uint lengths = 0u, length = 0u;
    for (uint i = 0u; i <= member; ++i) {
        if (i % 4u == 0u) lengths = LR_PACKED_WORD(group + 1u + i / 4u);
        offset += length;
        length = lengths >> (8u * (i % 4u)) & 0xffu;
        if (i < member) length = lr_packed_record_bytes(p, length);
    }
    uint byte = p.records + offset;
    r.plain = length == LR_PACKED_PLAIN;
    r.first = block * LR_PACKED_BLOCK;
    r.triangles = min(p.triangles - r.first, LR_PACKED_BLOCK);
    if (length > LR_PACKED_MAX_RECORD && !r.plain) {
        uint parts = lr_packed_bits(8u * byte);
        byte += LR_PACKED_PARTS;
        uint part = triangle % LR_PACKED_BLOCK / LR_PACKED_PART;
        for (uint i = 0u; i < part; ++i) byte += parts >> (8u * i) & 0xffu;
        length = parts >> (8u * part) & 0xffu;
        r.first += part * LR_PACKED_PART;
        r.triangles = min(p.triangles - r.first, LR_PACKED_PART);
    }
    r.at = 8u * byte;
    r.end = r.at + 8u * length;
    r.top = 0u;
    r.depth = 0u;
    r.finished = false;
    r.event = 0u;
    if (r.plain) return r;
    r.a = lr_packed_take(r, p.vertex_bits);
    r.b = lr_packed_take(r, p.vertex_bits);
    r.reversed = lr_packed_take(r, 1u) != 0u;
    r.begun_a = r.a;
    r.begun_b = r.b;
    r.begun_reversed = r.reversed;
    lr_packed_next_event(p, r);
    return r;
}

uvec3 lr_packed_plain(LrPackedLayout p, LrPackedReader r, uint triangle) {
    uint mask = (1u << p.vertex_bits) - 1u, at = r.at + 3u * p.vertex_bits * (triangle - r.first);
    return uvec3(lr_packed_bits(at) & mask, lr_packed_bits(at + p.vertex_bits) & mask,
                 lr_packed_bits(at + 2u * p.vertex_bits) & mask);
}

void lr_packed_pop(inout LrPackedReader r) {
    --r.depth;
    uvec2 edge = r.stack[--r.top % LR_PACKED_STACK];
    r.a = edge.x;
    r.b = edge.y;
}

// What an event says about the triangle that follows.
void lr_packed_before(LrPackedLayout p, inout LrPackedReader r) {
    if (r.code == LR_PACKED_TURN) {
        r.reversed = !r.reversed;
        return;
    }
    r.finished = false;
    if (r.code == LR_PACKED_END) {
        lr_packed_pop(r);
        return;
    }
    if (r.code == LR_PACKED_RESUME) {
        bool back = lr_packed_take(r, 1u) != 0u;
        uint step = lr_packed_golomb(r, LR_PACKED_RESUME_ORDER);
        uint other = lr_packed_take(r, p.vertex_bits);
        r.begun_a = back ? other : r.b + step;
        r.begun_b = back ? r.a - step : other;
    } else {
        uint kind = lr_packed_unary(r, LR_PACKED_START_ANY);
        r.depth = 0u;
        if (kind == LR_PACKED_START_OTHER) {
            r.reversed = !r.begun_reversed;
        } else if (kind == LR_PACKED_START_ANY) {
            r.begun_a = lr_packed_take(r, p.vertex_bits);
            r.begun_b = lr_packed_take(r, p.vertex_bits);
            r.reversed = lr_packed_take(r, 1u) != 0u;
        } else {
            uint step = 1u;
            if (kind != LR_PACKED_START_NEXT) step = lr_packed_golomb(r, LR_PACKED_SIZE_ORDER);
            r.begun_a = r.begun_b + step;
            r.begun_b = r.begun_a + 2u + lr_packed_golomb(r, LR_PACKED_SIZE_ORDER);
            r.reversed = kind != LR_PACKED_START_NEXT && r.begun_reversed;
        }
    }
    r.a = r.begun_a;
    r.b = r.begun_b;
    r.begun_reversed = r.reversed;
}

// Turns of triangles [first, first + count) of the mesh that are 1.
uint lr_packed_ups(uint first, uint count) {
    uint ups = 0u;
    while (count > 0u) {
        uint n = min(count, 32u - (first & 31u));
        ups += uint(bitCount(LR_PACKED_WORD(LR_PACKED_HEADER_WORDS + first / 32u) >> (first & 31u) << (32u - n)));
        first += n;
        count -= n;
    }
    return ups;
}
bool lr_packed_turn(uint triangle) {
    return (LR_PACKED_WORD(LR_PACKED_HEADER_WORDS + triangle / 32u) >> (triangle & 31u) & 1u) != 0u;
}

// The triangles from the record's i-th on, as many as belong together.
LrPackedPiece lr_packed_step(LrPackedLayout p, inout LrPackedReader r, uint i) {
    while (r.event == i && r.code != LR_PACKED_WART && r.code != LR_PACKED_SPLIT && r.code != LR_PACKED_FAR &&
           r.code != LR_PACKED_JUMP) {
        lr_packed_before(p, r);
        lr_packed_next_event(p, r);
    }
    if (r.finished) {
        if (r.depth > 0u) {
            lr_packed_pop(r);
        } else {
            uint size = r.begun_b - r.begun_a;
            r.begun_a = r.begun_b + 1u;
            r.begun_b = r.begun_a + size;
            r.a = r.begun_a;
            r.b = r.begun_b;
        }
        r.finished = false;
    }
    LrPackedPiece piece = LrPackedPiece(LR_PACKED_RUN, 0u, r.a, r.b, 0u, r.reversed);
    if (r.event != i) {
        uint left = r.b - r.a == 1u ? 1u : r.b - r.a - 1u;
        piece.count = min(min(r.triangles - i, r.event - i), left);
        uint ups = lr_packed_ups(r.first + i, piece.count);
        r.a += ups;
        r.b -= piece.count - ups;
        r.finished = r.b - r.a == 1u;
        return piece;
    }
    bool along_a = lr_packed_turn(r.first + i);
    if (r.code == LR_PACKED_WART) {
        piece.kind = LR_PACKED_PAIR;
        piece.count = min(2u, r.triangles - i);
        piece.x = along_a ? r.a + 2u : r.b - 2u;
        if (along_a) {
            r.a += 2u;
        } else {
            r.b -= 2u;
        }
        lr_packed_next_event(p, r);
        return piece;
    }
    piece.kind = LR_PACKED_ONE;
    piece.count = 1u;
    uint enters = along_a ? 2u : 1u;
    if (r.code == LR_PACKED_FAR) {
        enters = lr_packed_take(r, 2u);
        piece.x = lr_packed_take(r, p.vertex_bits);
    } else {
        bool split = r.code == LR_PACKED_SPLIT;
        uint size = lr_packed_golomb(r, split ? LR_PACKED_SPLIT_ORDER : LR_PACKED_JUMP_ORDER) + (split ? 3u : 2u);
        piece.x = along_a ? r.a + size : r.b - size;
        if (split) enters = 3u;
    }
    if (enters == 3u) {
        r.stack[r.top++ % LR_PACKED_STACK] = along_a ? uvec2(piece.x, r.b) : uvec2(r.a, piece.x);
        r.depth = min(r.depth + 1u, LR_PACKED_STACK);
    }
    bool high = enters == 3u ? !along_a : enters == 2u;
    if (high) {
        r.a = piece.x;
    } else {
        r.b = piece.x;
    }
    r.finished = enters == 0u;
    lr_packed_next_event(p, r);
    return piece;
}

uvec3 lr_packed_oriented(uint a, uint x, uint b, bool reversed) { return reversed ? uvec3(a, x, b) : uvec3(a, b, x); }

uvec3 lr_packed_triangle(LrPackedLayout p, uint triangle) {
    LrPackedReader r = lr_packed_open(p, triangle);
    if (r.plain) return lr_packed_plain(p, r, triangle);
    uint wanted = triangle - r.first, i = 0u;
    LrPackedPiece piece = lr_packed_step(p, r, 0u);
    while (i + piece.count <= wanted) {
        i += piece.count;
        piece = lr_packed_step(p, r, i);
    }
    uint a = piece.a, b = piece.b, x = piece.x;
    bool up = lr_packed_turn(triangle);
    if (piece.kind == LR_PACKED_RUN) {
        uint ups = lr_packed_ups(r.first + i, wanted - i);
        a += ups;
        b -= wanted - i - ups;
        x = up ? a + 1u : b - 1u;
    } else if (wanted > i) {  // a wart's T2
        a = up ? a : b - 2u;
        b = a + 2u;
        x = a + 1u;
    }
    return lr_packed_oriented(a, x, b, piece.reversed);
}

#endif
