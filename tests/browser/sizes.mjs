// node sizes.mjs (SOURCE PACKED LOSSLESS GLTFPACK)...: prints a table of the bytes of glTF files without their images,
// plain and compressed by brotli: the JSON without image data URIs, and all buffers without the bytes of images.
import {existsSync, readFileSync} from "node:fs";
import {basename, dirname, join} from "node:path";
import {brotliCompressSync, constants} from "node:zlib";

/** The JSON and, if there is one, the binary chunk of a GLB. */
function parts(file) {
  const data = readFileSync(file);
  if (data.toString("latin1", 0, 4) !== "glTF") return [data, null];
  const length = data.readUInt32LE(12);
  return [data.subarray(20, 20 + length), data.subarray(28 + length)];
}

/** The bytes of the images in a glTF file. Both programs keep these bytes, even if the JSON is compressed. */
function imagesOf(file) {
  const [text, binary] = parts(file);
  const json = JSON.parse(text);
  return (json.images ?? []).flatMap(({uri, bufferView}) => {
    if (bufferView === undefined) return uri?.startsWith("data:") ? [Buffer.from(uri.split(",")[1], "base64")] : [];
    const {buffer, byteOffset = 0, byteLength} = json.bufferViews[bufferView];
    const from = json.buffers[buffer].uri;
    const data = from === undefined ? binary : readUri(file, from);
    return [data.subarray(byteOffset, byteOffset + byteLength)];
  });
}

function readUri(file, uri) {
  return uri.startsWith("data:") ? Buffer.from(uri.split(",")[1], "base64") :
                                   readFileSync(join(dirname(file), decodeURIComponent(uri)));
}

function withoutImages(file, images) {
  const [text, binary] = parts(file);
  const files =
    (JSON.parse(text).buffers ?? []).flatMap(({uri}) => uri && !uri.startsWith("data:") ? [readUri(file, uri)] : []);
  let data = Buffer.concat([...(binary ? [binary] : []), ...files]);
  for (const image of images) {
    const at = data.indexOf(image);
    if (at >= 0) data = Buffer.concat([data.subarray(0, at), data.subarray(at + image.length)]);
  }
  return Buffer.concat([Buffer.from(text.toString().replaceAll(/"data:image[^"]*"/g, '""')), data]);
}

function sizes(file, images) {
  if (!existsSync(file)) return [NaN, NaN];
  const data = withoutImages(file, images);
  return [data.length, brotliCompressSync(data, {params: {[constants.BROTLI_PARAM_QUALITY]: 11}}).length];
}

console.log(
  "| scene | source | brotli | packed | brotli | lossless | brotli | gltfpack | brotli | packed / gltfpack | brotli |");
console.log("|---|---|---|---|---|---|---|---|---|---|---|");
for (let i = 2; i < process.argv.length; i += 4) {
  const images = imagesOf(process.argv[i]);
  const files = process.argv.slice(i, i + 4).map((file) => sizes(file, images));
  const ratios = [0, 1].map((k) => (files[1][k] / files[3][k]).toFixed(2));
  console.log(
    `| ${[basename(process.argv[i]), ...files.flat().map((n) => n.toLocaleString("en-US")), ...ratios].join(" | ")} |`);
}
