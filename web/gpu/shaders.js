// The page's WGSL. Shaders are assembled from shaders/include/*.wgsl and one snippet each for the source of triangles,
// positions and copies.

const INCLUDES = ["lacedring", "lacedring_vertices", "lacedring_seams", "lacedring_operators"];

/** Loads the files of shaders/include, by name. scripts/web serves them as /shaders/. */
export async function loadIncludes(folder = new URL("../shaders/", import.meta.url)) {
  const texts = await Promise.all(INCLUDES.map(async (name) => {
    const response = await fetch(new URL(`${name}.wgsl`, folder));
    if (!response.ok)
      throw new Error(
        `${name}.wgsl was not found: the server must have shaders/include as /shaders/, as scripts/web does`);
    return response.text();
  }));
  return Object.fromEntries(INCLUDES.map((name, i) => [name, texts[i]]));
}

const STREAM = {
  stream: ["read", "u32"]
};

/** Access to the words of a stream, and fn ring_edge(a, b): whether b is the next vertex after a on its ring. */
const EDGES = {
  lean: `fn lr_stream_word(i: u32) -> u32 { return stream[i]; }
fn ring_edge(a: u32, b: u32) -> bool {
  let lean = lr_lean_layout();
  if (a >= lean.rings2 + lean.rings1) { return false; }
  let two_sided = a < lean.rings2;
  let at = select(a + lean.rings2, 2u * a, two_sided);
  return lr_lean_next(a, lr_lean_word(at), lr_lean_word(select(at, at + 1u, two_sided))) == b;
}`,
  // A packed stream numbers vertices along the rings and does not store where a ring ends.
  packed: `fn lr_stream_word(i: u32) -> u32 { return stream[i]; }
fn ring_edge(a: u32, b: u32) -> bool { return b == a + 1u; }`,
  lr: `fn lr_table_word(i: u32) -> u32 { return stream[i]; }
fn ring_edge(a: u32, b: u32) -> bool { return a < lr_table_word(LR_TABLE_WORD_RING) && lr_ring_next(a) == b; }`,
};

/** fn triangle_of(t): decodes triangle t from the stream. */
const PULL = {
  lean: "fn triangle_of(t: u32) -> vec3u { return lr_lean_triangle(lr_lean_layout(), t); }",
  packed: "fn triangle_of(t: u32) -> vec3u { return lr_packed_triangle(lr_packed_layout(), t); }",
  // Numbers that are not canonical give degenerate triangles.
  lr: `fn triangle_of(t: u32) -> vec3u {
  let lr = lr_op_layout();
  if (!lr_is_canonical(lr, t)) { return vec3u(0u); }
  return vec3u(lr_vertex(lr, 4u * t), lr_vertex(lr, 4u * t + 1u), lr_vertex(lr, 4u * t + 2u));
}`,
};

/**
 * { table, code } that reads a stream's words, ring edges and triangles. indices: reads triangles from the expanded
 * index buffer.
 */
function triangles(includes, kind, indices) {
  const include = includes[kind === "lr" ? "lacedring_operators" : "lacedring"];
  if (!indices) return {table: STREAM, code: include + EDGES[kind] + PULL[kind]};
  return {
    table: {...STREAM, indices: ["read", "u32"]},
    code: `${include}${EDGES[kind]}
fn triangle_of(t: u32) -> vec3u { return vec3u(indices[3u * t], indices[3u * t + 1u], indices[3u * t + 2u]); }`,
  };
}

/**
 * Expands a stream to an index list. One invocation expands four triangles of a packed stream, or one slot of other
 * streams.
 */
export function expandShader(includes, kind) {
  const run = kind === "packed" ? `fn run(i: u32) {
  let p = lr_packed_layout();
  let count = min(lr_packed_triangles(p) - 4u * i, 4u);
  lr_packed_triangles_of_quad(p, 4u * i, count);
  for (var j = 0u; j < count; j++) { put(4u * i + j, lr_packed_quad[j]); }
}` :
                                  "fn run(i: u32) { put(i, triangle_of(i)); }";
  const {table, code} = triangles(includes, kind, false);
  return {
    table: {...table, expanded: ["write", "u32"]},
    code: `${code}
fn put(t: u32, v: vec3u) { for (var k = 0u; k < 3u; k++) { expanded[3u * t + k] = v[k]; } }
${run}`,
  };
}

