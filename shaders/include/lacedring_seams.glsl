// Decodes seam sections (docs/seams-format.md): finds the copy of its vertex that each corner of a triangle uses. Needs
// the surface's triangles as an index list: the slots of a stream, already expanded with lacedring.glsl.
//
//     #define LR_SEAM_WORD(i) words[i]             // word i of the section; reads up to two words past it (any values)
//     // In the shader that decodes the vertex blocks:
//     #define LR_SEAM_PUT_HOME(v, value) home[v] = value
//     // In the shader that decodes the triangle blocks, after all vertex blocks:
//     #define LR_SEAM_HOME(v) home[v]
//     #define LR_SEAM_VERTEX(k) indices[k]         // the vertex of corner k: corner k % 3 of triangle k / 3
//     #define LR_SEAM_COPY(k) copies[k]            // a uint of a read-write buffer: receives the copy of corner k
//     // Optional, in both: called once for every copy, with its vertex
//     #define LR_SEAM_PUT_VERTEX(copy, v) vertex_of[copy] = v
//     #include "lacedring_seams.glsl"
//
//     LrSeamLayout seams = lr_seam_layout(vertex_count, triangle_count);
//     lr_seam_vertex_block(seams, block);          // one invocation per 512 vertices
//     lr_seam_triangle_block(seams, block);        // one invocation per 512 triangles
//
// triangle_count counts slots. A slot that names a vertex twice has no triangle (degenerate slots of lean streams): its
// corners get copy 0. home[v] is twice the first copy of vertex v, plus 1 if the vertex wraps. It has vertex_count + 1
// entries; home[vertex_count] / 2 is the number of home copies. The section must be valid for these triangles
// (lacedring::validate_seams). With any other, every loop still ends, and only home[0..vertex_count] and the block's
// own corners are written; but LR_SEAM_PUT_VERTEX may be called for copies that do not exist, and entries past `home`
// and words past the section may be read.
#ifndef LACEDRING_SEAMS_GLSL
#define LACEDRING_SEAMS_GLSL

#define LR_SEAM_HEADER_WORDS 8u
#define LR_SEAM_BLOCK 512u  // triangles of a triangle block, vertices of a vertex block
#define LR_SEAM_GROUP 32u   // blocks per group of a directory
#define LR_SEAM_BACK 64u    // a triangle's parent is searched among this many triangles before it
#define LR_SEAM_MAX_STEPS 255u
#define LR_SEAM_ENDLESS 0x7fffffff

// Contexts of binary flags. The section's table has a likely value and a run class for each.
#define LR_SEAM_V0 0u
#define LR_SEAM_MORE 3u
#define LR_SEAM_MANY 4u
#define LR_SEAM_WRAP 5u
#define LR_SEAM_LONE 6u
#define LR_SEAM_LEFT0 7u
#define LR_SEAM_LEFT1 8u
#define LR_SEAM_LEFT2 9u
#define LR_SEAM_RIGHT0 10u
#define LR_SEAM_RIGHT1 11u
#define LR_SEAM_RIGHT2 12u
#define LR_SEAM_RIGHT3 13u
#define LR_SEAM_RIGHT4 14u
#define LR_SEAM_HALF 15u
#define LR_SEAM_BOTH 16u
#define LR_SEAM_STEP_L 17u
#define LR_SEAM_LEAVE 18u
#define LR_SEAM_LAST_R 19u
#define LR_SEAM_NEXT_R 20u
#define LR_SEAM_START_L 21u
#define LR_SEAM_MID_L 22u
#define LR_SEAM_PLAIN 23u
#define LR_SEAM_SEAMED 24u
#define LR_SEAM_SEAMED2 25u
#define LR_SEAM_MID_R 26u
#define LR_SEAM_MID_R2 27u
#define LR_SEAM_NEW_R 28u
#define LR_SEAM_NEW_L 29u
#define LR_SEAM_NEW_M 30u
#define LR_SEAM_OTHER 31u  // any other home copy
#define LR_SEAM_NONE 32u

// One of the section's two parts: vertex blocks or triangle blocks.
struct LrSeamPart {
    uint length_bits, copy_bits;  // widths of the directory's fields
    uint directory;               // its first bit in the section
    uint word, bit;               // position at which its blocks begin
};
struct LrSeamLayout {
    uint vertices, triangles;  // of the mesh
    uint homes;
    LrSeamPart by_vertex, by_triangle;
};

