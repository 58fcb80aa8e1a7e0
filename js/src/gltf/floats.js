import {refuse} from "./document.js";
import {inflate} from "./inflate.js";

const QUATERNIONS = 0x80, MOST_WIDTH = 16;

// The rank of a float, which increases with the float: its bits; of a negative float, the bits inverted.
const rankOf = (bits) => (bits < 0 ? ~bits : bits ^ 0x80000000);
const bitsOf = (rank) => (rank < 0 ? rank ^ 0x80000000 : ~rank);
const unfold = (code) => (code >>> 1) ^ -(code & 1);

/** Reads bits, the lowest bit of each byte first. A code's highest bit is not stored. */
class BitReader {
  #bytes;
  #at = 0;
  #held = 0;  // bits already read of the byte at #at

  constructor(bytes) {
    this.#bytes = bytes;
  }

  read(count) {
    let value = 0;
    for (let done = 0; done < count;) {
      if (this.#at === this.#bytes.length) refuse("floats: too few bits");
      const step = Math.min(8 - this.#held, count - done);
      value |= ((this.#bytes[this.#at] >> this.#held) & ((1 << step) - 1)) << done;
      done += step;
      this.#held += step;
      if (this.#held === 8) {
        this.#held = 0;
        this.#at++;
      }
    }
    return value;
  }

  /** True if only zero bits in the last byte are left. */
  isAtEnd() {
    if (this.#held === 0) return this.#at === this.#bytes.length;
    return this.#at === this.#bytes.length - 1 && this.#bytes[this.#at] >> this.#held === 0;
  }
}

/** The component `which` of a unit quaternion, computed from the other three. */
function restOf(row, which, isNegative) {
  let rest = 1;
  row.forEach((value, c) => {
    if (c !== which) rest -= value * value;
  });
  const root = rest > 0 && rest < Infinity ? Math.sqrt(rest) : 0;
  return isNegative ? -root : root;
}

/**
 * Decodes the coding "floats": rows of 32-bit floats, lossless.
 * @param {Uint8Array} coded
 * @param {number} size of the decoded floats, in bytes
 * @returns {Promise<Uint8Array>} Rejects with an Error of one line if the bytes are invalid.
 */
export async function decodeFloats(coded, size) {
  if (coded.length < 8) refuse("floats: no header");
  const header = new DataView(coded.buffer, coded.byteOffset, 8);
  const head = header.getUint32(0, true), packed = header.getUint32(4, true), width = head & 0x7f;
  const hasRest = (head & QUATERNIONS) !== 0;
  if (
    head > 0xff || width < 1 || width > MOST_WIDTH || (hasRest && width !== 4) || size % (4 * width) !== 0 ||
    packed > coded.length - 8)
    refuse("floats: a damaged header");
  const rows = size / (4 * width), base = hasRest ? rows : 0;
  const lengths = await inflate(coded.subarray(8, 8 + packed), base + rows * width);
  if (lengths.length !== base + rows * width) refuse("floats: not a length for each float");
  const codes = new BitReader(coded.subarray(8 + packed));
  const bits = new Int32Array(rows * width), floats = new Float32Array(bits.buffer);
  const row = new Int32Array(width);  // codes
  const line = new Float32Array(1), lineBits = new Int32Array(line.buffer);

  /** Predicts the rank of float `at` from the two floats before it in its column. */
  const expect = (at) => {
    if (at < width) return 0x80000000 | 0;
    if (at < 2 * width) return rankOf(bits[at - width]);
    line[0] = 2 * floats[at - width] - floats[at - 2 * width];
    return rankOf(Number.isFinite(line[0]) ? lineBits[0] : bits[at - width]);
  };

  for (let i = 0; i < rows; i++) {
    const at = i * width, rest = hasRest ? lengths[i] : -1;
    if (rest > 7) refuse(`floats: no component ${rest}`);
    for (let c = 0; c < width; c++) {
      const length = lengths[base + c * rows + i];
      if (length > 32) refuse(`floats: a code of ${length} bits`);
      row[c] = length < 2 ? length : codes.read(length - 1) | (1 << (length - 1));
    }
    for (let c = 0; c < width; c++) {
      if (!hasRest || c !== (rest & 3)) bits[at + c] = bitsOf((expect(at + c) + unfold(row[c])) | 0);
    }
    if (!hasRest) continue;
    line[0] = restOf(floats.subarray(at, at + 4), rest & 3, rest > 3);
    bits[at + (rest & 3)] = bitsOf((rankOf(lineBits[0]) + unfold(row[rest & 3])) | 0);
  }
  if (!codes.isAtEnd()) refuse("floats: bits after the last code");
  return new Uint8Array(bits.buffer);
}
