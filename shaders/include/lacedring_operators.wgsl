// The corner operators on LR tables, each in constant time, in any shader stage. This file needs no other. It is
// lacedring_operators.glsl in WGSL, with the same names. Paper: LR 2011, sections 4.4 to 4.7 and 5.
//
// Concatenate this text and your shader, and define a function that reads words of the LR stream (made by
// lacedring::encode_lr, or from an .lr file of kind lr):
//     @group(0) @binding(0) var<storage, read> words: array<u32>;
//     fn lr_table_word(i: u32) -> u32 { return words[i]; }
//     ...
//     let lr = lr_op_layout();
//     let across = lr_opposite(lr, c);  // LR_TABLE_NULL across a border
// Corners are numbers, as in lacedring::Operators: triangle t has corners 4t, 4t+1 and 4t+2. Triangle numbers are t <
// lr_triangle_numbers(lr) with lr_is_canonical(lr, t); other numbers are redundant copies and borders. Vertices are
// numbered in the stream's order (vertex_order maps them to the mesh's). To visit the corners around a vertex in the
// order of lacedring::Operators::star (at a border, starting at the corner that no swing leads to):
//     let first = lr_star_first(lr, v);
//     var c = first;
//     for (var left = lr_triangle_numbers(lr); c != LR_TABLE_NULL && left > 0u; left--) {
//       ...  // c's triangle is c / 4; lr_vertex(lr, lr_next(c)) is a neighbor of v
//       c = lr_swing(lr, c);
//       if (c == first) { break; }
//     }
// If the order does not matter, this loop is twice as fast, as it need not search for a border first:
//     for (var s = lr_star(lr, v); s.corner != LR_TABLE_NULL; s = lr_star_step(lr, s)) { ... }  // s.corner
// Triangles have the tables' orientation, which is consistent across every edge; LR_TABLE_FLIP marks triangles with the
// opposite orientation in the input. The stream must be valid (lacedring::validate_lr) and have fewer than 2^32 words;
// with any other, every loop still ends. No operator accepts LR_TABLE_NULL.

const LR_TABLE_MAGIC = 0x5443524cu;
const LR_TABLE_VERSION = 1u;
const LR_TABLE_HEADER_WORDS = 10u;
const LR_TABLE_WORD_MAGIC = 0u;
const LR_TABLE_WORD_VERSION = 1u;
const LR_TABLE_WORD_VERTICES = 2u;
const LR_TABLE_WORD_RING = 3u;
const LR_TABLE_WORD_T0 = 4u;
const LR_TABLE_WORD_STAR = 5u;
const LR_TABLE_WORD_ISOLATED = 6u;
const LR_TABLE_NULL = 0xffffffffu;

const LR_TABLE_TIP = 0x0fffffffu;
const LR_TABLE_WART = 0x80000000u;
const LR_TABLE_IRREGULAR = 0x40000000u;
const LR_TABLE_FLIP = 0x20000000u;
const LR_TABLE_SPECIAL = 0x10000000u;
const LR_TABLE_REDUNDANT = 0x10000000u;
const LR_TABLE_BORDER = 0x50000000u;
const LR_TABLE_CLOSING = 0x90000000u;
const LR_TABLE_KIND = 0xd0000000u;
const LR_TABLE_T0_FLIP = 0x80000000u;

struct LrOpLayout {
  vertices: u32,
  ring: u32,      // m_r: vertices on rings
  t0: u32,        // T0 triangles
  isolated: u32,  // isolated vertices
  vo: u32,        // first word of VO
  star: u32,      // first word of VO*
  c: u32,         // first word of C
}

fn lr_op_layout() -> LrOpLayout {
  var lr: LrOpLayout;
  lr.vertices = lr_table_word(LR_TABLE_WORD_VERTICES);
  lr.ring = lr_table_word(LR_TABLE_WORD_RING);
  lr.t0 = lr_table_word(LR_TABLE_WORD_T0);
  lr.isolated = lr_table_word(LR_TABLE_WORD_ISOLATED);
  lr.vo = LR_TABLE_HEADER_WORDS + 2u * lr.ring;
  lr.star = lr.vo + 6u * lr.t0;
  lr.c = lr.star + lr_table_word(LR_TABLE_WORD_STAR);
  return lr;
}

