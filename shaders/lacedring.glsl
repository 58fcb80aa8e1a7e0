// LacedRing in one file: any triangle of a lean or a packed stream, in any shader stage. Take this file alone.
//
// Say where the stream's words are, include it, ask:
//     layout(std430, binding = 0) readonly buffer Stream { uint words[]; };  // or a buffer reference
//     #define LR_LEAN_WORD(i) words[i]
//     #include "lacedring.glsl"
//     ...
//     uvec3 v = lr_lean_triangle(lr_lean_layout(), slot);  // slot < lr_lean_slots(lr_lean_layout())
// Of a packed stream:
//     #define LR_PACKED_WORD(i) words[i]
//     uvec3 v = lr_packed_triangle(lr_packed_layout(), t);  // t < lr_packed_layout().triangles
// v are vertices in the stream's order (its vertex_order). A lean triangle whose first two are equal is degenerate: it
// covers nothing, draw it or skip it. A stream must be valid (lacedring::validate_lean, lacedring::validate_packed); on any other, every
// loop still ends. docs/engine-guide.md has an example of every stage.
//
// The constants are those of lrcore/codec/lean/lean_format.h and lrcore/codec/packed/packed_format.h, which say what they mean. A C++
// file may include this one behind them: the compiler then checks that they are the same.
#ifndef LACEDRING_GLSL
#define LACEDRING_GLSL

#define LR_LEAN_MAGIC 0x4e4c524cu
#define LR_LEAN_VERSION 1u
#define LR_LEAN_HEADER_WORDS 8u
#define LR_LEAN_WORD_MAGIC 0u
#define LR_LEAN_WORD_VERSION 1u
#define LR_LEAN_WORD_VERTICES 2u
#define LR_LEAN_WORD_RINGS2 3u
#define LR_LEAN_WORD_RINGS1 4u
#define LR_LEAN_WORD_VERBATIM 5u
#define LR_LEAN_WORD_TRIANGLES 6u
#define LR_LEAN_WORD_CHECKSUM 7u
#define LR_LEAN_TIP_MASK 0x1fffffffu
#define LR_LEAN_WART_FLAG 0x80000000u
#define LR_LEAN_CLOSE_FLAG 0x40000000u
#define LR_LEAN_FLIP_FLAG 0x20000000u

#define LR_PACKED_MAGIC 0x4b50524cu
#define LR_PACKED_VERSION 1u
#define LR_PACKED_HEADER_WORDS 8u
#define LR_PACKED_WORD_MAGIC 0u
#define LR_PACKED_WORD_VERSION 1u
#define LR_PACKED_WORD_VERTICES 2u
#define LR_PACKED_WORD_TRIANGLES 3u
#define LR_PACKED_WORD_RECORD_BYTES 4u
#define LR_PACKED_WORD_WIDTHS 5u
#define LR_PACKED_WORD_RESERVED 6u
#define LR_PACKED_WORD_CHECKSUM 7u
#define LR_PACKED_BLOCK 256u
#define LR_PACKED_BLOCK_WORDS 8u
#define LR_PACKED_TAIL_WORDS 2u
#define LR_PACKED_MIN_GAP_BITS 3u
#define LR_PACKED_GROUP 16u
#define LR_PACKED_GROUP_WORDS 5u
#define LR_PACKED_MAX_RECORD 160u
#define LR_PACKED_PLAIN 255u
#define LR_PACKED_PARTS 4u
#define LR_PACKED_PART 64u
#define LR_PACKED_PART_WORDS 2u
#define LR_PACKED_STACK 16u
#define LR_PACKED_WART 0u
#define LR_PACKED_SPLIT 1u
#define LR_PACKED_BESIDE 2u
#define LR_PACKED_START 3u
#define LR_PACKED_FAR 4u
#define LR_PACKED_JUMP 5u
#define LR_PACKED_END 6u
#define LR_PACKED_TURN 7u
#define LR_PACKED_START_OTHER 0u
#define LR_PACKED_START_NEXT 1u
#define LR_PACKED_START_NEAR 2u
#define LR_PACKED_START_ANY 3u
#define LR_PACKED_BESIDE_NOW_B 0u
#define LR_PACKED_BESIDE_NOW_A 1u
#define LR_PACKED_BESIDE_BEGUN_A 2u
#define LR_PACKED_BESIDE_BEGUN_B 3u
#define LR_PACKED_SPLIT_ORDER 2u
#define LR_PACKED_JUMP_ORDER 1u
#define LR_PACKED_SIZE_ORDER 2u
#define LR_PACKED_BESIDE_ORDER 1u

