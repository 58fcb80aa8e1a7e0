// A worker that decodes, in browsers and in node.
import { LacedRingError } from "./errors.js";

let worker, last = 0;
const waiting = new Map();

function settle({ id, mesh, error }) {
  const { resolve, reject } = waiting.get(id);
  waiting.delete(id);
  if (worker && waiting.size === 0) worker.unref?.();  // node need not wait for it any more
  error ? reject(new LacedRingError(error.code, error.message)) : resolve(mesh);
}

function fail(message) {
  worker = undefined;
  for (const id of [...waiting.keys()]) settle({ id, error: { code: "WORKER", message: `lacedring: the worker ended: ${message}` } });
}

async function start() {
  const url = new URL("./worker.js", import.meta.url);
  if (typeof Worker === "function") {
    const made = new Worker(url, { type: "module" });
    made.onmessage = ({ data }) => settle(data);
    made.onerror = (event) => fail(event.message);
    return made;
  }
  const { Worker: NodeWorker } = await import(/* webpackIgnore: true */ /* @vite-ignore */ "node:worker_threads");
  const made = new NodeWorker(url);
  made.on("message", settle);
  made.on("error", (error) => fail(error.message));
  return made;
}

let starting;

/** As decodeMesh, in a worker; resolves to the mesh, whose arrays are moved and not copied. The bytes stay the caller's. */
export async function decodeMeshAsync(bytes, options = {}) {
  worker ?? await (starting ??= start().then((made) => { worker = made; starting = undefined; }));
  return new Promise((resolve, reject) => {
    const id = ++last, copy = bytes.slice();
    waiting.set(id, { resolve, reject });
    worker.ref?.();
    worker.postMessage({ id, bytes: copy, options }, [copy.buffer]);
  });
}