// The 32 bits that begin `bit` bits after the start of word `word`.
uint lr_seam_load(uint word, uint bit) {
    uint at = word + bit / 32u, shift = bit & 31u, low = LR_SEAM_WORD(at) >> shift;
    return shift == 0u ? low : low | LR_SEAM_WORD(at + 1u) << (32u - shift);
}
uint lr_seam_field(uint at, uint bits) { return bitfieldExtract(lr_seam_load(0u, at), 0, int(bits)); }

// The block being read. Bit positions count from word lr_seam_word.
uint lr_seam_word, lr_seam_at, lr_seam_end;
int lr_seam_run[8];   // by run class: likely values left in the run; -1: the run is not read yet
uvec4 lr_seam_table;  // likely value and run class of each context

// Starts reading a block. Returns the number of copies made by the blocks before it.
uint lr_seam_open(LrSeamPart part, uint block) {
    uint group = block / LR_SEAM_GROUP, size = part.length_bits + part.copy_bits;
    uint at = part.directory + group * (LR_SEAM_GROUP * size + 64u), begin = 0u, before = 0u;
    if (group > 0u) {
        begin = lr_seam_load(0u, at - 64u);
        before = lr_seam_load(0u, at - 32u);
    }
    for (uint i = 0u; i < LR_SEAM_GROUP; ++i) {
        if (i >= block % LR_SEAM_GROUP) break;
        begin += lr_seam_field(at, part.length_bits);
        before += lr_seam_field(at + part.length_bits, part.copy_bits);
        at += size;
    }
    uint bit = part.bit + begin % 32u;
    lr_seam_word = part.word + begin / 32u + bit / 32u;
    lr_seam_at = bit % 32u;
    lr_seam_end = lr_seam_at + lr_seam_field(at, part.length_bits);
    for (uint k = 0u; k < 8u; ++k) lr_seam_run[k] = -1;
    for (uint k = 0u; k < 4u; ++k) lr_seam_table[k] = LR_SEAM_WORD(4u + k);
    return before;
}

uint lr_seam_blocks(uint elements) { return elements / LR_SEAM_BLOCK + (elements % LR_SEAM_BLOCK == 0u ? 0u : 1u); }

uint lr_seam_directory_bits(LrSeamPart part, uint blocks) {
    return blocks * (part.length_bits + part.copy_bits) + (blocks == 0u ? 0u : 64u * ((blocks - 1u) / LR_SEAM_GROUP));
}

LrSeamLayout lr_seam_layout(uint vertices, uint triangles) {
    uint widths = LR_SEAM_WORD(3u), vertex_blocks = lr_seam_blocks(vertices);
    LrSeamLayout p;
    p.vertices = vertices;
    p.triangles = triangles;
    p.homes = LR_SEAM_WORD(2u);
    p.by_vertex.length_bits = widths & 31u;
    p.by_vertex.copy_bits = widths >> 8 & 31u;
    p.by_triangle.length_bits = widths >> 16 & 31u;
    p.by_triangle.copy_bits = widths >> 24 & 31u;
    p.by_vertex.directory = 32u * LR_SEAM_HEADER_WORDS;
    p.by_triangle.directory = p.by_vertex.directory + lr_seam_directory_bits(p.by_vertex, vertex_blocks);
    uint end = p.by_triangle.directory + lr_seam_directory_bits(p.by_triangle, lr_seam_blocks(triangles));
    p.by_vertex.word = end / 32u;
    p.by_vertex.bit = end % 32u;
    p.by_triangle.word = p.by_vertex.word;
    p.by_triangle.bit = p.by_vertex.bit;
    if (vertex_blocks > 0u) {  // the triangle blocks begin where the last vertex block ends
        lr_seam_open(p.by_vertex, vertex_blocks - 1u);
        p.by_triangle.word = lr_seam_word + lr_seam_end / 32u;
        p.by_triangle.bit = lr_seam_end % 32u;
    }
    return p;
}

uint lr_seam_take(uint bits) {
    uint value = bitfieldExtract(lr_seam_load(lr_seam_word, lr_seam_at), 0, int(bits));
    lr_seam_at = min(lr_seam_at + bits, lr_seam_end);
    return value;
}

uint lr_seam_unary() {
    uint ones = 0u;
    for (uint i = 0u; i < 0x8000u; ++i) {  // a block has less than 2^20 bits
        uint some = min(uint(findLSB(~lr_seam_load(lr_seam_word, lr_seam_at))), 32u);
        ones += some;
        lr_seam_at = min(lr_seam_at + some + (some < 32u ? 1u : 0u), lr_seam_end);
        if (some < 32u || lr_seam_at == lr_seam_end) break;
    }
    return ones;
}

