// Decodes seam sections (docs/seams-format.md): finds the copy of its vertex that each corner of a triangle uses. Needs
// the surface's triangles as an index list: the slots of a stream, already expanded with lacedring.wgsl. This file is
// lacedring_seams.glsl in WGSL, with the same names. Concatenate this text and your shader:
//
//     // Word i of the section. Reads up to two words past it (any values).
//     fn lr_seam_word(i: u32) -> u32 { return words[i]; }
//     fn lr_seam_put_home(v: u32, value: u32) { homes[v] = value; }  // written by the pass over vertex blocks,
//     fn lr_seam_home(v: u32) -> u32 { return homes[v]; }            // read by the pass over triangle blocks
//     fn lr_seam_vertex(k: u32) -> u32 { return indices[k]; }        // vertex of corner k % 3 of triangle k / 3
//     // A read-write buffer: receives the copy of corner k.
//     fn lr_seam_copy(k: u32) -> u32 { return copies[k]; }
//     fn lr_seam_put_copy(k: u32, value: u32) { copies[k] = value; }
//     // Called once for every copy, with its vertex; may do nothing.
//     fn lr_seam_put_vertex(copy: u32, v: u32) { vertex_of[copy] = v; }
//     ...
//     let seams = lr_seam_layout(vertex_count, triangle_count);
//     lr_seam_vertex_block(seams, block);    // one invocation per 512 vertices
//     lr_seam_triangle_block(seams, block);  // in a later dispatch, one invocation per 512 triangles
//
// triangle_count counts slots. A slot that names a vertex twice has no triangle (degenerate slots of lean streams): its
// corners get copy 0. home[v] is twice the first copy of vertex v, plus 1 if the vertex wraps. It has vertex_count + 1
// entries; home[vertex_count] / 2 is the number of home copies. The section must be valid for these triangles
// (lacedring::validate_seams). With any other, every loop still ends, and only home[0..vertex_count] and the block's
// own corners are written; but lr_seam_put_vertex may be called for copies that do not exist, and entries past `home`
// and words past the section may be read.

const LR_SEAM_HEADER_WORDS = 8u;
const LR_SEAM_BLOCK = 512u;  // triangles of a triangle block, vertices of a vertex block
const LR_SEAM_GROUP = 32u;   // blocks per group of a directory
const LR_SEAM_BACK = 64u;    // a triangle's parent is searched among this many triangles before it
const LR_SEAM_MAX_STEPS = 255u;
const LR_SEAM_ENDLESS = 0x7fffffffi;

// Contexts of binary flags. The section's table has a likely value and a run class for each.
const LR_SEAM_V0 = 0u;
const LR_SEAM_MORE = 3u;
const LR_SEAM_MANY = 4u;
const LR_SEAM_WRAP = 5u;
const LR_SEAM_LONE = 6u;
const LR_SEAM_LEFT0 = 7u;
const LR_SEAM_LEFT1 = 8u;
const LR_SEAM_LEFT2 = 9u;
const LR_SEAM_RIGHT0 = 10u;
const LR_SEAM_RIGHT1 = 11u;
const LR_SEAM_RIGHT2 = 12u;
const LR_SEAM_RIGHT3 = 13u;
const LR_SEAM_RIGHT4 = 14u;
const LR_SEAM_HALF = 15u;
const LR_SEAM_BOTH = 16u;
const LR_SEAM_STEP_L = 17u;
const LR_SEAM_LEAVE = 18u;
const LR_SEAM_LAST_R = 19u;
const LR_SEAM_NEXT_R = 20u;
const LR_SEAM_START_L = 21u;
const LR_SEAM_MID_L = 22u;
const LR_SEAM_PLAIN = 23u;
const LR_SEAM_SEAMED = 24u;
const LR_SEAM_SEAMED2 = 25u;
const LR_SEAM_MID_R = 26u;
const LR_SEAM_MID_R2 = 27u;
const LR_SEAM_NEW_R = 28u;
const LR_SEAM_NEW_L = 29u;
const LR_SEAM_NEW_M = 30u;
const LR_SEAM_OTHER = 31u;  // any other home copy
const LR_SEAM_NONE = 32u;

