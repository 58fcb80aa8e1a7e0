// Decodes any triangle of a lean or packed stream, in any shader stage. This file needs no other. It is lacedring.glsl
// in WGSL, with the same names.
//
// WGSL has no macros: concatenate this text and your shader, in any order, and define a function that reads words of
// the stream:
//     @group(0) @binding(0) var<storage, read> words: array<u32>;  // the stream as it lies in the file
//     fn lr_stream_word(i: u32) -> u32 { return words[i]; }        // i is counted from the stream's first word
//     ...
//     let v = lr_lean_triangle(lr_lean_layout(), slot);            // slot < lr_lean_slots(lr_lean_layout())
// For a packed stream:
//     let v = lr_packed_triangle(lr_packed_layout(), t);           // t < lr_packed_triangles(lr_packed_layout())
// lr_packed_triangles_of_quad decodes four triangles in about the time of one. If the stream is larger than
// maxStorageBufferBindingSize, bind it in several parts and let lr_stream_word choose the part.
// v are vertices in the stream's order (vertex_order maps them to the mesh's). A lean triangle with v.x == v.y is
// degenerate: it covers nothing; draw it or skip it. The stream must be valid (lacedring::validate_lean,
// lacedring::validate_packed); with any other, every loop still ends, and WebGPU keeps each access inside its buffer.
// docs/webgpu.md has examples.
//
// The constants equal those of lacedring.glsl (tests/js/webgpu.mjs compares them).

const LR_LEAN_MAGIC = 0x4e4c524cu;
const LR_LEAN_VERSION = 1u;
const LR_LEAN_HEADER_WORDS = 8u;
const LR_LEAN_WORD_MAGIC = 0u;
const LR_LEAN_WORD_VERSION = 1u;
const LR_LEAN_WORD_VERTICES = 2u;
const LR_LEAN_WORD_RINGS2 = 3u;
const LR_LEAN_WORD_RINGS1 = 4u;
const LR_LEAN_WORD_VERBATIM = 5u;
const LR_LEAN_WORD_TRIANGLES = 6u;
const LR_LEAN_WORD_CHECKSUM = 7u;
const LR_LEAN_TIP_MASK = 0x1fffffffu;
const LR_LEAN_WART_FLAG = 0x80000000u;
const LR_LEAN_CLOSE_FLAG = 0x40000000u;
const LR_LEAN_FLIP_FLAG = 0x20000000u;

const LR_PACKED_MAGIC = 0x3250524cu;
const LR_PACKED_HEADER_WORDS = 4u;
const LR_PACKED_WORD_MAGIC = 0u;
const LR_PACKED_WORD_VERTICES = 1u;
const LR_PACKED_WORD_TRIANGLES = 2u;
const LR_PACKED_WORD_CHECKSUM = 3u;
const LR_PACKED_DOUBLES = 0x80000000u;
const LR_PACKED_DOUBLES_WORDS = 2u;
const LR_PACKED_RUN_WORDS = 2u;
const LR_PACKED_BLOCK = 256u;
const LR_PACKED_BLOCK_WORDS = 8u;
const LR_PACKED_GROUP = 16u;
const LR_PACKED_MAX_OFFSET_BITS = 16u;
const LR_PACKED_MAX_ENTRY_BITS = 12u;
const LR_PACKED_RECORD = 0u;
const LR_PACKED_PARTED = 1u;
const LR_PACKED_PLAIN = 2u;
const LR_PACKED_MAX_RECORD = 160u;
const LR_PACKED_PARTS = 4u;
const LR_PACKED_PART = 64u;
const LR_PACKED_SPLIT = 0u;
const LR_PACKED_BESIDE = 1u;
const LR_PACKED_START = 2u;
const LR_PACKED_FAR = 3u;
const LR_PACKED_JUMP = 4u;
const LR_PACKED_TURN = 5u;
const LR_PACKED_FLIPS = 6u;
const LR_PACKED_START_OTHER = 0u;
const LR_PACKED_START_NEXT = 1u;
const LR_PACKED_START_NEAR = 2u;
const LR_PACKED_START_ANY = 3u;
const LR_PACKED_BESIDE_NOW_B = 0u;
const LR_PACKED_BESIDE_NOW_A = 1u;
const LR_PACKED_BESIDE_BEGUN_A = 2u;
const LR_PACKED_BESIDE_BEGUN_B = 3u;
const LR_PACKED_JUMP_ORDER = 1u;
const LR_PACKED_SIZE_ORDER = 2u;
const LR_PACKED_BESIDE_ORDER = 1u;
const LR_PACKED_FAR_ORDER = 2u;

// Lean streams: random access in constant time, reading at most four words. Paper: LR 2011, section 7.

struct LrLeanLayout {
  rings2: u32,
  rings1: u32,
  verbatim: u32,
}

fn lr_lean_layout() -> LrLeanLayout {
  return LrLeanLayout(lr_stream_word(LR_LEAN_WORD_RINGS2), lr_stream_word(LR_LEAN_WORD_RINGS1), lr_stream_word(LR_LEAN_WORD_VERBATIM));
}

