// Encodes in a worker, so that the page stays responsive.

let worker, last = 0;
const waiting = new Map();

function end(error) {
  worker?.terminate();
  worker = undefined;
  for (const {reject} of waiting.values()) reject(error);
  waiting.clear();
}

/** Cancels all encoding; the promises reject. */
export function cancel() {
  if (waiting.size > 0) end(new DOMException("another file was opened", "AbortError"));
}

/** Runs encodeMesh in the worker. Resolves to {bytes, ms}; `source` is copied. */
export function encode(source, options) {
  if (!worker) {
    worker = new Worker(new URL("encode-worker.js", import.meta.url), {type: "module"});
    worker.onmessage = ({data: {id, error, ...result}}) => {
      const {resolve, reject} = waiting.get(id);
      waiting.delete(id);
      error ? reject(new Error(error)) : resolve(result);
    };
    worker.onerror = ({message}) => end(new Error(`the encoder failed: ${message ?? "it could not be loaded"}`));
  }
  return new Promise((resolve, reject) => {
    waiting.set(++last, {resolve, reject});
    worker.postMessage({id: last, source, options});
  });
}
