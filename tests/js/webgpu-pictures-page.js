// Draws .lr files by every path of web/gpu and from the CPU's index buffer, and counts the pixels that differ.
import {Orbit} from "/gpu/camera.js";
import {Gl2Mesh, loadGlsl} from "/gpu/gl2.js";
import {createBuffer, openDevice, readBuffer} from "/gpu/gpu.js";
import {readLr} from "/gpu/lr-file.js";
import {GpuMesh} from "/gpu/mesh.js";
import {Renderer} from "/gpu/renderer.js";
import {loadIncludes} from "/gpu/shaders.js";

const WIDTH = 640, HEIGHT = 480, BACKGROUND = [0, 0, 0, 0];
// Meshes of more slots are not drawn with positions decoded from blocks, which reads half a block per corner.
const MOST_BLOCKS = 100000;

let device, includes, renderer, target;
window.open_ = async () => {
  [device, includes] = await Promise.all([openDevice(), loadIncludes()]);
  device.addEventListener("uncapturederror", ({error}) => console.error(error.message));
  renderer = new Renderer(device, "rgba8unorm");
  target = device.createTexture(
    {size: [WIDTH, HEIGHT], format: "rgba8unorm", usage: GPUTextureUsage.RENDER_ATTACHMENT | GPUTextureUsage.COPY_SRC});
};

/** The pixels of the target, one word each. */
async function pixels() {
  const size = 4 * WIDTH * HEIGHT;  // rows are multiples of 256 bytes
  const buffer = device.createBuffer({size, usage: GPUBufferUsage.COPY_DST | GPUBufferUsage.MAP_READ});
  const encoder = device.createCommandEncoder();
  encoder.copyTextureToBuffer({texture: target}, {buffer, bytesPerRow: 4 * WIDTH}, [WIDTH, HEIGHT]);
  device.queue.submit([encoder.finish()]);
  await buffer.mapAsync(GPUMapMode.READ);
  const out = new Uint32Array(buffer.getMappedRange().slice(0));
  buffer.destroy();
  return out;
}

/** Milliseconds of a draw, the minimum of `times` draws. */
async function timed(times, work) {
  let least = Infinity;
  for (let i = 0; i < times; i++) {
    await device.queue.onSubmittedWorkDone();
    const start = performance.now();
    await work();
    await device.queue.onSubmittedWorkDone();
    least = Math.min(least, performance.now() - start);
  }
  return Math.round(10 * least) / 10;
}

const differing = (a, b) => a.reduce((count, pixel, i) => count + (pixel !== b[i]), 0);

/**
 * Compares the paths with the CPU's index buffer, URL.indices (u32). Returns for each view the covered pixels and, by
 * path, the different pixels; the bytes; with `times` > 0 also milliseconds.
 */
window.pictures = async (url, {views, times = 0}) => {
  const load = async (from) => new Uint8Array(await (await fetch(from)).arrayBuffer());
  const mesh = await GpuMesh.create(device, readLr(await load(url)), includes);
  const list = await load(`${url}.indices`),
        plain = {indices: createBuffer(device, "indices", list.length, list), count: list.length / 4};
  const camera = new Orbit(mesh.bounds), out = {views: [], bytes: {}, times: {}};
  const choices = {
    plain: {path: "expand", plain},
    expand: {path: "expand"},
    pull: {path: "pull"},
    ...(mesh.position.words && mesh.file.slots < MOST_BLOCKS ? {"pull, blocks": {path: "pull", blocks: true}} : {})
  };
  for (const view of views) {
    const drawn = {};
    for (const [name, choice] of Object.entries(choices)) {
      const draw = await renderer.prepare(mesh, {...choice, view});
      renderer.draw(target, draw, camera, BACKGROUND);
      drawn[name] = await pixels();
      const list =
        Object.entries(mesh.buffers).filter(([buffer]) => draw.needs.has(buffer)).map(([buffer,
                                                                                        {size}]) => [buffer, size]);
      out.bytes[`${view}, ${name}`] = {list, plain: mesh.plainBytes};
      if (times)
        out.times[`${view}, ${name}`] = await timed(times, () => renderer.draw(target, draw, camera, BACKGROUND));
      if (times && name === "expand") out.times.expanding = await timed(times, () => mesh.expand());
    }
    const {plain: reference, ...others} = drawn;
    out.views.push({
      view,
      covered: reference.reduce((count, pixel) => count + (pixel !== 0), 0),
      different:
        Object.fromEntries(Object.entries(others).map(([name, picture]) => [name, differing(picture, reference)]))
    });
  }
  mesh.destroy();
  plain.indices.destroy();
  return out;
};

/**
 * Draws the pictures in WebGL2 with flat shading. Returns { covered, different: pixels, floats: differing words of
 * positions }.
 */
window.picturesGl2 = async (url) => {
  const load = async (from) => new Uint8Array(await (await fetch(from)).arrayBuffer());
  const gl = new OffscreenCanvas(WIDTH, HEIGHT).getContext("webgl2", {antialias: false});
  const mesh = new Gl2Mesh(gl, readLr(await load(url)), await loadGlsl()), list = await load(`${url}.indices`);
  const indices = gl.createBuffer(), camera = new Orbit(mesh.bounds).matrices(WIDTH / HEIGHT);
  gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, indices);
  gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, list, gl.STATIC_DRAW);
  const pictures = [[], [indices, list.length / 4]].map((from) => {
    mesh.draw(camera, BACKGROUND, ...from);
    const out = new Uint32Array(WIDTH * HEIGHT);
    gl.readPixels(0, 0, WIDTH, HEIGHT, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(out.buffer));
    return out;
  });
  const gpu = await GpuMesh.create(device, mesh.file, includes);
  const words = new Uint32Array(mesh.floats.buffer), expected = await readBuffer(device, gpu.buffers.positions);
  const out = {
    covered: pictures[1].reduce((count, pixel) => count + (pixel !== 0), 0),
    different: differing(...pictures),
    floats: differing(words, expected),
    error: gl.getError()
  };
  gpu.destroy();
  mesh.destroy();
  return out;
};