fn lr_lean_slots(lean: LrLeanLayout) -> u32 { return 2u * lean.rings2 + lean.rings1 + lean.verbatim; }

// v.n of ring vertex v. left, right: the words of its two slots; on a one-sided ring, its only word twice.
fn lr_lean_next(v: u32, left: u32, right: u32) -> u32 {
  if ((left & LR_LEAN_CLOSE_FLAG) != 0u) { return left & LR_LEAN_TIP_MASK; }
  if ((right & LR_LEAN_CLOSE_FLAG) != 0u) { return right & LR_LEAN_TIP_MASK; }
  return v + 1u;
}

// The triangle of a ring slot. `word`: the slot's word; next: v.n; skip: v.n.n (used for a wart only). In a free slot
// and in a right closing slot, the tip is an end of the slot's own edge, so the triangle is degenerate without a
// special case.
fn lr_lean_ring_triangle(word: u32, v: u32, next: u32, skip: u32, right: bool) -> vec3u {
  let closes = (word & LR_LEAN_CLOSE_FLAG) != 0u;
  let tip = select(word & LR_LEAN_TIP_MASK, v, closes && !right);
  let end = select(next, skip, (word & LR_LEAN_WART_FLAG) != 0u);
  let flip = (word & LR_LEAN_FLIP_FLAG) != 0u;
  return select(vec3u(v, tip, end), vec3u(end, tip, v), right != flip);
}

fn lr_lean_word(i: u32) -> u32 { return lr_stream_word(LR_LEAN_HEADER_WORDS + i); }

// All kinds of slots share their loads, so that invocations with different kinds diverge little.
fn lr_lean_triangle(lean: LrLeanLayout, slot: u32) -> vec3u {
  let two_sided = 2u * lean.rings2;
  let ring_slots = two_sided + lean.rings1;
  let verbatim = slot >= ring_slots;
  let one_sided = slot >= two_sided && !verbatim;
  let at = select(select(slot & ~1u, slot, one_sided), ring_slots + 3u * (slot - ring_slots), verbatim);
  let first = lr_lean_word(at);
  let second = lr_lean_word(select(at + 1u, at, one_sided));
  let v = select(slot >> 1u, slot - lean.rings2, one_sided);
  let right = slot < two_sided && (slot & 1u) != 0u;
  let word = select(first, second, right);
  let next = lr_lean_next(v, first, second);
  var skip = next + 1u;
  // After a closing edge, v.n.n is next + 1: the ring's first edge follows, which never closes.
  if (verbatim || ((word & LR_LEAN_WART_FLAG) != 0u && next == v + 1u)) {
    let far = select(select(2u * next, slot + 1u, one_sided), at + 2u, verbatim);
    let third = lr_lean_word(far);
    if (verbatim) { return vec3u(first, second, third); }
    skip = lr_lean_next(next, third, lr_lean_word(select(far + 1u, far, one_sided)));
  }
  return lr_lean_ring_triangle(word, v, next, skip, right);
}

// Packed streams: decodes any triangle with a few popcounts.

struct LrPackedLayout {
  own: u32,     // triangles [0, own) are coded; later ones are doubles of these
  table: u32,   // first word of the table of groups
  groups: u32,  // first word of the groups
  vertex_bits: u32,
}

// x / y, rounded up.
fn lr_packed_quotient(x: u32, y: u32) -> u32 { return x / y + select(1u, 0u, x % y == 0u); }

// The first word of the doubles section; the first word of the groups if there is none.
fn lr_packed_doubles(p: LrPackedLayout) -> u32 {
  return p.table + max(lr_packed_quotient(p.own, LR_PACKED_BLOCK * LR_PACKED_GROUP), 1u) - 1u;
}

fn lr_packed_layout() -> LrPackedLayout {
  var p: LrPackedLayout;
  p.own = lr_stream_word(LR_PACKED_WORD_TRIANGLES);
  p.table = LR_PACKED_HEADER_WORDS + lr_packed_quotient(p.own, 32u);
  p.groups = lr_packed_doubles(p);
  let vertices = lr_stream_word(LR_PACKED_WORD_VERTICES);
  if ((vertices & LR_PACKED_DOUBLES) != 0u) {
    p.groups += LR_PACKED_DOUBLES_WORDS + LR_PACKED_RUN_WORDS * lr_stream_word(p.groups + 1u);
  }
  p.vertex_bits = firstLeadingBit(max(vertices & ~LR_PACKED_DOUBLES, 2u) - 1u) + 1u;
  return p;
}

// The number of all triangles, doubles included.
fn lr_packed_triangles(p: LrPackedLayout) -> u32 {
  let doubles = lr_packed_doubles(p);
  if (doubles < p.groups) { return p.own + lr_stream_word(doubles); }
  return p.own;
}