/** Decodes a seam section: vertex blocks (seam_pass 0), then triangle blocks (seam_pass 1). */
export function seamShader(includes) {
  return {
    table: {
      seams: ["read", "u32"],
      indices: ["read", "u32"],
      homes: ["write", "u32"],
      copies: ["write", "u32"],
      vertex_of: ["write", "u32"],
      sizes: ["uniform", "vec4u"]
    },
    code: `${includes.lacedring_seams}
override seam_pass: u32;
fn lr_seam_word(i: u32) -> u32 { return seams[i]; }
fn lr_seam_put_home(v: u32, value: u32) { homes[v] = value; }
fn lr_seam_home(v: u32) -> u32 { return homes[v]; }
fn lr_seam_vertex(k: u32) -> u32 { return indices[k]; }
fn lr_seam_copy(k: u32) -> u32 { return copies[k]; }
fn lr_seam_put_copy(k: u32, value: u32) { copies[k] = value; }
fn lr_seam_put_vertex(copy: u32, v: u32) { if (copy < sizes.z) { vertex_of[copy] = v; } }
fn run(i: u32) {
  let section = lr_seam_layout(sizes.x, sizes.y);
  if (seam_pass == 0u) { lr_seam_vertex_block(section, i); } else { lr_seam_triangle_block(section, i); }
}`,
  };
}

/**
 * Decodes a vertex stream of 2 or 3 integers to three floats per vertex. One invocation decodes a block of 128
 * vertices.
 */
export function vertexShader(includes, integers) {
  return {
    table: {words: ["read", "u32"], floats: ["write", "f32"]},
    code: `const LR_VERTEX_COMPONENTS = ${integers}u;
${includes.lacedring_vertices}
var<private> layout_of_stream: LrVertexLayout;
fn lr_vertex_word(i: u32) -> u32 { return words[i]; }
fn lr_vertex_put(i: u32) {
  if (layout_of_stream.mapping == LR_MAPPING_OCTAHEDRAL) {
    let n = normalize(vec3f(lr_vertex_direction(layout_of_stream, lr_vertex_value[0], lr_vertex_value[1])));
    for (var c = 0u; c < 3u; c++) { floats[3u * i + c] = n[c]; }
  } else {
    for (var c = 0u; c < ${integers}u; c++) {
      floats[3u * i + c] = bitcast<f32>(lr_vertex_float(layout_of_stream, ${integers}u * i + c, lr_vertex_value[c]));
    }
  }
}
fn run(i: u32) {
  layout_of_stream = lr_vertex_layout();
  lr_vertex_block(layout_of_stream, i, 128u);
}`,
  };
}

/**
 * Computes smooth normals for files without normals, in two passes. Sums are integers, so the result does not depend
 * on their order.
 */
export function normalShaders(includes, kind, indices) {
  const {table, code} = triangles(includes, kind, indices);
  return [
    {
      table: {...table, positions: ["read", "f32"], sums: ["write", "atomic<i32>"]},
      code: `${code}
${POSITIONS.floats.code}
fn run(t: u32) {
  let v = triangle_of(t);
  if (v.x == v.y) { return; }
  let p = array(position(v.x), position(v.y), position(v.z));
  let across = cross(p[1] - p[0], p[2] - p[0]);
  if (!(dot(across, across) > 0.0)) { return; }
  for (var k = 0u; k < 3u; k++) {  // weighted by the angle
    let a = normalize(p[(k + 1u) % 3u] - p[k]);
    let b = normalize(p[(k + 2u) % 3u] - p[k]);
    let n = vec3i(normalize(across) * acos(clamp(dot(a, b), -1.0, 1.0)) * 1048576.0);
    for (var c = 0u; c < 3u; c++) { atomicAdd(&sums[3u * v[k] + c], n[c]); }
  }
}`,
    },
    {
      table: {sums: ["read", "i32"], floats: ["write", "f32"]},
      code: `fn run(v: u32) {
  let sum = vec3f(vec3i(sums[3u * v], sums[3u * v + 1u], sums[3u * v + 2u]));
  let n = sum / max(length(sum), 1.0);
  for (var c = 0u; c < 3u; c++) { floats[3u * v + c] = n[c]; }
}`,
    }
  ];
}