// One of the section's two parts: vertex blocks or triangle blocks.
struct LrSeamPart {
  length_bits: u32,  // widths of the directory's fields
  copy_bits: u32,
  directory: u32,  // its first bit in the section
  word: u32,       // position at which its blocks begin
  bit: u32,
}
struct LrSeamLayout {
  vertices: u32,  // of the mesh
  triangles: u32,
  homes: u32,
  by_vertex: LrSeamPart,
  by_triangle: LrSeamPart,
}

// The 32 bits that begin `bit` bits after the start of word `word`.
fn lr_seam_load(word: u32, bit: u32) -> u32 {
  let at = word + bit / 32u;
  let shift = bit & 31u;
  let low = lr_seam_word(at) >> shift;
  if (shift == 0u) { return low; }
  return low | (lr_seam_word(at + 1u) << (32u - shift));
}
fn lr_seam_field(at: u32, bits: u32) -> u32 { return extractBits(lr_seam_load(0u, at), 0u, bits); }

// The block being read. Bit positions count from word lr_seam_base.
var<private> lr_seam_base: u32;
var<private> lr_seam_at: u32;
var<private> lr_seam_end: u32;
var<private> lr_seam_run: array<i32, 8>;  // by run class: likely values left in the run; -1: the run is not read yet
var<private> lr_seam_table: vec4u;        // likely value and run class of each context

// Starts reading a block. Returns the number of copies made by the blocks before it.
fn lr_seam_open(part: LrSeamPart, block: u32) -> u32 {
  let group = block / LR_SEAM_GROUP;
  let size = part.length_bits + part.copy_bits;
  var at = part.directory + group * (LR_SEAM_GROUP * size + 64u);
  var begin = 0u;
  var before = 0u;
  if (group > 0u) {
    begin = lr_seam_load(0u, at - 64u);
    before = lr_seam_load(0u, at - 32u);
  }
  for (var i = 0u; i < LR_SEAM_GROUP; i++) {
    if (i >= block % LR_SEAM_GROUP) { break; }
    begin += lr_seam_field(at, part.length_bits);
    before += lr_seam_field(at + part.length_bits, part.copy_bits);
    at += size;
  }
  let bit = part.bit + begin % 32u;
  lr_seam_base = part.word + begin / 32u + bit / 32u;
  lr_seam_at = bit % 32u;
  lr_seam_end = lr_seam_at + lr_seam_field(at, part.length_bits);
  for (var k = 0u; k < 8u; k++) { lr_seam_run[k] = -1; }
  for (var k = 0u; k < 4u; k++) { lr_seam_table[k] = lr_seam_word(4u + k); }
  return before;
}

fn lr_seam_blocks(elements: u32) -> u32 { return elements / LR_SEAM_BLOCK + select(1u, 0u, elements % LR_SEAM_BLOCK == 0u); }

fn lr_seam_directory_bits(part: LrSeamPart, blocks: u32) -> u32 {
  return blocks * (part.length_bits + part.copy_bits) + select(64u * ((blocks - 1u) / LR_SEAM_GROUP), 0u, blocks == 0u);
}

