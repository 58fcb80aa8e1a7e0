// The WebGPU page: opens files, draws them as chosen, shows buffer sizes and errors.
import {Orbit} from "./camera.js";
import {openDevice} from "./gpu.js";
import {readLr} from "./lr-file.js";
import {GpuMesh} from "./mesh.js";
import {element, listenForFiles, showError, showTable, sizeOf} from "./page.js";
import {Renderer} from "./renderer.js";
import {loadIncludes} from "./shaders.js";

const canvas = element("picture"), panel = element("panel");
const NAMES = {
  stream: "connectivity, as in the file",
  seams: "seams, as in the file",
  position_words: "positions, as in the file",
  normal_words: "normals, as in the file",
  indices: "index buffer, expanded",
  copies: "index buffer over copies",
  vertex_of: "vertices of copies",
  positions: "positions, floats",
  normals: "normals, floats"
};
const LEGENDS = {
  ring: [["#000", "the ring"], ["#eedebc", "left of it"], ["#c4ccd4", "elsewhere"]],
  classes: [
    ["#65ac59", "T0: no edge on the ring"], ["#e9d9b1", "T1: one edge, left of the ring"],
    ["#ec9742", "T1: one edge, right of it"], ["#467cc8", "T2: two edges"]
  ],
  outlines: [["#000", "silhouettes and creases"], ["#e05a4f", "borders"]],
};

let device, includes, renderer, context, mesh, camera, draw, name = "";

const grouped = (n) => Math.round(n).toLocaleString("en-US");

/** Lists the buffers on the GPU: those that this picture needs, then (fainter) those kept for other pictures. */
function showBytes() {
  const plain = mesh.plainBytes, {slots} = mesh.file, list = Object.entries(mesh.buffers);
  const needed = list.filter(([buffer]) => draw?.needs.has(buffer)),
        kept = list.filter(([buffer]) => !draw?.needs.has(buffer));
  const sum = needed.reduce((total, [, {size}]) => total + size, 0);
  const rows = [
    ...needed.map(([buffer, {size}]) => [NAMES[buffer], size, ""]), ["total for this picture", sum, "sum"],
    [`uncompressed buffers (${(plain / sum).toFixed(1)} times as large)`, plain, ""],
    ...kept.map(([buffer, {size}]) => [`kept for other pictures: ${NAMES[buffer]}`, size, "faint"])
  ];
  showTable(rows);
  const bits = (8 * 4 * mesh.file.stream.length / mesh.file.triangles).toFixed(2);
  element("status").textContent = `${name}: ${mesh.file.kind}, ${grouped(mesh.file.triangles)} triangles` +
    `${slots > mesh.file.triangles ? ` in ${grouped(slots)} slots` : ""}, ${bits} bits per triangle`;
}

function showLegend(view) {
  const note = view === "ring" && mesh?.file.kind === "packed" ?
    " Edges that close a ring are missing: a packed stream does not store where rings close." :
    "";
  element("legend").replaceChildren(
    ...(LEGENDS[view] ?? []).map(([color, text]) => {
      const span = document.createElement("span");
      span.append(Object.assign(document.createElement("i"), {style: `background:${color}`}), text);
      return span;
    }),
    note);
}

let working = Promise.resolve();
/** Queues a piece of work after all earlier ones; shows its error. */
function later(work) {
  working = working.then(work).catch(showError);
  return working;
}

/** Prepares the buffers and pipelines of the chosen picture. */
async function choose() {
  if (!mesh) return;
  const choice = Object.fromEntries(new FormData(panel));
  showError();
  try {
    draw = await renderer.prepare(mesh, {...choice, blocks: choice.blocks !== undefined});
  } finally {
    showLegend(choice.view);
    showBytes();
    changed();
  }
}

let asked = false;
/** Draws once before the next frame. */
function changed() {
  if (asked || !draw) return;
  asked = true;
  requestAnimationFrame(() => {
    asked = false;
    const dark = matchMedia("(prefers-color-scheme: dark)").matches;
    renderer.draw(context.getCurrentTexture(), draw, camera, dark ? [0.098, 0.102, 0.11, 1] : [0.957, 0.953, 0.941, 1]);
  });
}

function resize() {
  Object.assign(canvas, sizeOf(canvas));
  changed();
}

async function open(bytes, called) {
  showError();
  const next = await GpuMesh.create(device, readLr(bytes), includes);
  mesh?.destroy();
  [mesh, draw, name] = [next, undefined, called];
  camera.bounds = mesh.bounds;
  element("hint").hidden = true;
  panel.elements.blocks.disabled = !mesh.position.words;
  if (panel.elements.blocks.disabled) panel.elements.blocks.checked = false;
  const outlines = panel.querySelector("[value=outlines]");
  outlines.disabled = mesh.file.kind !== "lr";
  outlines.parentElement.title = outlines.disabled ? "Outlines need LR tables: encode the file with --format lr" : "";
  if (outlines.checked && outlines.disabled) panel.querySelector("[value=smooth]").checked = true;
  await choose();
}

async function start() {
  [device, includes] = await Promise.all([openDevice(), loadIncludes()]);
  device.lost.then(
    ({message, reason}) =>
      reason !== "destroyed" && showError(new Error(`The GPU was lost: ${message} Load the page again.`)));
  device.addEventListener("uncapturederror", ({error}) => showError(error));
  const format = navigator.gpu.getPreferredCanvasFormat();
  renderer = new Renderer(device, format, 4);
  context = canvas.getContext("webgpu");
  context.configure({device, format, alphaMode: "opaque"});
  camera = new Orbit({center: [0, 0, 0], radius: 1});
  camera.listen(canvas, changed);
  new ResizeObserver(resize).observe(canvas);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", changed);
  panel.addEventListener("change", () => later(choose));
  await listenForFiles(later, open);
}

/** For tests: resolves when all queued work is done and drawn. */
window.idle = () => later(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
later(start);
