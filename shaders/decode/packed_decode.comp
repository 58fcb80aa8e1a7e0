#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
// Expands a packed stream into an index buffer, and writes the commands that draw it.
//
// A workgroup decodes kBlocks blocks, four or eight. First, one invocation per block reads the block's events and
// writes the pieces of its corridors into shared memory (3.2 KiB per block). Then all invocations expand four triangles
// at a time: the piece of a triangle and a popcount of turns give its (a, b). A workgroup is as large as a subgroup if
// possible, so that no subgroup waits for another at the barrier.
//
// Tuned for lavapipe, which executes both sides of a branch, and the body of a `while` once even if its condition is
// false. So rare cases are kept out of loops, and loops test their condition at the end. A bug of lavapipe 22.3: if
// some invocations leave a loop by its end condition before others, their values are wrong after it, unless the loop
// has a second exit. Hence the breaks marked "never".
#include "lrcore/codec/packed/packed_format.h"
#include "shaders/shared.h"

layout(local_size_x_id = 0) in;

layout(push_constant) uniform Push { DecodeConstants push; };

layout(buffer_reference, std430, buffer_reference_align = 4) readonly buffer Words { uint at[]; };
layout(std430, binding = 0) restrict writeonly buffer Indices { uvec4 indices[]; };
#define LR_BINDING_COMMANDS 1
#include "shaders/decode/draw_commands.glsl"

layout(constant_id = LR_CONSTANT_BLOCKS) const uint kBlocks = 4u;
const uint kWords = LR_PACKED_BLOCK_WORDS;
const uint kQuads = LR_PACKED_BLOCK / LR_TRIANGLES_PER_INVOCATION;

// One entry per word of 32 triangles; bitmaps have a bit per triangle:
shared uint ups[kBlocks * kWords];     // number of 1 turns in the block before this word
shared uint starts[kBlocks * kWords];  // bitmap: triangles that begin a piece
shared uint before[kBlocks * kWords];  // the last triangle before this word that begins a piece
shared uint thirds[kBlocks * kWords];  // bitmap: triangles whose third vertex comes from an event
shared uint warts[kBlocks * kWords];   // bitmap: T0s of warts
shared uint flips[kBlocks * kWords];   // bitmap: triangles with the opposite orientation
// For a triangle that begins a piece: (a, b), extrapolated back to the block's first triangle, and the orientation in
// piece_x (LR_REVERSED). For the triangle of an event: its third vertex in piece_x.
shared uint piece_a[kBlocks * LR_PACKED_BLOCK];
shared uint piece_b[kBlocks * LR_PACKED_BLOCK];
shared uint piece_x[kBlocks * LR_PACKED_BLOCK];
shared uint single_blocks;  // bitmap: blocks whose triangles are decoded one by one (plain, or with doubles)
#define LR_REVERSED 0x80000000u

uint bits_below(uint word, uint count) { return uint(bitCount(bitfieldExtract(word, 0, int(count)))); }

// Clamped, so that no stream makes the shader read past its end.
uint stream_word(uint i) { return Words(push.stream).at[min(i, push.words - 1u)]; }
uint turn_word(uint triangle) { return stream_word(LR_PACKED_HEADER_WORDS + triangle / 32u); }

#define LR_PACKED_WORD(i) stream_word(i)
#include "shaders/include/lacedring.glsl"

// Reads the events of a block. Triangles are counted from the workgroup's first.
struct Reader {
    uint first;       // the workgroup's first triangle in the mesh
    uint at;          // the triangle that the state's (a, b) belong to
    uint scopes_end;  // end of the outermost scope
};

uint ups_before(Reader b, uint i) {
    uint word = min(i / 32u, kBlocks * kWords - 1u);
    return ups[word] + bits_below(turn_word(b.first + 32u * word), i - 32u * word);
}
void begin_piece(Reader b, LrPackedState s, uint i) {
    if (i >= kBlocks * LR_PACKED_BLOCK) return;
    uint up = ups_before(b, i);
    starts[i / 32u] |= 1u << (i & 31u);
    piece_a[i] = s.a - up;
    piece_b[i] = s.b + i - up;
    piece_x[i] = s.reversed ? LR_REVERSED : 0u;
}
// The last triangle in (from, i] that begins a piece; `from` if there is none.
uint last_start(uint from, uint i) {
    uint last = from;
    for (uint word = from / 32u; word <= i / 32u; ++word) {
        uint bits = starts[word];
        if (word == i / 32u) bits &= 0xffffffffu >> (31u - (i & 31u));
        if (bits != 0u) last = max(last, 32u * word + uint(findMSB(bits)));
    }
    return last;
}

