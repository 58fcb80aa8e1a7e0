// The worker that pool.js starts: decodes the files that it receives.
import {decodeMesh, ready} from "./lacedring.js";

const port = typeof self === "object" ?
  self :
  (await import(/* webpackIgnore: true */ /* @vite-ignore */ "node:worker_threads")).parentPort;

function buffersOf({indices, attributes, surface, vertexOrder, cornerOrder}) {
  const arrays =
    [indices, vertexOrder, cornerOrder, surface?.indices, surface?.vertexOf, ...attributes.map(({values}) => values)];
  return arrays.filter((array) => array !== undefined).map(({buffer}) => buffer);
}

async function answer({id, bytes, options}) {
  try {
    await ready;
    const mesh = decodeMesh(bytes, options);
    port.postMessage({id, mesh}, buffersOf(mesh));
  } catch ({code, message}) {
    port.postMessage({id, error: {code: code ?? "WORKER", message}});
  }
}

if (port.on)
  port.on("message", answer);
else
  port.onmessage = ({data}) => answer(data);