#ifndef __cplusplus

// Lean: random access in constant time, at most four words read. Paper: LR 2011, section 7. A shader that has header and
// slots in different places says LR_LEAN_HEADER(i) and LR_LEAN_SLOTS(i), both with i counted from the stream's first word.

#ifdef LR_LEAN_WORD
#define LR_LEAN_HEADER(i) LR_LEAN_WORD(i)
#define LR_LEAN_SLOTS(i) LR_LEAN_WORD(i)
#endif

struct LrLeanLayout {
    uint rings2;
    uint rings1;
    uint verbatim;
};

#ifdef LR_LEAN_HEADER
LrLeanLayout lr_lean_layout() {
    return LrLeanLayout(LR_LEAN_HEADER(LR_LEAN_WORD_RINGS2), LR_LEAN_HEADER(LR_LEAN_WORD_RINGS1),
                        LR_LEAN_HEADER(LR_LEAN_WORD_VERBATIM));
}
#endif

uint lr_lean_slots(LrLeanLayout lean) { return 2u * lean.rings2 + lean.rings1 + lean.verbatim; }

// v.n of ring vertex v, whose left and right words these are; of a one-sided ring, its one word twice.
uint lr_lean_next(uint v, uint left, uint right) {
    if ((left & LR_LEAN_CLOSE_FLAG) != 0u) return left & LR_LEAN_TIP_MASK;
    if ((right & LR_LEAN_CLOSE_FLAG) != 0u) return right & LR_LEAN_TIP_MASK;
    return v + 1u;
}

// The triangle of a ring slot: `word` is the slot's, next = v.n, skip = v.n.n (looked at for a wart only). A free slot's
// tip is one of its edge's own vertices, and so is a right closing slot's: the triangle comes out degenerate by itself.
uvec3 lr_lean_ring_triangle(uint word, uint v, uint next, uint skip, bool right) {
    bool closes = (word & LR_LEAN_CLOSE_FLAG) != 0u;
    uint tip = closes && !right ? v : word & LR_LEAN_TIP_MASK;
    uint end = (word & LR_LEAN_WART_FLAG) != 0u ? skip : next;
    bool flip = (word & LR_LEAN_FLIP_FLAG) != 0u;
    return right != flip ? uvec3(end, tip, v) : uvec3(v, tip, end);
}

#ifdef LR_LEAN_SLOTS
uint lr_lean_word(uint i) { return LR_LEAN_SLOTS(LR_LEAN_HEADER_WORDS + i); }

// Every kind of slot takes the same few loads in the same places, so that invocations wait little for each other.
uvec3 lr_lean_triangle(LrLeanLayout lean, uint slot) {
    uint two_sided = 2u * lean.rings2, ring_slots = two_sided + lean.rings1;
    bool verbatim = slot >= ring_slots, one_sided = slot >= two_sided && !verbatim;
    uint at = verbatim ? ring_slots + 3u * (slot - ring_slots) : one_sided ? slot : slot & ~1u;
    uint first = lr_lean_word(at), second = lr_lean_word(one_sided ? at : at + 1u);
    uint v = one_sided ? slot - lean.rings2 : slot >> 1;
    bool right = slot < two_sided && (slot & 1u) != 0u;
    uint word = right ? second : first;
    uint next = lr_lean_next(v, first, second), skip = next + 1u;
    // v.n.n needs no third look: behind a closing edge comes the ring's first edge, which never closes.
    if (verbatim || ((word & LR_LEAN_WART_FLAG) != 0u && next == v + 1u)) {
        uint far = verbatim ? at + 2u : one_sided ? slot + 1u : 2u * next;
        uint third = lr_lean_word(far);
        if (verbatim) return uvec3(first, second, third);
        skip = lr_lean_next(next, third, lr_lean_word(one_sided ? far : far + 1u));
    }
    return lr_lean_ring_triangle(word, v, next, skip, right);
}
#endif