// The run of doubles that holds a triangle. x: its first triangle; y: its end; z: the own triangle that the first one
// doubles, with flag LR_PACKED_DOUBLES if orientations are opposite.
fn lr_packed_run(p: LrPackedLayout, triangle: u32) -> vec3u {
  let runs = lr_packed_doubles(p) + LR_PACKED_DOUBLES_WORDS;
  let count = (p.groups - runs) / LR_PACKED_RUN_WORDS;
  var low = 0u;
  var high = count;
  for (var k = 0u; k < 32u; k++) {
    let middle = (low + high) / 2u;
    if (middle == low) { break; }
    if (lr_stream_word(runs + LR_PACKED_RUN_WORDS * middle) <= triangle) {
      low = middle;
    } else {
      high = middle;
    }
  }
  let run = runs + LR_PACKED_RUN_WORDS * low;
  var end = lr_packed_triangles(p);
  if (low + 1u < count) { end = lr_stream_word(run + LR_PACKED_RUN_WORDS); }
  return vec3u(lr_stream_word(run), end, lr_stream_word(run + 1u));
}

// The bit reader: loads each word once, and none past the end. A global, as not every WGSL implementation passes
// pointers to members of structures.
struct LrPackedBits {
  bits: vec2u,  // the next `ready` bits
  ready: u32,
  left: u32,  // bits left up to the end
  word: u32,  // the next word to load
}
var<private> lr_packed_reader: LrPackedBits;

// Starts a reader at a bit of the groups, for `count` bits.
fn lr_packed_read_from(p: LrPackedLayout, bit: u32, count: u32) {
  let shift = bit & 31u;
  let word = p.groups + bit / 32u;
  var first = 0u;
  if (count != 0u) { first = lr_stream_word(word) >> shift; }
  lr_packed_reader = LrPackedBits(vec2u(first, 0u), 32u - shift, count, word + 1u);
}
// Loads bits until 32 are ready, or all up to the end.
fn lr_packed_fill() {
  let ready = lr_packed_reader.ready;
  if (ready < 32u && ready < lr_packed_reader.left) {
    let word = lr_stream_word(lr_packed_reader.word);
    lr_packed_reader.bits.y = select(word >> (32u - ready), 0u, ready == 0u);
    lr_packed_reader.bits.x |= word << ready;
    lr_packed_reader.word++;
    lr_packed_reader.ready += 32u;
  }
}
// Reads the next `count` bits, at most 31.
fn lr_packed_take(count: u32) -> u32 {
  lr_packed_fill();
  let bits = lr_packed_reader.bits;
  lr_packed_reader.bits = vec2u((bits.x >> count) | ((bits.y << 1u) << (31u - count)), bits.y >> count);
  lr_packed_reader.ready -= min(count, lr_packed_reader.ready);
  lr_packed_reader.left -= min(count, lr_packed_reader.left);
  return bits.x & ((1u << count) - 1u);
}
fn lr_packed_ones(bits: u32) -> u32 { return min(firstTrailingBit(~bits), 32u); }
fn lr_packed_unary(limit: u32) -> u32 {
  lr_packed_fill();
  let ones = min(lr_packed_ones(lr_packed_reader.bits.x), limit);
  lr_packed_take(ones + select(0u, 1u, ones < limit));
  return ones;
}
fn lr_packed_golomb(order: u32) -> u32 {
  let low = lr_packed_unary(31u - order) + order;
  return (lr_packed_take(low) | (1u << low)) - (1u << order);
}
// A Rice code: a unary prefix, then low bits.
fn lr_packed_rice(high: u32, bits: u32) -> u32 {
  lr_packed_take(high);
  return (high << bits) + (lr_packed_take(1u + bits) >> 1u);
}

// `count` bits of the groups from `bit` on, at most 32. Reads no word past them.
fn lr_packed_bits_at(p: LrPackedLayout, bit: u32, count: u32) -> u32 {
  let shift = bit & 31u;
  let word = p.groups + bit / 32u;
  var low = 0u;
  var high = 0u;
  if (count != 0u) { low = lr_stream_word(word); }
  if (shift + count > 32u) { high = lr_stream_word(word + 1u); }
  return extractBits((low >> shift) | ((high << 1u) << (31u - shift)), 0u, count);
}
// Reads an entry: a, b and reversed.
fn lr_packed_entry_at(p: LrPackedLayout, bit: u32) -> vec3u {
  let shift = bit & 31u;
  let word = p.groups + bit / 32u;
  let end = shift + 2u * p.vertex_bits + 1u;
  let x = lr_stream_word(word);
  var y = 0u;
  var z = 0u;
  if (end > 32u) { y = lr_stream_word(word + 1u); }
  if (end > 64u) { z = lr_stream_word(word + 2u); }
  let low = (x >> shift) | ((y << 1u) << (31u - shift));
  let high = (y >> shift) | ((z << 1u) << (31u - shift));
  let b = (low >> p.vertex_bits) | (high << (32u - p.vertex_bits));
  let r = 2u * p.vertex_bits;
  return vec3u(extractBits(low, 0u, p.vertex_bits), extractBits(b, 0u, p.vertex_bits),
               select(high >> (r - 32u), low >> r, r < 32u) & 1u);
}

