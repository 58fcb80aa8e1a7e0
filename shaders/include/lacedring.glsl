// Decodes any triangle of a lean or packed stream, in any shader stage. This file needs no other.
//
// Define a macro that reads the stream's words, include this file, and call:
//     layout(std430, binding = 0) readonly buffer Stream { uint words[]; };  // or a buffer reference
//     #define LR_LEAN_WORD(i) words[i]
//     #include "lacedring.glsl"
//     ...
//     uvec3 v = lr_lean_triangle(lr_lean_layout(), slot);  // slot < lr_lean_slots(lr_lean_layout())
// For a packed stream:
//     #define LR_PACKED_WORD(i) words[i]
//     uvec3 v = lr_packed_triangle(lr_packed_layout(), t);  // t < lr_packed_triangles(lr_packed_layout())
// lr_packed_triangles_of_quad decodes four triangles in about the time of one.
// v are vertices in the stream's order (vertex_order maps them to the mesh's). A lean triangle with v.x == v.y is
// degenerate: it covers nothing; draw it or skip it. The stream must be valid (lacedring::validate_lean,
// lacedring::validate_packed); with any other, every loop still ends. docs/engine-guide.md has examples.
//
// lrcore/codec/lean/lean_format.h and lrcore/codec/packed/packed_format.h explain the constants. A C++ file may include
// this file after these two: the compiler then checks that the constants are the same.
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

#define LR_PACKED_MAGIC 0x3250524cu
#define LR_PACKED_HEADER_WORDS 4u
#define LR_PACKED_WORD_MAGIC 0u
#define LR_PACKED_WORD_VERTICES 1u
#define LR_PACKED_WORD_TRIANGLES 2u
#define LR_PACKED_WORD_CHECKSUM 3u
#define LR_PACKED_DOUBLES 0x80000000u
#define LR_PACKED_DOUBLES_WORDS 2u
#define LR_PACKED_RUN_WORDS 2u
#define LR_PACKED_BLOCK 256u
#define LR_PACKED_BLOCK_WORDS 8u
#define LR_PACKED_GROUP 16u
#define LR_PACKED_STEP_FIELD 12u
#define LR_PACKED_OFFSET_FIELD 5u
#define LR_PACKED_ENTRY_FIELD 4u
#define LR_PACKED_GAP_FIELD 3u
#define LR_PACKED_WART_FIELD 3u
#define LR_PACKED_SPLIT_FIELD 2u
#define LR_PACKED_COUNT_FIELD 2u
#define LR_PACKED_KINDS_FIELD 1u
#define LR_PACKED_HEAD_BITS 32u
#define LR_PACKED_MAX_OFFSET_BITS 16u
#define LR_PACKED_MAX_ENTRY_BITS 12u
#define LR_PACKED_KIND_BITS 2u
#define LR_PACKED_RECORD 0u
#define LR_PACKED_PARTED 1u
#define LR_PACKED_PLAIN 2u
#define LR_PACKED_MAX_RECORD 160u
#define LR_PACKED_PARTS 4u
#define LR_PACKED_MAX_PART 200u
#define LR_PACKED_PART 64u
#define LR_PACKED_SPLIT 0u
#define LR_PACKED_BESIDE 1u
#define LR_PACKED_START 2u
#define LR_PACKED_FAR 3u
#define LR_PACKED_JUMP 4u
#define LR_PACKED_TURN 5u
#define LR_PACKED_FLIPS 6u
#define LR_PACKED_START_OTHER 0u
#define LR_PACKED_START_NEXT 1u
#define LR_PACKED_START_NEAR 2u
#define LR_PACKED_START_ANY 3u
#define LR_PACKED_BESIDE_NOW_B 0u
#define LR_PACKED_BESIDE_NOW_A 1u
#define LR_PACKED_BESIDE_BEGUN_A 2u
#define LR_PACKED_BESIDE_BEGUN_B 3u
#define LR_PACKED_JUMP_ORDER 1u
#define LR_PACKED_SIZE_ORDER 2u
#define LR_PACKED_BESIDE_ORDER 1u
#define LR_PACKED_FAR_ORDER 2u

#ifndef __cplusplus

// Lean streams: random access in constant time, reading at most four words. Paper: LR 2011, section 7. If header and
// slots are in different buffers, define LR_LEAN_HEADER(i) and LR_LEAN_SLOTS(i) instead of LR_LEAN_WORD(i); both count
// i from the stream's first word.

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

// v.n of ring vertex v. left, right: the words of its two slots; on a one-sided ring, its only word twice.
uint lr_lean_next(uint v, uint left, uint right) {
    if ((left & LR_LEAN_CLOSE_FLAG) != 0u) return left & LR_LEAN_TIP_MASK;
    if ((right & LR_LEAN_CLOSE_FLAG) != 0u) return right & LR_LEAN_TIP_MASK;
    return v + 1u;
}

