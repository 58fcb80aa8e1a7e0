// Decodes vertex streams (docs/vertex-format.md): one invocation decodes a block of 128 vertices, or a single vertex by
// decoding its block up to that vertex. This file needs no other. It is lacedring_vertices.glsl in WGSL, with the same
// names. Concatenate this text and your shader:
//
//     const LR_VERTEX_COMPONENTS = 3u;                       // integers per vertex
//     fn lr_vertex_word(i: u32) -> u32 { return words[i]; }  // word i of the stream
//     fn lr_vertex_put(i: u32) { ... }                       // called for vertex i, with its integers in lr_vertex_value
//     ...
//     lr_vertex_block(lr_vertex_layout(), block, 128u);
//
// The stream must be valid (lacedring::validate_vertices); with any other, every loop still ends. lr_vertex_float maps
// an integer to a float, bit for bit like the CPU's decoder. Needs neither 64-bit integers nor doubles. Set the
// pipeline constant LR_VERTEX_MAPPING to the stream's mapping to remove the code of the other mappings.

const LR_VERTEX_HEADER_WORDS = 7u;
const LR_VERTEX_BLOCK = 128u;
const LR_VERTEX_GROUP = 16u;
const LR_MAPPING_LATTICE = 1u;
const LR_MAPPING_OCTAHEDRAL = 2u;
const LR_MAPPING_FLOATS = 3u;
const LR_MAPPING_DECIMALS = 4u;
override LR_VERTEX_MAPPING: u32 = 8u;  // 8: the mapping in the stream's header

struct LrVertexLayout {
  vertices: u32,
  mapping: u32,
  unit: u32,        // lattice: bits of the step as a float; decimals: number of digits
  bits: u32,        // octahedral: bits per integer
  exceptions: u32,  // number of exceptions, which follow the parameters, two words each
  field_bits: u32,
  table: u32,  // first word of the table of groups
  data: u32,   // first word of the blocks
}

fn lr_vertex_exceptions() -> u32 { return LR_VERTEX_HEADER_WORDS + 2u * LR_VERTEX_COMPONENTS; }

fn lr_vertex_layout() -> LrVertexLayout {
  var p: LrVertexLayout;
  p.vertices = lr_vertex_word(1u);
  let layout_word = lr_vertex_word(2u);
  p.mapping = select(LR_VERTEX_MAPPING, (layout_word >> 5u) & 7u, LR_VERTEX_MAPPING == 8u);
  p.bits = (layout_word >> 13u) & 31u;
  p.field_bits = (layout_word >> 18u) & 31u;
  p.unit = lr_vertex_word(4u);
  p.exceptions = lr_vertex_word(6u);
  p.table = lr_vertex_exceptions() + 2u * p.exceptions;
  let in_group = LR_VERTEX_BLOCK * LR_VERTEX_GROUP;
  let groups = p.vertices / in_group + select(1u, 0u, p.vertices % in_group == 0u);
  p.data = p.table + groups * (1u + (15u * p.field_bits + 31u) / 32u);
  return p;
}

// The 32 bits that begin `at` bits after the start of word `base`.
fn lr_vertex_load(base: u32, at: u32) -> u32 {
  let word = base + at / 32u;
  let shift = at & 31u;
  let low = lr_vertex_word(word) >> shift;
  if (shift == 0u) { return low; }
  return low | (lr_vertex_word(word + 1u) << (32u - shift));
}
fn lr_vertex_field(base: u32, at: u32, count: u32) -> u32 { return extractBits(lr_vertex_load(base, at), 0u, count); }
fn lr_vertex_take(base: u32, at: ptr<function, u32>, count: u32) -> u32 {
  let value = lr_vertex_field(base, *at, count);
  *at += count;
  return value;
}
fn lr_vertex_quarter(x: u32) -> u32 { return u32(i32(x + 2u) >> 2u); }

var<private> lr_vertex_value: array<u32, LR_VERTEX_COMPONENTS>;

