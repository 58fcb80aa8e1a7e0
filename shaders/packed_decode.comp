#version 460
#extension GL_GOOGLE_include_directive : require
// Expands a packed stream into an index buffer, and writes the commands that draw it.
//
// A workgroup has LR_BLOCKS_PER_GROUP blocks. One invocation a block reads its events and writes pieces of corridors into
// shared memory (13.5 KiB); then all of them expand four triangles at a time, whatever piece they are of, in the same few
// steps. A workgroup is as large as a subgroup, where it can be: none waits for another at the barrier.
//
// What lavapipe wants: it runs through both sides of a branch, and once through a `while` that has nothing to do, so what
// is rare is kept out of loops and loops end at their end. But in 22.3, invocations that leave a loop at its end before
// others do have wrong values after it, unless there is a second way out of it: hence the breaks that never happen.
#include "lrcore/codec/packed/packed_format.h"
#include "shaders/shared.h"

layout(local_size_x_id = 0) in;

layout(push_constant) uniform Push { DecodeConstants push; };

layout(std430, binding = 0) restrict readonly buffer Header { uint header[]; };
layout(std430, binding = 1) restrict readonly buffer Turns { uint turns[]; };
layout(std430, binding = 2) restrict readonly buffer Directory { uint directory[]; };
layout(std430, binding = 3) restrict readonly buffer Records { uint records[]; };
layout(std430, binding = 4) restrict writeonly buffer Indices { uvec4 indices[]; };
#define LR_BINDING_COMMANDS 5
#include "shaders/draw_commands.glsl"

const uint kBlocks = LR_BLOCKS_PER_GROUP;
const uint kWords = LR_PACKED_BLOCK_WORDS;
const uint kQuads = LR_PACKED_BLOCK / LR_TRIANGLES_PER_INVOCATION;

// Of each block, by its triangles' words:
shared uint ups[kBlocks * kWords];     // turns before it that are 1
shared uint starts[kBlocks * kWords];  // triangles that begin a piece
shared uint before[kBlocks * kWords];  // pieces begun before it
shared uint thirds[kBlocks * kWords];  // triangles whose third vertex the piece has
shared uint warts[kBlocks * kWords];   // T0 of warts
// Of each piece (a, b) as if entered at the block's first triangle, and a third vertex with LR_REVERSED.
shared uint piece_a[kBlocks * LR_PACKED_BLOCK];
shared uint piece_b[kBlocks * LR_PACKED_BLOCK];
shared uint piece_x[kBlocks * LR_PACKED_BLOCK];
shared uint plain_blocks;
#define LR_REVERSED 0x80000000u

uint bits_below(uint word, uint count) { return uint(bitCount(bitfieldExtract(word, 0, int(count)))); }

uint turn_word(uint triangle) {
    return turns[min(LR_PACKED_HEADER_WORDS + triangle / 32u - push.first_word, uint(turns.length()) - 1u)];
}
// Where the tables have triangle i of the block that begins at `first`.
uint table_word(uint first, uint i) {
    return (first - push.first_slot) % (kBlocks * LR_PACKED_BLOCK) / 32u + min(i / 32u, kWords - 1u);
}
uint ups_before(uint first, uint i) {
    uint begin = 32u * min(i / 32u, kWords - 1u);
    return ups[table_word(first, i)] + bits_below(turn_word(first + begin), i - begin);
}

// Nothing is read past a descriptor, whatever the stream says.
#define LR_PACKED_HEADER(i) header[i]
#define LR_PACKED_TURNS(i) turns[min((i) - push.first_word, uint(turns.length()) - 1u)]
#define LR_PACKED_DIRECTORY(i) directory[min((i) - push.directory, uint(directory.length()) - 1u)]
#define LR_PACKED_RECORDS(i) records[min((i) - push.records, uint(records.length()) - 1u)]
#define LR_PACKED_UPS(first, i) ups_before(first, i)
#define LR_PACKED_SEE_WART(r, i) warts[table_word(r.first, i)] |= 1u << ((i) & 31u)
#include "shaders/lacedring.glsl"