// Sets the state to the start of the piece that begins at triangle i.
void resume(inout Reader b, inout LrPackedState s, uint i) {
    uint up = ups_before(b, i);
    s.a = piece_a[i] + up;
    s.b = piece_b[i] + up - i;
    s.reversed = (piece_x[i] & LR_REVERSED) != 0u;
    s.finished = false;
    b.at = i;
}

// Moves the state forward to triangle `to`. If a piece begins on the way (at the end of a scope), continues from that
// piece.
void advance(inout Reader b, inout LrPackedState s, uint to) {
    uint start = last_start(b.at, to);
    if (start > b.at) resume(b, s, start);
    uint left = s.finished ? 0u : lr_packed_left(s.a, s.b);
    for (uint k = 0u; k < LR_PACKED_BLOCK; ++k) {
        if (to - b.at <= left) break;
        b.at += left;
        lr_packed_repeat(s);
        begin_piece(b, s, b.at);
        left = lr_packed_left(s.a, s.b);
    }
    uint up = ups_before(b, to) - ups_before(b, b.at);
    s.a += up;
    s.b -= to - b.at - up;
    if (to > b.at) s.finished = to - b.at == left;
    b.at = to;
}

// The position of the set bit that has `rank` set bits below it.
uint select_bit(uint bits, uint rank) {
    uint at = 0u;
    for (uint size = 16u; size > 0u; size /= 2u) {
        uint low = bits_below(bits >> at, size);
        if (rank >= low) {
            rank -= low;
            at += size;
        }
    }
    return at;
}

void read_warts(inout LrPackedRecord r, uint first, uint begin) {
    uint end = begin + r.triangles, word = begin / 32u, candidates = 0u, next = turn_word(first + begin), seen = 0u;
    for (;;) {
        lr_packed_fill(r.bits);
        uint high = lr_packed_ones(r.bits.bits.x);
        if (high >= min(r.bits.left, 32u)) break;
        lr_packed_take(r.bits, high);
        uint gap = (high << r.wart_bits) + (lr_packed_take(r.bits, 1u + r.wart_bits) >> 1);
        uint count = uint(bitCount(candidates));
        while (gap >= count && 32u * word < end) {
            gap -= count;
            uint here = next, last = end - 32u * word;
            next = last > 32u ? turn_word(first + 32u * (word + 1u)) : 0u;
            candidates = ~(here ^ (here >> 1 | next << 31));
            if (last <= 32u) candidates = (candidates | 1u << (last - 1u)) & 0xffffffffu >> (32u - last);
            count = uint(bitCount(candidates));
            ++word;
        }
        if (gap >= count) break;
        uint bit = select_bit(candidates, gap);
        warts[word - 1u] |= 1u << bit;
        candidates &= 0xfffffffeu << bit;
    }
}