int lr_seam_read_run(uint k) {
    if (lr_seam_at == lr_seam_end) return LR_SEAM_ENDLESS;
    if (k == 7u && lr_seam_take(1u) == 0u) return LR_SEAM_ENDLESS;
    uint ones = lr_seam_unary(), width = k < 7u ? k - 1u : min(ones + 5u, 31u);
    uint high = k < 7u ? ones << width : (1u << width) - 32u;
    return int((high + lr_seam_take(width)) & 0x00ffffffu);
}

bool lr_seam_flag(uint context) {
    uint entry = lr_seam_table[context / 8u] >> 4u * (context & 7u), k = entry >> 1 & 7u;
    bool likely = (entry & 1u) != 0u;
    if (k == 0u) return lr_seam_at == lr_seam_end ? likely : lr_seam_take(1u) != 0u;
    int run = lr_seam_run[k];
    if (run < 0) run = lr_seam_read_run(k);
    lr_seam_run[k] = --run;
    return likely == (run >= 0);
}

#ifndef LR_SEAM_PUT_VERTEX
#define LR_SEAM_PUT_VERTEX(copy, v)
#endif

#ifdef LR_SEAM_PUT_HOME
void lr_seam_vertex_block(LrSeamLayout p, uint block) {
    uint vertex = block * LR_SEAM_BLOCK, first = vertex + lr_seam_open(p.by_vertex, block), before = 0u;
    for (uint i = 0u; i < LR_SEAM_BLOCK; ++i) {
        if (vertex >= p.vertices) break;
        uint steps = 0u, wrap = 0u, context = LR_SEAM_V0 + before;
        for (uint n = 0u; n < LR_SEAM_MAX_STEPS + 2u; ++n) {
            bool yes = lr_seam_flag(context), again = yes && steps < LR_SEAM_MAX_STEPS - 1u;
            if (context == LR_SEAM_WRAP) {
                wrap = yes ? 1u : 0u;
                break;
            }
            if (yes) ++steps;
            if (context <= LR_SEAM_MORE && !yes) break;
            context = context < LR_SEAM_MORE ? LR_SEAM_MORE : again ? LR_SEAM_MANY : LR_SEAM_WRAP;
        }
        LR_SEAM_PUT_HOME(vertex, 2u * first + wrap);
        for (uint copy = 0u; copy <= steps - wrap; ++copy) LR_SEAM_PUT_VERTEX(first + copy, vertex);
        first += steps + 1u - wrap;
        before = min(steps, 2u);
        ++vertex;
    }
    if (vertex == p.vertices) LR_SEAM_PUT_HOME(vertex, 2u * first);
}
#endif

#ifdef LR_SEAM_COPY
// While a block is decoded, the words of its corners have two flags beside the copy.
#define LR_SEAM_LAST 0x80000000u   // copy 0 of a vertex that wraps, used as its last position
#define LR_SEAM_RIGHT 0x40000000u  // in a triangle's first corner: the triangle is right of the ring
#define LR_SEAM_COPY_BITS 0x3fffffffu

uvec3 lr_seam_triangle(uint i) {
    uvec3 t = uvec3(LR_SEAM_VERTEX(3u * i), LR_SEAM_VERTEX(3u * i + 1u), LR_SEAM_VERTEX(3u * i + 2u));
    // A degenerate slot gets a number that no vertex has.
    return t.x == t.y || t.y == t.z || t.z == t.x ? uvec3(0xffffffffu) : t;
}
uint lr_seam_corner(uvec3 t, uint v) { return t.x == v ? 0u : t.y == v ? 1u : t.z == v ? 2u : 3u; }
bool lr_seam_two(bvec3 has) { return (has.x && has.y) || (has.z && (has.x || has.y)); }
bool lr_seam_has(uvec3 t, uint v) { return t.x == v || t.y == v || t.z == v; }
uint lr_seam_side(uvec3 t) {  // 0 left, 1 right, 2 no ring edge
    if (t.y == t.x + 1u) return 0u;
    if (t.x == t.y + 1u) return 1u;
    if (t.z == t.y + 1u) return 0u;
    if (t.y == t.z + 1u) return 1u;
    if (t.x == t.z + 1u) return 0u;
    return t.z == t.x + 1u ? 1u : 2u;
}

// A hash of a vertex: one bit of 32.
uint lr_seam_mark(uint v) { return 1u << (v * 0x9e3779b9u >> 27); }

