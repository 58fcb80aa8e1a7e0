import {refuse} from "./document.js";

const RECENT = 64;  // length of the list of recently used parts

/** Numbers in 7 bits per byte, the lowest bits first; the top bit is set in all bytes but the last. */
function* numbersIn(bytes) {
  let value = 0, shift = 0;
  for (const byte of bytes) {
    if (shift > 28 || (shift === 28 && byte > 15)) refuse("part codes: a number of more than 32 bits");
    value |= (byte & 127) << shift;
    shift += 7;
    if (byte < 128) {
      yield value >>> 0;
      value = shift = 0;
    }
  }
  if (shift > 0) refuse("part codes: half a number");
}

/**
 * Decodes the part of each triangle.
 * @param {Uint8Array} runs inflated part codes
 * @param {number} triangles in the stream
 * @param {number} parts in the stream
 * @returns {Uint32Array} Throws an Error of one line if the codes are invalid.
 */
export function decodePartCodes(runs, triangles, parts) {
  const numbers = numbersIn(runs);
  const next = () => numbers.next().value ?? refuse("part codes: half a run");
  const out = new Uint32Array(triangles);
  const seen = new Set();
  const recent = [];  // the most recent first
  let count = 0, expected = 0;
  for (const code of numbers) {
    let part;
    if (code === 0) {
      const distance = next();
      part = (expected + ((distance >>> 1) ^ -(distance & 1))) >>> 0;
      if (part >= parts || seen.has(part)) refuse(`part codes: part ${part} is not a new one`);
      seen.add(part);
      expected = part + 1;
    } else if (code <= RECENT) {
      if (code > recent.length) refuse("part codes: a code beyond the parts used lately");
      part = recent.splice(code - 1, 1)[0];
    } else {
      part = code - RECENT - 1;
      if (!seen.has(part) || recent.includes(part)) refuse(`part codes: part ${part} had no run, or a recent one`);
    }
    recent.unshift(part);
    if (recent.length > RECENT) recent.pop();
    const run = next() + 1;
    if (run > triangles - count) refuse("part codes: more triangles than the stream has");
    out.fill(part, count, count += run);
  }
  if (count !== triangles || seen.size !== parts)
    refuse("part codes: not a part for each triangle, or parts without triangles");
  return out;
}