// The tables of block k of the workgroup, whose first triangle is `first`.
void read_block(LrPackedLayout p, uint k, uint first) {
    uint count = 0u;
    for (uint word = k * kWords, i = first; word < (k + 1u) * kWords; ++word, i += 32u) {
        ups[word] = count;
        count += uint(bitCount(turn_word(i)));
    }
    uint end = min(p.triangles - first, LR_PACKED_BLOCK), piece = k * LR_PACKED_BLOCK;
    LrPackedReader r;
    r.first = first;
    r.stop = 0u;
    do {  // records
        lr_packed_open(p, r, r.stop);
        if (r.plain) {
            atomicOr(plain_blocks, 1u << k);
            break;
        }
        for (;;) {
            if (piece == (k + 1u) * LR_PACKED_BLOCK) break;  // never
            uint ups_here = r.ups;
            LrPackedStep s = lr_packed_step(p, r);
            bool begins = s.jumped && r.i > s.first;
            if (begins) {
                starts[k * kWords + s.first / 32u] |= 1u << (s.first & 31u);
                piece_a[piece] = s.a - ups_here;
                piece_b[piece] = s.b + s.first - ups_here;
                ++piece;
            }
            if (begins || s.third) piece_x[piece - 1u] = s.x | (s.reversed ? LR_REVERSED : 0u);
            if (s.third) thirds[k * kWords + (r.i - 1u) / 32u] |= 1u << ((r.i - 1u) & 31u);
            if (r.i >= r.stop) break;
        }
    } while (r.stop < end);
    count = k * LR_PACKED_BLOCK;
    for (uint word = k * kWords; word < (k + 1u) * kWords; ++word) {
        before[word] = count;
        count += uint(bitCount(starts[word]));
    }
}

void store(uint at, uvec3 t0, uvec3 t1, uvec3 t2, uvec3 t3) {
    indices[at] = uvec4(t0, t1.x);
    indices[at + 1u] = uvec4(t1.yz, t2.xy);
    indices[at + 2u] = uvec4(t2.z, t3);
}

bvec4 nibble(uint word, uint shift) { return notEqual(uvec4(word >> shift) & uvec4(1u, 2u, 4u, 8u), uvec4(0u)); }

// What the tables have of 32 triangles.
struct Word {
    uint turns, starts, thirds, warts, t2s;
    uint ups, before;
};
Word load_word(uint word, uint triangle) {
    Word w = Word(turn_word(triangle), starts[word], thirds[word], warts[word], 0u, ups[word], before[word]);
    uint wart_before = word % kWords == 0u ? 0u : warts[word - 1u] >> 31;
    w.t2s = (w.warts << 1 | wart_before) & ~w.starts;  // where a record ends at the T0, there is none
    return w;
}