fn lr_seam_layout(vertices: u32, triangles: u32) -> LrSeamLayout {
  let widths = lr_seam_word(3u);
  let vertex_blocks = lr_seam_blocks(vertices);
  var p: LrSeamLayout;
  p.vertices = vertices;
  p.triangles = triangles;
  p.homes = lr_seam_word(2u);
  p.by_vertex.length_bits = widths & 31u;
  p.by_vertex.copy_bits = (widths >> 8u) & 31u;
  p.by_triangle.length_bits = (widths >> 16u) & 31u;
  p.by_triangle.copy_bits = (widths >> 24u) & 31u;
  p.by_vertex.directory = 32u * LR_SEAM_HEADER_WORDS;
  p.by_triangle.directory = p.by_vertex.directory + lr_seam_directory_bits(p.by_vertex, vertex_blocks);
  let end = p.by_triangle.directory + lr_seam_directory_bits(p.by_triangle, lr_seam_blocks(triangles));
  p.by_vertex.word = end / 32u;
  p.by_vertex.bit = end % 32u;
  p.by_triangle.word = p.by_vertex.word;
  p.by_triangle.bit = p.by_vertex.bit;
  if (vertex_blocks > 0u) {  // the triangle blocks begin where the last vertex block ends
    lr_seam_open(p.by_vertex, vertex_blocks - 1u);
    p.by_triangle.word = lr_seam_base + lr_seam_end / 32u;
    p.by_triangle.bit = lr_seam_end % 32u;
  }
  return p;
}

fn lr_seam_take(bits: u32) -> u32 {
  let value = extractBits(lr_seam_load(lr_seam_base, lr_seam_at), 0u, bits);
  lr_seam_at = min(lr_seam_at + bits, lr_seam_end);
  return value;
}

fn lr_seam_unary() -> u32 {
  var ones = 0u;
  for (var i = 0u; i < 0x8000u; i++) {  // a block has less than 2^20 bits
    let some = min(firstTrailingBit(~lr_seam_load(lr_seam_base, lr_seam_at)), 32u);
    ones += some;
    lr_seam_at = min(lr_seam_at + some + select(0u, 1u, some < 32u), lr_seam_end);
    if (some < 32u || lr_seam_at == lr_seam_end) { break; }
  }
  return ones;
}

fn lr_seam_read_run(k: u32) -> i32 {
  if (lr_seam_at == lr_seam_end) { return LR_SEAM_ENDLESS; }
  if (k == 7u && lr_seam_take(1u) == 0u) { return LR_SEAM_ENDLESS; }
  let ones = lr_seam_unary();
  let width = select(min(ones + 5u, 31u), k - 1u, k < 7u);
  let high = select((1u << width) - 32u, ones << width, k < 7u);
  return i32((high + lr_seam_take(width)) & 0x00ffffffu);
}

fn lr_seam_flag(context: u32) -> bool {
  let entry = lr_seam_table[context / 8u] >> (4u * (context & 7u));
  let k = (entry >> 1u) & 7u;
  let likely = (entry & 1u) != 0u;
  if (k == 0u) {
    if (lr_seam_at == lr_seam_end) { return likely; }
    return lr_seam_take(1u) != 0u;
  }
  var run = lr_seam_run[k];
  if (run < 0) { run = lr_seam_read_run(k); }
  run--;
  lr_seam_run[k] = run;
  return likely == (run >= 0);
}

fn lr_seam_vertex_block(p: LrSeamLayout, block: u32) {
  var vertex = block * LR_SEAM_BLOCK;
  var first = vertex + lr_seam_open(p.by_vertex, block);
  var before = 0u;
  for (var i = 0u; i < LR_SEAM_BLOCK; i++) {
    if (vertex >= p.vertices) { break; }
    var steps = 0u;
    var wrap = 0u;
    var context = LR_SEAM_V0 + before;
    for (var n = 0u; n < LR_SEAM_MAX_STEPS + 2u; n++) {
      let yes = lr_seam_flag(context);
      let again = yes && steps < LR_SEAM_MAX_STEPS - 1u;
      if (context == LR_SEAM_WRAP) {
        wrap = u32(yes);
        break;
      }
      if (yes) { steps++; }
      if (context <= LR_SEAM_MORE && !yes) { break; }
      context = select(select(LR_SEAM_WRAP, LR_SEAM_MANY, again), LR_SEAM_MORE, context < LR_SEAM_MORE);
    }
    lr_seam_put_home(vertex, 2u * first + wrap);
    for (var copy = 0u; copy <= steps - wrap; copy++) { lr_seam_put_vertex(first + copy, vertex); }
    first += steps + 1u - wrap;
    before = min(steps, 2u);
    vertex++;
  }
  if (vertex == p.vertices) { lr_seam_put_home(vertex, 2u * first); }
}