// Packed: any triangle of a block, or a block in steps, event by event (as shaders/packed_decode.comp does). A stream
// that no one descriptor covers has LR_PACKED_HEADER, LR_PACKED_TURNS, LR_PACKED_DIRECTORY and LR_PACKED_RECORDS instead
// of LR_PACKED_WORD, all with i counted from the stream's first word. A shader without any of them has no packed part.

#ifdef LR_PACKED_WORD
#define LR_PACKED_HEADER(i) LR_PACKED_WORD(i)
#define LR_PACKED_TURNS(i) LR_PACKED_WORD(i)
#define LR_PACKED_DIRECTORY(i) LR_PACKED_WORD(i)
#define LR_PACKED_RECORDS(i) LR_PACKED_WORD(i)
#endif
#ifdef LR_PACKED_HEADER

struct LrPackedLayout {
    uint triangles;
    uint directory;  // first word of it
    uint records;    // first word of them
    uint vertex_bits;
    uint gap_bits;
};

LrPackedLayout lr_packed_layout() {
    LrPackedLayout p;
    p.triangles = LR_PACKED_HEADER(LR_PACKED_WORD_TRIANGLES);
    p.directory = LR_PACKED_HEADER_WORDS + p.triangles / 32u + (p.triangles % 32u == 0u ? 0u : 1u);
    uint blocks = p.triangles / LR_PACKED_BLOCK + (p.triangles % LR_PACKED_BLOCK == 0u ? 0u : 1u);
    uint rest = blocks % LR_PACKED_GROUP;
    p.records = p.directory + blocks / LR_PACKED_GROUP * LR_PACKED_GROUP_WORDS + (rest == 0u ? 0u : 1u + (rest + 3u) / 4u);
    p.vertex_bits = LR_PACKED_HEADER(LR_PACKED_WORD_WIDTHS) & 31u;
    p.gap_bits = LR_PACKED_HEADER(LR_PACKED_WORD_WIDTHS) >> 8 & 7u;
    return p;
}

// A block and what its reader knows. Triangles, where it does not say of the mesh, count from the block's first.
struct LrPackedReader {
    uint first;    // of the mesh: the block's first triangle
    uint i, stop;  // the next triangle, and the end of the record's
    uint ups;      // turns before i that are 1
    bool plain;
    uint word;     // of the stream, in which the block's records begin
    uint at, end;  // the next bit, and the end of the record, from there
    uvec2 bits;    // from `at` on, what lr_packed_fill has loaded
    uint a, b, begun_a, begun_b;
    bool reversed, begun_reversed, finished;
    bool jumped;       // (a, b) or the orientation do not come from the triangle before by its turn
    uint seek, wart;   // the last T0 of a wart that is not behind triangle `seek`
    uint event, code;  // the next event's triangle
    uint top, depth;
};
uvec2 lr_packed_stack[LR_PACKED_STACK];

// `run` triangles from `first` on, by their turns and warts alone, with (a, b) entered; then, where `third` says so, one
// whose third vertex is x.
struct LrPackedStep {
    uint first, run;
    bool third;
    uint x;
    uint a, b;
    bool reversed;
    bool jumped;  // see LrPackedReader
};

// 64 bits from r.at on, ones behind the record.
void lr_packed_fill(inout LrPackedReader r) {
    uint at = min(r.at, r.end - 1u), left = r.end - min(r.at, r.end), shift = at & 31u;
    uint word = r.word + (at >> 5);  // and two more: a stream has as many behind its last record
    uint w0 = LR_PACKED_RECORDS(word), w1 = LR_PACKED_RECORDS(word + 1u), w2 = LR_PACKED_RECORDS(word + 2u);
    r.bits = uvec2(w0 >> shift | w1 << 1 << (31u - shift), w1 >> shift | w2 << 1 << (31u - shift));
    if (left < 32u) r.bits.x |= 0xffffffffu << left;
    if (left < 64u) r.bits.y |= left <= 32u ? 0xffffffffu : 0xffffffffu << (left - 32u);
}
// Of the bits loaded: the next `count`, at most 31.
uint lr_packed_take(inout LrPackedReader r, uint count) {
    uint value = r.bits.x & ((1u << count) - 1u);
    r.bits = uvec2(r.bits.x >> count | r.bits.y << 1 << (31u - count), r.bits.y >> count);
    r.at += count;
    return value;
}
uint lr_packed_ones(uint bits) { return bits == 0xffffffffu ? 32u : uint(findLSB(~bits)); }
uint lr_packed_unary(inout LrPackedReader r, uint limit) {
    uint ones = min(lr_packed_ones(r.bits.x), limit);
    lr_packed_take(r, ones + (ones < limit ? 1u : 0u));
    return ones;
}
uint lr_packed_golomb(inout LrPackedReader r, uint order) {
    uint low = lr_packed_unary(r, 31u - order) + order;
    return (lr_packed_take(r, low) | 1u << low) - (1u << order);
}

