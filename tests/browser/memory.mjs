// node memory.mjs PACKAGES PLUGIN FILE: loads, draws and frees a packed glTF file 100 times with the plug-in in
// headless Chromium, and compares the memory used after 20 and 100 times. Exit code 1 if it grows. PACKAGES and PLUGIN:
// as for pictures.mjs.
import {dirname, join} from "node:path";
import {fileURLToPath} from "node:url";

import {serve, share} from "../../scripts/web.mjs";

import {Page} from "./chromium.mjs";

const [packages, plugin, file] = process.argv.slice(2);
const here = dirname(fileURLToPath(import.meta.url));
const MOST = 1 << 20;  // allowed growth in bytes; three.js itself leaves 1 to 3 KB of objects each time

const folders = {
  "": here,
  three: join(packages, "node_modules/three"),
  lacedring: plugin
};
const server = await serve(folders);
const page = new Page();
let failed = false;
try {
  await page.open(`http://127.0.0.1:${server.address().port}/page.html`);
  const url = JSON.stringify(share(folders, file));
  const after = async (times) => {
    const gpu = await page.evaluate(`repeat(${url}, ${times})`);
    return {...gpu, ...await page.memory()};
  };
  const first = await after(20), last = await after(80);
  for (const name of Object.keys(first)) {
    const grows = last[name] > first[name] + (["objects", "arrays"].includes(name) ? MOST : 0);
    failed ||= grows;
    console.log(`${grows ? "FAILED " : ""}${name}: ${first[name]} after 20 times, ${last[name]} after 100`);
  }
  failed ||= page.problems.length > 0;
  page.problems.forEach((text) => console.log(`FAILED console: ${text}`));
} finally {
  await page.close();
  server.close();
}
process.exit(failed ? 1 : 0);