// While a block is decoded, the words of its corners have two flags beside the copy.
const LR_SEAM_LAST = 0x80000000u;   // copy 0 of a vertex that wraps, used as its last position
const LR_SEAM_RIGHT = 0x40000000u;  // in a triangle's first corner: the triangle is right of the ring
const LR_SEAM_COPY_BITS = 0x3fffffffu;

fn lr_seam_triangle(i: u32) -> vec3u {
  let t = vec3u(lr_seam_vertex(3u * i), lr_seam_vertex(3u * i + 1u), lr_seam_vertex(3u * i + 2u));
  // A degenerate slot gets a number that no vertex has.
  return select(t, vec3u(0xffffffffu), t.x == t.y || t.y == t.z || t.z == t.x);
}
fn lr_seam_corner(t: vec3u, v: u32) -> u32 { return select(select(select(3u, 2u, t.z == v), 1u, t.y == v), 0u, t.x == v); }
fn lr_seam_two(has: vec3<bool>) -> bool { return (has.x && has.y) || (has.z && (has.x || has.y)); }
fn lr_seam_has(t: vec3u, v: u32) -> bool { return any(t == vec3u(v)); }
fn lr_seam_side(t: vec3u) -> u32 {  // 0 left, 1 right, 2 no ring edge
  if (t.y == t.x + 1u) { return 0u; }
  if (t.x == t.y + 1u) { return 1u; }
  if (t.z == t.y + 1u) { return 0u; }
  if (t.y == t.z + 1u) { return 1u; }
  if (t.x == t.z + 1u) { return 0u; }
  return select(2u, 1u, t.z == t.x + 1u);
}

// A hash of a vertex: one bit of 32.
fn lr_seam_mark(v: u32) -> u32 { return 1u << ((v * 0x9e3779b9u) >> 27u); }

// The home copies of the three vertices of a triangle.
struct LrSeamHomes {
  first: vec3u,
  count: vec3u,
  steps: vec3u,  // number of the last position
}
fn lr_seam_homes(t: vec3u) -> LrSeamHomes {
  let entry = vec3u(lr_seam_home(t.x), lr_seam_home(t.y), lr_seam_home(t.z));
  let end = vec3u(lr_seam_home(t.x + 1u), lr_seam_home(t.y + 1u), lr_seam_home(t.z + 1u));
  let first = entry >> vec3u(1u);
  let count = (end >> vec3u(1u)) - first;
  return LrSeamHomes(first, count, count - 1u + (entry & vec3u(1u)));
}
// The word of a position of corner j's vertex. LR_SEAM_LAST marks the position past the last home copy.
fn lr_seam_place(h: LrSeamHomes, j: u32, position: u32) -> u32 {
  return select(h.first[j] + position, h.first[j] | LR_SEAM_LAST, position == h.count[j]);
}

