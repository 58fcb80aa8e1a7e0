// Makes the .lr files that the tests decode, from generated meshes and assets/.
import {execFileSync} from "node:child_process";
import {mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync} from "node:fs";
import {tmpdir} from "node:os";
import {basename, dirname, join} from "node:path";
import {fileURLToPath} from "node:url";

export const root = join(dirname(fileURLToPath(import.meta.url)), "../..");
export const program = process.env.LACEDRING ?? join(root, "build/release/bin/lacedring");
export const work = mkdtempSync(join(tmpdir(), "lacedring-js-"));
process.on("exit", () => rmSync(work, {recursive: true, force: true}));

export function lacedring(...args) {
  execFileSync(program, args, {stdio: ["ignore", "ignore", "pipe"]});
}

/** Writes a grid with normals, texture coordinates and colors that change at a seam in its middle. */
function writeGrid(file) {
  const n = 24, lines = [], faces = [];
  for (const half of [0, 1]) {
    for (let y = 0; y <= n; ++y) {
      for (let x = 0; x <= n; ++x) {
        const z = Math.sin(x / 3) * Math.cos(y / 4), tilt = Math.cos(x / 3) / 3, size = Math.hypot(tilt, 1);
        lines.push([
          x + half * n, y, z.toFixed(4), -tilt / size, 0, 1 / size, (x / n).toFixed(3),
          (half ? 1 - y / n : y / n).toFixed(3), half ? 255 : 9 * x, 10 * y, 99
        ]);
        if (x < n && y < n)
          faces.push([0, 1, n + 2], [0, n + 2, n + 1]),
            faces.push(...faces.splice(-2).map((t) => [3, ...t.map((i) => i + lines.length - 1)]));
      }
    }
  }
  writeFileSync(file, [
    "ply", "format ascii 1.0", `element vertex ${lines.length}`,
    ...["x", "y", "z", "nx", "ny", "nz", "s", "t"].map((p) => `property float ${p}`),
    ...["red", "green", "blue"].map((p) => `property uchar ${p}`), `element face ${faces.length}`,
    "property list uchar int vertex_indices", "end_header", ...lines.map((line) => line.join(" ")),
    ...faces.map((face) => face.join(" "))
  ].join("\n") + "\n");
}

const BITS = ["--positions", "14", "--normals", "10", "--texcoords", "12"];
export const VARIANTS = {
  lean: ["--format", "lean"],
  "lean, 14 bits": ["--format", "lean", ...BITS],
  resident: ["--resident"],
  "resident, 14 bits": ["--resident", ...BITS],
  stored: [],
  "stored, 14 bits": BITS,
  "stored, order kept": ["--keep-order", ...BITS],
};

/** Generated meshes of every kind and the assets, or those of the folder LACEDRING_MESHES if it is set. */
export function sources() {
  const folder = process.env.LACEDRING_MESHES;
  if (folder)
    return readdirSync(folder)
      .filter((name) => /\.(glb|gltf|obj|off|ply|stl)$/.test(name))
      .map((name) => join(folder, name));
  const files = ["globe.glb", "materials.glb", "cut_torus.ply"].map((name) => join(root, "assets", name));
  for (const kind of ["blob", "terrain", "parts", "soup", "moebius", "genus"]) {
    const file = join(work, `${kind}.glb`);
    lacedring("generate", kind, "--triangles", "3000", "--force", "-o", file);
    files.push(file);
  }
  const scene = join(work, "scene.glb"), grid = join(work, "grid.ply");
  execFileSync("python3", ["-B", join(root, "tests/scene/make_scene.py"), scene, join(work, "scene.gltf")]);
  writeGrid(grid);
  return [...files, scene, grid];
}

/** Encodes a mesh; returns the bytes of the .lr file and its path. */
export function encode(source, variant, options = VARIANTS[variant]) {
  const file = join(work, `${basename(source)}.${variant.replaceAll(/\W+/g, "-")}.lr`);
  lacedring("encode", source, ...options, "--force", "-o", file);
  return {file, bytes: new Uint8Array(readFileSync(file))};
}
