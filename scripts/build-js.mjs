// node build-js.mjs WORK OUT: writes the .wasm files of WORK as modules to OUT/wasm, and prints a table of sizes.
import {readdirSync, readFileSync, writeFileSync} from "node:fs";
import {brotliCompressSync} from "node:zlib";

const [work, out] = process.argv.slice(2);
const rows = [];
for (const file of readdirSync(work).filter((name) => name.endsWith(".wasm")).sort()) {
  const wasm = readFileSync(`${work}/${file}`);
  const module = `// ${file} in base64, by scripts/build-js.\nexport default "${wasm.toString("base64")}";\n`;
  writeFileSync(`${out}/wasm/${file.replace(".wasm", ".js")}`, module);
  rows.push([file, wasm.length, module.length, brotliCompressSync(module).length]);
}
for (const file of readdirSync(out).filter((name) => name.endsWith(".js")).sort()) {
  const script = readFileSync(`${out}/${file}`);
  rows.push([file, "", script.length, brotliCompressSync(script).length]);
}
const show = (cells) =>
  console.log(cells.map((cell, i) => i === 0 ? String(cell).padEnd(20) : String(cell).padStart(9)).join(""));
show(["bytes", "wasm", "script", "brotli"]);
rows.forEach(show);
