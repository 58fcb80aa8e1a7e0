// Damaged files decode or throw LacedRingError, in bounded time and memory. LACEDRING_MUTATIONS: their number (2000);
// LACEDRING_SEED: the first seed. A failure's message has its seed.
import assert from "node:assert/strict";
import {join} from "node:path";
import test from "node:test";

import {damage, mend, random} from "./damage.mjs";
import {encode, root, sources, VARIANTS} from "./files.mjs";

const memories = new Set();
const {Instance} = WebAssembly;
WebAssembly.Instance = function(...args) {
  const made = new Instance(...args);
  memories.add(new WeakRef(made.exports.memory));
  return made;
};
const {validate} = WebAssembly;
const {LacedRingError, ready, decodeMesh} = await import(join(root, "build/js/lacedring.js"));
await ready;
WebAssembly.validate = () => false;
const scalar = await import(join(root, "build/js/lacedring.js") + "?scalar");
await scalar.ready;
WebAssembly.validate = validate;

const count = Number(process.env.LACEDRING_MUTATIONS ?? 2000), first = Number(process.env.LACEDRING_SEED ?? 1);
const MOST = 64 * 2 ** 20;  // bytes that decoding may take

/** Decodes; returns a mesh or the code of an error. */
function outcome(decode, bytes) {
  try {
    return decode(bytes, {limits: {maxMemory: MOST}});
  } catch (error) {
    assert.ok(error instanceof LacedRingError, error.stack);
    assert.ok(!/\n/.test(error.message) && error.code !== "UNKNOWN", error.message);
    return error.code;
  }
}

test("damaged files decode, or throw LacedRingError, in bounded time and memory", () => {
  const files = sources()
                  .flatMap(
                    (source) => Object.keys(VARIANTS).map(
                      (variant) => ({name: `${source.split("/").pop()}, ${variant}`, ...encode(source, variant)})))
                  .filter(({bytes}) => bytes.length < 200000);
  for (const {name, bytes} of files) {  // mend does not change valid files
    const copy = bytes.slice();
    mend(copy);
    assert.deepEqual(copy, bytes, name);
  }
  const codes = {};
  let slowest = 0, largest = 0;
  for (let seed = first; seed < first + count; ++seed) {
    const next = random(seed), {name, bytes} = files[next(files.length)], damaged = damage(bytes, next);
    try {
      const begin = performance.now(), result = outcome(decodeMesh, damaged);
      slowest = Math.max(slowest, performance.now() - begin);
      codes[typeof result === "string" ? result : "decodes"] =
        (codes[typeof result === "string" ? result : "decodes"] ?? 0) + 1;
      const other = outcome(scalar.decodeMesh, damaged);
      if (typeof result === "string")
        assert.equal(typeof other, "string", "the scalar module decodes it");
      else
        assert.deepEqual(other, result);
    } catch (error) {
      error.message = `seed ${seed}, ${name}: ${error.message}`;
      throw error;
    }
    for (const memory of memories) largest = Math.max(largest, memory.deref()?.buffer.byteLength ?? 0);
  }
  console.log(`${count} damaged files: ${JSON.stringify(codes)}; slowest ${slowest.toFixed(1)} ms; largest memory ${
    (largest / 2 ** 20).toFixed(1)} MiB`);
  assert.ok(codes.TRAP === undefined, "a trap");
  assert.ok(largest <= MOST + 2 ** 20);
});