// Decodes the first `most` vertices of a block (all if it has fewer).
fn lr_vertex_block(p: LrVertexLayout, block: u32, most: u32) {
  const n = LR_VERTEX_COMPONENTS;
  let first = block * LR_VERTEX_BLOCK;
  let count = min(p.vertices - first, LR_VERTEX_BLOCK);
  let group = p.table + block / LR_VERTEX_GROUP * (1u + (15u * p.field_bits + 31u) / 32u);
  let k = block % LR_VERTEX_GROUP;
  let base = p.data + lr_vertex_word(group);
  var at = 0u;
  if (k > 0u) { at = lr_vertex_field(group + 1u, (k - 1u) * p.field_bits, p.field_bits); }
  var predictor: array<u32, n>;
  var width: array<u32, n>;
  var step1: array<u32, n>;
  var step2: array<u32, n>;
  for (var c = 0u; c < n; c++) {
    let said = lr_vertex_word(LR_VERTEX_HEADER_WORDS + 2u * c + 1u);
    width[c] = (said >> 6u) & 31u;
    predictor[c] = (said >> 11u) & 31u;
    let own = lr_vertex_take(base, &at, 1u);
    let other = lr_vertex_take(base, &at, 5u * own);
    if (own != 0u) { predictor[c] = other; }
  }
  let run = 4u << lr_vertex_take(base, &at, 2u);
  for (var c = 0u; c < n; c++) {
    let bits = lr_vertex_word(LR_VERTEX_HEADER_WORDS + 2u * c + 1u) & 63u;
    lr_vertex_value[c] = lr_vertex_word(LR_VERTEX_HEADER_WORDS + 2u * c) + lr_vertex_take(base, &at, bits);
  }
  lr_vertex_put(first);

  let last = min(count, most);
  var low_at = 0u;
  var end = 1u;  // end: of the current run
  var low_bits: array<u32, n>;
  var row = 0u;
  var present = 0u;
  var axis = 3u;
  var last_axis = 0u;
  var slopes = 36u;  // the plane's two slopes, 3 bits each, biased by 4
  var last_slopes = 36u;
  var zeros = vec2u(0u);
  var seen = 0u;
  for (var i = 1u; i < LR_VERTEX_BLOCK; i++) {
    if (i >= last) { break; }
    if (i == end) {
      at += seen;  // skip the unary numbers at the end of the previous run
      if (n == 3u && (i - 1u) % 16u == 0u) {
        let code = lr_vertex_load(base, at);
        axis = 3u;
        if ((code & 1u) == 0u) {
          at += 1u;
        } else {
          at += 2u;
          if ((code & 2u) != 0u) {
            last_axis = (code >> 2u) & 3u;
            last_slopes = (code >> 4u) & 63u;
            at += 8u;
          }
          axis = last_axis;
          slopes = last_slopes;
        }
      }
      row = 0u;
      present = 0u;
      for (var c = 0u; c < n; c++) {
        let code = lr_vertex_load(base, at);
        let ones = min(firstTrailingBit(~code), 4u);
        at += min(ones + 1u, 4u);
        if (ones == 2u) { width[c] = (width[c] + 1u) & 31u; }
        if (ones == 3u) { width[c] = (width[c] - 1u) & 31u; }
        if (ones == 4u) {
          width[c] = (code >> 4u) & 31u;
          at += 5u;
        }
        if (ones != 1u) { present |= 1u << c; }
        low_bits[c] = select(width[c], 0u, ones == 1u);
        row += low_bits[c];
      }
      low_at = at;
      end = min(i + run, count);
      at += row * (end - i);
      if (end == count) { end = LR_VERTEX_BLOCK; }  // no run follows
      zeros = vec2u(lr_vertex_load(base, at), lr_vertex_load(base, at + 32u));
      seen = 0u;
    }
    var low = lr_vertex_load(base, low_at);
    var taken = 0u;
    var residual: array<u32, n>;
    for (var c = 0u; c < n; c++) {
      residual[c] = 0u;
      if (((present >> c) & 1u) != 0u) {
        if (taken + low_bits[c] > 32u) {
          low_at += taken;
          taken = 0u;
          low = lr_vertex_load(base, low_at);
        }
        if (seen > 39u) {  // keeps at least 25 bits in `zeros`
          at += seen;
          seen = 0u;
          zeros = vec2u(lr_vertex_load(base, at), lr_vertex_load(base, at + 32u));
        }
        let z = min(firstTrailingBit(zeros.x), 24u);
        let code = (z << low_bits[c]) | extractBits(low, taken, low_bits[c]);
        zeros = vec2u((zeros.x >> (z + 1u)) | (zeros.y << (31u - z)), zeros.y >> (z + 1u));
        seen += z + 1u;
        taken += low_bits[c];
        residual[c] = (code >> 1u) ^ (0u - (code & 1u));
      }
    }
    low_at += taken;
    if (n == 3u && axis < 3u) {
      const x = min(0u, n - 1u);  // compiled for one and two components, too, where it has no effect
      const y = min(1u, n - 1u);
      const z = min(2u, n - 1u);
      let u = select(select(residual[x], residual[z], axis == 1u), residual[y], axis == 0u);
      let v = select(select(residual[y], residual[x], axis == 1u), residual[z], axis == 0u);
      let more = lr_vertex_quarter(((slopes & 7u) - 4u) * u + ((slopes >> 3u) - 4u) * v);
      for (var c = 0u; c < n; c++) { residual[c] += select(0u, more, c == axis); }
    }
    for (var c = 0u; c < n; c++) {
      let alpha = (predictor[c] & 7u) - 2u;
      let beta = (predictor[c] >> 3u) - 2u;
      let difference = residual[c] + lr_vertex_quarter(alpha * step1[c] + beta * step2[c]);
      step2[c] = step1[c];
      step1[c] = difference;
      lr_vertex_value[c] += difference;
    }
    lr_vertex_put(first + i);
  }
}

