// A mesh on the GPU: the sections of its file as they lie there, and what compute shaders make of them when it is wanted.
import { Kernel, createBuffer, readBuffer } from "./gpu.js";
import { expandShader, normalShaders, seamShader, vertexShader } from "./shaders.js";

export class GpuMesh {
  /** Kernels, by name: compiled when first used. */
  #kernels = new Map();

  /** file: of readLr. includes: of loadIncludes. Uploads it and decodes positions once, for the camera; they stay until drop("positions"). */
  static async create(device, file, includes) {
    const mesh = new GpuMesh();
    Object.assign(mesh, { device, file, includes, buffers: {} });
    const find = (name) => file.attributes.find((attribute) => attribute.name === name);
    mesh.position = find("POSITION");
    const normal = find("NORMAL");
    const drawable = normal && (normal.values ? normal.components === 3 : (normal.mapping === 2 && normal.integers === 2) || normal.mapping === 3);
    if (drawable && normal.components === 3) mesh.normal = normal;
    mesh.hasCopies = mesh.normal?.perCopy === true;
    try {
      mesh.#upload("stream", file.stream);
      if (mesh.hasCopies) mesh.#upload("seams", file.seams, 8);
      for (const [name, attribute] of [["position", mesh.position], ["normal", mesh.normal]])
        if (attribute?.words) mesh.#upload(`${name}_words`, attribute.words);
      await mesh.ensure("positions");
      mesh.bounds = boundsOf(new Float32Array((await readBuffer(device, mesh.buffers.positions)).buffer, 0, 3 * file.vertices));
    } catch (error) {
      mesh.destroy();
      throw error;
    }
    return mesh;
  }

  #upload(name, data, more = 0) {
    this.buffers[name] = createBuffer(this.device, name, data.byteLength + more, data);
  }

  async #kernel(name, { table, code }, constants) {
    if (!this.#kernels.has(name)) this.#kernels.set(name, await Kernel.create(this.device, table, code, constants));
    return this.#kernels.get(name);
  }

  /** Makes a buffer if it is not there: "indices", "positions", "normals", or "copies" (with "vertex_of"). */
  async ensure(name) {
    if (this.buffers[name]) return;
    if (name === "indices") await this.expand();
    if (name === "positions") await this.#decode("positions", "position", this.position);
    if (name === "copies") await this.#decodeSeams();
    if (name === "normals") await (this.normal ? this.#decode("normals", "normal", this.normal) : this.#computeNormals());
  }

  /** Gives buffers back that ensure makes again. */
  drop(...names) {
    for (const name of names) {
      this.buffers[name]?.destroy();
      delete this.buffers[name];
    }
  }

  destroy() {
    this.drop(...Object.keys(this.buffers));
  }

  /** Expands the stream into the index buffer, again if it is there: to be timed. */
  async expand() {
    const { kind, slots } = this.file;
    const kernel = await this.#kernel("expand", expandShader(this.includes, kind));
    this.buffers.indices ??= createBuffer(this.device, "index buffer", 12 * slots);
    kernel.run({ stream: this.buffers.stream, expanded: this.buffers.indices }, kind === "packed" ? Math.ceil(slots / 4) : slots);
  }

  async #decode(name, source, attribute) {
    if (attribute.values) return this.#upload(name, attribute.values);
    const kernel = await this.#kernel(name, vertexShader(this.includes, attribute.integers), { LR_VERTEX_MAPPING: attribute.mapping });
    this.buffers[name] = createBuffer(this.device, name, 12 * attribute.count);
    kernel.run({ words: this.buffers[`${source}_words`], floats: this.buffers[name] }, Math.ceil(attribute.count / 128));
  }

  async #decodeSeams() {
    const { device, file } = this, hadIndices = this.buffers.indices !== undefined;
    await this.ensure("indices");
    const homes = createBuffer(device, "homes", 4 * (file.vertices + 1));
    const sizes = device.createBuffer({ size: 16, usage: GPUBufferUsage.UNIFORM | GPUBufferUsage.COPY_DST });
    device.queue.writeBuffer(sizes, 0, new Uint32Array([file.vertices, file.slots, file.copies, 0]));
    this.buffers.copies = createBuffer(device, "index buffer over copies", 12 * file.slots);
    this.buffers.vertex_of = createBuffer(device, "vertices of copies", 4 * file.copies);
    const { seams, indices, copies, vertex_of } = this.buffers;
    for (const [seam_pass, count] of [file.vertices, file.slots].entries()) {
      const kernel = await this.#kernel(`seams ${seam_pass}`, seamShader(this.includes), { seam_pass });
      kernel.run({ seams, indices, homes, copies, vertex_of, sizes }, Math.ceil(count / 512));
    }
    homes.destroy();
    if (!hadIndices) this.drop("indices");
  }

  async #computeNormals() {
    const { file } = this, hadIndices = this.buffers.indices !== undefined;
    await this.ensure("positions");
    const [add, finish] = normalShaders(this.includes, file.kind, hadIndices);
    const sums = createBuffer(this.device, "sums of normals", 12 * file.vertices);
    const adding = await this.#kernel(`normals ${hadIndices}`, add), finishing = await this.#kernel("normals", finish);
    adding.run({ stream: this.buffers.stream, indices: this.buffers.indices, positions: this.buffers.positions, sums }, file.slots);
    this.buffers.normals = createBuffer(this.device, "normals", 12 * file.vertices);
    finishing.run({ sums, floats: this.buffers.normals }, file.vertices);
    sums.destroy();
  }

  /** Bytes of plain buffers for the same picture: three indices a triangle, floats for positions and, where it has them, normals. */
  get plainBytes() {
    const { file } = this, vertices = this.hasCopies ? file.copies : file.vertices;
    return 12 * file.triangles + (this.buffers.normals ? 24 : 12) * vertices;
  }
}

/** The middle and radius of a box around positions. */
export function boundsOf(positions) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < positions.length; i++) {
    low[i % 3] = Math.min(low[i % 3], positions[i]);
    high[i % 3] = Math.max(high[i % 3], positions[i]);
  }
  if (!(high[0] >= low[0])) return { center: [0, 0, 0], radius: 1 };
  return { center: low.map((x, k) => (x + high[k]) / 2), radius: Math.hypot(...low.map((x, k) => high[k] - x)) / 2 || 1 };
}
