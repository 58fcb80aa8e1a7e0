// The encoder's worker. Answers a message {id, source, options} with {id, bytes, ms} or {id, error}.
import {encodeMesh, ready} from "./lacedring/encode.js";

onmessage = async ({data: {id, source, options}}) => {
  try {
    await ready;
    const start = performance.now(), bytes = encodeMesh(source, options);
    postMessage({id, bytes, ms: performance.now() - start}, [bytes.buffer]);
  } catch ({message}) {
    postMessage({id, error: message});
  }
};