// Fills the tables of the workgroup's block k; `first` is the block's first triangle in the mesh.
void read_block(LrPackedLayout p, uint k, uint first) {
    uint count = 0u;
    for (uint word = k * kWords, i = first; word < (k + 1u) * kWords; ++word, i += 32u) {
        ups[word] = count;
        count += uint(bitCount(turn_word(i)));
    }
    uint end = min(p.own - first, LR_PACKED_BLOCK), base = k * LR_PACKED_BLOCK, i = 0u;
    Reader b;
    b.first = first - base;
    do {  // records
        LrPackedRecord r = lr_packed_record(p, first / LR_PACKED_BLOCK, i);
        if (r.plain) {
            atomicOr(single_blocks, 1u << k);
            break;
        }
        uint begin = base + i;
        b.at = b.scopes_end = begin;
        LrPackedState s = lr_packed_state(r);
        begin_piece(b, s, begin);
        LrPackedEvent e;
        e.after = 0u;
        uint events = lr_packed_events(r);
        for (uint n = 0u; n < events; ++n) {
            lr_packed_next_event(p, r, e);
            if (e.triangle >= r.triangles) break;
            uint at = begin + e.triangle;
            advance(b, s, at);
            if (e.code == LR_PACKED_FLIPS) {
                for (uint t = begin; t < begin + r.triangles; t += 32u) {
                    uint bit = e.flips + t - begin;
                    uint low = LR_PACKED_GROUPS(p.groups + bit / 32u) >> (bit & 31u);
                    flips[t / 32u] = low | LR_PACKED_GROUPS(p.groups + bit / 32u + 1u) << 1 << (31u - (bit & 31u));
                }
            } else if (e.after > e.triangle) {
                if (s.finished) {
                    lr_packed_repeat(s);
                    begin_piece(b, s, at);
                }
                bool up = (turn_word(b.first + at) >> (at & 31u) & 1u) != 0u;
                uvec2 rest;
                uint x = lr_packed_third(e, up, s, rest);
                piece_x[at] = (piece_x[at] & ((starts[at / 32u] >> (at & 31u) & 1u) != 0u ? LR_REVERSED : 0u)) | x;
                thirds[at / 32u] |= 1u << (at & 31u);
                b.at = at + 1u;
                uint left = r.triangles - e.after;
                if (e.w > 0u && e.w < left) {
                    begin_piece(b, LrPackedState(rest.x, rest.y, s.reversed, false, 0u, 0u, false), b.at + e.w);
                    if (b.at >= b.scopes_end) b.scopes_end = b.at + e.w;
                }
                // If a piece begins here already, a scope has ended.
                if (left > 0u && (starts[b.at / 32u] >> (b.at & 31u) & 1u) != 0u) {
                    resume(b, s, b.at);
                } else if (left > 0u) {
                    begin_piece(b, s, b.at);
                }
            } else {
                if (e.code == LR_PACKED_TURN) {
                    s.reversed = !s.reversed;
                } else {
                    lr_packed_begin(e, s, at < b.scopes_end);
                }
                if (!s.finished) begin_piece(b, s, at);  // else the next polygon begins a piece with this orientation
            }
        }
        if (b.at < begin + r.triangles) advance(b, s, begin + r.triangles - 1u);
        if (s.finished && b.at < begin + r.triangles) {
            lr_packed_repeat(s);
            begin_piece(b, s, b.at);
        }
        read_warts(r, b.first, begin);
        i += r.triangles;
    } while (i < end);
    count = k * LR_PACKED_BLOCK;
    for (uint word = k * kWords; word < (k + 1u) * kWords; ++word) {
        before[word] = count;
        if (starts[word] != 0u) count = 32u * word + uint(findMSB(starts[word]));
    }
}

void store(uint at, uvec3 t0, uvec3 t1, uvec3 t2, uvec3 t3) {
    indices[at] = uvec4(t0, t1.x);
    indices[at + 1u] = uvec4(t1.yz, t2.xy);
    indices[at + 2u] = uvec4(t2.z, t3);
}

bvec4 nibble(uint word, uint shift) { return notEqual(uvec4(word >> shift) & uvec4(1u, 2u, 4u, 8u), uvec4(0u)); }

// The tables' entries for a word of 32 triangles.
struct Word {
    uint turns, starts, thirds, warts, t2s, flips;
    uint ups, before;
};
Word load_word(uint word, uint triangle) {
    Word w = Word(turn_word(triangle), starts[word], thirds[word], warts[word], 0u, flips[word], ups[word], before[word]);
    uint wart_before = word % kWords == 0u ? 0u : warts[word - 1u] >> 31;
    w.t2s = (w.warts << 1 | wart_before) & ~w.starts;  // a record that ends at a wart's T0 has no T2 after it
    return w;
}