// One end of the edge that a triangle shares with its parent.
struct LrSeamEnd {
  word: u32,      // its word in the parent
  position: u32,  // its position in the parent, if not private
  is_private: bool,
  far: u32,    // the position at which the fan ends
  // The end's class: 0 the vertex has only one position; 1 the end is at `far`; else 2 on the right. On the left, else
  // 2 if the end can still reach `far`, 3 if it cannot.
  class_: u32,
  fan: u32,    // number of the fan's triangles from this one on, at most 3
}
// Describes the end at corner j of the edge that triangle t shares with `parent`; `other`: the corner at the edge's
// other end. next0, next1: the two triangles after t. left: triangles from t on in the block.
fn lr_seam_end_of(p: LrSeamLayout, t: vec3u, h: LrSeamHomes, j: u32, other: u32, parent: vec3u, parent_corner: u32, side: u32,
                  next0: vec3u, next1: vec3u, left: u32) -> LrSeamEnd {
  let v = t[j];
  let in_parent = lr_seam_corner(parent, v);
  var e: LrSeamEnd;
  e.word = lr_seam_copy(parent_corner + in_parent) & (LR_SEAM_LAST | LR_SEAM_COPY_BITS);
  e.is_private = (e.word & LR_SEAM_COPY_BITS) >= p.homes;
  e.position = select(e.word - h.first[j], h.count[j], (e.word & LR_SEAM_LAST) != 0u);
  e.fan = 3u;
  if (left >= 3u && !lr_seam_has(next1, v)) { e.fan = 2u; }
  if (left >= 2u && !lr_seam_has(next0, v)) { e.fan = 1u; }
  let precedes = parent[select(2u, in_parent - 1u, in_parent > 0u)] == t[other];
  e.far = select(h.steps[j], 0u, (side == 0u) == precedes);
  if (side == 0u) {
    let to_go = select(u32(abs(i32(e.far - e.position))), 0u, e.is_private);
    e.class_ = select(select(3u, 2u, to_go < e.fan), select(0u, 1u, h.steps[j] > 0u), to_go == 0u);
  } else {
    let there = (e.word & LR_SEAM_COPY_BITS) == (lr_seam_place(h, j, e.far) & LR_SEAM_COPY_BITS);
    e.class_ = select(2u, select(0u, 1u, h.steps[j] > 0u), there);
  }
  return e;
}

// The flags to read for a corner: does it have the copy at position `at`, and does it have a new private copy?
struct LrSeamQuestion {
  at: u32,
  at_context: u32,  // LR_SEAM_NONE: the flag is not read
  new_context: u32,
  new_first: bool,  // its flag is read before that of the position
}
// The question about the new copy at end e of the shared edge.
fn lr_seam_change(e: LrSeamEnd, steps: u32, side: u32) -> LrSeamQuestion {
  var q = LrSeamQuestion(e.far, LR_SEAM_STEP_L, LR_SEAM_NEW_L, false);
  if (side == 0u) {
    if (!e.is_private) {
      q.at = select(e.position - 1u, e.position + 1u, e.far > e.position);
      if (e.far == e.position) { q.at = select(select(e.far - 1u, 1u, e.far == 0u), 0u, steps == 0u); }
    }
  } else if (e.class_ < 2u) {
    q.at_context = LR_SEAM_NONE;
    q.new_context = LR_SEAM_LEAVE;
  } else {
    q.at_context = select(LR_SEAM_NEXT_R, LR_SEAM_LAST_R, e.fan == 1u);
    q.new_context = LR_SEAM_NEW_R;
  }
  return q;
}
// The question for corner j, which is not in the parent. If there is a parent, the words of the other corners are
// known.
fn lr_seam_start(t: vec3u, h: LrSeamHomes, words: vec3u, j: u32, side: u32, has_parent: bool) -> LrSeamQuestion {
  let steps = h.steps[j];
  let before = lr_seam_corner(t, t[j] - 1u);
  let after = lr_seam_corner(t, t[j] + 1u);
  var q = LrSeamQuestion(select(0u, steps, before == 3u && after < 3u), LR_SEAM_START_L, LR_SEAM_NEW_L, false);
  if (side == 0u) {
    if (before == 3u && after == 3u && steps > 0u) { q.at_context = LR_SEAM_MID_L; }
    return q;
  }
  q.at_context = select(LR_SEAM_MID_R, LR_SEAM_MID_R2, steps > 0u);
  q.new_context = select(LR_SEAM_NEW_R, LR_SEAM_NEW_M, steps > 0u);
  if (!has_parent) { return q; }
  for (var n = 0u; n < 2u; n++) {  // compares the copies of neighbors along the ring
    let neighbor = select(after, before, n == 0u);
    if (neighbor == 3u) { continue; }
    let place = lr_seam_place(h, neighbor, select(0u, h.steps[neighbor], n == 0u));
    let plain = ((words[neighbor] ^ place) & LR_SEAM_COPY_BITS) == 0u;
    q.at = select(steps, 0u, (n == 0u) == plain);
    q.at_context = select(LR_SEAM_LEAVE, LR_SEAM_PLAIN, plain);
    q.new_context = select(select(LR_SEAM_SEAMED, LR_SEAM_SEAMED2, steps > 0u), LR_SEAM_NEW_R, plain);
    q.new_first = !plain;
    if (plain) { break; }
  }
  return q;
}

