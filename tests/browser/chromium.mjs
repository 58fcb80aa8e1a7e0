// Controls headless Chromium by the DevTools protocol over a pipe.
import {spawn} from "node:child_process";
import {mkdtempSync, rmSync} from "node:fs";
import {tmpdir} from "node:os";
import {join} from "node:path";

// WebGL2 in software (SwiftShader) draws the same pixels on every machine. The sandbox needs rights that containers do
// not have.
const FLAGS = [
  "--headless=new", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--no-first-run",
  "--disable-extensions", "--remote-debugging-pipe"
];
// WebGPU in software. Pages must be served from 127.0.0.1. Without Vulkan the GPU process crashes when a canvas is
// shown.
export const WEBGPU = [
  "--enable-unsafe-webgpu", "--use-webgpu-adapter=swiftshader", "--enable-features=Vulkan", "--use-vulkan=swiftshader"
];

export class Page {
  #process;
  #profile = mkdtempSync(join(tmpdir(), "lacedring-chromium-"));
  #waiting = new Map();
  #listeners = new Map();
  #session;
  #last = 0;  // id of the last message
  #ended;
  #why;  // why the browser ended; undefined while it runs
  /** Errors and warnings of the page's console, and uncaught exceptions. */
  problems = [];

  constructor(flags = []) {
    this.#process = spawn(
      process.env.CHROMIUM ?? "chromium", [...FLAGS, ...flags, `--user-data-dir=${this.#profile}`, "about:blank"],
      {stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"]});
    let text = "";
    this.#process.stdio[4].setEncoding("utf8").on("data", (more) => {
      const messages = (text + more).split("\0");
      text = messages.pop();
      messages.forEach((message) => this.#receive(JSON.parse(message)));
    });
    this.#ended = new Promise((resolve) => {
      this.#process.on("error", ({message}) => resolve(message));
      this.#process.on("exit", (code, signal) => resolve(`ended with ${code ?? signal}`));
    });
    this.#ended.then((why) => {
      this.#why = `Chromium: ${why}`;
      for (const {reject} of this.#waiting.values()) reject(new Error(this.#why));
      this.#waiting.clear();
    });
    this.#process.stdio[3].on("error", () => {});
  }

  #receive({id, method, params, result, error}) {
    if (id === undefined) {
      this.#listeners.get(method)?.(params);
      return;
    }
    const {resolve, reject} = this.#waiting.get(id);
    this.#waiting.delete(id);
    error ? reject(new Error(error.message)) : resolve(result);
  }

  #send(method, params = {}) {
    return new Promise((resolve, reject) => {
      if (this.#why) return reject(new Error(this.#why));
      const id = ++this.#last;
      this.#waiting.set(id, {resolve, reject});
      this.#process.stdio[3].write(JSON.stringify({id, method, params, sessionId: this.#session}) + "\0");
    });
  }

  async open(url) {
    const {targetId} = await this.#send("Target.createTarget", {url: "about:blank"});
    this.#session = (await this.#send("Target.attachToTarget", {targetId, flatten: true})).sessionId;
    await this.#send("Page.enable");
    const tell = (text) => this.problems.push(text);
    this.#listeners.set("Runtime.consoleAPICalled", ({type, args}) => {
      if (type === "error" || type === "warning")
        tell(args.map(({value, description}) => value ?? description).join(" "));
    });
    this.#listeners.set(
      "Runtime.exceptionThrown",
      ({exceptionDetails}) => tell(exceptionDetails.exception?.description ?? exceptionDetails.text));
    this.#listeners.set("Log.entryAdded", ({entry}) => {
      if (entry.level === "error" || entry.level === "warning") tell(`${entry.text} ${entry.url ?? ""}`);
    });
    await this.#send("Runtime.enable");
    await this.#send("Log.enable");
    const loaded = new Promise((resolve) => this.#listeners.set("Page.loadEventFired", resolve));
    await this.#send("Page.navigate", {url});
    await loaded;
  }

  /** Evaluates an expression in the page; awaits promises. */
  async evaluate(expression) {
    const {result, exceptionDetails} =
      await this.#send("Runtime.evaluate", {expression, awaitPromise: true, returnByValue: true});
    if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
    return result.value;
  }

  /** Bytes used after a garbage collection, by JavaScript objects and by arrays and wasm memories. */
  async memory() {
    await this.#send("HeapProfiler.collectGarbage");
    const {usedSize, backingStorageSize} = await this.#send("Runtime.getHeapUsage");
    return {objects: usedSize, arrays: backingStorageSize};
  }

  /** Chooses files in a file input, like a user. `input` is an expression. */
  async choose(input, files) {
    const {result} = await this.#send("Runtime.evaluate", {expression: input});
    await this.#send("DOM.setFileInputFiles", {objectId: result.objectId, files});
  }

  /** Sets the size of the page in pixels, and its color scheme. */
  async show(width, height, scheme = "light") {
    await this.#send("Emulation.setDeviceMetricsOverride", {width, height, deviceScaleFactor: 1, mobile: false});
    await this.#send("Emulation.setEmulatedMedia", {features: [{name: "prefers-color-scheme", value: scheme}]});
  }

  /** The page as a PNG file's bytes. */
  async screenshot() {
    const {data} = await this.#send("Page.captureScreenshot", {format: "png"});
    return Buffer.from(data, "base64");
  }

  async close() {
    await this.#send("Browser.close").catch(() => this.#process.kill());
    await this.#ended;
    rmSync(this.#profile, {recursive: true, force: true, maxRetries: 5, retryDelay: 200});
  }
}
