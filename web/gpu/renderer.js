// Draws a mesh by one of two paths: "pull" decodes triangles in the vertex shader, "expand" draws an index buffer that
// a compute shader has written.
import {Draw} from "./gpu.js";
import {outlineShader, surfaceShader} from "./shaders.js";

/**
 * Fragment entry points by view. The views ring and classes need whole triangles in the vertex shader; outlines need
 * LR tables.
 */
export const VIEWS = {
  smooth: "smooth_view",
  flat: "flat_view",
  ring: "ring_view",
  classes: "class_view",
  outlines: "pale_view"
};
const CREASE_COS = Math.cos(40 * Math.PI / 180);

export class Renderer {
  #draws = new Map();
  #targets = {};  // depth and, with several samples per pixel, color

  constructor(device, format, samples = 1) {
    Object.assign(this, {device, format, samples});
    this.frame = device.createBuffer({size: 96, usage: GPUBufferUsage.UNIFORM | GPUBufferUsage.COPY_DST});
  }

  async #pipeline(key, shader, options) {
    if (!this.#draws.has(key)) {
      const {device, format, samples} = this;
      this.#draws.set(key, await Draw.create(device, shader.table, shader.code, {format, samples, ...options}));
    }
    return this.#draws.get(key);
  }

  /**
   * Makes the buffers and pipelines that a picture needs; drops unneeded buffers. Returns { record, needs }:
   * record(pass) draws the picture; needs: names of the buffers that it uses. Options: path: "pull" or "expand";
   * blocks: whether the vertex shader decodes positions from vertex blocks; view: one of VIEWS; plain: { indices, count
   * }, an index buffer to draw instead of the expanded one.
   */
  async prepare(mesh, {path, blocks = false, view, plain}) {
    const {file} = mesh, expand = path === "expand";
    if (view === "outlines" && file.kind !== "lr")
      throw new Error("Outlines need LR tables: write the file with `lacedring encode --format lr`.");
    if (blocks && !mesh.position.words)
      throw new Error("The positions of this file are not compressed: there are no vertex blocks to decode.");
    const marked = view === "ring" || view === "classes", hasNormals = view === "smooth",
          hasCopies = hasNormals && mesh.hasCopies;
    if (hasNormals) await mesh.ensure("normals");
    if (hasCopies) await mesh.ensure("copies");
    if (expand) await mesh.ensure("indices");
    if (!blocks) await mesh.ensure("positions");
    if (!expand) mesh.drop("indices");
    if (!hasNormals) mesh.drop("normals");
    if (!hasCopies) mesh.drop("copies", "vertex_of");
    if (blocks) mesh.drop("positions");

    const key = JSON.stringify([file.kind, expand, blocks, view, hasCopies]), positions = blocks ? "blocks" : "floats";
    const shader = surfaceShader(mesh.includes, {kind: file.kind, indices: expand, positions, hasCopies, hasNormals});
    const isIndexed = expand && !marked;  // in an indexed draw, the vertex shader does not know the triangle
    const constants = {marked: marked ? 1 : 0, ...(blocks ? {LR_VERTEX_MAPPING: mesh.position.mapping} : {})};
    const surface =
      await this.#pipeline(key, shader, {vertex: isIndexed ? "indexed" : "pulled", fragment: VIEWS[view], constants});
    const outlines = view !== "outlines" ?
      undefined :
      await this.#pipeline(
        `outlines ${blocks}`, outlineShader(mesh.includes, positions),
        {topology: "line-list", constants: blocks ? {LR_VERTEX_MAPPING: mesh.position.mapping} : {}});
    const buffers = {
      ...mesh.buffers,
      ...(plain ? {indices: plain.indices, copies: plain.indices} : {}),
      frame: this.frame
    };
    const count = plain?.count ?? 3 * file.slots;
    const list = hasCopies ? "copies" : "indices";
    const needs =
      new Set([...surface.bindings.names, ...(outlines?.bindings.names ?? [])].filter((name) => name in mesh.buffers));
    if (isIndexed) {
      ["stream", "indices", "copies"].forEach((name) => needs.delete(name));
      needs.add(list);
    }
    const record = (pass) => {
      surface.use(pass, buffers);
      if (isIndexed) {
        pass.setIndexBuffer(buffers[list], "uint32");
        pass.drawIndexed(count);
      } else {
        pass.draw(count);
      }
      if (!outlines) return;
      outlines.use(pass, buffers);
      pass.draw(6 * file.slots);
    };
    return {record, needs};
  }

  /** Draws a prepared picture to a texture. */
  draw(texture, {record}, camera, background) {
    const {device} = this, {width, height} = texture, {clipFromWorld, eye} = camera.matrices(width / height);
    this.#resize(width, height);
    device.queue.writeBuffer(this.frame, 0, new Float32Array([...clipFromWorld, ...eye, 1, CREASE_COS, 0, 0, 0]));
    const encoder = device.createCommandEncoder();
    const pass = encoder.beginRenderPass({
      colorAttachments:
        [{...this.#color(texture.createView()), clearValue: background, loadOp: "clear", storeOp: "store"}],
      depthStencilAttachment:
        {view: this.#targets.depth.createView(), depthClearValue: 1, depthLoadOp: "clear", depthStoreOp: "discard"},
    });
    record(pass);
    pass.end();
    device.queue.submit([encoder.finish()]);
  }

  #resize(width, height) {
    if (this.#targets.depth?.width === width && this.#targets.depth.height === height) return;
    Object.values(this.#targets).forEach((texture) => texture.destroy());
    const usage = GPUTextureUsage.RENDER_ATTACHMENT;
    const make = (format) =>
      this.device.createTexture({size: [width, height], format, sampleCount: this.samples, usage});
    this.#targets = {depth: make("depth32float"), ...(this.samples > 1 ? {color: make(this.format)} : {})};
  }

  #color(view) {
    return this.samples > 1 ? {view: this.#targets.color.createView(), resolveTarget: view} : {view};
  }
}