// Four triangles from the quad's first on, of which the first `left` are there.
void expand_quad(Word w, uint quad, uint triangle, uint left) {
    uint shift = quad % 8u * 4u;
    uint u = w.ups + bits_below(w.turns, shift);
    uint next = (w.starts >> shift & 14u) | 16u;
    uint piece = w.before + bits_below(w.starts, shift + 1u) - 1u;

    bvec4 up = nibble(w.turns, shift), is_third = nibble(w.thirds, shift), is_wart = nibble(w.warts, shift);
    bvec4 t2 = nibble(w.t2s, shift);
    uvec4 ones = uvec4(up);
    uvec4 to_a = u + uvec4(0u, ones.x, ones.x + ones.y, ones.x + ones.y + ones.z);
    uvec4 to_b = to_a - (quad % kQuads * 4u + uvec4(0u, 1u, 2u, 3u));
    uvec4 a, b, x;
    uint from = 0u;
    for (;;) {
        if (piece >= kBlocks * LR_PACKED_BLOCK) break;  // never
        bvec4 fresh = greaterThanEqual(uvec4(0u, 1u, 2u, 3u), uvec4(from));
        a = mix(a, piece_a[piece] + to_a, fresh);
        b = mix(b, piece_b[piece] + to_b, fresh);
        x = mix(x, uvec4(piece_x[piece]), fresh);
        ++piece;
        from = uint(findLSB(next));
        next &= next - 1u;
        if (from >= 4u) break;
    }

    bvec4 reversed = notEqual(x & LR_REVERSED, uvec4(0u));
    uvec4 tip = mix(b - 1u, a + 1u, up);
    uvec4 far = mix(b - 2u, a + 2u, up);
    uvec4 inner = mix(b, a, up);  // a wart's T2 is (inner - 1, inner, inner + 1)
    tip = mix(mix(tip, x & ~LR_REVERSED, is_third), far, is_wart);
    tip = mix(tip, inner, t2);
    a = mix(a, inner - 1u, t2);
    b = mix(b, inner + 1u, t2);
    uvec4 second = mix(b, tip, reversed), last = mix(tip, b, reversed);
    bvec4 none = greaterThanEqual(uvec4(0u, 1u, 2u, 3u), uvec4(left));  // drawn by no command
    a = mix(a, uvec4(0u), none);
    second = mix(second, uvec4(0u), none);
    last = mix(last, uvec4(0u), none);
    store((triangle - push.first_slot) / 4u * 3u, uvec3(a.x, second.x, last.x), uvec3(a.y, second.y, last.y),
          uvec3(a.z, second.z, last.z), uvec3(a.w, second.w, last.w));
}

void expand_plain(LrPackedLayout p, uint quad, uint triangle, uint left) {
    LrPackedReader r;
    r.first = triangle / LR_PACKED_BLOCK * LR_PACKED_BLOCK;
    uint i = triangle - r.first;
    lr_packed_open(p, r, i);
    uvec3 t[4];
    for (uint k = 0u; k < 4u; ++k) t[k] = k < left ? lr_packed_plain(p, r, i + k) : uvec3(0u);
    store((triangle - push.first_slot) / 4u * 3u, t[0], t[1], t[2], t[3]);
}

void main() {
    LrPackedLayout p = lr_packed_layout();
    uint id = gl_LocalInvocationID.x, size = gl_WorkGroupSize.x;
    if (gl_GlobalInvocationID.x == 0u) write_commands(push.draws, push.draw_slots, p.triangles);
    uint first = push.first_slot + gl_WorkGroupID.x * kBlocks * LR_PACKED_BLOCK;
    uint end = min(p.triangles, push.first_slot + push.slots);
    if (id == 0u) plain_blocks = 0u;
    for (uint word = id; word < kBlocks * kWords; word += size) starts[word] = thirds[word] = warts[word] = 0u;
    barrier();
    for (uint k = id; k < kBlocks; k += size) {
        if (first + k * LR_PACKED_BLOCK < end) read_block(p, k, first + k * LR_PACKED_BLOCK);
    }
    barrier();
    uint quads = (min(end - first, kBlocks * LR_PACKED_BLOCK) + 3u) / 4u;
    uint quad = 2u * id;
    do {
        if (quad < quads && (plain_blocks >> quad / kQuads & 1u) == 0u) {
            uint triangle = first + 4u * quad;
            Word w = load_word(quad / 8u, triangle);
            expand_quad(w, quad, triangle, end - triangle);
            if (quad + 1u < quads) expand_quad(w, quad + 1u, triangle + 4u, end - triangle - 4u);
        }
        quad += 2u * size;
    } while (quad < quads);
    for (uint rest = plain_blocks; rest != 0u; rest &= rest - 1u) {
        uint begin = uint(findLSB(rest)) * kQuads;
        for (uint q = begin + id; q < min(begin + kQuads, quads); q += size) {
            expand_plain(p, q, first + 4u * q, end - first - 4u * q);
        }
    }
}