// The bits of the float nearest to value / 10^digits. Uses long division, as float arithmetic would round twice.
fn lr_vertex_decimal(value: u32, digits: u32) -> u32 {
  let sign = value & 0x80000000u;
  let number = select(value, 0u - value, sign != 0u);
  var divisor = 1u;
  for (var k = 0u; k < 9u; k++) { divisor *= select(1u, 10u, k < digits); }
  if (number == 0u) { return 0u; }
  var quotient = number / divisor;
  var rest = number % divisor;
  var exponent = 0u;           // power of two of the quotient's lowest bit, modulo 2^32
  if (quotient >= 1u << 25u) {  // more bits than needed: the lowest only decide whether there is a rest
    let shift = firstLeadingBit(quotient) - 24u;
    if (extractBits(quotient, 0u, shift) != 0u) { rest = 1u; }
    quotient >>= shift;
    exponent = shift;
  }
  for (var k = 0u; k < 64u; k++) {
    if (quotient >= 1u << 24u) { break; }
    rest *= 2u;
    quotient = quotient * 2u + select(0u, 1u, rest >= divisor);
    if (rest >= divisor) { rest -= divisor; }
    exponent--;
  }
  let odd = (quotient >> 1u) & 1u;  // round 25 bits to 24, ties to even
  let half_way = quotient & 1u;
  quotient = (quotient >> 1u) + select(0u, 1u, half_way != 0u && (rest != 0u || odd != 0u));
  return sign | (((exponent + 1u + 150u) << 23u) + quotient - (1u << 23u));
}

// The bits of the float that an integer maps to, for lattices, floats and decimals. at: LR_VERTEX_COMPONENTS * vertex +
// component.
fn lr_vertex_float(p: LrVertexLayout, at: u32, value: u32) -> u32 {
  if (p.mapping == LR_MAPPING_LATTICE) { return bitcast<u32>(f32(i32(value)) * bitcast<f32>(p.unit)); }
  if (p.mapping == LR_MAPPING_DECIMALS) {
    var low = 0u;
    var high = p.exceptions;  // binary search for the first exception at or after `at`
    for (var k = 0u; k < 32u; k++) {
      if (low >= high) { break; }
      let middle = low + (high - low) / 2u;
      if (lr_vertex_word(lr_vertex_exceptions() + 2u * middle) < at) {
        low = middle + 1u;
      } else {
        high = middle;
      }
    }
    let word = lr_vertex_exceptions() + 2u * low;
    if (low < p.exceptions && lr_vertex_word(word) == at) { return lr_vertex_word(word + 1u); }
    return lr_vertex_decimal(value, p.unit);
  }
  return value ^ select(0xffffffffu, 0x80000000u, (value & 0x80000000u) != 0u);
}

// The direction of two octahedral integers, as exact integers; not of unit length.
fn lr_vertex_direction(p: LrVertexLayout, x: u32, y: u32) -> vec3i {
  let most = (1 << (p.bits - 1u)) - 1;
  var v = vec2i(i32(x), i32(y));
  let size = abs(v);
  let z = most - size.x - size.y;
  if (z < 0) { v = select(most - size.yx, size.yx - most, v < vec2i(0)); }
  return vec3i(v, z);
}
