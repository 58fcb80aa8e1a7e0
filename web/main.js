// The page: opens files, shows the mesh, its sizes and times.
import {cancel} from "./encoder.js";
import {open} from "./open.js";
import {Viewer} from "./viewer.js";

const [canvas, empty, error, name, summary, sizes, numbers, note, samples, stage, file, ring, turn, lossless] = [
  "canvas", "empty", "error", "name", "summary", "sizes", "numbers", "note", "samples", "stage", "file", "ring", "turn",
  "lossless"
].map((id) => document.getElementById(id));
const count = new Intl.NumberFormat("en-US"), put = (id, text) => {
  document.getElementById(id).textContent = text;
};
const time = (ms) =>
  (ms < 10 ? `${ms.toFixed(1)} ms` :
     ms < 1000 ? `${ms.toFixed(0)} ms` :
                 `${(ms / 1000).toFixed(1)} s`);
const share = (part, whole) => `${(100 * part / whole).toFixed(part / whole < 0.1 ? 1 : 0)} %`;

let viewer, shown, last = 0;  // shown: {title, bytes, brotli} of the file in the picture
// For tests. count: files shown or refused; viewer; started: promise that resolves when the first sample is drawn.
const forTests = window.page = {
  count: 0
};

function fail(title, {message}) {
  error.textContent = `${title ? `${title}: ` : ""}${message.split("\n")[0]}`;
  error.hidden = false;
  if (!shown) {
    name.textContent = "";
    empty.hidden = false;
  }
}

function showSizes({plain, ours, ourName}, brotli) {
  const rows = {plain: {...plain, brotli: brotli?.plain}, our: {...ours, brotli: brotli?.ours}};
  put("ourName", ourName);
  for (const column of ["bytes", "gzip", "brotli"]) {
    const id = column[0].toUpperCase() + column.slice(1), known = rows.plain[column] !== undefined;
    for (const row of ["plain", "our"]) put(row + id, known ? count.format(rows[row][column]) : "");
    put(`share${id}`, known ? share(rows.our[column], rows.plain[column]) : "");
  }
  sizes.classList.toggle("has-brotli", brotli !== undefined);
  sizes.hidden = false;
}

function showFigures(title, result, brotli) {
  const {triangles, vertices, plain, ours, decodeMs, encodeMs, whole, images, kind} = result;
  name.textContent = title;
  summary.textContent = `${share(ours.bytes, plain.bytes)} of the size of plain glTF, decoded in ${time(decodeMs)}`;
  showSizes(result, brotli);
  const rows = [
    ["triangles", count.format(triangles)], ["vertices", count.format(vertices)],
    ...(images === undefined ? [["bits per triangle, whole file", (8 * ours.bytes / triangles).toFixed(1)]] : []),
    ...(encodeMs ? [["encoding time", time(encodeMs)]] : [])
  ];
  numbers.replaceChildren(...rows.flatMap(
    (row) => row.map((text, i) => Object.assign(document.createElement(i ? "dd" : "dt"), {textContent: text}))));
  const both = images ? `Both sizes include ${count.format(images)} bytes of images.` : "";
  note.textContent = whole ?
    `Sizes of triangles and vertices only, ${
      lossless.checked ? "lossless" :
                         "with positions rounded to 14 bits, normals to 10, texture coordinates to 12"}. ` +
      `The whole file has ${
        count.format(whole)} bytes; the program "lacedring pack" compresses all of it to one .glb.` :
    both;
  document.getElementById("losslessSwitch").hidden = !["glb", "gltf"].includes(kind);
  canvas.setAttribute("aria-label", `${title}: ${count.format(triangles)} triangles`);
}

/**
 * Shows a file, or its error; on an error the mesh shown before stays. Resolves when the mesh or error is on the page.
 */
async function show(title, bytes, brotli) {
  const own = ++last;
  cancel();
  error.hidden = true;
  stage.setAttribute("aria-busy", "true");
  const busy = (text) => {
    name.textContent = text;
  };
  busy(`Opening ${title}…`);
  try {
    const data = bytes instanceof Uint8Array ? bytes : new Uint8Array(await bytes.arrayBuffer());
    const progress = (done, of) => {
      if (own === last) busy(of > 1 ? `Encoding ${title}, mesh ${done + 1} of ${of}…` : `Encoding ${title}…`);
    };
    const result = await open(data, {isLossless: lossless.checked, progress});
    if (own !== last) return;
    shown = {title, bytes: data, brotli};
    viewer.show(result.object, result.animations);
    empty.hidden = true;
    showFigures(title, result, brotli);
  } catch (problem) {
    if (own !== last) return;
    if (shown) name.textContent = shown.title;
    fail(title, problem);
  } finally {
    if (own === last) stage.removeAttribute("aria-busy");
    forTests.count++;
  }
}

/** Fetches and shows one of the samples made by scripts/web. */
async function showSample({file: path, label, brotli}) {
  for (const button of samples.children) button.setAttribute("aria-pressed", String(button.textContent === label));
  const response = await fetch(new URL(path, new URL("samples/", location.href)));
  if (!response.ok) return fail(label, new Error("it could not be read"));
  await show(label, new Uint8Array(await response.arrayBuffer()), brotli);
}

async function start() {
  try {
    viewer = forTests.viewer = new Viewer(canvas);
  } catch {
    return fail("", new Error("This page needs WebGL 2, which this browser does not support."));
  }
  turn.checked = !matchMedia("(prefers-reduced-motion: reduce)").matches;
  viewer.setTurning(turn.checked);
  const response = await fetch("samples/index.json").catch(() => undefined);
  const list = response?.ok ? await response.json() : [];
  samples.replaceChildren(...list.map((sample) => {
    const button = Object.assign(document.createElement("button"), {type: "button", textContent: sample.label});
    button.addEventListener("click", () => showSample(sample).catch((problem) => fail(sample.label, problem)));
    return button;
  }));
  if (list.length > 0) return showSample(list[0]);
  name.textContent = "";
  empty.hidden = false;
}

function showFile(dropped) {
  for (const button of samples.children) button.setAttribute("aria-pressed", "false");
  return show(dropped.name, dropped);
}

file.addEventListener("change", () => {
  if (file.files.length > 0) showFile(file.files[0]);
  file.value = "";
});
addEventListener("dragover", (event) => {
  event.preventDefault();
  stage.classList.add("over");
});
addEventListener("dragleave", ({relatedTarget}) => {
  if (!relatedTarget) stage.classList.remove("over");
});
addEventListener("drop", (event) => {
  event.preventDefault();
  stage.classList.remove("over");
  const dropped = event.dataTransfer.files[0];
  if (dropped) showFile(dropped);
});
ring.addEventListener("change", () => viewer.setRing(ring.checked));
turn.addEventListener("change", () => viewer.setTurning(turn.checked));
lossless.addEventListener("change", () => {
  if (shown) show(shown.title, shown.bytes, shown.brotli);
});
addEventListener("keydown", ({key, target, ctrlKey, metaKey, altKey}) => {
  if (ctrlKey || metaKey || altKey || target.type === "file") return;
  ({e: ring, t: turn})[key.toLowerCase()]?.click();
});
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => viewer?.setColors());

forTests.started = start();