uint lr_packed_turn_word(uint triangle) { return LR_PACKED_TURNS(LR_PACKED_HEADER_WORDS + triangle / 32u); }
bool lr_packed_turn(uint triangle) { return (lr_packed_turn_word(triangle) >> (triangle & 31u) & 1u) != 0u; }

// Turns that are 1 of the block's first i triangles. A program that has tables of them says so.
#ifndef LR_PACKED_UPS
uint lr_packed_ups(uint first, uint i) {
    uint ups = 0u;
    for (uint k = 0u; k < i; k += 32u) {
        ups += uint(bitCount(bitfieldExtract(lr_packed_turn_word(first + k), 0, int(min(i - k, 32u)))));
    }
    return ups;
}
#define LR_PACKED_UPS(first, i) lr_packed_ups(first, i)
#endif

// What is done at a wart's T0, triangle i of the block. A program that makes a table of them says so.
#ifndef LR_PACKED_SEE_WART
#define LR_PACKED_SEE_WART(r, i) r.wart = (i) <= r.seek ? (i) : r.wart
#endif

// The next event that is not a wart. Warts on the way are seen: they do not change how (a, b) goes on.
void lr_packed_next_event(LrPackedLayout p, inout LrPackedReader r) {
    for (;;) {
        lr_packed_fill(r);
        uint high = lr_packed_ones(r.bits.x);
        if (high > 31u) {
            r.event = 0xffffffffu;
            r.code = LR_PACKED_TURN;
            break;
        }
        lr_packed_take(r, high);
        r.event += (high << p.gap_bits) + (lr_packed_take(r, 1u + p.gap_bits) >> 1);
        r.code = lr_packed_unary(r, LR_PACKED_TURN);
        if (r.code != LR_PACKED_WART) break;
        if (r.event < r.stop) LR_PACKED_SEE_WART(r, r.event);
    }
}

// Begins the record that holds triangle r.first + i.
void lr_packed_open(LrPackedLayout p, inout LrPackedReader r, uint i) {
    uint block = r.first / LR_PACKED_BLOCK, member = block % LR_PACKED_GROUP;
    uint group = p.directory + block / LR_PACKED_GROUP * LR_PACKED_GROUP_WORDS;
    uint byte = LR_PACKED_DIRECTORY(group);
    uint lengths = 0u, length = 0u;
    for (uint k = 0u; k <= member; ++k) {
        byte += length <= LR_PACKED_MAX_RECORD ? length
                : length < LR_PACKED_PLAIN     ? 8u * (length - LR_PACKED_MAX_RECORD)
                                               : 3u * LR_PACKED_BLOCK / 8u * p.vertex_bits;
        if (k % 4u == 0u) lengths = LR_PACKED_DIRECTORY(group + 1u + k / 4u);
        length = lengths & 0xffu;
        lengths >>= 8;
    }
    r.i = 0u;
    r.stop = min(p.triangles - r.first, LR_PACKED_BLOCK);
    r.plain = length == LR_PACKED_PLAIN;
    r.word = p.records + byte / 4u;
    r.at = 8u * (byte % 4u);
    r.end = r.at + 8u * length;
    if (length > LR_PACKED_MAX_RECORD && !r.plain) {
        lr_packed_fill(r);
        uint parts = r.bits.x, part = i / LR_PACKED_PART;
        r.at += 8u * LR_PACKED_PARTS;
        for (uint k = 0u; k < part; ++k) r.at += 8u * (parts >> (8u * k) & 0xffu);
        r.end = r.at + 8u * (parts >> (8u * part) & 0xffu);
        r.i = part * LR_PACKED_PART;
        r.stop = min(r.stop, r.i + LR_PACKED_PART);
    }
    if (r.plain) return;
    r.wart = 0xfffffffeu;
    r.ups = LR_PACKED_UPS(r.first, r.i);
    lr_packed_fill(r);
    r.a = r.begun_a = lr_packed_take(r, p.vertex_bits);
    r.b = r.begun_b = lr_packed_take(r, p.vertex_bits);
    r.reversed = r.begun_reversed = lr_packed_take(r, 1u) != 0u;
    r.finished = false;
    r.jumped = true;
    r.top = r.depth = 0u;
    r.event = r.i;
    lr_packed_next_event(p, r);
}

