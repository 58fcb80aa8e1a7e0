import { refuse } from "./document.js";

/**
 * Inflates a zlib stream (RFC 1950).
 * @param {Uint8Array} bytes
 * @param {number} most bytes that the stream may decode to; it is given up once it has more
 * @returns {Promise<Uint8Array>} Rejects with an Error in one line: no whole stream, or too large.
 */
export async function inflate(bytes, most) {
  const reader = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate")).getReader();
  const chunks = [];
  let size = 0;
  for (;;) {
    const { done, value } = await reader.read().catch(() => refuse("a damaged zlib stream"));
    if (done) break;
    size += value.length;
    if (size > most) {
      reader.cancel().catch(() => {});
      refuse(`a zlib stream of more than ${most} bytes`);
    }
    chunks.push(value);
  }
  const out = new Uint8Array(size);
  size = 0;
  for (const chunk of chunks) {
    out.set(chunk, size);
    size += chunk.length;
  }
  return out;
}
