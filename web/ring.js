// Finds the ring of a mesh whose vertices are in ring order, as in every packed stream: edges from vertex i to i + 1.

/**
 * Numbers the distinct positions in order of appearance: copies at seams get the same number. `firsts`: first vertex
 * of each number.
 */
function weld(position) {
  const {count} = position, bits = new Uint32Array(3 * count), values = new Float32Array(bits.buffer);
  for (let v = 0; v < count; v++) {
    values[3 * v] = position.getX(v) + 0;  // turns -0 into 0
    values[3 * v + 1] = position.getY(v) + 0;
    values[3 * v + 2] = position.getZ(v) + 0;
  }
  const size = 2 ** Math.ceil(Math.log2(2 * count + 2)), table = new Uint32Array(size);  // 1 + a vertex, or 0
  const numbers = new Uint32Array(count), firsts = [];
  for (let v = 0; v < count; v++) {
    const [x, y, z] = [bits[3 * v], bits[3 * v + 1], bits[3 * v + 2]];
    let at = Math.imul(x, 0x9e3779b1) ^ Math.imul(y, 0x85ebca77) ^ Math.imul(z, 0xc2b2ae3d);
    at = (at ^ (at >>> 15)) & (size - 1);
    for (; table[at] !== 0; at = (at + 1) & (size - 1)) {
      const w = table[at] - 1;
      if (bits[3 * w] === x && bits[3 * w + 1] === y && bits[3 * w + 2] === z) break;
    }
    if (table[at] === 0) {
      table[at] = v + 1;
      numbers[v] = firsts.push(v) - 1;
    } else {
      numbers[v] = numbers[table[at] - 1];
    }
  }
  return {numbers, firsts};
}

/** The ring edges of an indexed geometry, as pairs of vertices. Cost: O(V + T). */
export function ringOf({attributes: {position}, index}) {
  const {numbers, firsts} = weld(position), {array} = index;
  const forEachEdge = (use) => {
    for (let i = 0; i < array.length; i++) {
      const a = numbers[array[i]], b = numbers[array[i % 3 === 2 ? i - 2 : i + 1]];
      use(Math.min(a, b), Math.max(a, b));
    }
  };
  const isEdge = new Uint8Array(firsts.length);  // [i]: there is an edge from i to i + 1
  forEachEdge((a, b) => {
    if (b === a + 1) isEdge[a] = 1;
  });
  const lines = [],
        last =
          new Uint32Array(firsts.length);  // last[first]: the last vertex of the run of edges that begins at `first`
  for (let i = 0, first = 0; i < firsts.length; i++) {
    if (isEdge[i]) {
      lines.push(firsts[i], firsts[i + 1]);
    } else {
      last[first] = i;
      first = i + 1;
    }
  }
  forEachEdge((a, b) => {
    if (b < a + 2 || last[a] !== b) return;
    lines.push(firsts[b], firsts[a]);  // closes the ring
    last[a] = 0;
  });
  return Uint32Array.from(lines);
}