fn lr_triangle_numbers(lr: LrOpLayout) -> u32 { return 2u * lr.ring + lr.t0; }

// The word of a slot. side: 0 left, 1 right. operators.hpp and LrView have the same functions.
fn lr_slot_word(v: u32, side: u32) -> u32 { return lr_table_word(LR_TABLE_HEADER_WORDS + 2u * v + side); }
fn lr_word_closes(w: u32) -> bool { return (w & LR_TABLE_KIND) == LR_TABLE_CLOSING; }
fn lr_word_skips(w: u32) -> bool { return (w & (LR_TABLE_SPECIAL | LR_TABLE_WART)) == LR_TABLE_WART; }
// True if w is a redundant copy or a T0w: the triangle in the next slot is then a T2.
fn lr_word_precedes_t2(w: u32) -> bool { return (w & LR_TABLE_WART) != 0u || (w & LR_TABLE_KIND) == LR_TABLE_REDUNDANT; }
fn lr_word_tip(lr: LrOpLayout, w: u32) -> u32 {
  let i = w & LR_TABLE_TIP;
  if ((w & (LR_TABLE_SPECIAL | LR_TABLE_IRREGULAR)) == LR_TABLE_IRREGULAR) { return lr_table_word(lr.star + i); }
  return i;
}

// v.n and v.p of a vertex on a ring.
fn lr_ring_next(v: u32) -> u32 {
  let w = lr_slot_word(v, 0u);
  return select(v + 1u, w & LR_TABLE_TIP, lr_word_closes(w));
}
fn lr_ring_previous(lr: LrOpLayout, v: u32) -> u32 {
  // On the left of a ring's first vertex is a T2 between the ring's last and first edges: its tip is the ring's last
  // vertex.
  if (v == 0u || lr_word_closes(lr_slot_word(v - 1u, 0u))) { return lr_word_tip(lr, lr_slot_word(v, 0u)); }
  return v - 1u;
}

// The roles of a slot's corners: start (at v), tip, and end (at v.n, or v.n.n if the edge skips a wart).
const LR_ROLE_START = 0u;
const LR_ROLE_TIP = 1u;
const LR_ROLE_END = 2u;
fn lr_slot_corner(v: u32, side: u32, role: u32) -> u32 { return 8u * v + select(6u - role, role, side == 0u); }
fn lr_corner_role(c: u32) -> u32 { return select(2u - (c & 3u), c & 3u, (c & 4u) == 0u); }

// The vertex at which the edge of v's slot ends; w is the slot's word.
fn lr_slot_end(v: u32, w: u32) -> u32 {
  let n = lr_ring_next(v);
  if (lr_word_skips(w)) { return lr_ring_next(n); }
  return n;
}
// The vertex of the slot whose edge ends at v: v.p, or v.p.p if its slot skips v.p.
fn lr_slot_before(lr: LrOpLayout, v: u32, side: u32) -> u32 {
  let p = lr_ring_previous(lr, v);
  let pp = lr_ring_previous(lr, p);
  return select(p, pp, lr_word_skips(lr_slot_word(pp, side)));
}
// The third vertex of the triangle in a slot, even of a redundant copy; null if the slot has no triangle.
fn lr_slot_tip(lr: LrOpLayout, w: u32) -> u32 {
  let kind = w & LR_TABLE_KIND;
  if (kind == LR_TABLE_BORDER) { return LR_TABLE_NULL; }
  if (kind == LR_TABLE_CLOSING) { return lr_ring_next(w & LR_TABLE_TIP); }
  return lr_word_tip(lr, w);
}