// Reads the word of corner j, whose copy differs from that of `current`. Returns `made`, the next private copy, if the
// corner gets a new one.
const LR_SEAM_UNKNOWN = 0xffffffffu;  // no copy is known
fn lr_seam_choose(h: LrSeamHomes, j: u32, current: u32, q: LrSeamQuestion, made: u32) -> u32 {
  let copy = (lr_seam_place(h, j, q.at) & LR_SEAM_COPY_BITS) - h.first[j];
  var left = h.count[j];
  // Home copies that are ruled out, in ascending order.
  var excluded = vec2u((current & LR_SEAM_COPY_BITS) - h.first[j], 0xffffffffu);
  if (excluded.x < h.count[j]) {
    left--;
  } else {
    excluded.x = 0xffffffffu;
  }
  var answer = 4u;
  for (var n = select(1u, 0u, q.new_first); n < 4u; n++) {
    var context = LR_SEAM_NONE;
    if (n == 1u && copy != excluded.x) { context = q.at_context; }
    if (n == 0u || (n == 2u && !q.new_first)) { context = q.new_context; }
    if (n == 3u && left > 0u) { context = LR_SEAM_OTHER; }
    if (context == LR_SEAM_NONE) { continue; }
    if (lr_seam_flag(context)) {
      answer = n;
      break;
    }
    if (n == 1u) {
      excluded = vec2u(min(copy, excluded.x), max(copy, excluded.x));
      left--;
    }
  }
  if (answer == 1u) { return lr_seam_place(h, j, q.at); }
  if (answer < 3u) { return made; }
  var width = firstLeadingBit(left - 1u) + 1u;
  if (answer == 4u) { width = min(lr_seam_unary() + 2u, 31u); }
  var value = lr_seam_take(width);
  if (answer == 4u) { return made + 3u - (1u << width) - value; }
  if (value >= excluded.x) { value++; }
  if (value >= excluded.y) { value++; }
  return h.first[j] + value;
}