// A record. Its bits begin at the number of events.
struct LrPackedRecord {
  bit: u32,        // its first bit in the groups
  turn_word: u32,  // word of the stream with the turns of its first triangle
  begin: u32,      // its first triangle in the block
  triangles: u32,  // number of triangles
  a: u32,          // (a, b): the edge at which it is entered
  b: u32,
  reversed: bool,
  plain: bool,  // its block is plain
  gap_bits: u32,
  wart_bits: u32,
  split_order: u32,
  count_order: u32,
}

// The record that holds triangle i of a block; starts the bit reader there. In a plain block, the bits are vertex
// numbers.
fn lr_packed_record(p: LrPackedLayout, block: u32, i: u32) -> LrPackedRecord {
  let group = block / LR_PACKED_GROUP;
  let k = block % LR_PACKED_GROUP;
  let first = block * LR_PACKED_BLOCK;
  let blocks = min((p.own - 1u) / LR_PACKED_BLOCK + 1u - group * LR_PACKED_GROUP, LR_PACKED_GROUP);
  var begin = 0u;
  if (group != 0u) { begin = lr_stream_word(p.table + group - 1u); }
  let bit = 32u * begin;
  let head = lr_stream_word(p.groups + begin);
  let stride = head & 0xfffu;
  let offset_bits = min((head >> 12u) & 31u, LR_PACKED_MAX_OFFSET_BITS);
  let entry_bits = min((head >> 17u) & 15u, LR_PACKED_MAX_ENTRY_BITS);
  var r: LrPackedRecord;
  r.gap_bits = (head >> 21u) & 7u;
  r.wart_bits = (head >> 24u) & 7u;
  r.split_order = (head >> 27u) & 3u;
  r.count_order = (head >> 29u) & 3u;

  // Bitmap of blocks 1 to blocks - 1 whose entry is in the head; then the bit positions of the head's fields.
  let owns = extractBits(lr_stream_word(p.groups + begin + 1u), 0u, blocks - 1u);
  let own = extractBits(owns, 0u, k);
  let entries = bit + 32u + blocks - 1u;
  let entry_size = 2u * p.vertex_bits + 1u;
  let kinds = entries + (1u + countOneBits(owns)) * entry_size;
  let has_kinds = (head >> 31u) != 0u;
  let offsets = kinds + select(0u, 2u * blocks, has_kinds);
  let steps = offsets + blocks * offset_bits;
  var kind = LR_PACKED_RECORD;
  if (has_kinds) { kind = lr_packed_bits_at(p, kinds + 2u * k, 2u); }
  let both = lr_packed_bits_at(p, offsets + (max(k, 1u) - 1u) * offset_bits, offset_bits * select(2u, 1u, k == 0u));
  let here = extractBits(both, 0u, offset_bits);
  var next = select((both >> 1u) >> (max(offset_bits, 1u) - 1u), here, k == 0u);
  let middle = (1u << offset_bits) >> 1u;
  if (offset_bits == 0u) { next = 0u; }
  let start = select(k * stride + here - middle, 0u, k == 0u);
  let end = (k + 1u) * stride + next - middle;
  var byte = (steps + (blocks - 1u) * entry_bits + 7u) / 8u + start;
  var bytes = min(end - start, LR_PACKED_MAX_RECORD);

  r.turn_word = LR_PACKED_HEADER_WORDS + first / 32u;
  r.begin = 0u;
  r.triangles = min(p.own - first, LR_PACKED_BLOCK);
  r.plain = kind == LR_PACKED_PLAIN;
  var entry_bit = entries + countOneBits(own) * entry_size;
  var origin = firstLeadingBit(own) + 1u;  // the block of the entry
  var skipped = 0u;                        // bits of the record's own entry, if it begins with one
  if (kind == LR_PACKED_PARTED) {
    let part = i / LR_PACKED_PART;
    let lengths = lr_packed_bits_at(p, 8u * byte, 32u);
    byte += LR_PACKED_PARTS;
    for (var n = 0u; n < part; n++) { byte += (lengths >> (8u * n)) & 255u; }
    bytes = (lengths >> (8u * part)) & 255u;
    if (part > 0u) {
      entry_bit = 8u * byte;
      origin = k;
      skipped = entry_size;
    }
    r.begin = part * LR_PACKED_PART;
    r.turn_word += r.begin / 32u;
    r.triangles = min(r.triangles - r.begin, LR_PACKED_PART);
  }
  let entry = lr_packed_entry_at(p, entry_bit);
  r.a = entry.x;
  r.b = entry.y;
  r.reversed = entry.z != 0u;
  if (origin < k) {
    let span = r.b - r.a;
    r.a += (k - origin) * (LR_PACKED_BLOCK / 2u) - ((1u << entry_bits) >> 1u) +
           lr_packed_bits_at(p, steps + (k - 1u) * entry_bits, entry_bits);
    r.b = r.a + span - (k - origin) * LR_PACKED_BLOCK;
  }
  r.bit = 8u * byte + skipped;
  lr_packed_read_from(p, r.bit, max(8u * bytes, skipped) - skipped);
  return r;
}