// True for corners of T0 triangles, and for null.
fn lr_is_t0(lr: LrOpLayout, c: u32) -> bool { return c >= 8u * lr.ring; }
// A T0 has six words: three vertices (array = 0), then three opposite corners (array = 3).
fn lr_t0_word(lr: LrOpLayout, c: u32, field: u32) -> u32 {
  let i = c - 8u * lr.ring;
  return lr_table_word(lr.vo + i / 4u * 6u + (i & 3u) + field);
}

// c.n, c.p
fn lr_next(c: u32) -> u32 { return select(c + 1u, c - 2u, (c & 3u) == 2u); }
fn lr_previous(c: u32) -> u32 { return select(c - 1u, c + 2u, (c & 3u) == 0u); }

// True if the triangle exists and this is its canonical number (not the number of a T2's first copy).
fn lr_is_canonical(lr: LrOpLayout, triangle: u32) -> bool {
  if (triangle >= 2u * lr.ring) { return true; }
  return (lr_slot_word(triangle / 2u, triangle & 1u) & LR_TABLE_SPECIAL) == 0u;
}

// For a corner of a T2's first copy, the same corner of its second copy in the next slot; else c. Null stays null.
fn lr_turned(lr: LrOpLayout, c: u32) -> u32 {
  if (lr_is_t0(lr, c)) { return c; }
  let v = c / 8u;
  let side = (c / 4u) & 1u;
  let w = lr_slot_word(v, side);
  if ((w & LR_TABLE_SPECIAL) == 0u) { return c; }
  if ((w & LR_TABLE_KIND) == LR_TABLE_BORDER) { return LR_TABLE_NULL; }
  let role = lr_corner_role(c);  // start, tip, end of the first copy are tip, end, start of the second
  return lr_slot_corner(lr_ring_next(v), side, select(role + 1u, LR_ROLE_START, role == LR_ROLE_END));
}
// The canonical number of a corner. Null for a corner of a border slot, which has no triangle.
// A triangle with three ring edges has three copies, so lr_turned is applied twice.
fn lr_canonical(lr: LrOpLayout, c: u32) -> u32 { return lr_turned(lr, lr_turned(lr, c)); }

// c.v
fn lr_vertex(lr: LrOpLayout, c: u32) -> u32 {
  if (lr_is_t0(lr, c)) { return lr_t0_word(lr, c, 0u) & ~LR_TABLE_T0_FLIP; }
  let v = c / 8u;
  let role = lr_corner_role(c);
  if (role == LR_ROLE_START) { return v; }
  let w = lr_slot_word(v, (c / 4u) & 1u);
  if (role == LR_ROLE_TIP) { return lr_slot_tip(lr, w); }
  return lr_slot_end(v, w);
}

// A fast path of c.o: applies if neither the slot nor the slots next to it have flags. Reads two or three words. Returns
// LR_TABLE_NULL if it does not apply.
fn lr_plain_opposite(lr: LrOpLayout, c: u32) -> u32 {
  let v = c / 8u;
  let side = (c / 4u) & 1u;
  if (v < 2u || v + 1u >= lr.ring) { return LR_TABLE_NULL; }
  let w = lr_slot_word(v, side);
  let other = lr_slot_word(v, 1u - side);
  let left = select(other, w, side == 0u);
  if ((c & 3u) == 1u) { return select(LR_TABLE_NULL, c ^ 4u, (w | other) <= LR_TABLE_TIP); }
  let before = lr_slot_word(v - 1u, side);
  if ((w | before) > LR_TABLE_TIP || lr_word_closes(left)) { return LR_TABLE_NULL; }
  if ((c & 7u) % 6u == 0u) {  // at v: the opposite slot starts at v.n or ends at the tip
    let after = lr_slot_word(v + 1u, side);
    if (after > LR_TABLE_TIP) { return LR_TABLE_NULL; }
    if (after == w) { return select(c + 6u, c + 10u, side == 0u); }
    if (w < 2u || w >= lr.ring) { return LR_TABLE_NULL; }
    let u = w - 1u;
    let found = lr_slot_word(u, side) == v + 1u && !lr_word_skips(lr_slot_word(u - 1u, side)) && !lr_word_closes(lr_slot_word(u, 0u));
    return select(LR_TABLE_NULL, 8u * u + (c & 7u), found);
  }
  // At v.n: the opposite slot ends at v or starts at the tip.
  if (lr_word_skips(lr_slot_word(v - 2u, side)) || lr_word_closes(lr_slot_word(v - 1u, 0u)) || lr_word_closes(lr_slot_word(v - 2u, 0u))) {
    return LR_TABLE_NULL;
  }
  if (before == w) { return select(c - 6u, c - 10u, side == 0u); }
  if (w < lr.ring && lr_slot_word(w, side) == v) { return 8u * w + (c & 7u); }
  return LR_TABLE_NULL;
}

