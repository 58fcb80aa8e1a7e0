// node bundlers.test.mjs: an application that decodes with and without a worker, bundled by esbuild and by Vite with
// their defaults, gives the same results with both in headless Chromium. Exit code 77 if npm's registry cannot be
// reached.
import assert from "node:assert/strict";
import {execFileSync, spawnSync} from "node:child_process";
import {cpSync, mkdirSync, mkdtempSync, rmSync, symlinkSync, writeFileSync} from "node:fs";
import {tmpdir} from "node:os";
import {join} from "node:path";

import {serve} from "../../scripts/web.mjs";
import {Page} from "../browser/chromium.mjs";

import {encode, root, sources} from "./files.mjs";

const packages =
  spawnSync(join(root, "scripts/node-packages"), {encoding: "utf8", stdio: ["ignore", "pipe", "inherit"]});
if (packages.status !== 0) process.exit(packages.status);
const modules = join(packages.stdout.trim(), "node_modules");

const HTML = `<!doctype html><title>-</title><script type="module" src="app.js"></script>`;
const APP = `import {decodeMesh, decodeMeshAsync, ready} from "lacedring";
globalThis.result = (async () => {
  const bytes = new Uint8Array(await (await fetch("/files/mesh.lr")).arrayBuffer());
  await ready;
  const here = decodeMesh(bytes), there = await decodeMeshAsync(bytes);
  return [here, there].map(({indices, attributes}) => [indices, ...attributes.map(({values}) => values)].join());
})().catch(({code, message}) => code + ": " + message);
`;

const work = mkdtempSync(join(tmpdir(), "lacedring-bundlers-"));
const run = (program, ...line) => execFileSync("node", [join(modules, program), ...line], {cwd: work, stdio: "pipe"});
let server;
try {
  mkdirSync(join(work, "node_modules"));
  symlinkSync(join(root, "build/js"), join(work, "node_modules/lacedring"));
  writeFileSync(join(work, "index.html"), HTML);
  writeFileSync(join(work, "app.js"), APP);
  const esbuild = (...entries) => run(
    "esbuild-wasm/bin/esbuild", ...entries, "--bundle", "--minify", "--format=esm", "--outdir=" + entries.length,
    "--log-level=warning");
  // esbuild does not bundle workers: the worker is an entry of its own.
  esbuild("app.js", "worker=lacedring/worker.js");
  esbuild("app.js");
  run("vite/bin/vite.js", "build", "--outDir", "vite");
  for (const folder of ["1", "2"]) cpSync(join(work, "index.html"), join(work, folder, "index.html"));

  const folders = {"": join(work, "vite"), one: join(work, "1"), two: join(work, "2")};
  const files = {"mesh.lr": encode(sources()[0], "stored").bytes};
  server = await serve(folders, 0, {files});
  const result = async (path) => {
    const page = new Page();
    try {
      await page.open(`http://127.0.0.1:${server.address().port}/${path}`);
      return await page.evaluate("result");
    } finally {
      await page.close();
    }
  };
  for (const path of ["", "two/"]) {
    const [here, there] = await result(path);
    assert.ok(here.length > 100 && here === there, path);
  }
  assert.match(await result("one/"), /^WORKER: .*worker\.js of the package/);
} finally {
  server?.close();
  rmSync(work, {recursive: true, force: true});
}