// What r.code says, and the event after it. Everything is read in the same place whatever the code is, so that invocations
// with other events wait little for each other; 64 bits are enough for what is taken between two fills.
void lr_packed_event(LrPackedLayout p, inout LrPackedReader r, inout LrPackedStep s) {
    bool split = r.code == LR_PACKED_SPLIT, jump = r.code == LR_PACKED_JUMP, far = r.code == LR_PACKED_FAR;
    bool start = r.code == LR_PACKED_START, beside = r.code == LR_PACKED_BESIDE;
    uint small;
    lr_packed_fill(r);
    if (start) {
        small = lr_packed_unary(r, LR_PACKED_START_ANY);
    } else {
        small = lr_packed_take(r, far ? 2u : beside ? 3u : 0u);
    }
    bool next = start && small == LR_PACKED_START_NEXT, near = start && small == LR_PACKED_START_NEAR;
    bool any = start && small == LR_PACKED_START_ANY;
    uint order = split    ? LR_PACKED_SPLIT_ORDER
                 : jump   ? LR_PACKED_JUMP_ORDER
                 : beside ? LR_PACKED_BESIDE_ORDER
                          : LR_PACKED_SIZE_ORDER;
    uint size = 0u, size2 = 0u, v = 0u, v2 = 0u;
    if (split || jump || beside || next || near) size = lr_packed_golomb(r, order);
    lr_packed_fill(r);
    if (near) size2 = lr_packed_golomb(r, LR_PACKED_SIZE_ORDER);
    if (far || beside || any) v = lr_packed_take(r, p.vertex_bits);
    if (any) v2 = lr_packed_take(r, p.vertex_bits);

    bool up = lr_packed_turn(r.first + r.i);
    if (split || jump || far) {
        s.third = true;
        uint away = size + (split ? 3u : 2u);
        s.x = far ? v : up ? r.a + away : r.b - away;
        uint enters = far ? small : split ? 3u : up ? 2u : 1u;
        if (enters == 3u) {
            lr_packed_stack[r.top++ % LR_PACKED_STACK] = up ? uvec2(s.x, r.b) : uvec2(r.a, s.x);
            r.depth = min(r.depth + 1u, LR_PACKED_STACK);
        }
        if (enters == 3u ? !up : enters == 2u) {
            r.a = s.x;
        } else {
            r.b = s.x;
        }
        r.finished = enters == 0u;
        r.ups += up ? 1u : 0u;
        ++r.i;
        r.jumped = true;
    } else {
        r.jumped = true;
        if (r.code == LR_PACKED_TURN) {
            r.reversed = !r.reversed;
        } else if (r.code != LR_PACKED_END) {
            if (beside) {
                if ((small & 1u) != 0u) r.reversed = !r.reversed;
                uint from = small >> 1, step = (size & 1u) != 0u ? ~(size >> 1) : size >> 1;
                bool is_a = from == LR_PACKED_BESIDE_NOW_B || from == LR_PACKED_BESIDE_BEGUN_A;  // that is counted
                uint near_to = from == LR_PACKED_BESIDE_NOW_B     ? r.b
                               : from == LR_PACKED_BESIDE_NOW_A   ? r.a
                               : from == LR_PACKED_BESIDE_BEGUN_A ? r.begun_a
                                                                  : r.begun_b;
                r.begun_a = is_a ? near_to + step : v;
                r.begun_b = is_a ? v : near_to + step;
            } else if (any) {
                r.begun_a = v;
                r.begun_b = v2;
                r.reversed = lr_packed_take(r, 1u) != 0u;
            } else if (next || near) {
                r.begun_a = r.begun_b + (next ? 1u : size);
                r.begun_b = r.begun_a + 2u + (next ? size : size2);
                r.reversed = near && r.begun_reversed;
            } else {
                r.reversed = !r.begun_reversed;
            }
            r.depth = 0u;
            r.begun_reversed = r.reversed;
            r.a = r.begun_a;
            r.b = r.begun_b;
            r.finished = false;
        }
    }
    lr_packed_next_event(p, r);
}