// The number of events. At most one per bit of the record, even if a damaged stream claims more.
fn lr_packed_events(r: LrPackedRecord) -> u32 {
  if (lr_packed_reader.left == 0u) { return 0u; }
  let events = lr_packed_golomb(r.count_order);
  return min(events, lr_packed_reader.left);
}

// An event. Its code determines which of these members are used.
struct LrPackedEvent {
  triangle: u32,  // triangle, counted from the record's first
  after: u32,     // the triangle from which the next gap counts
  code: u32,
  choice: u32,
  v: u32,
  w: u32,
  reversed: bool,
  flips: u32,  // FLIPS: bit of the groups at which its bits begin
}

// Reads the event after e. Fields that several codes share are read at the same place, so that invocations diverge
// little.
fn lr_packed_next_event(p: LrPackedLayout, r: LrPackedRecord, before: LrPackedEvent) -> LrPackedEvent {
  var e = before;
  lr_packed_fill();
  e.triangle = e.after + lr_packed_rice(min(lr_packed_ones(lr_packed_reader.bits.x), 31u), r.gap_bits);
  e.code = lr_packed_unary(7u);
  let split = e.code == LR_PACKED_SPLIT;
  let jump = e.code == LR_PACKED_JUMP;
  let far = e.code == LR_PACKED_FAR;
  let start = e.code == LR_PACKED_START;
  let beside = e.code == LR_PACKED_BESIDE;
  e.after = e.triangle + select(0u, 1u, split || jump || far);
  if (start) {
    e.choice = lr_packed_unary(LR_PACKED_START_ANY);
  } else {
    e.choice = lr_packed_take(select(select(0u, 3u, beside), 2u, far));
  }
  let any = start && e.choice == LR_PACKED_START_ANY;
  let near = start && e.choice == LR_PACKED_START_NEAR;
  let next = start && e.choice == LR_PACKED_START_NEXT;
  e.v = 1u;
  if (near || split || jump || beside) {
    let other = select(LR_PACKED_BESIDE_ORDER, LR_PACKED_SIZE_ORDER, near);
    e.v = lr_packed_golomb(select(select(other, LR_PACKED_JUMP_ORDER, jump), r.split_order, split));
  } else if (far || any) {
    e.v = lr_packed_take(p.vertex_bits);
  }
  if (jump) { e.choice = lr_packed_take(1u); }
  e.v += select(select(0u, 2u, jump), 3u, split);
  let counts = (far && e.choice == 3u) || (jump && e.choice == 1u);
  e.w = select(0u, e.v - 1u, split);
  if (counts || near || next) {
    e.w = select(2u, 1u, counts) + lr_packed_golomb(select(LR_PACKED_SIZE_ORDER, LR_PACKED_FAR_ORDER, counts));
  }
  if (beside || any) { e.w = lr_packed_take(p.vertex_bits); }
  if (any) { e.reversed = lr_packed_take(1u) != 0u; }
  if (e.code == LR_PACKED_FLIPS) {
    e.flips = (lr_packed_reader.word - p.groups) * 32u - lr_packed_reader.ready;
    for (var k = 0u; k < r.triangles; k += 16u) { lr_packed_take(min(r.triangles - k, 16u)); }
  }
  return e;
}

// A decoder's state: the edge entered, and the last polygon begun outside of all scopes.
struct LrPackedState {
  at: u32,  // the triangle that is entered across (a, b)
  a: u32,
  b: u32,
  reversed: bool,
  finished: bool,
  begun_a: u32,
  begun_b: u32,
  begun_reversed: bool,
}

fn lr_packed_state(r: LrPackedRecord) -> LrPackedState {
  return LrPackedState(0u, r.a, r.b, r.reversed, false, r.a, r.b, r.reversed);
}

