// Draws glTF files from fixed directions at fixed times of their animations, and compares the pictures.
import * as THREE from "three";
import {GLTFLoader} from "three/addons/loaders/GLTFLoader.js";

const [WIDTH, HEIGHT] = [640, 480];
const VIEWS = [
  {direction: [0.25, 0.2, 1], time: 0},
  {direction: [-0.8, 0.4, -0.6], time: 0.7},
  {direction: [0.9, 0.1, 0.4], time: 1.6},
];

const renderer = new THREE.WebGLRenderer({antialias: false, preserveDrawingBuffer: true});
renderer.setSize(WIDTH, HEIGHT);
document.body.append(renderer.domElement);

/** A sphere around everything that is drawn at time 0. */
function bounds(scene) {
  scene.updateMatrixWorld(true);
  return new THREE.Box3().setFromObject(scene, true).getBoundingSphere(new THREE.Sphere());
}

function cameraOf({center, radius}, direction) {
  const camera = new THREE.PerspectiveCamera(35, WIDTH / HEIGHT, radius * 0.1, radius * 10);
  camera.position.fromArray(direction).normalize().multiplyScalar(radius * 2.7).add(center);
  camera.lookAt(center);
  return camera;
}

function pixels() {
  const gl = renderer.getContext();
  const out = new Uint8Array(4 * WIDTH * HEIGHT);
  gl.readPixels(0, 0, WIDTH, HEIGHT, gl.RGBA, gl.UNSIGNED_BYTE, out);
  return out;
}

/** A mesh of an .lr file, with the material that GLTFLoader gives to a mesh without one. */
async function loadLr(url) {
  const {LacedRingLoader} = await import("lacedring/three");
  const geometry = await new LacedRingLoader().loadAsync(url);
  const {normal, color} = geometry.attributes;
  const material =
    new THREE.MeshStandardMaterial({metalness: 1, roughness: 1, flatShading: !normal, vertexColors: !!color});
  return {scene: new THREE.Group().add(new THREE.Mesh(geometry, material)), animations: []};
}

/** Loads a file; with the package lacedring if `isPacked`. */
async function load(url, isPacked) {
  if (url.endsWith(".lr")) return loadLr(url);
  const loader = new GLTFLoader();
  if (isPacked) {
    const {LacedRingExtension} = await import("lacedring/three");
    loader.register((parser) => new LacedRingExtension(parser));
  }
  return loader.loadAsync(url);
}

let sphere, reference, last;  // last: the last picture without the plug-in

/**
 * Draws a file. The first is the reference: its bounds place the camera for all, and it stays on the GPU with its
 * shaders.
 */
async function draw(url, isPacked, views = VIEWS) {
  const {scene: model, animations} = await load(url, isPacked);
  const scene = new THREE.Scene();
  scene.background = new THREE.Color(0x8090a0);
  const sun = new THREE.DirectionalLight(0xffffff, 2);
  sun.position.set(1, 2, 3);
  scene.add(model, new THREE.HemisphereLight(0xffffff, 0x404040, 1.5), sun);
  sphere ??= bounds(model);
  const mixer = new THREE.AnimationMixer(model);
  animations.forEach((clip) => mixer.clipAction(clip).play());
  const drawn = views.map(({direction, time}) => {
    mixer.setTime(time);
    renderer.render(scene, cameraOf(sphere, direction));
    return {pixels: pixels(), png: renderer.domElement.toDataURL("image/png")};
  });
  mixer.stopAllAction();
  if (reference) dispose(model);
  reference ??= drawn;
  return drawn;
}

/** Takes a model off the GPU. */
function dispose(model) {
  model.traverse(({geometry, material, skeleton}) => {
    geometry?.dispose();
    skeleton?.dispose();
    for (const one of [material ?? []].flat()) {
      Object.values(one).filter((value) => value?.isTexture).forEach((texture) => {
        texture.source.data?.close?.();
        texture.dispose();
      });
      one.dispose();
    }
  });
}

function statistics(ours, theirs) {
  let different = 0, over = 0, largest = 0, covered = 0;
  for (let i = 0; i < ours.length; i += 4) {
    let difference = 0, fromBackground = 0;
    for (let channel = 0; channel < 3; channel++) {
      difference = Math.max(difference, Math.abs(ours[i + channel] - theirs[i + channel]));
      fromBackground = Math.max(
        fromBackground, Math.abs(theirs[i + channel] - theirs[channel]));  // the first pixel shows the background
    }
    different += difference > 0;
    over += difference > 16;
    covered += fromBackground > 0;
    largest = Math.max(largest, difference);
  }
  return {different, over, largest, covered};
}

/**
 * For each view: pixels that differ by more than 16 of 255, the largest difference, covered pixels. A packed file is
 * compared with the last plain one, others with the reference.
 */
window.compare = async (url, isPacked) => {
  const drawn = await draw(url, isPacked);
  if (!isPacked) last = drawn;
  const others = isPacked ? last : reference;
  return drawn.map(({pixels, png}, view) => ({...statistics(pixels, others[view].pixels), png}));
};
window.reset = () => {
  sphere = reference = undefined;
};

/** Loads, draws and frees a packed file `times` times. Returns the objects on the GPU afterwards. */
window.repeat = async (url, times) => {
  for (let i = 0; i < times; i++) await draw(url, true, VIEWS.slice(0, 1));
  return {...renderer.info.memory};
};