/** fn position(v): reads the decoded position, or decodes v's block up to v. */
const POSITIONS = {
  floats: {
    table: {positions: ["read", "f32"]},
    code:
      "fn position(v: u32) -> vec3f { return vec3f(positions[3u * v], positions[3u * v + 1u], positions[3u * v + 2u]); }",
  },
  blocks: {
    table: {position_words: ["read", "u32"]},
    code: `fn lr_vertex_word(i: u32) -> u32 { return position_words[i]; }
fn lr_vertex_put(i: u32) {}
fn position(v: u32) -> vec3f {
  let p = lr_vertex_layout();
  lr_vertex_block(p, v / 128u, v % 128u + 1u);
  var at: vec3f;
  for (var c = 0u; c < 3u; c++) { at[c] = bitcast<f32>(lr_vertex_float(p, 3u * v + c, lr_vertex_value[c])); }
  return at;
}`,
  },
};

const FRAME = `struct Frame { clip_from_world: mat4x4f, eye: vec4f, crease_cos: f32 }
`;

const SURFACE = `
override marked: bool = false;  // whether the view shows ring edges
struct Corner {
  @builtin(position) @invariant clip: vec4f,
  @location(0) world: vec3f,
  @location(1) normal: vec3f,
  @location(2) place: vec3f,                   // barycentric coordinates
  @location(3) @interpolate(flat) edges: u32,  // bit k: the edge opposite corner k is on the ring; bit 3 + k: the triangle is left of it
}
fn corner(v: u32, copy: u32) -> Corner {
  var out: Corner;
  out.world = position(v);
  out.normal = normal(copy);
  out.clip = frame.clip_from_world * vec4f(out.world, 1.0);
  return out;
}
fn edges_of(v: vec3u) -> u32 {
  var edges = 0u;
  for (var k = 0u; k < 3u; k++) {
    let a = v[(k + 1u) % 3u];
    let b = v[(k + 2u) % 3u];
    if (ring_edge(a, b)) { edges |= 9u << k; }
    if (ring_edge(b, a)) { edges |= 1u << k; }
  }
  return edges;
}
// Without index and vertex buffers: three vertices per triangle.
@vertex fn pulled(@builtin(vertex_index) i: u32) -> Corner {
  let v = triangle_of(i / 3u);
  let k = i % 3u;
  var out = corner(v[k], copy_of(i, v[k]));
  out.place[k] = 1.0;
  if (marked) { out.edges = edges_of(v); }
  return out;
}
// With an index buffer: over copies if normals belong to copies.
@vertex fn indexed(@builtin(vertex_index) i: u32) -> Corner { return corner(vertex_of_copy(i), i); }

fn lit(color: vec3f, n: vec3f, world: vec3f) -> vec4f {
  let to_eye = normalize(frame.eye.xyz - world);
  let m = select(-n, n, dot(n, to_eye) >= 0.0);
  let light = 0.25 + 0.2 * m.y + 0.6 * max(dot(m, to_eye), 0.0);
  return vec4f(pow(color * light, vec3f(1.0 / 2.2)), 1.0);
}
fn flat_normal(world: vec3f) -> vec3f { return normalize(cross(dpdx(world), dpdy(world))); }
const GRAY = vec3f(0.62, 0.62, 0.6);
@fragment fn smooth_view(in: Corner) -> @location(0) vec4f { return lit(GRAY, normalize(in.normal), in.world); }
@fragment fn flat_view(in: Corner) -> @location(0) vec4f { return lit(GRAY, flat_normal(in.world), in.world); }
// The fraction of the pixel that the ring's line covers.
fn line(in: Corner) -> f32 {
  let distance = in.place / max(fwidth(in.place), vec3f(1e-6));
  var nearest = 9.0;
  for (var k = 0u; k < 3u; k++) {
    if (((in.edges >> k) & 1u) != 0u) { nearest = min(nearest, distance[k]); }
  }
  return clamp(1.6 - nearest, 0.0, 1.0);
}
@fragment fn ring_view(in: Corner) -> @location(0) vec4f {
  let left = ((in.edges >> 3u) & 7u) != 0u;
  let base = lit(select(vec3f(0.55, 0.6, 0.66), vec3f(0.85, 0.75, 0.55), left), flat_normal(in.world), in.world);
  return mix(base, vec4f(0.0, 0.0, 0.0, 1.0), line(in));
}
@fragment fn class_view(in: Corner) -> @location(0) vec4f {
  let count = countOneBits(in.edges & 7u);
  let left = (in.edges >> 3u) != 0u;
  var color = vec3f(0.13, 0.42, 0.1);  // T0; the colors are the viewer's
  if (count == 1u) { color = select(vec3f(0.84, 0.31, 0.055), vec3f(0.82, 0.7, 0.44), left); }  // T1, right and left
  if (count > 1u) { color = vec3f(0.06, 0.2, 0.58); }  // T2
  return mix(lit(color, flat_normal(in.world), in.world), vec4f(0.0, 0.0, 0.0, 1.0), 0.6 * line(in));
}
@fragment fn pale_view(in: Corner) -> @location(0) vec4f {
  return mix(lit(GRAY, flat_normal(in.world), in.world), vec4f(1.0), 0.75);
}
`;