// The triangles up to the next event or the corridor's end, and that event. While r.i < r.stop; each step reads an event
// or makes a triangle.
LrPackedStep lr_packed_step(LrPackedLayout p, inout LrPackedReader r) {
    bool before = r.code == LR_PACKED_START || r.code == LR_PACKED_BESIDE || r.code >= LR_PACKED_END;
    bool end = r.code == LR_PACKED_END && r.event == r.i;
    if (end || (r.finished && !(before && r.event == r.i))) {
        if (r.depth > 0u) {
            --r.depth;
            uvec2 edge = lr_packed_stack[--r.top % LR_PACKED_STACK];
            r.a = edge.x;
            r.b = edge.y;
        } else {
            uint size = r.begun_b - r.begun_a;
            r.a = r.begun_a = r.begun_b + 1u;
            r.b = r.begun_b = r.begun_a + size;
        }
        r.finished = false;
        r.jumped = true;
    }
    uint left = r.b - r.a == 1u ? 1u : r.b - r.a - 1u;
    LrPackedStep s;
    s.first = r.i;
    s.run = min(min(r.stop - r.i, left), r.event - r.i);
    s.third = false;
    s.x = 0u;
    s.a = r.a;
    s.b = r.b;
    s.reversed = r.reversed;
    s.jumped = r.jumped;
    if (s.run > 0u) {
        r.i += s.run;
        uint ups = LR_PACKED_UPS(r.first, r.i) - r.ups;
        r.ups += ups;
        r.a += ups;
        r.b -= s.run - ups;
        r.finished = r.b - r.a == 1u;
        r.jumped = false;
    }
    bool next = r.event == r.i && r.i < r.stop && (before || !r.finished);
    if (next && (end || r.code != LR_PACKED_END)) lr_packed_event(p, r, s);
    return s;
}

// Triangle i of a plain block.
uvec3 lr_packed_plain(LrPackedLayout p, LrPackedReader r, uint i) {
    uvec3 v;
    r.end = 0xffffffffu;
    r.at += 3u * p.vertex_bits * i;
    lr_packed_fill(r);
    v.x = lr_packed_take(r, p.vertex_bits);
    v.y = lr_packed_take(r, p.vertex_bits);
    lr_packed_fill(r);
    v.z = lr_packed_take(r, p.vertex_bits);
    return v;
}

uvec3 lr_packed_oriented(uint a, uint x, uint b, bool reversed) { return reversed ? uvec3(a, x, b) : uvec3(a, b, x); }

uvec3 lr_packed_triangle(LrPackedLayout p, uint triangle) {
    LrPackedReader r;
    r.seek = triangle % LR_PACKED_BLOCK;
    r.first = triangle / LR_PACKED_BLOCK * LR_PACKED_BLOCK;
    uint i = triangle - r.first;
    lr_packed_open(p, r, i);
    if (r.plain) return lr_packed_plain(p, r, i);
    LrPackedStep s = lr_packed_step(p, r);
    while (r.i <= i && r.i < r.stop) s = lr_packed_step(p, r);
    uint run = min(i - s.first, s.run);
    uint ups = LR_PACKED_UPS(r.first, s.first + run) - LR_PACKED_UPS(r.first, s.first);
    uint a = s.a + ups, b = s.b - (run - ups);
    bool up = lr_packed_turn(triangle);
    if (i == s.first + s.run) return lr_packed_oriented(a, s.x, b, s.reversed);
    uint inner = up ? a : b;
    if (r.wart + 1u == i) return lr_packed_oriented(inner - 1u, inner, inner + 1u, s.reversed);
    uint by = r.wart == i ? 2u : 1u;
    return lr_packed_oriented(a, up ? a + by : b - by, b, s.reversed);
}

#endif  // LR_PACKED_HEADER
#endif  // __cplusplus
#endif  // LACEDRING_GLSL