// The corner that faces v's ring edge on side `side`; not yet canonical (may belong to a first copy).
fn lr_across_ring(v: u32, side: u32) -> u32 {
  let w = lr_slot_word(v, side);
  if ((w & LR_TABLE_KIND) == LR_TABLE_BORDER) { return LR_TABLE_NULL; }
  // A T2 has its first copy here (perhaps replaced by a T0w): the end corner of its second copy faces this edge.
  if (lr_word_precedes_t2(w)) { return lr_slot_corner(lr_ring_next(v), side, LR_ROLE_END); }
  return lr_slot_corner(v, side, LR_ROLE_TIP);
}

// The corner opposite edge (tip, end) (facing_start) or (start, tip) of the triangle in v's slot, if its word does not
// store it: looks at the slot at the edge's end or start, then at the slot at the tip. Not yet canonical (may belong to
// a first copy).
fn lr_infer_opposite(lr: LrOpLayout, v: u32, side: u32, w: u32, facing_start: bool) -> u32 {
  let u = lr_word_tip(lr, w);
  var near = 0u;
  if (facing_start) {
    near = lr_slot_end(v, w);
  } else {
    near = lr_slot_before(lr, v, side);
  }
  if (lr_slot_tip(lr, lr_slot_word(near, side)) == u) {
    return lr_slot_corner(near, side, select(LR_ROLE_START, LR_ROLE_END, facing_start));
  }
  if (u >= lr.ring) { return LR_TABLE_NULL; }
  var far = u;
  if (facing_start) { far = lr_slot_before(lr, u, side); }
  if (lr_slot_tip(lr, lr_slot_word(far, side)) != select(v, near, facing_start)) { return LR_TABLE_NULL; }
  return lr_slot_corner(far, side, select(LR_ROLE_END, LR_ROLE_START, facing_start));
}

// c.o: a canonical corner, or null across a border.
fn lr_opposite(lr: LrOpLayout, corner: u32) -> u32 {
  if (lr_is_t0(lr, corner)) { return lr_t0_word(lr, corner, 3u); }
  let plain = lr_plain_opposite(lr, corner);
  if (plain != LR_TABLE_NULL) { return plain; }
  let c = lr_canonical(lr, corner);
  if (c == LR_TABLE_NULL) { return c; }
  let v = c / 8u;
  let side = (c / 4u) & 1u;
  let role = lr_corner_role(c);
  let w = lr_slot_word(v, side);
  // If the edge opposite c is a ring edge: the vertex at which it starts.
  var across = LR_TABLE_NULL;
  if (role == LR_ROLE_TIP) {
    if ((w & LR_TABLE_WART) != 0u) { return lr_slot_corner(lr_ring_next(v), side, LR_ROLE_START); }  // the T2w's tip
    across = v;
  } else {
    let p = lr_ring_previous(lr, v);
    let before = lr_slot_word(p, side);
    if (role == LR_ROLE_START) {
      if (lr_word_skips(before)) { return lr_slot_corner(p, side, LR_ROLE_TIP); }  // v is a wart's tip
      if (lr_word_precedes_t2(before)) {
        let pp = lr_slot_word(lr_ring_previous(lr, p), side);
        // All three edges are ring edges.
        if (lr_word_precedes_t2(pp) && (pp & LR_TABLE_SPECIAL) != 0u) { across = lr_ring_next(v); }
      }
    } else if (lr_word_precedes_t2(before)) {
      across = p;
    }
  }
  if (across != LR_TABLE_NULL) { return lr_canonical(lr, lr_across_ring(across, 1u - side)); }
  if ((w & LR_TABLE_IRREGULAR) != 0u) {
    return lr_table_word(lr.star + (w & LR_TABLE_TIP) + select(2u, 1u, role == LR_ROLE_START));
  }
  return lr_canonical(lr, lr_infer_opposite(lr, v, side, w, role == LR_ROLE_START));
}

