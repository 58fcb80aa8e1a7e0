// Uses every declaration of the package: tests/js/types.test.mjs has tsc check it.
import {decodeMesh, decodeMeshAsync, decodeTriangle, LacedRingError, ready, validate} from "lacedring";

import type {Attribute, Mesh, Options, Values} from "lacedring";
import * as core from "lacedring/core";
import * as vertices from "lacedring/vertices";
import {encodeMesh, ready as encoderReady} from "lacedring/encode";
import type {EncodeOptions, Source, SourceAttribute} from "lacedring/encode";
import {EXTENSION, splitGltf, unpackGlb, unpackGltf} from "lacedring/gltf";
import type {LoadBuffer, UnpackOptions} from "lacedring/gltf";
import {LacedRingExtension, LacedRingLoader, geometryOf} from "lacedring/three";
import {BufferGeometry} from "three";
import {GLTFLoader} from "three/addons/loaders/GLTFLoader.js";

export async function decode(bytes: Uint8Array): Promise<number> {
  await Promise.all([ready, core.ready, vertices.ready, encoderReady]);
  const options: Options = {limits: {maxMemory: 1 << 20}};
  const mesh: Mesh = decodeMesh(bytes, options);
  const [position]: Attribute[] = mesh.attributes;
  const values: Values = position.values;
  validate(bytes);
  core.validate(bytes);
  const [a, b, c]: [number, number, number] = decodeTriangle(bytes, 0);
  const surface: Uint32Array = mesh.surface?.vertexOf ?? mesh.indices;
  try {
    await decodeMeshAsync(bytes, options);
  } catch (error) {
    if (error instanceof LacedRingError && error.code === "LIMIT") return a + b + c;
  }
  return vertices.decodeMesh(bytes).triangleCount + surface.length + values.length + (mesh.vertexOrder?.length ?? 0);
}

export function encode(indices: Uint16Array, positions: Float32Array, weights: SourceAttribute): Uint8Array {
  const source: Source = {indices, positions, attributes: [weights]};
  const options: EncodeOptions = {positionBits: 14, lossless: false, effort: 3};
  return encodeMesh(source, options);
}

export async function unpack(bytes: Uint8Array, loadBuffer: LoadBuffer): Promise<string> {
  const options: UnpackOptions = {decodeMesh: decodeMeshAsync};
  const {json, binaryChunk} = splitGltf(bytes);
  const {views} = await unpackGltf(json, binaryChunk, loadBuffer, options);
  const plain: Uint8Array = await unpackGlb(bytes);
  return `${EXTENSION} ${views.length} ${plain.length}`;
}

export async function load(url: string): Promise<BufferGeometry> {
  const loader = new GLTFLoader();
  loader.register((parser) => new LacedRingExtension(parser, {decodeMesh: decodeMeshAsync}));
  await loader.loadAsync(url);
  const geometry: BufferGeometry = await new LacedRingLoader().loadAsync(url);
  return geometry.index ? geometry : geometryOf(decodeMesh(new Uint8Array()));
}

// @ts-expect-error: the small modules have no worker
core.decodeMeshAsync;
// @ts-expect-error: bytes are no ArrayBuffer
decodeMesh(new ArrayBuffer(8));
