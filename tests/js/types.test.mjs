// node types.test.mjs: the package's declarations. tsc accepts types.ts, which uses each of them, and every entry of
// the package exports just the values that its .d.ts declares. Exit code 1 otherwise; 77 if npm's registry cannot be
// reached.
import {execFileSync, spawnSync} from "node:child_process";
import {mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, symlinkSync, writeFileSync} from "node:fs";
import {createRequire} from "node:module";
import {tmpdir} from "node:os";
import {dirname, join} from "node:path";
import {fileURLToPath, pathToFileURL} from "node:url";

const here = dirname(fileURLToPath(import.meta.url)), root = join(here, "../.."), built = join(root, "build/js");
const packages =
  spawnSync(join(root, "scripts/node-packages"), {encoding: "utf8", stdio: ["ignore", "pipe", "inherit"]});
if (packages.status !== 0) process.exit(packages.status);
const modules = join(packages.stdout.trim(), "node_modules");
const work = mkdtempSync(join(tmpdir(), "lacedring-types-"));
let failed = false;
const check = (isRight, message) => {
  failed ||= !isRight;
  if (!isRight) console.log(`FAILED ${message}`);
};

try {
  mkdirSync(join(work, "node_modules"));
  symlinkSync(built, join(work, "node_modules/lacedring"));
  for (const name of readdirSync(modules)) symlinkSync(join(modules, name), join(work, "node_modules", name));
  writeFileSync(join(work, "use.ts"), readFileSync(join(here, "types.ts")));
  const compilerOptions = {
    strict: true,
    noEmit: true,
    preserveSymlinks: true,
    module: "nodenext",
    target: "es2022",
    lib: ["es2022", "dom"],
    types: []
  };
  writeFileSync(join(work, "package.json"), JSON.stringify({type: "module"}));
  writeFileSync(join(work, "tsconfig.json"), JSON.stringify({compilerOptions, files: ["use.ts"]}));
  const {status, stdout} = spawnSync("node", [join(modules, "typescript/bin/tsc"), "-p", work], {encoding: "utf8"});
  check(status === 0, `tsc: ${stdout}`);

  const ts = createRequire(join(modules, "typescript/package.json"))("typescript");
  // ./three imports "three", which node does not find beside build/js.
  const entries = Object.entries(JSON.parse(readFileSync(join(built, "package.json"))).exports)
                    .filter(([entry, {types}]) => types && entry !== "./three");
  const program = ts.createProgram(
    entries.map(([, {types}]) => join(built, types)),
    {module: ts.ModuleKind.NodeNext, moduleResolution: ts.ModuleResolutionKind.NodeNext, types: []});
  const checker = program.getTypeChecker();
  for (const [entry, {types, default: script}] of entries) {
    const symbol = checker.getSymbolAtLocation(program.getSourceFile(join(built, types)));
    const isValue = (e) =>
      ((e.flags & ts.SymbolFlags.Alias ? checker.getAliasedSymbol(e) : e).flags & ts.SymbolFlags.Value) !== 0;
    const declared = checker.getExportsOfModule(symbol).filter(isValue).map(({name}) => name).sort().join(", ");
    const exported = Object.keys(await import(pathToFileURL(join(built, script)))).sort().join(", ");
    check(declared === exported, `${entry}: declared are ${declared}; exported are ${exported}`);
  }
} finally {
  rmSync(work, {recursive: true, force: true});
}
console.log(failed ? "types: FAILED" : "types: all good");
process.exit(failed ? 1 : 0);