// The home copies of the three vertices of a triangle.
struct LrSeamHomes {
    uvec3 first, count;  // of the home copies
    uvec3 steps;         // number of the last position
};
LrSeamHomes lr_seam_homes(uvec3 t) {
    uvec3 entry = uvec3(LR_SEAM_HOME(t.x), LR_SEAM_HOME(t.y), LR_SEAM_HOME(t.z));
    LrSeamHomes h;
    h.first = entry >> 1;
    h.count = (uvec3(LR_SEAM_HOME(t.x + 1u), LR_SEAM_HOME(t.y + 1u), LR_SEAM_HOME(t.z + 1u)) >> 1) - h.first;
    h.steps = h.count - 1u + (entry & 1u);
    return h;
}
// The word of a position of corner j's vertex. LR_SEAM_LAST marks the position past the last home copy.
uint lr_seam_place(LrSeamHomes h, uint j, uint position) {
    return position == h.count[j] ? h.first[j] | LR_SEAM_LAST : h.first[j] + position;
}

// One end of the edge that a triangle shares with its parent.
struct LrSeamEnd {
    uint word;      // its word in the parent
    uint position;  // its position in the parent, if not private
    bool is_private;
    uint far;     // the position at which the fan ends
    // The end's class: 0 the vertex has only one position; 1 the end is at `far`; else 2 on the right. On the left, else
    // 2 if the end can still reach `far`, 3 if it cannot.
    uint type;
    uint fan;     // number of the fan's triangles from this one on, at most 3
};
// Describes the end at corner j of the edge that triangle t shares with `parent`; `other`: the corner at the edge's
// other end. next: the two triangles after t. left: triangles from t on in the block.
LrSeamEnd lr_seam_end_of(LrSeamLayout p, uvec3 t, LrSeamHomes h, uint j, uint other, uvec3 parent, uint parent_corner, uint side, uvec3 next[2],
                         uint left) {
    uint v = t[j], in_parent = lr_seam_corner(parent, v);
    LrSeamEnd e;
    e.word = LR_SEAM_COPY(parent_corner + in_parent) & (LR_SEAM_LAST | LR_SEAM_COPY_BITS);
    e.is_private = (e.word & LR_SEAM_COPY_BITS) >= p.homes;
    e.position = (e.word & LR_SEAM_LAST) != 0u ? h.count[j] : e.word - h.first[j];
    e.fan = left >= 2u && !lr_seam_has(next[0], v) ? 1u : left >= 3u && !lr_seam_has(next[1], v) ? 2u : 3u;
    bool precedes = parent[in_parent > 0u ? in_parent - 1u : 2u] == t[other];
    e.far = (side == 0u) == precedes ? 0u : h.steps[j];
    if (side == 0u) {
        uint to_go = e.is_private ? 0u : uint(abs(int(e.far - e.position)));
        e.type = to_go == 0u ? (h.steps[j] > 0u ? 1u : 0u) : to_go < e.fan ? 2u : 3u;
    } else {
        bool there = (e.word & LR_SEAM_COPY_BITS) == (lr_seam_place(h, j, e.far) & LR_SEAM_COPY_BITS);
        e.type = !there ? 2u : h.steps[j] > 0u ? 1u : 0u;
    }
    return e;
}

