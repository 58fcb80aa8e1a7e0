import {refuse} from "./document.js";

// Bytes written to the decoder at once. They may decode to 1000 times their size before the size can be checked.
const PIECE = 16384;

async function write(bytes, writer) {
  for (let at = 0; at < bytes.length; at += PIECE) await writer.write(bytes.subarray(at, at + PIECE));
  await writer.close();
}

/**
 * Inflates a zlib stream (RFC 1950).
 * @param {Uint8Array} bytes
 * @param {number} most bytes that the stream may decode to
 * @returns {Promise<Uint8Array>} Rejects with an Error of one line if the stream is damaged or decodes to more bytes.
 */
export async function inflate(bytes, most) {
  const {readable, writable} = new DecompressionStream("deflate");
  const reader = readable.getReader();
  write(bytes, writable.getWriter()).catch(() => {});  // the reader sees the same error
  const chunks = [];
  let size = 0;
  for (;;) {
    const {done, value} = await reader.read().catch(() => refuse("a damaged zlib stream"));
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
