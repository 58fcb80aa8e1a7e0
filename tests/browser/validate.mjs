// node validate.mjs PACKAGES [FILE...] [--source SOURCE FILE...]...
// Runs the Khronos glTF validator. A FILE may have no error; one made from a SOURCE may have only the kinds of errors
// and warnings of its source. Exit code 1 otherwise. PACKAGES is the output of scripts/node-packages.
import {readFileSync} from "node:fs";
import {createRequire} from "node:module";
import {basename, dirname, join, resolve} from "node:path";

const [packages, ...args] = process.argv.slice(2);
const {validateBytes} = createRequire(resolve(packages, "package.json"))("gltf-validator");

// A GLB keeps the data URIs of its source .gltf. The validator warns of them only in a GLB.
const ALLOWED = new Set(["DATA_URI_GLB"]);

async function codes(file, folders) {
  const read = (uri) => {
    for (const folder of folders) {
      try {
        return new Uint8Array(readFileSync(join(folder, decodeURIComponent(uri))));
      } catch {
        // in the next folder
      }
    }
    throw new Error(`${uri} is missing`);
  };
  const report = await validateBytes(new Uint8Array(readFileSync(file)), {
    uri: basename(file),
    maxIssues: 0,
    externalResourceFunction: async (uri) => read(uri),
  });
  const found = {errors: new Map(), warnings: new Map()};
  for (const {severity, code, pointer, message} of report.issues.messages) {
    if (severity < 2) (severity ? found.warnings : found.errors).set(code, `${pointer ?? ""} ${message}`);
  }
  return found;
}

let source, expected;
let files = 0, errors = 0, warnings = 0, unexpected = 0;
for (let i = 0; i < args.length; i++) {
  const isSource = args[i] === "--source";
  if (isSource) source = args[++i];
  const found = await codes(args[i], [args[i], ...(source ? [source] : [])].map(dirname));
  files++;
  errors += found.errors.size;
  warnings += found.warnings.size;
  if (isSource) expected = found;
  for (const [severity, all] of Object.entries(found)) {
    for (const [code, text] of all) {
      const isNew =
        !isSource && (expected ? !expected[severity].has(code) && !ALLOWED.has(code) : severity === "errors");
      unexpected += isNew;
      console.log(`${basename(args[i])}: ${severity}: ${code}${
        isNew ? ` (${expected ? "not in the source" : "not allowed"})` : ""} ${text}`);
    }
  }
}
console.log(`${files} files; kinds of errors ${errors}, of warnings ${warnings}, of those that fail ${unexpected}`);
process.exit(unexpected ? 1 : 0);
