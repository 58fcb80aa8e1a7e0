// Decodes bytes to typed arrays by each library, for bench.mjs, in node and in pages.

/** Milliseconds per call, measured over enough calls to take 5 ms. */
function time(work) {
  let calls = 0;
  const begin = performance.now();
  let end;
  do {
    work();
    ++calls;
    end = performance.now();
  } while (end - begin < 5);
  return (end - begin) / calls;
}

function decodeDraco(draco, bytes) {
  const decoder = new draco.Decoder(), mesh = new draco.Mesh();
  const status = decoder.DecodeArrayToMesh(bytes, bytes.length, mesh);
  if (!status.ok()) throw new Error(status.error_msg());
  const size = 12 * mesh.num_faces(), indexAt = draco._malloc(size);
  decoder.GetTrianglesUInt32Array(mesh, size, indexAt);
  const indices = new Uint32Array(draco.HEAPF32.buffer, indexAt, size / 4).slice();
  draco._free(indexAt);
  const bytesOf = 12 * mesh.num_points(), at = draco._malloc(bytesOf);
  decoder.GetAttributeDataArrayForAllPoints(
    mesh, decoder.GetAttribute(mesh, decoder.GetAttributeId(mesh, draco.POSITION)), draco.DT_FLOAT32, bytesOf, at);
  const positions = new Float32Array(draco.HEAPF32.buffer, at, bytesOf / 4).slice();
  draco._free(at);
  draco.destroy(mesh);
  draco.destroy(decoder);
  return {indices, positions};
}

/**
 * Minimum and median milliseconds of each library for one mesh, over `rounds` interleaved rounds.
 * mesh: bytes { resident, stored, indices, vertices, draco }, and vertexCount, triangleCount of the meshopt buffers.
 */
export function bench({lacedring, meshopt, draco}, mesh, rounds) {
  const works = {
    resident: () => lacedring.decodeMesh(mesh.resident),
    stored: () => lacedring.decodeMesh(mesh.stored),
    meshoptimizer: () => {
      meshopt.decodeIndexBuffer(new Uint8Array(12 * mesh.triangleCount), 3 * mesh.triangleCount, 4, mesh.indices);
      meshopt.decodeVertexBuffer(new Uint8Array(8 * mesh.vertexCount), mesh.vertexCount, 8, mesh.vertices);
    },
    draco: () => decodeDraco(draco, mesh.draco),
  };
  const times = Object.fromEntries(Object.keys(works).map((name) => [name, []]));
  for (let round = 0; round < rounds + 2; ++round) {  // the first two warm up
    for (const [name, work] of Object.entries(works)) {
      const took = time(work);
      if (round >= 2) times[name].push(took);
    }
  }
  return Object.fromEntries(Object.entries(times).map(([name, all]) => {
    all.sort((a, b) => a - b);
    return [name, {least: all[0], median: all[all.length >> 1]}];
  }));
}
