// Decodes in a worker, in browsers and in node.
import {LacedRingError} from "./errors.js";
import {nodeThreads} from "./threads.js";

let worker, last = 0;
const waiting = new Map();

function settle({id, mesh, error}) {
  const {resolve, reject} = waiting.get(id);
  waiting.delete(id);
  if (worker && waiting.size === 0) worker.unref?.();  // lets node exit
  error ? reject(new LacedRingError(error.code, error.message)) : resolve(mesh);
}

function fail(message) {
  worker = undefined;
  for (const id of [...waiting.keys()])
    settle({id, error: {code: "WORKER", message: `lacedring: the worker ended: ${message}`}});
}

async function start() {
  if (typeof Worker === "function") {
    // Bundlers find the worker's script by this expression only if it is in one piece.
    const made = new Worker(new URL("./worker.js", import.meta.url), {type: "module"});
    made.onmessage = ({data}) => settle(data);
    // A script that cannot be loaded has an event without a message.
    made.onerror = ({message}) => fail(message || "its script (worker.js of the package) could not be loaded");
    return made;
  }
  const {Worker: NodeWorker} = await nodeThreads();
  const here = import.meta.url;  // in one expression, bundlers for browsers would copy the script a second time
  const made = new NodeWorker(new URL("./worker.js", here));
  made.on("message", settle);
  made.on("error", (error) => fail(error.message));
  return made;
}

let starting;

/** Runs decodeMesh in a worker. The mesh's arrays are transferred, not copied; `bytes` are copied and stay usable. */
export async function decodeMeshAsync(bytes, options = {}) {
  worker ?? await (starting ??= start().then((made) => {
    worker = made;
    starting = undefined;
  }));
  return new Promise((resolve, reject) => {
    const id = ++last, copy = bytes.slice();
    waiting.set(id, {resolve, reject});
    worker.ref?.();
    worker.postMessage({id, bytes: copy, options}, [copy.buffer]);
  });
}