// The triangle of a ring slot. `word`: the slot's word; next: v.n; skip: v.n.n (used for a wart only). In a free slot
// and in a right closing slot, the tip is an end of the slot's own edge, so the triangle is degenerate without a
// special case.
uvec3 lr_lean_ring_triangle(uint word, uint v, uint next, uint skip, bool right) {
    bool closes = (word & LR_LEAN_CLOSE_FLAG) != 0u;
    uint tip = closes && !right ? v : word & LR_LEAN_TIP_MASK;
    uint end = (word & LR_LEAN_WART_FLAG) != 0u ? skip : next;
    bool flip = (word & LR_LEAN_FLIP_FLAG) != 0u;
    return right != flip ? uvec3(end, tip, v) : uvec3(v, tip, end);
}

#ifdef LR_LEAN_SLOTS
uint lr_lean_word(uint i) { return LR_LEAN_SLOTS(LR_LEAN_HEADER_WORDS + i); }

// All kinds of slots share their loads, so that invocations with different kinds diverge little.
uvec3 lr_lean_triangle(LrLeanLayout lean, uint slot) {
    uint two_sided = 2u * lean.rings2, ring_slots = two_sided + lean.rings1;
    bool verbatim = slot >= ring_slots, one_sided = slot >= two_sided && !verbatim;
    uint at = verbatim ? ring_slots + 3u * (slot - ring_slots) : one_sided ? slot : slot & ~1u;
    uint first = lr_lean_word(at), second = lr_lean_word(one_sided ? at : at + 1u);
    uint v = one_sided ? slot - lean.rings2 : slot >> 1;
    bool right = slot < two_sided && (slot & 1u) != 0u;
    uint word = right ? second : first;
    uint next = lr_lean_next(v, first, second), skip = next + 1u;
    // After a closing edge, v.n.n is next + 1: the ring's first edge follows, which never closes.
    if (verbatim || ((word & LR_LEAN_WART_FLAG) != 0u && next == v + 1u)) {
        uint far = verbatim ? at + 2u : one_sided ? slot + 1u : 2u * next;
        uint third = lr_lean_word(far);
        if (verbatim) return uvec3(first, second, third);
        skip = lr_lean_next(next, third, lr_lean_word(one_sided ? far : far + 1u));
    }
    return lr_lean_ring_triangle(word, v, next, skip, right);
}
#endif

// Packed streams: decodes any triangle with a few popcounts, or the events of a record one by one (as
// shaders/decode/packed_decode.comp does). If the stream is in several buffers, define LR_PACKED_HEADER,
// LR_PACKED_TURNS, LR_PACKED_TABLE and LR_PACKED_GROUPS instead of LR_PACKED_WORD; all count i from the stream's first
// word.

#ifdef LR_PACKED_WORD
#define LR_PACKED_HEADER(i) LR_PACKED_WORD(i)
#define LR_PACKED_TURNS(i) LR_PACKED_WORD(i)
#define LR_PACKED_TABLE(i) LR_PACKED_WORD(i)
#define LR_PACKED_GROUPS(i) LR_PACKED_WORD(i)
#endif
#ifdef LR_PACKED_HEADER

struct LrPackedLayout {
    uint own;     // triangles [0, own) are coded; later ones are doubles of these
    uint table;   // first word of the table of groups
    uint groups;  // first word of the groups
    uint vertex_bits;
};

// The first word of the doubles section; the first word of the groups if there is none.
uint lr_packed_doubles(LrPackedLayout p) {
    uint in_group = LR_PACKED_BLOCK * LR_PACKED_GROUP, groups = p.own / in_group + (p.own % in_group == 0u ? 0u : 1u);
    return p.table + max(groups, 1u) - 1u;
}

LrPackedLayout lr_packed_layout() {
    LrPackedLayout p;
    p.own = LR_PACKED_HEADER(LR_PACKED_WORD_TRIANGLES);
    p.table = LR_PACKED_HEADER_WORDS + p.own / 32u + (p.own % 32u == 0u ? 0u : 1u);
    p.groups = lr_packed_doubles(p);
    uint vertices = LR_PACKED_HEADER(LR_PACKED_WORD_VERTICES);
    if ((vertices & LR_PACKED_DOUBLES) != 0u) {
        p.groups += LR_PACKED_DOUBLES_WORDS + LR_PACKED_RUN_WORDS * LR_PACKED_TABLE(p.groups + 1u);
    }
    p.vertex_bits = uint(findMSB(max(vertices & ~LR_PACKED_DOUBLES, 2u) - 1u)) + 1u;
    return p;
}

// The number of all triangles, doubles included.
uint lr_packed_triangles(LrPackedLayout p) {
    uint doubles = lr_packed_doubles(p);
    return doubles < p.groups ? p.own + LR_PACKED_TABLE(doubles) : p.own;
}

