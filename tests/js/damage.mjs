// Damages .lr files, mostly with valid checksums, so that the damage reaches the decoders.

const TABLE = Uint32Array.from({length: 256}, (_, i) => {
  for (let k = 0; k < 8; ++k) i = (i >>> 1) ^ (0xedb88320 & -(i & 1));
  return i;
});

function crc32(bytes, crc = 0) {
  crc = ~crc;
  for (const byte of bytes) crc = (crc >>> 8) ^ TABLE[(crc ^ byte) & 255];
  return ~crc >>> 0;
}

/** Returns a function that gives random integers below a bound. */
export function random(seed) {
  let state = seed >>> 0;
  return (bound) => {
    state = (state + 0x9e3779b9) >>> 0;
    let x = state;
    x = Math.imul(x ^ (x >>> 16), 0x21f0aaad);
    x = Math.imul(x ^ (x >>> 15), 0x735a2d97);
    return ((x ^ (x >>> 15)) >>> 0) % bound;
  };
}

/**
 * By kind of a resident section: the word of its checksum, and the first word that the checksum covers, without
 * itself.
 */
const CHECKSUMS = {
  1: [7, 0],
  7: [3, 0],
  8: [3, 0],
  9: [1, 2]
};

function mendSection(bytes, view, at) {
  const kind = view.getUint16(at, true), coding = view.getUint16(at + 2, true), offset = view.getUint32(at + 8, true),
        size = view.getUint32(at + 16, true);
  if (offset + size > bytes.length) return;
  const [word, from] = coding === 0 ? CHECKSUMS[kind] ?? [] : [];
  const begin = offset + (kind === 8 ? Math.ceil(view.getUint32(at + 28, true) / 8) * 8 : 0), end = offset + size;
  if (word !== undefined && begin + 4 * word + 4 <= end)
    view.setUint32(
      begin + 4 * word,
      crc32(bytes.subarray(begin + 4 * word + 4, end), from ? 0 : crc32(bytes.subarray(begin, begin + 4 * word))),
      true);
  view.setUint32(at + 4, crc32(bytes.subarray(offset, end)), true);
}

export function mend(bytes) {
  const view = new DataView(bytes.buffer), count = Math.min(view.getUint32(8, true), (bytes.length - 32) / 32 | 0);
  for (let i = 0; i < count; ++i) mendSection(bytes, view, 32 + 32 * i);
  view.setUint32(24, crc32(bytes.subarray(32, 32 + 32 * count)), true);
  view.setUint32(28, crc32(bytes.subarray(0, 28)), true);
}

/**
 * A damaged copy: bits flipped, words replaced or moved, mostly in a section, sometimes in the header or table, or
 * cut.
 */
export function damage(bytes, next) {
  const cut = next(20) === 0 ? 32 + next(bytes.length - 32) : bytes.length, copy = bytes.slice(0, cut),
        view = new DataView(copy.buffer);
  const count = view.getUint32(8, true), table = 32 + 32 * count;
  for (let changes = 1 + next(4); changes > 0; --changes) {
    let from = 0, size = cut;
    const place = next(10);
    if (place === 0)
      size = Math.min(table, cut);
    else if (table <= cut) {  // in a section, often in its first words
      const entry = 32 + 32 * next(count);
      from = view.getUint32(entry + 8, true);
      size = view.getUint32(entry + 16, true);
      if (place < 5) size = Math.min(size, 96);
    }
    const at = Math.min(from + next(size || 1), cut - 4) & ~3;
    const kind = next(5), word = view.getUint32(at, true);
    const value = kind === 0 ? next(2 ** 32) :
      kind === 1             ? [0, 0xffffffff, 0x7fffffff, 0x80000000, 1][next(5)] :
      kind === 2             ? word + next(5) - 2 :
                               word ^ 1 << next(32);
    view.setUint32(at, value >>> 0, true);
  }
  if (next(10) > 0) mend(copy);
  return copy;
}