/**
 * Draws the surface. positions: "floats" or "blocks"; hasCopies: normals belong to copies; without hasNormals, normals
 * are 0.
 */
export function surfaceShader(includes, {kind, indices, positions, hasCopies, hasNormals}) {
  const source = triangles(includes, kind, indices), vertices = POSITIONS[positions];
  const table = {...source.table, ...vertices.table, frame: ["uniform", "Frame"]};
  if (hasNormals) table.normals = ["read", "f32"];
  if (hasCopies) Object.assign(table, {copies: ["read", "u32"], vertex_of: ["read", "u32"]});
  const blocks = positions === "blocks" ? `const LR_VERTEX_COMPONENTS = 3u;\n${includes.lacedring_vertices}` : "";
  return {
    table,
    code: `${FRAME}${source.code}${blocks}${vertices.code}
fn normal(c: u32) -> vec3f { return ${
      hasNormals ? "vec3f(normals[3u * c], normals[3u * c + 1u], normals[3u * c + 2u])" : "vec3f(0.0)"}; }
fn copy_of(i: u32, v: u32) -> u32 { return ${hasCopies ? "copies[i]" : "v"}; }
fn vertex_of_copy(c: u32) -> u32 { return ${hasCopies ? "vertex_of[c]" : "c"}; }
${SURFACE}`,
  };
}

/**
 * Draws silhouettes, borders and creases, found by LR tables. Two vertices per corner: the ends of the edge opposite
 * it.
 */
export function outlineShader(includes, positions) {
  const vertices = POSITIONS[positions];
  const blocks = positions === "blocks" ? `const LR_VERTEX_COMPONENTS = 3u;\n${includes.lacedring_vertices}` : "";
  return {
    table: {...STREAM, ...vertices.table, frame: ["uniform", "Frame"]},
    code: `${FRAME}${includes.lacedring_operators}${EDGES.lr}${blocks}${vertices.code}
struct Line { @builtin(position) clip: vec4f, @location(0) @interpolate(flat) is_border: u32 }
@vertex fn vertex(@builtin(vertex_index) i: u32) -> Line {
  let lr = lr_op_layout();
  let t = i / 6u;
  let c = 4u * t + (i % 6u) / 2u;
  let nowhere = Line(vec4f(2.0, 2.0, 2.0, 1.0), 0u);
  if (!lr_is_canonical(lr, t)) { return nowhere; }
  let o = lr_opposite(lr, c);
  if (o < c) { return nowhere; }  // drawn from the other side
  let from_vertex = lr_vertex(lr, lr_next(c));
  let to_vertex = lr_vertex(lr, lr_previous(c));
  let a = position(from_vertex);
  let b = position(to_vertex);
  let is_border = o == LR_TABLE_NULL;
  if (!is_border) {
    let near = cross(b - a, position(lr_vertex(lr, c)) - a);
    let far = cross(position(lr_vertex(lr, o)) - a, b - a);
    let to_eye = frame.eye.xyz - a;
    let silhouette = (dot(near, to_eye) > 0.0) != (dot(far, to_eye) > 0.0);
    let lengths = length(near) * length(far);
    if (!silhouette && !(lengths > 0.0 && dot(near, far) < frame.crease_cos * lengths)) { return nowhere; }
  }
  let world = select(b, a, (i & 1u) == 0u);
  let lifted = mix(world, frame.eye.xyz, 0.002);  // a little in front of the surface
  return Line(frame.clip_from_world * vec4f(lifted, 1.0), u32(is_border));
}
@fragment fn fragment(in: Line) -> @location(0) vec4f { return select(vec4f(0.0, 0.0, 0.0, 1.0), vec4f(0.75, 0.1, 0.1, 1.0), in.is_border != 0u); }
`,
  };
}