// c.l = c.n.o, c.r = c.p.o
fn lr_left(lr: LrOpLayout, c: u32) -> u32 { return lr_opposite(lr, lr_next(c)); }
fn lr_right(lr: LrOpLayout, c: u32) -> u32 { return lr_opposite(lr, lr_previous(c)); }
// c.s: the next corner around c's vertex, null at a border; lr_swing_back is its inverse.
fn lr_swing(lr: LrOpLayout, c: u32) -> u32 {
  let l = lr_left(lr, c);
  return select(lr_next(l), l, l == LR_TABLE_NULL);
}
fn lr_swing_back(lr: LrOpLayout, c: u32) -> u32 {
  let r = lr_right(lr, c);
  return select(lr_previous(r), r, r == LR_TABLE_NULL);
}

// v.c: a canonical corner; null if no triangle uses the vertex.
fn lr_corner(lr: LrOpLayout, v: u32) -> u32 {
  if (v < lr.ring) { return lr_canonical(lr, 8u * v); }  // the left slot of a ring vertex always has a triangle
  if (v < lr.ring + lr.isolated) { return lr_table_word(lr.c + (v - lr.ring)); }
  return LR_TABLE_NULL;
}

// Visits every triangle at a vertex once: swings from v.c; at a border, continues from v.c in the other direction.
struct LrStar {
  corner: u32,  // null at the end
  first: u32,
  border: bool,  // a border was met: now swings back
  left: u32,     // ends after this many triangles, even if tables are malformed
}
fn lr_star(lr: LrOpLayout, v: u32) -> LrStar {
  let first = lr_corner(lr, v);
  return LrStar(first, first, false, lr_triangle_numbers(lr));
}
// Moves to the next corner of the star. Only the step that meets the border runs the loop twice.
fn lr_star_step(lr: LrOpLayout, before: LrStar) -> LrStar {
  var s = before;
  var c = s.corner;
  s.corner = LR_TABLE_NULL;
  for (var looks = select(0u, 1u, s.border); looks < 2u; looks++) {
    let o = lr_opposite(lr, select(lr_next(c), lr_previous(c), s.border));
    if (o != LR_TABLE_NULL) {
      s.corner = select(lr_next(o), lr_previous(o), s.border);
      break;
    }
    s.border = true;
    c = s.first;
  }
  s.left -= min(s.left, 1u);
  if (s.corner == s.first || s.left == 0u) { s.corner = LR_TABLE_NULL; }
  return s;
}

// v.c; if v is on a border, the corner of v that no swing leads to. O(valence).
fn lr_star_first(lr: LrOpLayout, v: u32) -> u32 {
  let first = lr_corner(lr, v);
  var c = first;
  for (var left = lr_triangle_numbers(lr); c != LR_TABLE_NULL && left > 0u; left--) {
    let back = lr_swing_back(lr, c);
    if (back == LR_TABLE_NULL) { return c; }
    if (back == first) { break; }
    c = back;
  }
  return first;
}

// The number of edges at v: the number of triangles, plus one on a border. O(valence).
fn lr_valence(lr: LrOpLayout, v: u32) -> u32 {
  var count = 0u;
  var s = lr_star(lr, v);
  for (; s.corner != LR_TABLE_NULL; s = lr_star_step(lr, s)) { count++; }
  return select(count, count + 1u, s.border);
}