// Expands the four triangles of a quad; only the first `left` exist.
void expand_quad(Word w, uint quad, uint triangle, uint left) {
    uint shift = quad % 8u * 4u, at = 4u * quad;
    uint u = w.ups + bits_below(w.turns, shift);
    uint begun = bitfieldExtract(w.starts, 0, int(shift + 1u));
    uint piece = begun == 0u ? w.before : at - shift + uint(findMSB(begun));
    uint next = (w.starts >> shift & 14u) | 16u;

    bvec4 up = nibble(w.turns, shift), is_third = nibble(w.thirds, shift), is_wart = nibble(w.warts, shift);
    bvec4 t2 = nibble(w.t2s, shift), flip = nibble(w.flips, shift);
    uvec4 ones = uvec4(up), k = uvec4(0u, 1u, 2u, 3u);
    uvec4 to_a = u + uvec4(0u, ones.x, ones.x + ones.y, ones.x + ones.y + ones.z);
    uvec4 to_b = to_a - (at + k);
    uvec4 a, b, r;
    uint from = 0u;
    for (;;) {
        if (piece >= kBlocks * LR_PACKED_BLOCK) break;  // never
        bvec4 fresh = greaterThanEqual(k, uvec4(from));
        a = mix(a, piece_a[piece] + to_a, fresh);
        b = mix(b, piece_b[piece] + to_b, fresh);
        r = mix(r, uvec4(piece_x[piece]), fresh);
        from = uint(findLSB(next));
        piece = at + from;
        next &= next - 1u;
        if (from >= 4u) break;
    }

    bvec4 reversed = notEqual(notEqual(r & LR_REVERSED, uvec4(0u)), flip);
    uvec4 tip = mix(b - 1u, a + 1u, up);
    uvec4 far = mix(b - 2u, a + 2u, up);
    uvec4 inner = mix(b, a, up);  // a wart's T2 is (inner - 1, inner, inner + 1)
    if (any(is_third)) {
        uvec4 x = uvec4(piece_x[at], piece_x[at + 1u], piece_x[at + 2u], piece_x[at + 3u]);
        tip = mix(tip, x & ~LR_REVERSED, is_third);
    }
    tip = mix(mix(tip, far, is_wart), inner, t2);
    a = mix(a, inner - 1u, t2);
    b = mix(b, inner + 1u, t2);
    uvec4 second = mix(b, tip, reversed), last = mix(tip, b, reversed);
    bvec4 none = greaterThanEqual(k, uvec4(left));  // past the last triangle: not drawn
    a = mix(a, uvec4(0u), none);
    second = mix(second, uvec4(0u), none);
    last = mix(last, uvec4(0u), none);
    store((triangle - push.first_slot) / 4u * 3u, uvec3(a.x, second.x, last.x), uvec3(a.y, second.y, last.y),
          uvec3(a.z, second.z, last.z), uvec3(a.w, second.w, last.w));
}

void expand_singly(LrPackedLayout p, uint triangle, uint left) {
    uvec3 t[4];
    for (uint k = 0u; k < 4u; ++k) t[k] = k < left ? lr_packed_triangle(p, triangle + k) : uvec3(0u);
    store((triangle - push.first_slot) / 4u * 3u, t[0], t[1], t[2], t[3]);
}

void main() {
    LrPackedLayout p = lr_packed_layout();
    uint id = gl_LocalInvocationID.x, size = gl_WorkGroupSize.x;
    uint triangles = lr_packed_triangles(p);
    if (gl_GlobalInvocationID.x == 0u) write_commands(push.draws, push.draw_slots, triangles);
    uint first = push.first_slot + gl_WorkGroupID.x * kBlocks * LR_PACKED_BLOCK;
    uint end = min(triangles, push.first_slot + push.slots);
    if (id == 0u) single_blocks = 0u;
    for (uint word = id; word < kBlocks * kWords; word += size) starts[word] = thirds[word] = warts[word] = flips[word] = 0u;
    barrier();
    for (uint k = id; k < kBlocks; k += size) {
        uint begin = first + k * LR_PACKED_BLOCK;
        if (min(end, begin + LR_PACKED_BLOCK) > p.own) {
            atomicOr(single_blocks, 1u << k);
        } else if (begin < end) {
            read_block(p, k, begin);
        }
    }
    barrier();
    uint quads = (min(end - first, kBlocks * LR_PACKED_BLOCK) + 3u) / 4u;
    uint quad = 2u * id;
    do {
        if (quad < quads && (single_blocks >> quad / kQuads & 1u) == 0u) {
            uint triangle = first + 4u * quad;
            Word w = load_word(quad / 8u, triangle);
            expand_quad(w, quad, triangle, end - triangle);
            if (quad + 1u < quads) expand_quad(w, quad + 1u, triangle + 4u, end - triangle - 4u);
        }
        quad += 2u * size;
    } while (quad < quads);
    for (uint rest = single_blocks; rest != 0u; rest &= rest - 1u) {
        uint begin = uint(findLSB(rest)) * kQuads;
        for (uint q = begin + id; q < min(begin + kQuads, quads); q += size) {
            expand_singly(p, first + 4u * q, end - first - 4u * q);
        }
    }
}