// The flags to read for a corner: does it have the copy at position `at`, and does it have a new private copy?
struct LrSeamQuestion {
    uint at, at_context;  // LR_SEAM_NONE: the flag is not read
    uint new_context;
    bool new_first;  // its flag is read before that of the position
};
// The question about the new copy at end e of the shared edge.
LrSeamQuestion lr_seam_change(LrSeamEnd e, uint steps, uint side) {
    LrSeamQuestion q = LrSeamQuestion(e.far, LR_SEAM_STEP_L, LR_SEAM_NEW_L, false);
    if (side == 0u) {
        if (!e.is_private) {
            q.at = e.far > e.position ? e.position + 1u : e.position - 1u;
            if (e.far == e.position) q.at = steps == 0u ? 0u : e.far == 0u ? 1u : e.far - 1u;
        }
    } else if (e.type < 2u) {
        q.at_context = LR_SEAM_NONE;
        q.new_context = LR_SEAM_LEAVE;
    } else {
        q.at_context = e.fan == 1u ? LR_SEAM_LAST_R : LR_SEAM_NEXT_R;
        q.new_context = LR_SEAM_NEW_R;
    }
    return q;
}
// The question for corner j, which is not in the parent. If there is a parent, the words of the other corners are
// known.
LrSeamQuestion lr_seam_start(uvec3 t, LrSeamHomes h, uvec3 words, uint j, uint side, bool has_parent) {
    uint steps = h.steps[j];
    uint before = lr_seam_corner(t, t[j] - 1u), after = lr_seam_corner(t, t[j] + 1u);
    LrSeamQuestion q = LrSeamQuestion(before == 3u && after < 3u ? steps : 0u, LR_SEAM_START_L, LR_SEAM_NEW_L, false);
    if (side == 0u) {
        if (before == 3u && after == 3u && steps > 0u) q.at_context = LR_SEAM_MID_L;
        return q;
    }
    q.at_context = steps > 0u ? LR_SEAM_MID_R2 : LR_SEAM_MID_R;
    q.new_context = steps > 0u ? LR_SEAM_NEW_M : LR_SEAM_NEW_R;
    if (!has_parent) return q;
    for (uint n = 0u; n < 2u; ++n) {  // compares the copies of neighbors along the ring
        uint neighbor = n == 0u ? before : after;
        if (neighbor == 3u) continue;
        bool plain = ((words[neighbor] ^ lr_seam_place(h, neighbor, n == 0u ? h.steps[neighbor] : 0u)) & LR_SEAM_COPY_BITS) == 0u;
        q.at = (n == 0u) == plain ? 0u : steps;
        q.at_context = plain ? LR_SEAM_PLAIN : LR_SEAM_LEAVE;
        q.new_context = plain ? LR_SEAM_NEW_R : steps > 0u ? LR_SEAM_SEAMED2 : LR_SEAM_SEAMED;
        q.new_first = !plain;
        if (plain) break;
    }
    return q;
}

// Reads the word of corner j, whose copy differs from that of `current`. made: the next private copy; incremented if
// used.
#define LR_SEAM_UNKNOWN 0xffffffffu  // no copy is known
uint lr_seam_choose(LrSeamHomes h, uint j, uint current, LrSeamQuestion q, inout uint made) {
    uint copy = (lr_seam_place(h, j, q.at) & LR_SEAM_COPY_BITS) - h.first[j], left = h.count[j];
    // Home copies that are ruled out, in ascending order.
    uvec2 excluded = uvec2((current & LR_SEAM_COPY_BITS) - h.first[j], 0xffffffffu);
    if (excluded.x < h.count[j]) {
        --left;
    } else {
        excluded.x = 0xffffffffu;
    }
    uint answer = 4u;
    for (uint n = q.new_first ? 0u : 1u; n < 4u; ++n) {
        uint context = LR_SEAM_NONE;
        if (n == 1u && copy != excluded.x) context = q.at_context;
        if (n == 0u || (n == 2u && !q.new_first)) context = q.new_context;
        if (n == 3u && left > 0u) context = LR_SEAM_OTHER;
        if (context == LR_SEAM_NONE) continue;
        if (lr_seam_flag(context)) {
            answer = n;
            break;
        }
        if (n == 1u) {
            excluded = uvec2(min(copy, excluded.x), max(copy, excluded.x));
            --left;
        }
    }
    if (answer == 1u) return lr_seam_place(h, j, q.at);
    if (answer < 3u) return made++;
    uint width = answer == 3u ? uint(findMSB(left - 1u) + 1) : min(lr_seam_unary() + 2u, 31u), value = lr_seam_take(width);
    if (answer == 4u) return made + 3u - (1u << width) - value;
    if (value >= excluded.x) ++value;
    if (value >= excluded.y) ++value;
    return h.first[j] + value;
}

