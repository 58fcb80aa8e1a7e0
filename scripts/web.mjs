// A web server of folders on 127.0.0.1, for scripts/web and the tests in Chromium.
import {createReadStream, statSync} from "node:fs";
import {createServer} from "node:http";
import {basename, dirname, join, normalize, resolve, sep} from "node:path";
import {fileURLToPath} from "node:url";

const ROOT = join(dirname(fileURLToPath(import.meta.url)), "..");
const TYPES = {
  html: "text/html",
  js: "text/javascript",
  mjs: "text/javascript",
  css: "text/css",
  json: "application/json",
  wasm: "application/wasm",
  svg: "image/svg+xml",
  png: "image/png",
  gltf: "model/gltf+json",
  glb: "model/gltf-binary",
  wgsl: "text/plain",
  glsl: "text/plain"
};

/** The folders that the page needs: the page, the package, the shaders, three.js, and the samples. */
export const FOLDERS = {
  "": join(ROOT, "web"),
  lacedring: join(ROOT, "build/js"),
  shaders: join(ROOT, "shaders/include"),
  three: join(ROOT, "build/node/node_modules/three"),
  samples: join(ROOT, "build/samples")
};

/** A file of a folder, or the index.html of a folder in it; undefined if there is none. */
function fileIn(folder, parts) {
  const file = normalize(join(folder, ...parts));
  if (file !== normalize(folder) && !file.startsWith(normalize(folder + sep))) return undefined;
  const info = statSync(file, {throwIfNoEntry: false});
  return info?.isDirectory() ? fileIn(file, ["index.html"]) : info?.isFile() ? file : undefined;
}

function find(folders, path) {
  let parts;
  try {
    parts = decodeURIComponent(path).split("/").slice(1);
  } catch {
    return undefined;
  }
  const name = parts[0] in folders && parts[0] !== "" ? parts.shift() : "";
  for (const folder of [folders[name] ?? []].flat()) {
    const file = fileIn(folder, parts);
    if (file) return file;
  }
  return undefined;
}

/**
 * Adds a file to folders that are served, and returns its path. Files that it refers to are looked for beside it, then
 * in `others`.
 */
export function share(folders, file, ...others) {
  const name = `shared-${Object.keys(folders).length}`;
  folders[name] = [dirname(resolve(file)), ...others.map((folder) => resolve(folder))];
  return `/${name}/${encodeURIComponent(basename(file))}`;
}

/**
 * Serves /NAME/... from folders[NAME], anything else from folders[""]; several folders are an array, and the first that
 * has a file serves it. Port 0: any free port. `files`: bytes by name, at /files/NAME. `isolated`: the page's clock has
 * a resolution of 5 microseconds. Resolves to the server; its address().port is the port.
 */
export function serve(folders, port = 0, {files = {}, isolated = false} = {}) {
  const more =
    isolated ? {"cross-origin-opener-policy": "same-origin", "cross-origin-embedder-policy": "require-corp"} : {};
  const server = createServer((request, response) => {
    const {pathname} = new URL(request.url, "http://127.0.0.1");
    const held = pathname.startsWith("/files/") ? files[pathname.slice(7)] : undefined;
    if (held) return response.writeHead(200, {"content-type": "application/octet-stream", ...more}).end(held);
    const file = find(folders, pathname);
    if (!file) return response.writeHead(404).end();
    if (!pathname.endsWith("/") && file.endsWith("index.html") && !pathname.endsWith("index.html"))
      return response.writeHead(301, {location: `${pathname}/`}).end();
    response.writeHead(200, {
      "content-type": TYPES[file.split(".").pop()] ?? "application/octet-stream",
      "cache-control": "no-store",
      ...more
    });
    createReadStream(file).pipe(response);
  });
  return new Promise((resolve, reject) => server.on("error", reject).listen(port, "127.0.0.1", () => resolve(server)));
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const port = Number(process.argv[2] ?? 8080);
  if (!Number.isInteger(port) || port < 0 || port > 65535) {
    console.error("web: PORT is a number from 0 to 65535");
    process.exit(2);
  }
  serve(FOLDERS, port)
    .then(
      () => console.log(`http://127.0.0.1:${port}/ and http://127.0.0.1:${port}/gpu/ (control + C ends it)`),
      ({code, message}) => {
        console.error(`web: ${code === "EADDRINUSE" ? `port ${port} is in use: scripts/web PORT` : message}`);
        process.exit(1);
      });
}
