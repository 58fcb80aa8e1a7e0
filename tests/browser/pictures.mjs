// node pictures.mjs PACKAGES PLUGIN [--keep FOLDER] [--source SOURCE [--exact FILE | --close FILE | --packed
// FILE]...]... Draws glTF files with three.js in headless Chromium and compares the pictures with those of their
// source. --packed draws with the plug-in and allows no different pixel from the preceding file. Exit code 1: a picture
// differs too much, or the page's console has an error. PACKAGES is the output of scripts/node-packages, PLUGIN the
// output folder of scripts/build-js; --keep writes the pictures as PNG files.
import {mkdirSync, writeFileSync} from "node:fs";
import {basename, dirname, join} from "node:path";
import {fileURLToPath} from "node:url";

import {serve, share} from "../../scripts/web.mjs";

import {Page} from "./chromium.mjs";

// The share of covered pixels that may differ by more than 16 of 255. Equal triangles may differ at equal depth and at
// the edges of texels, because their order and first corners change the last bit.
const LIMITS = {
  "--exact": 0.0002,
  "--close": 0.01,
  "--packed": 0
};

const here = dirname(fileURLToPath(import.meta.url));
const [packages, plugin, ...args] = process.argv.slice(2);
const folders = {
  "": here,
  three: join(packages, "node_modules/three"),
  lacedring: plugin
};
const server = await serve(folders);
const page = new Page();
let failed = 0, keep, source;
try {
  await page.open(`http://127.0.0.1:${server.address().port}/page.html`);
  for (let i = 0; i < args.length; i += 2) {
    const [option, file] = [args[i], args[i + 1]], isPacked = option === "--packed";
    if (option === "--keep") {
      mkdirSync(keep = file, {recursive: true});
      continue;
    }
    if (option === "--source") {
      source = file;
      await page.evaluate("reset()");
    }
    const url = JSON.stringify(share(folders, file, dirname(source)));
    const views = await page.evaluate(`compare(${url}, ${isPacked})`);
    views.forEach(({png, different, over, largest, covered}, view) => {
      const limit = LIMITS[option];
      const wrong = isPacked ? different > 0 : limit ? over > limit * covered : covered < 100;
      failed += wrong;
      console.log(
        `${wrong ? "FAILED " : ""}${basename(file)}, view ${view}: ${covered} pixels covered` +
        (option !== "--source" ?
           `, ${different} differ, ${over} of them by more than 16, largest difference ${largest}` :
           ""));
      if (keep) writeFileSync(join(keep, `${basename(file)}-${view}.png`), Buffer.from(png.split(",")[1], "base64"));
    });
  }
  failed += page.problems.length;
  page.problems.forEach((text) => console.log(`FAILED console: ${text}`));
} finally {
  await page.close();
  server.close();
}
process.exit(failed ? 1 : 0);
