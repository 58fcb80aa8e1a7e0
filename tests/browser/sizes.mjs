// node sizes.mjs (SOURCE PACKED LOSSLESS GLTFPACK)...: a table of the bytes of glTF files without their images, as they are and after
// brotli. The bytes are the JSON without image data URIs, and all buffers without the buffer views of images.
import { existsSync, readFileSync } from "node:fs";
import { basename, dirname, join } from "node:path";
import { brotliCompressSync, constants } from "node:zlib";

/** The JSON, and the GLB's binary chunk if there is one. */
function parts(file) {
  const data = readFileSync(file);
  if (data.toString("latin1", 0, 4) !== "glTF") return [data, null];
  const length = data.readUInt32LE(12);
  return [data.subarray(20, 20 + length), data.subarray(28 + length)];
}

function withoutImages(file) {
  const [text, binary] = parts(file);
  const json = JSON.parse(text);
  const views = (json.images ?? []).flatMap(({ bufferView }) => json.bufferViews[bufferView] ?? []);
  const out = [Buffer.from(text.toString().replaceAll(/"data:image[^"]*"/g, '""'))];
  (json.buffers ?? []).forEach(({ uri, byteLength }, index) => {
    if (uri?.startsWith("data:")) return;  // in the JSON
    if (uri === undefined && (index > 0 || !binary)) return;  // EXT_meshopt_compression's, which has no bytes
    const data = uri === undefined ? binary : readFileSync(join(dirname(file), decodeURIComponent(uri)));
    let at = 0;
    const mine = views.filter(({ buffer }) => buffer === index).sort((a, b) => (a.byteOffset ?? 0) - (b.byteOffset ?? 0));
    for (const { byteOffset = 0, byteLength: size } of mine) {
      out.push(data.subarray(at, byteOffset));
      at = byteOffset + size;
    }
    out.push(data.subarray(at, Math.max(at, byteLength)));
  });
  return Buffer.concat(out);
}

function sizes(file) {
  if (!existsSync(file)) return [NaN, NaN];
  const data = withoutImages(file);
  return [data.length, brotliCompressSync(data, { params: { [constants.BROTLI_PARAM_QUALITY]: 11 } }).length];
}

console.log("| scene | source | brotli | packed | brotli | lossless | brotli | gltfpack | brotli | packed / gltfpack | brotli |");
console.log("|---|---|---|---|---|---|---|---|---|---|---|");
for (let i = 2; i < process.argv.length; i += 4) {
  const files = process.argv.slice(i, i + 4).map(sizes);
  const ratios = [0, 1].map((k) => (files[1][k] / files[3][k]).toFixed(2));
  console.log(`| ${[basename(process.argv[i]), ...files.flat().map((n) => n.toLocaleString("en-US")), ...ratios].join(" | ")} |`);
}
