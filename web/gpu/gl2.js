// Draws a mesh from its stream in WebGL2. The stream is a texture. The vertex shader decodes triangles with
// shaders/include/lacedring.glsl. Positions are decoded once, by a fragment shader with one fragment per vertex.
import {boundsOf} from "./mesh.js";

const WIDTH = 2048;  // of the textures: every WebGL2 device supports 2048 x 2048

// Functions that GLSL ES 3.00 lacks. lacedring.glsl needs them for packed streams, lacedring_vertices.glsl always.
const PRELUDE = `#version 300 es
precision highp float;
precision highp int;
precision highp usampler2D;
uint bitfieldExtract(uint x, int at, int bits) { return bits == 0 ? 0u : x << (32 - bits - at) >> (32 - bits); }
int bitCount(uint x) {
  x -= x >> 1 & 0x55555555u;
  x = (x & 0x33333333u) + (x >> 2 & 0x33333333u);
  return int((x + (x >> 4) & 0x0f0f0f0fu) * 0x01010101u >> 24);
}
int findLSB(uint x) { return x == 0u ? -1 : bitCount((x & (0u - x)) - 1u); }
int findMSB(uint x) {
  for (int k = 1; k < 32; k *= 2) x |= x >> k;
  return bitCount(x) - 1;
}
ivec2 lr_mix(ivec2 a, ivec2 b, bvec2 second) { return ivec2(second.x ? b.x : a.x, second.y ? b.y : a.y); }
#define lr_texel(texture_, i) texelFetch(texture_, ivec2(int(i) % ${WIDTH}, int(i) / ${WIDTH}), 0)
`;

const TRIANGLES = {
  lean: `#define LR_LEAN_WORD(i) lr_texel(stream, i).x
#include "lacedring.glsl"
uvec3 triangle_of(uint t) { return lr_lean_triangle(lr_lean_layout(), t); }`,
  packed: `#define LR_PACKED_WORD(i) lr_texel(stream, i).x
#include "lacedring.glsl"
uvec3 triangle_of(uint t) { return lr_packed_triangle(lr_packed_layout(), t); }`,
};

const VERTEX = (kind, indexed) => `uniform usampler2D stream;
uniform usampler2D positions;
uniform mat4 clip_from_world;
out vec3 world;
${indexed ? "" : TRIANGLES[kind]}
void main() {
  uint i = uint(gl_VertexID);
  ${indexed ? "uint v = i;" : "uint v = triangle_of(i / 3u)[i % 3u];"}
  world = uintBitsToFloat(lr_texel(positions, v).xyz);
  gl_Position = clip_from_world * vec4(world, 1.0);
}`;

const FRAGMENT = `in vec3 world;
uniform vec3 eye;
out vec4 color;
void main() {
  vec3 n = normalize(cross(dFdx(world), dFdy(world))), to_eye = normalize(eye - world);
  n = dot(n, to_eye) < 0.0 ? -n : n;
  color = vec4(pow(vec3(0.62, 0.62, 0.6) * (0.25 + 0.2 * n.y + 0.6 * max(dot(n, to_eye), 0.0)), vec3(1.0 / 2.2)), 1.0);
}`;

const WHOLE =
  "void main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0); }";
// One vertex per fragment: decodes the vertex's block up to it.
const DECODE = `uniform usampler2D words;
out uvec4 place;
void nothing(uint i) {}
#define LR_VERTEX_WORD(i) lr_texel(words, i).x
#define LR_VERTEX_COMPONENTS 3u
#define LR_VERTEX_PUT(i) nothing(i)
#define mix lr_mix
#include "lacedring_vertices.glsl"
void main() {
  uint v = uint(gl_FragCoord.x) + ${WIDTH}u * uint(gl_FragCoord.y);
  LrVertexLayout p = lr_vertex_layout();
  if (v >= p.vertices) discard;
  lr_vertex_block(p, v / 128u, v % 128u + 1u);
  uvec3 bits;
  for (uint c = 0u; c < 3u; ++c) bits[c] = lr_vertex_float(p, 3u * v + c, lr_vertex_value[c]);
  place = uvec4(bits, 0u);
}`;

