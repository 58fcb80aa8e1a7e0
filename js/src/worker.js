// The worker that pool.js starts: decodes the files that it receives.
import {decodeMesh, ready} from "./lacedring.js";
import {nodeThreads} from "./threads.js";

function buffersOf({indices, attributes, surface, vertexOrder, cornerOrder}) {
  const arrays =
    [indices, vertexOrder, cornerOrder, surface?.indices, surface?.vertexOf, ...attributes.map(({values}) => values)];
  return arrays.filter((array) => array !== undefined).map(({buffer}) => buffer);
}

async function answer(port, {id, bytes, options}) {
  try {
    await ready;
    const mesh = decodeMesh(bytes, options);
    port.postMessage({id, mesh}, buffersOf(mesh));
  } catch ({code, message}) {
    port.postMessage({id, error: {code: code ?? "WORKER", message}});
  }
}

if (typeof self === "object")
  self.onmessage = ({data}) => answer(self, data);
else
  nodeThreads().then(({parentPort}) => parentPort.on("message", (data) => answer(parentPort, data)));
