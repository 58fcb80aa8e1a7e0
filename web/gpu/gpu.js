// A thin layer over WebGPU: opens the device, creates buffers within its limits, and compute and render pipelines with
// named bindings.

/** Opens a device with its adapter's limits for buffers. Throws an Error of one line. */
export async function openDevice() {
  if (!navigator.gpu)
    throw new Error(
      "This browser has no WebGPU. The page webgl2.html, next to this one, draws lean and packed files with WebGL2.");
  const adapter = await navigator.gpu.requestAdapter();
  if (!adapter)
    throw new Error("This browser has WebGPU, but no GPU for it: it may have disabled the GPU of this machine.");
  const {maxStorageBufferBindingSize, maxBufferSize} = adapter.limits;
  return adapter.requestDevice({requiredLimits: {maxStorageBufferBindingSize, maxBufferSize}});
}

/** Creates a buffer of `size` bytes, usable as storage and index buffer, and readable. `what` names it in errors. */
export function createBuffer(device, what, size, data) {
  const {maxBufferSize, maxStorageBufferBindingSize} = device.limits;
  const most = Math.min(maxBufferSize, maxStorageBufferBindingSize);
  const padded = Math.max(Math.ceil(size / 4) * 4, 16);
  if (padded > most)
    throw new Error(`${what}: needs a buffer of ${padded.toLocaleString("en-US")} bytes; this device allows ${
      most.toLocaleString("en-US")}`);
  const {STORAGE, INDEX, COPY_SRC, COPY_DST} = GPUBufferUsage;
  const buffer = device.createBuffer({label: what, size: padded, usage: STORAGE | INDEX | COPY_SRC | COPY_DST});
  if (data) device.queue.writeBuffer(buffer, 0, data.buffer, data.byteOffset, data.byteLength);
  return buffer;
}

/** Reads back the words of a buffer. */
export async function readBuffer(device, buffer) {
  const copy = device.createBuffer({size: buffer.size, usage: GPUBufferUsage.COPY_DST | GPUBufferUsage.MAP_READ});
  const encoder = device.createCommandEncoder();
  encoder.copyBufferToBuffer(buffer, 0, copy, 0, buffer.size);
  device.queue.submit([encoder.finish()]);
  await copy.mapAsync(GPUMapMode.READ);
  const words = new Uint32Array(copy.getMappedRange().slice(0));
  copy.destroy();
  return words;
}

// Uses of a binding: the type in the bind group layout, and the declaration in WGSL.
const USES = {
  read: ["read-only-storage", (name, type) => `var<storage, read> ${name}: array<${type}>`],
  write: ["storage", (name, type) => `var<storage, read_write> ${name}: array<${type}>`],
  uniform: ["uniform", (name, type) => `var<uniform> ${name}: ${type}`],
};

/**
 * A shader's bindings, described by a table such as { words: ["read", "u32"], frame: ["uniform", "Frame"] }: makes
 * their WGSL declarations, their layout, and bind groups of buffers with these names.
 */
class Bindings {
  constructor(device, table, visibility) {
    this.device = device;
    this.names = Object.keys(table);
    this.code =
      this.names.map((name, i) => `@group(0) @binding(${i}) ${USES[table[name][0]][1](name, table[name][1])};\n`)
        .join("");
    this.layout = device.createBindGroupLayout({
      entries: this.names.map((name, binding) => ({binding, visibility, buffer: {type: USES[table[name][0]][0]}})),
    });
    this.pipelineLayout = device.createPipelineLayout({bindGroupLayouts: [this.layout]});
  }

  group(buffers) {
    return this.device.createBindGroup({
      layout: this.layout,
      entries: this.names.map((name, binding) => ({binding, resource: {buffer: buffers[name]}})),
    });
  }
}

const LANES = 64;  // invocations per workgroup

/**
 * A compute pipeline. Its code defines `fn run(i: u32)`, which is called for each i below the number of invocations.
 */
export class Kernel {
  static async create(device, table, code, constants = {}) {
    const kernel = new Kernel();
    kernel.bindings = new Bindings(device, {...table, lr_count: ["uniform", "vec4u"]}, GPUShaderStage.COMPUTE);
    kernel.counts = device.createBuffer({size: 16, usage: GPUBufferUsage.UNIFORM | GPUBufferUsage.COPY_DST});
    const main = `@compute @workgroup_size(${
      LANES}) fn main(@builtin(global_invocation_id) at: vec3u, @builtin(num_workgroups) groups: vec3u) {
      let i = at.x + at.y * groups.x * ${LANES}u;  // more than 65,535 groups take a second dimension
      if (i < lr_count.x) { run(i); }
    }`;
    const module = device.createShaderModule({code: kernel.bindings.code + code + main});
    kernel.pipeline =
      await device.createComputePipelineAsync({layout: kernel.bindings.pipelineLayout, compute: {module, constants}});
    return kernel;
  }

  /** Runs the kernel, in a separate submission. */
  run(buffers, invocations) {
    if (invocations === 0) return;
    const {device} = this.bindings, groups = Math.ceil(invocations / LANES);
    const x = Math.min(groups, device.limits.maxComputeWorkgroupsPerDimension);
    device.queue.writeBuffer(this.counts, 0, new Uint32Array([invocations]));
    const encoder = device.createCommandEncoder(), pass = encoder.beginComputePass();
    pass.setPipeline(this.pipeline);
    pass.setBindGroup(0, this.bindings.group({...buffers, lr_count: this.counts}));
    pass.dispatchWorkgroups(x, Math.ceil(groups / x));
    pass.end();
    device.queue.submit([encoder.finish()]);
  }
}

/** A render pipeline. Default entry points: `vertex` and `fragment`. `constants` are for the vertex stage. */
export class Draw {
  static async create(device, table, code, options) {
    const {format, samples = 1, topology = "triangle-list", vertex = "vertex", fragment = "fragment", constants = {}} =
      options;
    const draw = new Draw();
    draw.bindings = new Bindings(device, table, GPUShaderStage.VERTEX | GPUShaderStage.FRAGMENT);
    const module = device.createShaderModule({code: draw.bindings.code + code});
    draw.pipeline = await device.createRenderPipelineAsync({
      layout: draw.bindings.pipelineLayout,
      vertex: {module, entryPoint: vertex, constants},
      fragment: {module, entryPoint: fragment, targets: [{format}]},
      primitive: {topology},
      multisample: {count: samples},
      depthStencil: {format: "depth32float", depthWriteEnabled: true, depthCompare: "less"},
    });
    return draw;
  }

  /** Sets the pipeline and its bindings in a pass. */
  use(pass, buffers) {
    pass.setPipeline(this.pipeline);
    pass.setBindGroup(0, this.bindings.group(buffers));
  }
}