/** Returns a function that replaces #include lines by the files of shaders/include, and adds the prelude. */
export async function loadGlsl(folder = new URL("../shaders/", import.meta.url)) {
  const texts = {};
  for (const name of ["lacedring.glsl", "lacedring_vertices.glsl"])
    texts[name] = await (await fetch(new URL(name, folder))).text();
  return (text) => PRELUDE + text.replace(/#include "(.*)"/g, (_, name) => texts[name]);
}

function compile(gl, vertex, fragment) {
  const program = gl.createProgram();
  for (const [type, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(type);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader).split("\n")[0]);
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program).split("\n")[0]);
  return program;
}

/** Makes a texture whose texels have `each` words (1 or 4), with `data` or empty. */
function createTexture(gl, what, elements, each, data) {
  const height = Math.max(Math.ceil(elements / WIDTH), 1), most = gl.getParameter(gl.MAX_TEXTURE_SIZE);
  if (height > most) throw new Error(`${what}: needs a texture of ${height} rows; this device allows ${most}`);
  const texture = gl.createTexture(),
        [internal, layout] = each === 1 ? [gl.R32UI, gl.RED_INTEGER] : [gl.RGBA32UI, gl.RGBA_INTEGER];
  let padded = null;
  if (data) (padded = new Uint32Array(each * WIDTH * height)).set(data);
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  gl.texImage2D(gl.TEXTURE_2D, 0, internal, WIDTH, height, 0, layout, gl.UNSIGNED_INT, padded);
  return {texture, height, bytes: 4 * each * WIDTH * height};
}

export class Gl2Mesh {
  /** file: from readLr, lean or packed. glsl: from loadGlsl. */
  constructor(gl, file, glsl) {
    const position = file.attributes.find(({name}) => name === "POSITION");
    if (!(file.kind in TRIANGLES)) throw new Error("The WebGL2 page draws only files with a lean or packed stream.");
    if (!position.words)
      throw new Error("The WebGL2 page needs compressed positions: write the file with `lacedring encode --resident`.");
    Object.assign(this, {gl, file});
    this.stream = createTexture(gl, "stream", file.stream.length, 1, file.stream);
    this.positions = createTexture(gl, "positions", file.vertices, 4);
    const words = createTexture(gl, "vertex stream", position.words.length, 1, position.words);
    this.#decode(glsl, words.texture);
    gl.deleteTexture(words.texture);
    this.pulled = compile(gl, glsl(VERTEX(file.kind, false)), glsl(FRAGMENT));
    this.indexed = compile(gl, glsl(VERTEX(file.kind, true)), glsl(FRAGMENT));
  }

  #decode(glsl, words) {
    const {gl, positions} = this, program = compile(gl, glsl(WHOLE), glsl(DECODE)), target = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, target);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, positions.texture, 0);
    gl.viewport(0, 0, WIDTH, positions.height);
    gl.disable(gl.DEPTH_TEST);
    gl.useProgram(program);
    gl.bindTexture(gl.TEXTURE_2D, words);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    const read = new Uint32Array(4 * WIDTH * positions.height);
    gl.readPixels(0, 0, WIDTH, positions.height, gl.RGBA_INTEGER, gl.UNSIGNED_INT, read);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.deleteFramebuffer(target);
    gl.deleteProgram(program);
    this.floats = new Float32Array(read.buffer)
                    .subarray(0, 4 * this.file.vertices)
                    .filter((_, i) => i % 4 < 3);  // three per vertex
    this.bounds = boundsOf(this.floats);
  }

  destroy() {
    const {gl} = this;
    [this.stream, this.positions].forEach(({texture}) => gl.deleteTexture(texture));
    [this.pulled, this.indexed].forEach((program) => gl.deleteProgram(program));
  }

  /** Draws to the canvas. indices: if given, draws this buffer of `count` u32 instead of the stream. */
  draw({clipFromWorld, eye}, background, indices, count) {
    const {gl} = this, program = indices ? this.indexed : this.pulled,
          uniform = (name) => gl.getUniformLocation(program, name);
    gl.viewport(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight);
    gl.clearColor(...background);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.useProgram(program);
    for (const [unit, name] of ["stream", "positions"].entries()) {
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(gl.TEXTURE_2D, this[name].texture);
      gl.uniform1i(uniform(name), unit);
    }
    gl.activeTexture(gl.TEXTURE0);
    gl.uniformMatrix4fv(uniform("clip_from_world"), false, clipFromWorld);
    gl.uniform3fv(uniform("eye"), eye);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, indices ?? null);
    if (indices)
      gl.drawElements(gl.TRIANGLES, count, gl.UNSIGNED_INT, 0);
    else
      gl.drawArrays(gl.TRIANGLES, 0, 3 * this.file.slots);
  }
}
