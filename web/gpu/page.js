// Code of both pages: opens files that are dropped, chosen or named in the address, shows errors and the table of
// buffer sizes.

export const element = (id) => document.getElementById(id);

const MOST_PIXELS = 4e6;  // in a canvas

/** Shows an error in the page's error line; without an error, hides the line. */
export function showError(error) {
  element("error").textContent = error?.message ?? "";
  element("error").hidden = !error;
}

/** Shows the table of buffer sizes. rows: [text, bytes, CSS class]. */
export function showTable(rows) {
  element("bytes").replaceChildren(...rows.map(([what, bytes, style]) => {
    const row = document.createElement("tr");
    row.className = style;
    for (const text of [what, bytes.toLocaleString("en-US")])
      row.append(Object.assign(document.createElement("td"), {textContent: text}));
    return row;
  }));
}

/** The size { width, height } that a canvas should have, in device pixels. */
export function sizeOf({clientWidth, clientHeight}) {
  const scale = Math.min(devicePixelRatio, Math.sqrt(MOST_PIXELS / Math.max(clientWidth * clientHeight, 1)));
  return {width: Math.max(1, Math.round(clientWidth * scale)), height: Math.max(1, Math.round(clientHeight * scale))};
}

/**
 * Calls open(bytes, name) for the file named by ?file=URL, and through the queue `later` for each file that is dropped
 * or chosen.
 */
export async function listenForFiles(later, open) {
  const openFile = (file) => file && later(async () => open(new Uint8Array(await file.arrayBuffer()), file.name));
  element("file").addEventListener("change", ({target}) => openFile(target.files[0]));
  addEventListener("dragover", (event) => event.preventDefault());
  addEventListener("drop", (event) => {
    event.preventDefault();
    openFile(event.dataTransfer.files[0]);
  });
  const url = new URLSearchParams(location.search).get("file");
  if (!url) return;
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url}: ${response.status}`);
  await open(new Uint8Array(await response.arrayBuffer()), url.split("/").at(-1));
}