// START or BESIDE: begins a polygon. inside: whether in a scope.
fn lr_packed_begin(e: LrPackedEvent, before: LrPackedState, inside: bool) -> LrPackedState {
  var s = before;
  var a = s.begun_b + e.v;
  var b = a + e.w;
  if (e.code == LR_PACKED_BESIDE) {
    let place = e.choice >> 1u;
    let stride = select(e.v >> 1u, ~(e.v >> 1u), (e.v & 1u) != 0u);
    // Of a and b, one is coded relative to a known vertex (`near`), the other as a number.
    let is_a = place == LR_PACKED_BESIDE_NOW_B || place == LR_PACKED_BESIDE_BEGUN_A;
    var near = s.begun_b;
    if (place == LR_PACKED_BESIDE_NOW_B) { near = s.b; }
    if (place == LR_PACKED_BESIDE_NOW_A) { near = s.a; }
    if (place == LR_PACKED_BESIDE_BEGUN_A) { near = s.begun_a; }
    near += stride;
    s.reversed = s.reversed != ((e.choice & 1u) != 0u);
    a = select(e.w, near, is_a);
    b = select(near, e.w, is_a);
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
  return s;
}

// Begins the polygon that follows without an event: directly after the last one begun, with the same size.
fn lr_packed_repeat(before: LrPackedState) -> LrPackedState {
  var s = before;
  let size = s.begun_b - s.begun_a;
  s.begun_a = s.begun_b + 1u;
  s.a = s.begun_a;
  s.begun_b = s.a + size;
  s.b = s.begun_b;
  s.finished = false;
  return s;
}

// The number of triangles from edge (a, b) on until the polygon is finished; 0xffffffff if b - a is 1 already, since only
// a turn finishes a polygon.
fn lr_packed_left(a: u32, b: u32) -> u32 { return select(b - a - 1u, 0xffffffffu, b - a == 1u); }

// SPLIT, FAR or JUMP: the third vertex of its triangle.
fn lr_packed_third(e: LrPackedEvent, up: bool, s: LrPackedState) -> u32 {
  return select(select(s.b - e.v, s.a + e.v, up), e.v, e.code == LR_PACKED_FAR);
}
// Moves the state to the first part after the event's triangle, whose third vertex is x. If e.w is not 0, the rest is
// entered e.w triangles later, across (x, s.b) if up, else across (s.a, x).
fn lr_packed_enter(e: LrPackedEvent, up: bool, x: u32, before: LrPackedState) -> LrPackedState {
  var s = before;
  let both = e.code == LR_PACKED_SPLIT || (e.code == LR_PACKED_JUMP && e.choice == 1u);
  let enters = select(select(select(1u, 2u, up), 3u, both), e.choice, e.code == LR_PACKED_FAR);
  if (select(enters == 2u, !up, enters == 3u)) {
    s.a = x;
  } else {
    s.b = x;
  }
  s.at = e.triangle + 1u;
  s.finished = enters == 0u;
  return s;
}

// Triangle i of a plain block.
fn lr_packed_plain(p: LrPackedLayout, r: LrPackedRecord, i: u32) -> vec3u {
  lr_packed_read_from(p, r.bit + 3u * p.vertex_bits * i, 3u * p.vertex_bits);
  let x = lr_packed_take(p.vertex_bits);
  let y = lr_packed_take(p.vertex_bits);
  return vec3u(x, y, lr_packed_take(p.vertex_bits));
}

fn lr_packed_oriented(a: u32, x: u32, b: u32, reversed: bool) -> vec3u { return select(vec3u(a, b, x), vec3u(a, x, b), reversed); }

// The record's turn bits, and the number of ones before each word.
var<private> lr_packed_turn_bits: array<u32, LR_PACKED_BLOCK_WORDS + 1u>;
var<private> lr_packed_turn_ups: array<u32, LR_PACKED_BLOCK_WORDS>;
fn lr_packed_turn(i: u32) -> bool { return ((lr_packed_turn_bits[i / 32u] >> (i & 31u)) & 1u) != 0u; }
// The number of 1 turns before triangle i.
fn lr_packed_ups(i: u32) -> u32 {
  return lr_packed_turn_ups[i / 32u] + countOneBits(extractBits(lr_packed_turn_bits[i / 32u], 0u, i & 31u));
}

// Moves the state forward to triangle `to`, using turns alone.
fn lr_packed_skip(before: LrPackedState, to: u32) -> LrPackedState {
  var s = before;
  var left = select(lr_packed_left(s.a, s.b), 0u, s.finished);
  if (to - s.at > left) {  // skip whole polygons
    let each = lr_packed_left(s.begun_a, s.begun_b);
    let behind = to - s.at - left;
    let whole = (behind - 1u) / each;
    let size = s.begun_b - s.begun_a;
    s.begun_a += whole * (size + 1u);
    s.begun_b += whole * (size + 1u);
    s = lr_packed_repeat(s);
    s.at = to - (behind - whole * each);
    left = each;
  }
  let ups = lr_packed_ups(to) - lr_packed_ups(s.at);
  s.a += ups;
  s.b -= to - s.at - ups;
  if (to > s.at) { s.finished = to - s.at == left; }
  s.at = to;
  return s;
}

fn lr_packed_own_triangle(p: LrPackedLayout, triangle: u32) -> vec3u {
  let block = triangle / LR_PACKED_BLOCK;
  var i = triangle % LR_PACKED_BLOCK;
  let r = lr_packed_record(p, block, i);
  if (r.plain) { return lr_packed_plain(p, r, i); }
  i -= r.begin;
  let last = min(i + 1u, r.triangles - 1u) / 32u;
  var sum = 0u;
  var rank = 0u;
  for (var k = 0u; k <= last; k++) { lr_packed_turn_bits[k] = lr_stream_word(r.turn_word + k); }
  for (var k = 0u; k <= i / 32u; k++) {
    let bits = lr_packed_turn_bits[k];
    lr_packed_turn_ups[k] = sum;
    sum += countOneBits(bits);
    var behind = 0u;
    if (k < last) { behind = lr_packed_turn_bits[k + 1u] << 31u; }
    let candidates = ~(bits ^ ((bits >> 1u) | behind));
    rank += countOneBits(extractBits(candidates, 0u, min(i - 32u * k, 32u)));
  }
  var s = lr_packed_state(r);
  var e: LrPackedEvent;
  let events = lr_packed_events(r);
  var skip = 0u;
  var inside = false;
  var flip = false;
  for (var k = 0u; k < events; k++) {
    e = lr_packed_next_event(p, r, e);
    if (e.triangle > i || e.triangle < skip) { continue; }
    s = lr_packed_skip(s, e.triangle);
    if (e.code == LR_PACKED_TURN) {
      s.reversed = !s.reversed;
    } else if (e.code == LR_PACKED_FLIPS) {
      let bit = e.flips + i;
      flip = ((lr_stream_word(p.groups + bit / 32u) >> (bit & 31u)) & 1u) != 0u;
    } else if (e.code == LR_PACKED_START || e.code == LR_PACKED_BESIDE) {
      s = lr_packed_begin(e, s, inside);
    } else {
      if (s.finished) { s = lr_packed_repeat(s); }
      let up = lr_packed_turn(e.triangle);
      let x = lr_packed_third(e, up, s);
      if (e.triangle == i) { return lr_packed_oriented(s.a, x, s.b, s.reversed != flip); }
      let rest = select(vec2u(s.a, x), vec2u(x, s.b), up);
      s = lr_packed_enter(e, up, x, s);
      if (e.w == 0u || e.w >= r.triangles - s.at) { continue; }  // no scope
      if (i - s.at >= e.w) {                                     // after the scope
        s.at += e.w;
        skip = s.at;
        s.a = rest.x;
        s.b = rest.y;
        s.finished = false;
      } else {
        inside = true;
      }
    }
  }
  s = lr_packed_skip(s, i);
  if (s.finished) { s = lr_packed_repeat(s); }
  let up = lr_packed_turn(i);
  let before = i > 0u && lr_packed_turn(i - select(0u, 1u, i > 0u)) == up;
  let here = i + 1u == r.triangles || lr_packed_turn(min(i + 1u, r.triangles - 1u)) == up;
  var by = 1u;
  var seen = 0u;
  // The triangle may be a wart's T0 or the T2 after it. Warts are identified by their rank among the candidates.
  if (before || here) {
    while (seen <= rank) {
      lr_packed_fill();
      let high = lr_packed_ones(lr_packed_reader.bits.x);
      if (high >= min(lr_packed_reader.left, 32u)) { break; }
      seen += lr_packed_rice(high, r.wart_bits) + 1u;
      if (before && seen == rank) {
        let inner = select(s.b, s.a, up);
        return lr_packed_oriented(inner - 1u, inner, inner + 1u, s.reversed != flip);
      }
      if (here && seen == rank + 1u) { by = 2u; }
    }
  }
  return lr_packed_oriented(s.a, select(s.b - by, s.a + by, up), s.b, s.reversed != flip);
}

fn lr_packed_triangle(p: LrPackedLayout, triangle: u32) -> vec3u {
  if (triangle < p.own) { return lr_packed_own_triangle(p, triangle); }
  let run = lr_packed_run(p, triangle);
  let original = (run.z & ~LR_PACKED_DOUBLES) + triangle - run.x;
  let v = lr_packed_own_triangle(p, min(original, p.own - 1u));
  return select(v, v.xzy, (run.z & LR_PACKED_DOUBLES) != 0u);
}

// Decodes up to four own triangles from `first` on into lr_packed_four: those in the same record and the same word of
// turns. Reads shared data once. Returns the number of triangles.
var<private> lr_packed_four: array<vec3u, 4>;
fn lr_packed_own_four(p: LrPackedLayout, first: u32) -> u32 {
  var i = first % LR_PACKED_BLOCK;
  let r = lr_packed_record(p, first / LR_PACKED_BLOCK, i);
  if (r.plain) {
    for (var j = 0u; j < 4u; j++) { lr_packed_four[j] = lr_packed_plain(p, r, min(i + j, r.triangles - 1u)); }
    return min(4u, r.triangles - i);
  }
  i -= r.begin;
  let word = i / 32u;
  let last = min(i + 4u, r.triangles - 1u) / 32u;
  var sum = 0u;
  var candidates = 0u;
  var before = 0u;
  for (var k = 0u; k <= last; k++) { lr_packed_turn_bits[k] = lr_stream_word(r.turn_word + k); }
  for (var k = 0u; k <= word; k++) {
    let bits = lr_packed_turn_bits[k];
    lr_packed_turn_ups[k] = sum;
    sum += countOneBits(bits);
    var behind = 0u;
    if (k < last) { behind = lr_packed_turn_bits[k + 1u] << 31u; }
    candidates = ~(bits ^ ((bits >> 1u) | behind));
    if (k < word) { before += countOneBits(candidates); }
  }
  // The record's last triangle is a candidate, too.
  if (r.triangles - 32u * word <= 32u) { candidates |= 1u << (r.triangles - 1u - 32u * word); }
  var states: array<LrPackedState, 4>;
  var rank: array<u32, 4>;
  var skip: array<u32, 4>;
  var inside: array<bool, 4>;
  var flip: array<bool, 4>;
  var known: array<bool, 4>;
  for (var j = 0u; j < 4u; j++) {
    states[j] = lr_packed_state(r);
    rank[j] = before + countOneBits(extractBits(candidates, 0u, min((i & 31u) + j, 32u)));
  }
  var e: LrPackedEvent;
  let events = lr_packed_events(r);
  for (var k = 0u; k < events; k++) {
    e = lr_packed_next_event(p, r, e);
    let third = e.after > e.triangle;
    var flips = 0u;
    if (e.code == LR_PACKED_FLIPS) { flips = lr_packed_bits_at(p, e.flips + i, min(r.triangles - i, 4u)); }
    for (var j = 0u; j < 4u; j++) {
      if (e.triangle > i + j || e.triangle < skip[j]) { continue; }
      var s = lr_packed_skip(states[j], e.triangle);
      if (e.code == LR_PACKED_TURN) {
        s.reversed = !s.reversed;
      } else if (e.code == LR_PACKED_FLIPS) {
        flip[j] = ((flips >> j) & 1u) != 0u;
      } else if (!third) {
        s = lr_packed_begin(e, s, inside[j]);
      } else {
        if (s.finished) { s = lr_packed_repeat(s); }
        let up = lr_packed_turn(e.triangle);
        let x = lr_packed_third(e, up, s);
        if (e.triangle == i + j) {
          lr_packed_four[j] = lr_packed_oriented(s.a, x, s.b, s.reversed != flip[j]);
          known[j] = true;
          skip[j] = 0xffffffffu;
        }
        let rest = select(vec2u(s.a, x), vec2u(x, s.b), up);
        s = lr_packed_enter(e, up, x, s);
        if (!known[j] && e.w != 0u && e.w < r.triangles - s.at) {
          if (i + j - s.at >= e.w) {
            s.at += e.w;
            skip[j] = s.at;
            s.a = rest.x;
            s.b = rest.y;
            s.finished = false;
          } else {
            inside[j] = true;
          }
        }
      }
      states[j] = s;
    }
  }
  var seen = 0u;
  var firsts = 0u;   // bitmap of the four: T0s of warts
  var seconds = 0u;  // bitmap of the four: T2s of warts
  while (seen <= rank[3]) {
    lr_packed_fill();
    let high = lr_packed_ones(lr_packed_reader.bits.x);
    if (high >= min(lr_packed_reader.left, 32u)) { break; }
    seen += lr_packed_rice(high, r.wart_bits) + 1u;
    for (var j = 0u; j < 4u; j++) {
      if (seen == rank[j]) { seconds |= 1u << j; }
      if (seen == rank[j] + 1u) { firsts |= 1u << j; }
    }
  }
  let bits = lr_packed_turn_bits[word] >> (i & 31u);
  var turn_before = ~bits & 1u;
  if (i > 0u) { turn_before = u32(lr_packed_turn(i - 1u)); }
  seconds &= ~(bits ^ ((bits << 1u) | turn_before));
  firsts &= candidates >> (i & 31u);
  for (var j = 0u; j < 4u; j++) {
    if (known[j]) { continue; }
    var s = lr_packed_skip(states[j], min(i + j, r.triangles - 1u));
    if (s.finished) { s = lr_packed_repeat(s); }
    let up = ((bits >> j) & 1u) != 0u;
    let by = select(1u, 2u, ((firsts >> j) & 1u) != 0u);
    let x = select(s.b - by, s.a + by, up);
    let inner = select(s.b, s.a, up);
    let t2 = ((seconds >> j) & 1u) != 0u;
    lr_packed_four[j] = lr_packed_oriented(select(s.a, inner - 1u, t2), select(x, inner, t2), select(s.b, inner + 1u, t2),
                                           s.reversed != flip[j]);
  }
  return min(4u, min(32u - (i & 31u), r.triangles - i));
}

// Decodes `count` triangles (at most four) from `first` on, a multiple of four, into lr_packed_quad: far faster than
// one by one.
var<private> lr_packed_quad: array<vec3u, 4>;
fn lr_packed_triangles_of_quad(p: LrPackedLayout, first: u32, count: u32) {
  var done = 0u;
  // One pass suffices, except for doubles and at the end of the own triangles.
  for (var n = 0u; n < 4u; n++) {
    var t = first + done;
    var left = min(count - done, p.own - t);
    var turned = false;
    if (t >= p.own) {
      let run = lr_packed_run(p, t);
      left = min(count - done, run.y - t);
      turned = (run.z & LR_PACKED_DOUBLES) != 0u;
      t = min((run.z & ~LR_PACKED_DOUBLES) + t - run.x, p.own - 1u);
    }
    left = min(left, lr_packed_own_four(p, t));
    for (var j = 0u; j < 4u; j++) {
      if (j < left) { lr_packed_quad[done + j] = select(lr_packed_four[j], lr_packed_four[j].xzy, turned); }
    }
    done += left;
    if (done >= count || left == 0u) { break; }
  }
}
