// The WebGL2 page: opens files and draws them from the stream.
import {Orbit} from "./camera.js";
import {Gl2Mesh, loadGlsl} from "./gl2.js";
import {readLr} from "./lr-file.js";
import {element, listenForFiles, showError, showTable, sizeOf} from "./page.js";

const canvas = element("picture"), grouped = (n) => n.toLocaleString("en-US");
let gl, glsl, mesh, camera, asked = false;

function changed() {
  if (asked || !mesh) return;
  asked = true;
  requestAnimationFrame(() => {
    asked = false;
    const dark = matchMedia("(prefers-color-scheme: dark)").matches;
    mesh.draw(camera.matrices(canvas.width / canvas.height), dark ? [0.098, 0.102, 0.11, 1] : [0.957, 0.953, 0.941, 1]);
  });
}

function open(bytes, name) {
  showError();
  const next = new Gl2Mesh(gl, readLr(bytes), glsl), {file} = next;
  mesh?.destroy();
  mesh = next;
  camera.bounds = mesh.bounds;
  element("hint").hidden = true;
  const sum = mesh.stream.bytes + mesh.positions.bytes;
  showTable([
    ["connectivity, a texture", mesh.stream.bytes, ""], ["positions, a texture of floats", mesh.positions.bytes, ""],
    ["total for this picture", sum, "sum"], ["uncompressed buffers", 12 * (file.triangles + file.vertices), ""]
  ]);
  element("status").textContent = `${name}: ${file.kind}, ${grouped(file.triangles)} triangles`;
  changed();
}

async function start() {
  gl = canvas.getContext("webgl2");
  if (!gl) throw new Error("This browser has no WebGL2.");
  glsl = await loadGlsl();
  camera = new Orbit({center: [0, 0, 0], radius: 1});
  camera.listen(canvas, changed);
  new ResizeObserver(() => {
    Object.assign(canvas, sizeOf(canvas));
    changed();
  }).observe(canvas);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", changed);
  await listenForFiles(later, open);
}

let working = Promise.resolve();
/** Queues a piece of work after all earlier ones; shows its error. */
function later(work) {
  return (working = working.then(work).catch(showError));
}

/** For tests: resolves when all queued work is done and drawn. */
window.idle = () => later(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
later(start);