// The run of doubles that holds a triangle. x: its first triangle; y: its end; z: the own triangle that the first one
// doubles, with flag LR_PACKED_DOUBLES if orientations are opposite.
uvec3 lr_packed_run(LrPackedLayout p, uint triangle) {
    uint runs = lr_packed_doubles(p) + LR_PACKED_DOUBLES_WORDS, count = (p.groups - runs) / LR_PACKED_RUN_WORDS;
    uint low = 0u, high = count;
    for (uint k = 0u; k < 32u; ++k) {
        uint middle = (low + high) / 2u;
        if (middle == low) break;
        if (LR_PACKED_TABLE(runs + LR_PACKED_RUN_WORDS * middle) <= triangle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    uint run = runs + LR_PACKED_RUN_WORDS * low;
    uint end = low + 1u < count ? LR_PACKED_TABLE(run + LR_PACKED_RUN_WORDS) : lr_packed_triangles(p);
    return uvec3(LR_PACKED_TABLE(run), end, LR_PACKED_TABLE(run + 1u));
}

// A bit reader. Loads each word once, and none past the end.
struct LrPackedBits {
    uvec2 bits;  // the next `ready` bits
    uint ready;
    uint left;  // bits left up to the end
    uint word;  // the next word to load
};

// Starts a reader at a bit of the groups, for `count` bits.
LrPackedBits lr_packed_bits(LrPackedLayout p, uint bit, uint count) {
    LrPackedBits r;
    uint shift = bit & 31u;
    r.word = p.groups + bit / 32u;
    r.bits = uvec2(count == 0u ? 0u : LR_PACKED_GROUPS(r.word) >> shift, 0u);
    ++r.word;
    r.ready = 32u - shift;
    r.left = count;
    return r;
}
// Loads bits until 32 are ready, or all up to the end.
void lr_packed_fill(inout LrPackedBits r) {
    if (r.ready < 32u && r.ready < r.left) {
        uint word = LR_PACKED_GROUPS(r.word);
        r.bits.y = r.ready == 0u ? 0u : word >> (32u - r.ready);
        r.bits.x |= word << r.ready;
        ++r.word;
        r.ready += 32u;
    }
}
// Reads the next `count` bits, at most 31.
uint lr_packed_take(inout LrPackedBits r, uint count) {
    lr_packed_fill(r);
    uint value = r.bits.x & ((1u << count) - 1u);
    r.bits = uvec2(r.bits.x >> count | r.bits.y << 1 << (31u - count), r.bits.y >> count);
    r.ready -= min(count, r.ready);
    r.left -= min(count, r.left);
    return value;
}
uint lr_packed_ones(uint bits) { return bits == 0xffffffffu ? 32u : uint(findLSB(~bits)); }
uint lr_packed_unary(inout LrPackedBits r, uint limit) {
    lr_packed_fill(r);
    uint ones = min(lr_packed_ones(r.bits.x), limit);
    lr_packed_take(r, ones + (ones < limit ? 1u : 0u));
    return ones;
}
uint lr_packed_golomb(inout LrPackedBits r, uint order) {
    uint low = lr_packed_unary(r, 31u - order) + order;
    return (lr_packed_take(r, low) | 1u << low) - (1u << order);
}

// `count` bits of the groups from `bit` on, at most 32. Reads no word past them.
uint lr_packed_bits_at(LrPackedLayout p, uint bit, uint count) {
    uint shift = bit & 31u, low = 0u, high = 0u;
    if (count != 0u) low = LR_PACKED_GROUPS(p.groups + bit / 32u);
    if (shift + count > 32u) high = LR_PACKED_GROUPS(p.groups + bit / 32u + 1u);
    return bitfieldExtract(low >> shift | high << 1 << (31u - shift), 0, int(count));
}
// Reads an entry: a, b and reversed.
uvec3 lr_packed_entry_at(LrPackedLayout p, uint bit) {
    uint shift = bit & 31u, word = p.groups + bit / 32u, end = shift + 2u * p.vertex_bits + 1u;
    uint x = LR_PACKED_GROUPS(word), y = 0u, z = 0u;
    if (end > 32u) y = LR_PACKED_GROUPS(word + 1u);
    if (end > 64u) z = LR_PACKED_GROUPS(word + 2u);
    uint low = x >> shift | y << 1 << (31u - shift), high = y >> shift | z << 1 << (31u - shift);
    uint b = low >> p.vertex_bits | high << (32u - p.vertex_bits), r = 2u * p.vertex_bits;
    return uvec3(bitfieldExtract(low, 0, int(p.vertex_bits)), bitfieldExtract(b, 0, int(p.vertex_bits)),
                 (r < 32u ? low >> r : high >> (r - 32u)) & 1u);
}

// A record. Its bits begin at the number of events.
struct LrPackedRecord {
    LrPackedBits bits;
    uint turn_word;  // word of the stream with the turns of its first triangle
    uint begin, triangles;  // its first triangle in the block; number of triangles
    uint a, b;              // the edge at which it is entered
    bool reversed;
    bool plain;             // its block is plain
    uint gap_bits, wart_bits, split_order, count_order;
};

// The record that holds triangle i of a block. In a plain block, the bits are vertex numbers.
LrPackedRecord lr_packed_record(LrPackedLayout p, uint block, uint i) {
    uint group = block / LR_PACKED_GROUP, k = block % LR_PACKED_GROUP, first = block * LR_PACKED_BLOCK;
    uint blocks = min((p.own - 1u) / LR_PACKED_BLOCK + 1u - group * LR_PACKED_GROUP, LR_PACKED_GROUP);
    uint begin = group == 0u ? 0u : LR_PACKED_TABLE(p.table + group - 1u), bit = 32u * begin;
    uint head = LR_PACKED_GROUPS(p.groups + begin), step = head & 0xfffu;
    uint offset_bits = min(head >> 12 & 31u, LR_PACKED_MAX_OFFSET_BITS), entry_bits = min(head >> 17 & 15u, LR_PACKED_MAX_ENTRY_BITS);
    LrPackedRecord r;
    r.gap_bits = head >> 21 & 7u;
    r.wart_bits = head >> 24 & 7u;
    r.split_order = head >> 27 & 3u;
    r.count_order = head >> 29 & 3u;

    // Bitmap of blocks 1 to blocks - 1 whose entry is in the head; then the bit positions of the head's fields.
    uint owns = bitfieldExtract(LR_PACKED_GROUPS(p.groups + begin + 1u), 0, int(blocks - 1u)), own = bitfieldExtract(owns, 0, int(k));
    uint entries = bit + 32u + blocks - 1u, entry_size = 2u * p.vertex_bits + 1u;
    uint kinds = entries + (1u + uint(bitCount(owns))) * entry_size;
    bool has_kinds = head >> 31 != 0u;
    uint offsets = kinds + (has_kinds ? 2u * blocks : 0u), steps = offsets + blocks * offset_bits;
    uint kind = has_kinds ? lr_packed_bits_at(p, kinds + 2u * k, 2u) : LR_PACKED_RECORD;
    uint both = lr_packed_bits_at(p, offsets + (max(k, 1u) - 1u) * offset_bits, offset_bits * (k == 0u ? 1u : 2u));
    uint here = bitfieldExtract(both, 0, int(offset_bits)), next = k == 0u ? here : both >> 1 >> (max(offset_bits, 1u) - 1u);
    uint middle = 1u << offset_bits >> 1;
    if (offset_bits == 0u) next = 0u;
    uint from = k == 0u ? 0u : k * step + here - middle, end = (k + 1u) * step + next - middle;
    uint byte = (steps + (blocks - 1u) * entry_bits + 7u) / 8u + from, bytes = min(end - from, LR_PACKED_MAX_RECORD);

    r.turn_word = LR_PACKED_HEADER_WORDS + first / 32u;
    r.begin = 0u;
    r.triangles = min(p.own - first, LR_PACKED_BLOCK);
    r.plain = kind == LR_PACKED_PLAIN;
    // origin: the block of the entry.
    uint entry_bit = entries + uint(bitCount(own)) * entry_size, origin = uint(findMSB(own) + 1);
    uint skipped = 0u;  // bits of the record's own entry, if it begins with one
    if (kind == LR_PACKED_PARTED) {
        uint part = i / LR_PACKED_PART;
        uint lengths = lr_packed_bits_at(p, 8u * byte, 32u);
        byte += LR_PACKED_PARTS;
        for (uint n = 0u; n < part; ++n) byte += lengths >> (8u * n) & 255u;
        bytes = lengths >> (8u * part) & 255u;
        if (part > 0u) {
            entry_bit = 8u * byte;
            origin = k;
            skipped = entry_size;
        }
        r.begin = part * LR_PACKED_PART;
        r.turn_word += r.begin / 32u;
        r.triangles = min(r.triangles - r.begin, LR_PACKED_PART);
    }
    uvec3 entry = lr_packed_entry_at(p, entry_bit);
    r.a = entry.x;
    r.b = entry.y;
    r.reversed = entry.z != 0u;
    if (origin < k) {
        uint span = r.b - r.a;
        r.a += (k - origin) * (LR_PACKED_BLOCK / 2u) - (1u << entry_bits >> 1) +
               lr_packed_bits_at(p, steps + (k - 1u) * entry_bits, entry_bits);
        r.b = r.a + span - (k - origin) * LR_PACKED_BLOCK;
    }
    r.bits = lr_packed_bits(p, 8u * byte + skipped, max(8u * bytes, skipped) - skipped);
    return r;
}

// The number of events. At most one per bit of the record, even if a damaged stream claims more.
uint lr_packed_events(inout LrPackedRecord r) {
    return r.bits.left == 0u ? 0u : min(lr_packed_golomb(r.bits, r.count_order), r.bits.left);
}

// An event. Its code determines which of these members are used.
struct LrPackedEvent {
    uint triangle;  // triangle, counted from the record's first
    uint after;     // the triangle from which the next gap counts
    uint code, choice;
    uint v, w;
    bool reversed;
    uint flips;  // FLIPS: bit of the groups at which its bits begin
};

// Reads the event after e. Fields that several codes share are read at the same place, so that invocations diverge
// little.
void lr_packed_next_event(LrPackedLayout p, inout LrPackedRecord r, inout LrPackedEvent e) {
    lr_packed_fill(r.bits);
    uint high = min(lr_packed_ones(r.bits.bits.x), 31u);
    lr_packed_take(r.bits, high);
    e.triangle = e.after + (high << r.gap_bits) + (lr_packed_take(r.bits, 1u + r.gap_bits) >> 1);
    e.code = lr_packed_unary(r.bits, 7u);
    bool split = e.code == LR_PACKED_SPLIT, jump = e.code == LR_PACKED_JUMP, far = e.code == LR_PACKED_FAR;
    bool start = e.code == LR_PACKED_START, beside = e.code == LR_PACKED_BESIDE;
    e.after = e.triangle + (split || jump || far ? 1u : 0u);
    if (start) {
        e.choice = lr_packed_unary(r.bits, LR_PACKED_START_ANY);
    } else {
        e.choice = lr_packed_take(r.bits, far ? 2u : beside ? 3u : 0u);
    }
    bool any = start && e.choice == LR_PACKED_START_ANY, near = start && e.choice == LR_PACKED_START_NEAR;
    bool next = start && e.choice == LR_PACKED_START_NEXT;
    e.v = near || split || jump || beside
              ? lr_packed_golomb(r.bits, split  ? r.split_order
                                         : jump ? LR_PACKED_JUMP_ORDER
                                         : near ? LR_PACKED_SIZE_ORDER
                                                : LR_PACKED_BESIDE_ORDER)
              : far || any ? lr_packed_take(r.bits, p.vertex_bits)
                           : 1u;
    if (jump) e.choice = lr_packed_take(r.bits, 1u);
    e.v += split ? 3u : jump ? 2u : 0u;
    bool counts = (far && e.choice == 3u) || (jump && e.choice == 1u);
    e.w = split ? e.v - 1u : 0u;
    if (counts || near || next) {
        e.w = (counts ? 1u : 2u) + lr_packed_golomb(r.bits, counts ? LR_PACKED_FAR_ORDER : LR_PACKED_SIZE_ORDER);
    }
    if (beside || any) e.w = lr_packed_take(r.bits, p.vertex_bits);
    if (any) e.reversed = lr_packed_take(r.bits, 1u) != 0u;
    if (e.code == LR_PACKED_FLIPS) {
        e.flips = (r.bits.word - p.groups) * 32u - r.bits.ready;
        for (uint k = 0u; k < r.triangles; k += 16u) lr_packed_take(r.bits, min(r.triangles - k, 16u));
    }
}

// A decoder's state: the edge entered, and the last polygon begun outside of all scopes.
struct LrPackedState {
    uint a, b;
    bool reversed, finished;
    uint begun_a, begun_b;
    bool begun_reversed;
};

LrPackedState lr_packed_state(LrPackedRecord r) {
    return LrPackedState(r.a, r.b, r.reversed, false, r.a, r.b, r.reversed);
}

// START or BESIDE: begins a polygon. inside: whether in a scope.
void lr_packed_begin(LrPackedEvent e, inout LrPackedState s, bool inside) {
    uint a = s.begun_b + e.v, b = a + e.w;
    if (e.code == LR_PACKED_BESIDE) {
        uint from = e.choice >> 1, step = (e.v & 1u) != 0u ? ~(e.v >> 1) : e.v >> 1;
        // Of a and b, one is coded relative to a known vertex (`near`), the other as a number.
        bool is_a = from == LR_PACKED_BESIDE_NOW_B || from == LR_PACKED_BESIDE_BEGUN_A;
        uint near = step + (from == LR_PACKED_BESIDE_NOW_B     ? s.b
                            : from == LR_PACKED_BESIDE_NOW_A   ? s.a
                            : from == LR_PACKED_BESIDE_BEGUN_A ? s.begun_a
                                                               : s.begun_b);
        s.reversed = s.reversed != ((e.choice & 1u) != 0u);
        a = is_a ? near : e.w;
        b = is_a ? e.w : near;
    } else if (e.choice == LR_PACKED_START_ANY) {
        a = e.v;
        b = e.w;
        s.reversed = e.reversed;
    } else if (e.choice == LR_PACKED_START_OTHER) {
        a = s.begun_a;
        b = s.begun_b;
        s.reversed = !s.begun_reversed;
    } else {
        s.reversed = e.choice == LR_PACKED_START_NEAR && s.begun_reversed;
    }
    s.a = a;
    s.b = b;
    s.finished = false;
    if (!inside) {
        s.begun_a = a;
        s.begun_b = b;
        s.begun_reversed = s.reversed;
    }
}

// Begins the polygon that follows without an event: directly after the last one begun, with the same size.
void lr_packed_repeat(inout LrPackedState s) {
    uint size = s.begun_b - s.begun_a;
    s.a = s.begun_a = s.begun_b + 1u;
    s.b = s.begun_b = s.a + size;
    s.finished = false;
}

// The number of triangles from edge (a, b) on until the polygon is finished; 0xffffffff if b - a is 1 already, since only
// a turn finishes a polygon.
uint lr_packed_left(uint a, uint b) { return b - a == 1u ? 0xffffffffu : b - a - 1u; }

// SPLIT, FAR or JUMP: returns the third vertex of the event's triangle, and moves the state to the first part after it.
// If e.w is not 0, the rest is entered e.w triangles later, across edge `rest`.
uint lr_packed_third(LrPackedEvent e, bool up, inout LrPackedState s, out uvec2 rest) {
    bool far = e.code == LR_PACKED_FAR, both = e.code == LR_PACKED_SPLIT || (e.code == LR_PACKED_JUMP && e.choice == 1u);
    uint x = far ? e.v : up ? s.a + e.v : s.b - e.v;
    uint enters = far ? e.choice : both ? 3u : up ? 2u : 1u;
    rest = up ? uvec2(x, s.b) : uvec2(s.a, x);
    if (enters == 3u ? !up : enters == 2u) {
        s.a = x;
    } else {
        s.b = x;
    }
    s.finished = enters == 0u;
    return x;
}

// Triangle i of a plain block.
uvec3 lr_packed_plain(LrPackedLayout p, LrPackedRecord r, uint i) {
    uint bit = (r.bits.word - p.groups) * 32u - r.bits.ready + 3u * p.vertex_bits * i;
    LrPackedBits bits = lr_packed_bits(p, bit, 3u * p.vertex_bits);
    uvec3 v;
    v.x = lr_packed_take(bits, p.vertex_bits);
    v.y = lr_packed_take(bits, p.vertex_bits);
    v.z = lr_packed_take(bits, p.vertex_bits);
    return v;
}

uvec3 lr_packed_oriented(uint a, uint x, uint b, bool reversed) { return reversed ? uvec3(a, x, b) : uvec3(a, b, x); }

// The record's turn bits, and the number of ones before each word. Global, as an array parameter would be copied.
uint lr_packed_turn_bits[LR_PACKED_BLOCK_WORDS + 1u];
uint lr_packed_turn_ups[LR_PACKED_BLOCK_WORDS];
bool lr_packed_turn(uint i) { return (lr_packed_turn_bits[i / 32u] >> (i & 31u) & 1u) != 0u; }
// The number of 1 turns before triangle i.
uint lr_packed_ups(uint i) {
    return lr_packed_turn_ups[i / 32u] + uint(bitCount(bitfieldExtract(lr_packed_turn_bits[i / 32u], 0, int(i & 31u))));
}

// Moves the state from triangle `at` to triangle `to`, using turns alone.
void lr_packed_skip(inout LrPackedState s, inout uint at, uint to) {
    uint left = s.finished ? 0u : lr_packed_left(s.a, s.b);
    if (to - at > left) {  // skip whole polygons
        uint each = lr_packed_left(s.begun_a, s.begun_b), behind = to - at - left, whole = (behind - 1u) / each;
        uint size = s.begun_b - s.begun_a;
        s.begun_a += whole * (size + 1u);
        s.begun_b += whole * (size + 1u);
        lr_packed_repeat(s);
        at = to - (behind - whole * each);
        left = each;
    }
    uint ups = lr_packed_ups(to) - lr_packed_ups(at);
    s.a += ups;
    s.b -= to - at - ups;
    if (to > at) s.finished = to - at == left;
    at = to;
}

uvec3 lr_packed_own_triangle(LrPackedLayout p, uint triangle) {
    uint block = triangle / LR_PACKED_BLOCK, i = triangle % LR_PACKED_BLOCK;
    LrPackedRecord r = lr_packed_record(p, block, i);
    if (r.plain) return lr_packed_plain(p, r, i);
    i -= r.begin;
    uint last = min(i + 1u, r.triangles - 1u) / 32u, sum = 0u, rank = 0u;
    for (uint k = 0u; k <= last; ++k) lr_packed_turn_bits[k] = LR_PACKED_TURNS(r.turn_word + k);
    for (uint k = 0u; k <= i / 32u; ++k) {
        lr_packed_turn_ups[k] = sum;
        sum += uint(bitCount(lr_packed_turn_bits[k]));
        uint behind = k < last ? lr_packed_turn_bits[k + 1u] << 31 : 0u;
        uint candidates = ~(lr_packed_turn_bits[k] ^ (lr_packed_turn_bits[k] >> 1 | behind));
        rank += uint(bitCount(bitfieldExtract(candidates, 0, int(min(i - 32u * k, 32u)))));
    }
    LrPackedState s = lr_packed_state(r);
    LrPackedEvent e;
    e.after = 0u;
    uint events = lr_packed_events(r);
    uint at = 0u, skip = 0u;
    bool inside = false, flip = false;
    for (uint k = 0u; k < events; ++k) {
        lr_packed_next_event(p, r, e);
        if (e.triangle > i || e.triangle < skip) continue;
        lr_packed_skip(s, at, e.triangle);
        if (e.code == LR_PACKED_TURN) {
            s.reversed = !s.reversed;
        } else if (e.code == LR_PACKED_FLIPS) {
            uint bit = e.flips + i;
            flip = (LR_PACKED_GROUPS(p.groups + bit / 32u) >> (bit & 31u) & 1u) != 0u;
        } else if (e.code == LR_PACKED_START || e.code == LR_PACKED_BESIDE) {
            lr_packed_begin(e, s, inside);
        } else {
            if (s.finished) lr_packed_repeat(s);
            uint a = s.a, b = s.b;
            uvec2 rest;
            uint x = lr_packed_third(e, lr_packed_turn(e.triangle), s, rest);
            if (e.triangle == i) return lr_packed_oriented(a, x, b, s.reversed != flip);
            at = e.triangle + 1u;
            if (e.w == 0u || e.w >= r.triangles - at) continue;  // no scope
            if (i - at >= e.w) {                                 // after the scope
                at += e.w;
                skip = at;
                s.a = rest.x;
                s.b = rest.y;
                s.finished = false;
            } else {
                inside = true;
            }
        }
    }
    lr_packed_skip(s, at, i);
    if (s.finished) lr_packed_repeat(s);
    bool up = lr_packed_turn(i), before = i > 0u && lr_packed_turn(i - (i > 0u ? 1u : 0u)) == up;
    bool here = i + 1u == r.triangles || lr_packed_turn(min(i + 1u, r.triangles - 1u)) == up;
    uint by = 1u, seen = 0u;
    // The triangle may be a wart's T0 or the T2 after it. Warts are identified by their rank among the candidates.
    if (before || here) {
        while (seen <= rank) {
            lr_packed_fill(r.bits);
            uint high = lr_packed_ones(r.bits.bits.x);
            if (high >= min(r.bits.left, 32u)) break;
            lr_packed_take(r.bits, high);
            seen += (high << r.wart_bits) + (lr_packed_take(r.bits, 1u + r.wart_bits) >> 1) + 1u;
            if (before && seen == rank) {
                uint inner = up ? s.a : s.b;
                return lr_packed_oriented(inner - 1u, inner, inner + 1u, s.reversed != flip);
            }
            if (here && seen == rank + 1u) by = 2u;
        }
    }
    return lr_packed_oriented(s.a, up ? s.a + by : s.b - by, s.b, s.reversed != flip);
}

uvec3 lr_packed_triangle(LrPackedLayout p, uint triangle) {
    if (triangle < p.own) return lr_packed_own_triangle(p, triangle);
    uvec3 run = lr_packed_run(p, triangle);
    uint of = (run.z & ~LR_PACKED_DOUBLES) + triangle - run.x;
    uvec3 v = lr_packed_own_triangle(p, min(of, p.own - 1u));
    return (run.z & LR_PACKED_DOUBLES) != 0u ? v.xzy : v;
}

// Decodes up to four own triangles from `first` on into lr_packed_four: those in the same record and the same word of
// turns. Reads shared data once. Returns the number of triangles.
uvec3 lr_packed_four[4];
uint lr_packed_own_four(LrPackedLayout p, uint first) {
    uint i = first % LR_PACKED_BLOCK;
    LrPackedRecord r = lr_packed_record(p, first / LR_PACKED_BLOCK, i);
    if (r.plain) {
        for (uint j = 0u; j < 4u; ++j) lr_packed_four[j] = lr_packed_plain(p, r, min(i + j, r.triangles - 1u));
        return min(4u, r.triangles - i);
    }
    i -= r.begin;
    uint word = i / 32u, last = min(i + 4u, r.triangles - 1u) / 32u, sum = 0u, rank[4], candidates = 0u, before = 0u;
    for (uint k = 0u; k <= last; ++k) lr_packed_turn_bits[k] = LR_PACKED_TURNS(r.turn_word + k);
    for (uint k = 0u; k <= word; ++k) {
        lr_packed_turn_ups[k] = sum;
        sum += uint(bitCount(lr_packed_turn_bits[k]));
        uint behind = k < last ? lr_packed_turn_bits[k + 1u] << 31 : 0u;
        candidates = ~(lr_packed_turn_bits[k] ^ (lr_packed_turn_bits[k] >> 1 | behind));
        if (k < word) before += uint(bitCount(candidates));
    }
    // The record's last triangle is a candidate, too.
    if (r.triangles - 32u * word <= 32u) candidates |= 1u << (r.triangles - 1u - 32u * word);
    LrPackedState s[4];
    uint at[4], skip[4];
    bool inside[4], flip[4], known[4];
    for (uint j = 0u; j < 4u; ++j) {
        s[j] = lr_packed_state(r);
        at[j] = skip[j] = 0u;
        inside[j] = flip[j] = known[j] = false;
        rank[j] = before + uint(bitCount(bitfieldExtract(candidates, 0, int(min((i & 31u) + j, 32u)))));
    }
    LrPackedEvent e;
    e.after = 0u;
    uint events = lr_packed_events(r);
    for (uint k = 0u; k < events; ++k) {
        lr_packed_next_event(p, r, e);
        bool third = e.after > e.triangle;
        uint flips = 0u;
        if (e.code == LR_PACKED_FLIPS) flips = lr_packed_bits_at(p, e.flips + i, min(r.triangles - i, 4u));
        for (uint j = 0u; j < 4u; ++j) {
            if (e.triangle > i + j || e.triangle < skip[j]) continue;
            lr_packed_skip(s[j], at[j], e.triangle);
            if (e.code == LR_PACKED_TURN) {
                s[j].reversed = !s[j].reversed;
            } else if (e.code == LR_PACKED_FLIPS) {
                flip[j] = (flips >> j & 1u) != 0u;
            } else if (!third) {
                lr_packed_begin(e, s[j], inside[j]);
            } else {
                if (s[j].finished) lr_packed_repeat(s[j]);
                uint a = s[j].a, b = s[j].b;
                uvec2 rest;
                uint x = lr_packed_third(e, lr_packed_turn(e.triangle), s[j], rest);
                at[j] = e.triangle + 1u;
                if (e.triangle == i + j) {
                    lr_packed_four[j] = lr_packed_oriented(a, x, b, s[j].reversed != flip[j]);
                    known[j] = true;
                    skip[j] = 0xffffffffu;
                } else if (e.w != 0u && e.w < r.triangles - at[j]) {
                    if (i + j - at[j] >= e.w) {
                        skip[j] = at[j] += e.w;
                        s[j].a = rest.x;
                        s[j].b = rest.y;
                        s[j].finished = false;
                    } else {
                        inside[j] = true;
                    }
                }
            }
        }
    }
    uint seen = 0u, firsts = 0u, seconds = 0u;  // bitmaps of the four: T0s of warts, T2s of warts
    while (seen <= rank[3]) {
        lr_packed_fill(r.bits);
        uint high = lr_packed_ones(r.bits.bits.x);
        if (high >= min(r.bits.left, 32u)) break;
        lr_packed_take(r.bits, high);
        seen += (high << r.wart_bits) + (lr_packed_take(r.bits, 1u + r.wart_bits) >> 1) + 1u;
        for (uint j = 0u; j < 4u; ++j) {
            if (seen == rank[j]) seconds |= 1u << j;
            if (seen == rank[j] + 1u) firsts |= 1u << j;
        }
    }
    uint bits = lr_packed_turn_bits[word] >> (i & 31u);
    uint turn_before = i == 0u ? ~bits & 1u : uint(lr_packed_turn(i - 1u));
    seconds &= ~(bits ^ (bits << 1 | turn_before));
    firsts &= candidates >> (i & 31u);
    for (uint j = 0u; j < 4u; ++j) {
        if (known[j]) continue;
        uint t = min(i + j, r.triangles - 1u);
        lr_packed_skip(s[j], at[j], t);
        if (s[j].finished) lr_packed_repeat(s[j]);
        bool up = (bits >> j & 1u) != 0u;
        uint by = (firsts >> j & 1u) != 0u ? 2u : 1u, x = up ? s[j].a + by : s[j].b - by, inner = up ? s[j].a : s[j].b;
        bool t2 = (seconds >> j & 1u) != 0u;
        lr_packed_four[j] = lr_packed_oriented(t2 ? inner - 1u : s[j].a, t2 ? inner : x, t2 ? inner + 1u : s[j].b,
                                               s[j].reversed != flip[j]);
    }
    return min(4u, min(32u - (i & 31u), r.triangles - i));
}

// Decodes `count` triangles (at most four) from `first` on, a multiple of four, into lr_packed_quad: far faster than
// one by one.
uvec3 lr_packed_quad[4];
void lr_packed_triangles_of_quad(LrPackedLayout p, uint first, uint count) {
    uint done = 0u;
    // One pass suffices, except for doubles and at the end of the own triangles.
    for (uint pass = 0u; pass < 4u; ++pass) {
        uint t = first + done, left = min(count - done, p.own - t);
        bool turned = false;
        if (t >= p.own) {
            uvec3 run = lr_packed_run(p, t);
            left = min(count - done, run.y - t);
            turned = (run.z & LR_PACKED_DOUBLES) != 0u;
            t = min((run.z & ~LR_PACKED_DOUBLES) + t - run.x, p.own - 1u);
        }
        left = min(left, lr_packed_own_four(p, t));
        for (uint j = 0u; j < 4u; ++j) {
            if (j < left) lr_packed_quad[done + j] = turned ? lr_packed_four[j].xzy : lr_packed_four[j];
        }
        done += left;
        if (done >= count || left == 0u) break;
    }
}

#endif  // LR_PACKED_HEADER
#endif  // __cplusplus
#endif  // LACEDRING_GLSL
