// Serves page.html, three.js, the lacedring package and single files on 127.0.0.1.
import { createReadStream, existsSync } from "node:fs";
import { createServer } from "node:http";
import { basename, dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const TYPES = { html: "text/html", js: "text/javascript", gltf: "model/gltf+json", glb: "model/gltf-binary" };
const here = dirname(fileURLToPath(import.meta.url));

/**
 * @param {string} packages output of scripts/node-packages
 * @param {string} plugin output folder of scripts/build-js
 */
export async function serve(packages, plugin) {
  const folders = [];  // the URL /N/NAME is NAME in the first folder of folders[N] that has it
  const find = (path) => {
    const [, place, ...rest] = decodeURIComponent(path).split("/");
    if (place === "three") return join(packages, "node_modules/three", ...rest);
    if (place === "lacedring") return join(plugin, ...rest);
    if (folders[place]) return folders[place].map((folder) => join(folder, ...rest)).find(existsSync);
    return join(here, place);
  };
  const server = createServer((request, response) => {
    const file = find(new URL(request.url, "http://127.0.0.1").pathname);
    if (!file || !existsSync(file)) {
      response.writeHead(404).end();
      return;
    }
    response.writeHead(200, { "content-type": TYPES[file.split(".").pop()] ?? "application/octet-stream" });
    createReadStream(file).pipe(response);
  });
  await new Promise((listening) => server.listen(0, "127.0.0.1", listening));
  return {
    url: (path) => `http://127.0.0.1:${server.address().port}/${path}`,
    /** Returns the URL path of a file. Files that it refers to are searched in its folder, then in `others`. */
    add: (file, ...others) => {
      folders.push([dirname(resolve(file)), ...others.map((folder) => resolve(folder))]);
      return `/${folders.length - 1}/${encodeURIComponent(basename(file))}`;
    },
    close: () => server.close(),
  };
}