fn lr_seam_triangle_block(p: LrSeamLayout, block: u32) {
  let first = block * LR_SEAM_BLOCK;
  let count = min(p.triangles - first, LR_SEAM_BLOCK);
  var made = p.homes + lr_seam_open(p.by_triangle, block);
  var marks: array<u32, LR_SEAM_BACK>;  // vertex hashes of the last triangles, to avoid loading most of these again
  var next0 = lr_seam_triangle(first);  // the next triangles, if they exist
  var next1 = next0;
  if (count > 1u) { next1 = lr_seam_triangle(first + 1u); }
  for (var i = 0u; i < LR_SEAM_BLOCK; i++) {
    if (i >= count) { break; }
    let corner = 3u * (first + i);
    var found = 0u;
    let t = next0;
    var parent = vec3u(0u);
    var words = vec3u(0u);
    next0 = next1;
    if (i + 2u < count) { next1 = lr_seam_triangle(first + i + 2u); }
    if (t.x == t.y) {
      for (var j = 0u; j < 3u; j++) { lr_seam_put_copy(corner + j, 0u); }
      marks[i % LR_SEAM_BACK] = 0u;
      continue;
    }
    var has = vec3<bool>(false);
    let mark = vec3u(lr_seam_mark(t.x), lr_seam_mark(t.y), lr_seam_mark(t.z));
    for (var back = 1u; back <= LR_SEAM_BACK; back++) {
      if (back > i) { break; }
      has = (vec3u(marks[(i - back) % LR_SEAM_BACK]) & mark) != vec3u(0u);
      if (lr_seam_two(has)) {
        parent = lr_seam_triangle(first + i - back);
        has = vec3<bool>(lr_seam_has(parent, t.x), lr_seam_has(parent, t.y), lr_seam_has(parent, t.z));
        if (lr_seam_two(has)) {
          found = back;
          break;
        }
      }
    }
    marks[i % LR_SEAM_BACK] = mark.x | mark.y | mark.z;
    let parent_corner = corner - 3u * found;
    var side = lr_seam_side(t);
    if (side == 2u) { side = u32(found > 0u && (lr_seam_copy(parent_corner) & LR_SEAM_RIGHT) != 0u); }
    var order = vec3u(0u, 1u, 2u);  // the two corners in the parent, then the third
    let h = lr_seam_homes(t);
    var a: LrSeamEnd;
    var b: LrSeamEnd;
    var b_changes = true;
    var n = 0u;
    if (found > 0u) {
      if (!has.y) { order = vec3u(0u, 2u, 1u); }
      if (!has.x) { order = vec3u(1u, 2u, 0u); }
      a = lr_seam_end_of(p, t, h, order.x, order.y, parent, parent_corner, side, next0, next1, count - i);
      b = lr_seam_end_of(p, t, h, order.y, order.x, parent, parent_corner, side, next0, next1, count - i);
      if (b.class_ < a.class_) {
        let swap = a;
        a = b;
        b = swap;
        order = order.yxz;
      }
      words[order.x] = a.word;
      words[order.y] = b.word;
      let left1 = select(LR_SEAM_LEFT1, LR_SEAM_LEFT0, b.class_ < 3u);
      var context = select(select(left1, LR_SEAM_LEFT2, a.class_ >= 2u), LR_SEAM_LONE, a.class_ == 0u);
      if (side == 1u) {
        context = select(LR_SEAM_RIGHT3, LR_SEAM_RIGHT2, a.fan == 1u);
        if (b.class_ == 0u) { context = LR_SEAM_RIGHT1; }
        if (a.class_ == 2u) { context = LR_SEAM_RIGHT4; }
        if (a.class_ == 1u || b.class_ == 1u) { context = LR_SEAM_RIGHT0; }
      }
      var seam = false;
      var usual = false;
      let lone = context == LR_SEAM_LONE;  // usual: b alone changes (lone), or both
      for (var flag = 0u; flag < 2u; flag++) {
        usual = lr_seam_flag(select(select(LR_SEAM_BOTH, LR_SEAM_HALF, a.class_ == 0u), context, flag == 0u));
        if (flag == 0u && !usual) { break; }
        seam = true;
      }
      n = 2u;
      if (seam) {
        var a_alone = false;
        if (!usual) { a_alone = lr_seam_take(1u) != 0u; }
        b_changes = !a_alone;
        n = select(1u, 0u, select(a_alone || lone, !lone, usual));
      }
    }
    for (; n < 3u; n++) {
      if (n == 1u && !b_changes) { continue; }
      let j = order[n];
      var current = LR_SEAM_UNKNOWN;
      var q: LrSeamQuestion;
      if (found > 0u && n < 2u) {
        var e = b;
        if (n == 0u) { e = a; }
        q = lr_seam_change(e, h.steps[j], side);
        current = e.word;
      } else {
        q = lr_seam_start(t, h, words, j, side, found > 0u);
      }
      words[j] = lr_seam_choose(h, j, current, q, made);
      if (words[j] == made) {
        lr_seam_put_vertex(made, t[j]);
        made++;
      }
    }
    words.x |= side << 30u;
    for (var j = 0u; j < 3u; j++) { lr_seam_put_copy(corner + j, words[j]); }
  }
  for (var k = 0u; k < 3u * LR_SEAM_BLOCK; k++) {
    if (k >= 3u * count) { break; }
    lr_seam_put_copy(3u * first + k, lr_seam_copy(3u * first + k) & LR_SEAM_COPY_BITS);
  }
}