void lr_seam_triangle_block(LrSeamLayout p, uint block) {
    uint first = block * LR_SEAM_BLOCK, count = min(p.triangles - first, LR_SEAM_BLOCK);
    uint made = p.homes + lr_seam_open(p.by_triangle, block);
    uint marks[LR_SEAM_BACK];  // vertex hashes of the last triangles, to avoid loading most of these again
    uvec3 next[2];             // the next triangles, if they exist
    next[0] = lr_seam_triangle(first);
    if (count > 1u) next[1] = lr_seam_triangle(first + 1u);
    for (uint i = 0u; i < LR_SEAM_BLOCK; ++i) {
        if (i >= count) break;
        uint corner = 3u * (first + i), found = 0u;
        uvec3 t = next[0], parent, words = uvec3(0u);
        next[0] = next[1];
        if (i + 2u < count) next[1] = lr_seam_triangle(first + i + 2u);
        if (t.x == t.y) {
            for (uint j = 0u; j < 3u; ++j) LR_SEAM_COPY(corner + j) = 0u;
            marks[i % LR_SEAM_BACK] = 0u;
            continue;
        }
        bvec3 has;
        uvec3 mark = uvec3(lr_seam_mark(t.x), lr_seam_mark(t.y), lr_seam_mark(t.z));
        for (uint back = 1u; back <= LR_SEAM_BACK; ++back) {
            if (back > i) break;
            has = notEqual(marks[(i - back) % LR_SEAM_BACK] & mark, uvec3(0u));
            if (lr_seam_two(has)) {
                parent = lr_seam_triangle(first + i - back);
                has = bvec3(lr_seam_has(parent, t.x), lr_seam_has(parent, t.y), lr_seam_has(parent, t.z));
                if (lr_seam_two(has)) {
                    found = back;
                    break;
                }
            }
        }
        marks[i % LR_SEAM_BACK] = mark.x | mark.y | mark.z;
        uint side = lr_seam_side(t), parent_corner = corner - 3u * found, n = 0u;
        if (side == 2u) side = found > 0u && (LR_SEAM_COPY(parent_corner) & LR_SEAM_RIGHT) != 0u ? 1u : 0u;
        uvec3 order = uvec3(0u, 1u, 2u);  // the two corners in the parent, then the third
        LrSeamHomes h = lr_seam_homes(t);
        LrSeamEnd a, b;
        bool b_changes = true;
        if (found > 0u) {
            if (!has.y) order = uvec3(0u, 2u, 1u);
            if (!has.x) order = uvec3(1u, 2u, 0u);
            a = lr_seam_end_of(p, t, h, order.x, order.y, parent, parent_corner, side, next, count - i);
            b = lr_seam_end_of(p, t, h, order.y, order.x, parent, parent_corner, side, next, count - i);
            if (b.type < a.type) {
                LrSeamEnd swap = a;
                a = b;
                b = swap;
                order.xy = order.yx;
            }
            words[order.x] = a.word;
            words[order.y] = b.word;
            uint context = a.type == 0u   ? LR_SEAM_LONE
                           : a.type >= 2u ? LR_SEAM_LEFT2
                           : b.type < 3u  ? LR_SEAM_LEFT0
                                          : LR_SEAM_LEFT1;
            if (side == 1u) {
                context = a.type == 1u || b.type == 1u ? LR_SEAM_RIGHT0
                          : a.type == 2u               ? LR_SEAM_RIGHT4
                          : b.type == 0u               ? LR_SEAM_RIGHT1
                          : a.fan == 1u                ? LR_SEAM_RIGHT2
                                                       : LR_SEAM_RIGHT3;
            }
            bool seam = false, usual = false, lone = context == LR_SEAM_LONE;  // usual: b alone changes (lone), or both
            for (uint flag = 0u; flag < 2u; ++flag) {
                usual = lr_seam_flag(flag == 0u ? context : a.type == 0u ? LR_SEAM_HALF : LR_SEAM_BOTH);
                if (flag == 0u && !usual) break;
                seam = true;
            }
            n = 2u;
            if (seam) {
                bool a_alone = !usual && lr_seam_take(1u) != 0u;
                b_changes = !a_alone;
                n = (usual ? !lone : a_alone || lone) ? 0u : 1u;
            }
        }
        for (; n < 3u; ++n) {
            if (n == 1u && !b_changes) continue;
            uint j = order[n], current = LR_SEAM_UNKNOWN;
            LrSeamQuestion q;
            if (found > 0u && n < 2u) {
                LrSeamEnd e = b;
                if (n == 0u) e = a;
                q = lr_seam_change(e, h.steps[j], side);
                current = e.word;
            } else {
                q = lr_seam_start(t, h, words, j, side, found > 0u);
            }
            uint copy = made;
            words[j] = lr_seam_choose(h, j, current, q, made);
            if (copy < made) LR_SEAM_PUT_VERTEX(copy, t[j]);
        }
        words.x |= side << 30;
        for (uint j = 0u; j < 3u; ++j) LR_SEAM_COPY(corner + j) = words[j];
    }
    for (uint k = 0u; k < 3u * LR_SEAM_BLOCK; ++k) {
        if (k >= 3u * count) break;
        LR_SEAM_COPY(3u * first + k) = LR_SEAM_COPY(3u * first + k) & LR_SEAM_COPY_BITS;
    }
}
#endif

#endif
