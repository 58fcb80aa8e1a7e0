// Serves folders on a port of this machine that is free: for pages in headless Chromium.
import { createReadStream, statSync } from "node:fs";
import { createServer } from "node:http";
import { join, normalize } from "node:path";

const TYPES = { html: "text/html", js: "text/javascript", mjs: "text/javascript", json: "application/json", wasm: "application/wasm", css: "text/css" };
// With these, clocks of pages have 5 microseconds.
const ISOLATED = { "cross-origin-opener-policy": "same-origin", "cross-origin-embedder-policy": "require-corp" };

/**
 * folders: what each first part of a path stands for; `files`: names to bytes, which lie under /files/.
 * @returns { url, close }
 */
export async function serve(folders, files = {}) {
  const server = createServer((request, response) => {
    const [, first, ...rest] = normalize(decodeURIComponent(new URL(request.url, "http://127.0.0.1").pathname)).split("/");
    const headers = { "content-type": TYPES[request.url.split(".").pop()] ?? "application/octet-stream", ...ISOLATED };
    const held = first === "files" ? files[rest.join("/")] : undefined;
    if (held) return response.writeHead(200, headers).end(held);
    const file = folders[first] && join(folders[first], ...rest);
    if (!file || !statSync(file, { throwIfNoEntry: false })?.isFile()) return response.writeHead(404).end();
    response.writeHead(200, headers);
    createReadStream(file).pipe(response);
  });
  await new Promise((listening) => server.listen(0, "127.0.0.1", listening));
  return { url: `http://127.0.0.1:${server.address().port}`, close: () => server.close() };
}
