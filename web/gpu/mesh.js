// A mesh on the GPU: the unchanged sections of its file, and buffers that compute shaders decode from these on demand.
import {createBuffer, Kernel, readBuffer} from "./gpu.js";
import {expandShader, normalShaders, seamShader, vertexShader} from "./shaders.js";

export class GpuMesh {
  /** Kernels by name, compiled at first use. */
  #kernels = new Map();

  /**
   * Uploads a file (from readLr); includes: from loadIncludes. Decodes positions to find the bounds for the camera;
   * their buffer stays until drop("positions").
   */
  static async create(device, file, includes) {
    const mesh = new GpuMesh();
    Object.assign(mesh, {device, file, includes, buffers: {}});
    const find = (name) => file.attributes.find((attribute) => attribute.name === name);
    mesh.position = find("POSITION");
    const normal = find("NORMAL");
    const drawable = normal &&
      (normal.values ? normal.components === 3 :
                       (normal.mapping === 2 && normal.integers === 2) || normal.mapping === 3);
    if (drawable && normal.components === 3) mesh.normal = normal;
    mesh.hasCopies = mesh.normal?.perCopy === true;
    try {
      mesh.#upload("stream", file.stream);
      if (mesh.hasCopies) mesh.#upload("seams", file.seams, 8);
      for (const [name, attribute] of [["position", mesh.position], ["normal", mesh.normal]])
        if (attribute?.words) mesh.#upload(`${name}_words`, attribute.words);
      await mesh.ensure("positions");
      mesh.bounds =
        boundsOf(new Float32Array((await readBuffer(device, mesh.buffers.positions)).buffer, 0, 3 * file.vertices));
    } catch (error) {
      mesh.destroy();
      throw error;
    }
    return mesh;
  }

  #upload(name, data, more = 0) {
    this.buffers[name] = createBuffer(this.device, name, data.byteLength + more, data);
  }

  async #kernel(name, {table, code}, constants) {
    if (!this.#kernels.has(name)) this.#kernels.set(name, await Kernel.create(this.device, table, code, constants));
    return this.#kernels.get(name);
  }

  /** Makes a buffer unless it exists: "indices", "positions", "normals", or "copies" (with "vertex_of"). */
  async ensure(name) {
    if (this.buffers[name]) return;
    if (name === "indices") await this.expand();
    if (name === "positions") await this.#decode("positions", "position", this.position);
    if (name === "copies") await this.#decodeSeams();
    if (name === "normals")
      await (this.normal ? this.#decode("normals", "normal", this.normal) : this.#computeNormals());
  }

  /** Frees buffers; ensure can make them again. */
  drop(...names) {
    for (const name of names) {
      this.buffers[name]?.destroy();
      delete this.buffers[name];
    }
  }

  destroy() {
    this.drop(...Object.keys(this.buffers));
  }

  /** Expands the stream to the index buffer, even if that exists (benchmarks call this repeatedly). */
  async expand() {
    const {kind, slots} = this.file;
    const kernel = await this.#kernel("expand", expandShader(this.includes, kind));
    this.buffers.indices ??= createBuffer(this.device, "index buffer", 12 * slots);
    kernel.run(
      {stream: this.buffers.stream, expanded: this.buffers.indices}, kind === "packed" ? Math.ceil(slots / 4) : slots);
  }

  async #decode(name, source, attribute) {
    if (attribute.values) return this.#upload(name, attribute.values);
    const kernel =
      await this.#kernel(name, vertexShader(this.includes, attribute.integers), {LR_VERTEX_MAPPING: attribute.mapping});
    this.buffers[name] = createBuffer(this.device, name, 12 * attribute.count);
    kernel.run({words: this.buffers[`${source}_words`], floats: this.buffers[name]}, Math.ceil(attribute.count / 128));
  }

  async #decodeSeams() {
    const {device, file} = this, hadIndices = this.buffers.indices !== undefined;
    await this.ensure("indices");
    const homes = createBuffer(device, "homes", 4 * (file.vertices + 1));
    const sizes = device.createBuffer({size: 16, usage: GPUBufferUsage.UNIFORM | GPUBufferUsage.COPY_DST});
    device.queue.writeBuffer(sizes, 0, new Uint32Array([file.vertices, file.slots, file.copies, 0]));
    this.buffers.copies = createBuffer(device, "index buffer over copies", 12 * file.slots);
    this.buffers.vertex_of = createBuffer(device, "vertices of copies", 4 * file.copies);
    const {seams, indices, copies, vertex_of} = this.buffers;
    for (const [seam_pass, count] of [file.vertices, file.slots].entries()) {
      const kernel = await this.#kernel(`seams ${seam_pass}`, seamShader(this.includes), {seam_pass});
      kernel.run({seams, indices, homes, copies, vertex_of, sizes}, Math.ceil(count / 512));
    }
    homes.destroy();
    if (!hadIndices) this.drop("indices");
  }

  async #computeNormals() {
    const {file} = this, hadIndices = this.buffers.indices !== undefined;
    await this.ensure("positions");
    const [add, finish] = normalShaders(this.includes, file.kind, hadIndices);
    const sums = createBuffer(this.device, "sums of normals", 12 * file.vertices);
    const adding = await this.#kernel(`normals ${hadIndices}`, add), finishing = await this.#kernel("normals", finish);
    adding.run(
      {stream: this.buffers.stream, indices: this.buffers.indices, positions: this.buffers.positions, sums},
      file.slots);
    this.buffers.normals = createBuffer(this.device, "normals", 12 * file.vertices);
    finishing.run({sums, floats: this.buffers.normals}, file.vertices);
    sums.destroy();
  }

  /**
   * Bytes of uncompressed buffers for the same picture: three indices per triangle, positions and, if used, normals as
   * floats.
   */
  get plainBytes() {
    const {file} = this, vertices = this.hasCopies ? file.copies : file.vertices;
    return 12 * file.triangles + (this.buffers.normals ? 24 : 12) * vertices;
  }
}

/** { center, radius } of the bounding box of positions. */
export function boundsOf(positions) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < positions.length; i++) {
    low[i % 3] = Math.min(low[i % 3], positions[i]);
    high[i % 3] = Math.max(high[i % 3], positions[i]);
  }
  if (!(high[0] >= low[0])) return {center: [0, 0, 0], radius: 1};
  return {center: low.map((x, k) => (x + high[k]) / 2), radius: Math.hypot(...low.map((x, k) => high[k] - x)) / 2 || 1};
}
