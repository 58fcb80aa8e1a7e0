// The package decodes the same arrays in headless Chromium, with and without a worker, as in node.
import assert from "node:assert/strict";
import {createHash} from "node:crypto";
import {join} from "node:path";

import {serve} from "../../scripts/web.mjs";
import {Page} from "../browser/chromium.mjs";

import {encode, root, sources, VARIANTS} from "./files.mjs";

const {ready, decodeMesh} = await import(join(root, "build/js/lacedring.js"));
await ready;

function hash(arrays) {
  const all = createHash("sha256");
  for (const array of arrays) all.update(new Uint8Array(array.buffer));
  return all.digest("hex");
}

const files = {}, expected = {};
for (const source of sources().slice(0, 4)) {
  for (const variant of Object.keys(VARIANTS)) {
    const {bytes} = encode(source, variant), name = `${Object.keys(files).length}.lr`, mesh = decodeMesh(bytes);
    files[name] = bytes;
    expected[name] = hash([mesh.indices, ...mesh.attributes.map(({values}) => values)]);
  }
}
const page = new Page(),
      server = await serve({package: join(root, "build/js"), tests: join(root, "tests/js")}, 0, {files});
try {
  await page.open(`http://127.0.0.1:${server.address().port}/tests/decode.html`);
  for (const name of Object.keys(files)) {
    for (const how of ["decodeMesh", "decodeMeshAsync"])
      assert.equal(await page.evaluate(`hashOf("${name}", "${how}")`), expected[name], `${name}, ${how}`);
  }
  assert.equal(await page.evaluate("faultOf(new Uint8Array(50))"), "LacedRingError MAGIC");
  console.log(`${Object.keys(files).length} files alike`);
} finally {
  await page.close();
  server.close();
}
