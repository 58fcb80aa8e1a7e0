// Draws a model, and its ring over it.
import * as THREE from "three";
import {OrbitControls} from "three/addons/controls/OrbitControls.js";
import {RoomEnvironment} from "three/addons/environments/RoomEnvironment.js";

import {ringOf} from "./ring.js";

const STEP = Math.PI / 24, ZOOM = 1.15;  // rotation and zoom per key press

function dispose(object) {
  object.traverse(({geometry, material, skeleton}) => {
    geometry?.dispose();
    skeleton?.dispose();
    for (const one of [material ?? []].flat()) {
      for (const value of Object.values(one)) {
        if (!value?.isTexture) continue;
        value.source.data?.close?.();  // if it is an ImageBitmap
        value.dispose();
      }
      one.dispose();
    }
  });
}

/** Makes the lines of a mesh's ring, animated like the mesh. */
function ringLines(mesh, material) {
  const geometry = new THREE.BufferGeometry();
  geometry.attributes = {...mesh.geometry.attributes};
  geometry.morphAttributes = mesh.geometry.morphAttributes;
  geometry.morphTargetsRelative = mesh.geometry.morphTargetsRelative;
  geometry.setIndex(new THREE.BufferAttribute(ringOf(mesh.geometry), 1));
  delete geometry.attributes.color;
  const lines = new THREE.LineSegments(geometry, material);
  lines.frustumCulled = false;
  lines.morphTargetInfluences = mesh.morphTargetInfluences;
  if (mesh.isSkinnedMesh) {
    const {skeleton, bindMatrix, bindMatrixInverse, bindMode} = mesh;
    Object.assign(lines, {isSkinnedMesh: true, skeleton, bindMatrix, bindMatrixInverse, bindMode});
  }
  return lines;
}

/** The mean length of the rings' lines, in world space. */
function meanLength(rings) {
  const [a, b] = [new THREE.Vector3(), new THREE.Vector3()];
  let sum = 0, count = 0;
  for (const {geometry: {index, attributes: {position}}, matrixWorld} of rings) {
    const scale = matrixWorld.getMaxScaleOnAxis();
    for (let i = 0; i < index.count; i += 2) {
      sum += scale *
        a.fromBufferAttribute(position, index.array[i]).distanceTo(b.fromBufferAttribute(position, index.array[i + 1]));
    }
    count += index.count / 2;
  }
  return count > 0 ? sum / count : 0;
}

/** The largest distance of a vertex from a point; Infinity if there are instanced meshes. */
function farthest(object, center) {
  const position = new THREE.Vector3();
  let most = 0;
  object.traverse((mesh) => {
    if (mesh.isInstancedMesh) most = Infinity;
    if (!mesh.isMesh) return;
    for (let v = 0; v < mesh.geometry.attributes.position.count; v++) {
      most = Math.max(most, mesh.getVertexPosition(v, position).applyMatrix4(mesh.matrixWorld).distanceTo(center));
    }
  });
  return most;
}

export class Viewer {
  #renderer;
  #scene = new THREE.Scene();
  #camera = new THREE.PerspectiveCamera(32, 1, 0.1, 100);
  #controls;
  #model;
  #rings = [];
  #mixer;
  #clock = new THREE.Timer();
  #isWaiting = false;
  #ringMaterial = new THREE.LineBasicMaterial({transparent: true});
  #ringLength = 0;  // mean length of a line
  #hasRing = true;
  #isFramed = false;  // the user has not moved the camera since frame()

  constructor(canvas) {
    this.#renderer = new THREE.WebGLRenderer({canvas, antialias: true, alpha: true});
    this.#renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    const generator = new THREE.PMREMGenerator(this.#renderer), room = new RoomEnvironment();
    this.#scene.environment = generator.fromScene(room, 0.04).texture;
    room.dispose();
    generator.dispose();
    this.#scene.environmentIntensity = 0.5;
    const sun = new THREE.DirectionalLight(0xffffff, 1.2);
    sun.position.set(-2, 4, 3);
    this.#camera.add(sun);
    this.#scene.add(this.#camera);
    this.#controls = new OrbitControls(this.#camera, canvas);
    this.#controls.enablePan = false;
    this.#controls.autoRotateSpeed = 1.5;
    this.#controls.addEventListener("change", () => this.draw());
    this.#controls.addEventListener("start", () => {
      this.#isFramed = false;
    });
    new ResizeObserver(() => this.#resize()).observe(canvas);
    canvas.addEventListener("keydown", (event) => this.#press(event));
    this.setColors();
  }

  /** Sets colors from the style sheet. */
  setColors() {
    const style = getComputedStyle(document.documentElement);
    this.#ringMaterial.color.set(style.getPropertyValue("--ring").trim());
    const mesh = style.getPropertyValue("--mesh").trim();
    this.#model?.traverse(({material}) => {
      if (material?.userData.isPlain) material.color.set(mesh);
    });
    this.draw();
  }

  /** Shows a model; frees the previous one. */
  show(object, animations = []) {
    if (this.#model) {
      this.#scene.remove(this.#model);
      dispose(this.#model);
      this.#rings.forEach((lines) => lines.geometry.dispose());
    }
    this.#model = object;
    this.#rings = [];
    this.#scene.add(object);
    object.traverse((mesh) => {
      if (!mesh.isMesh) return;
      for (const material of [mesh.material].flat())
        Object.assign(material, {polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1});
    });
    this.#mixer = animations.length > 0 ? new THREE.AnimationMixer(object) : undefined;
    this.#mixer?.clipAction(animations[0]).play();
    this.setRing(this.#hasRing);
    this.setColors();
    this.#camera.position.set(0.5, 0.35, 1);
    this.#controls.target.set(0, 0, 0);
    this.frame();
  }

  /** Shows or hides the ring. Makes its lines at first use. */
  setRing(hasRing) {
    this.#hasRing = hasRing;
    if (hasRing && this.#rings.length === 0) {
      const meshes = [];
      this.#model?.traverse((mesh) => {
        if (mesh.isMesh && mesh.geometry.index && !mesh.isInstancedMesh) meshes.push(mesh);
      });
      for (const mesh of meshes) {
        const lines = ringLines(mesh, this.#ringMaterial);
        this.#rings.push(lines);
        mesh.add(lines);
      }
      this.#model?.updateMatrixWorld(true);
      this.#ringLength = meanLength(this.#rings);
    }
    this.#rings.forEach((lines) => {
      lines.visible = hasRing;
    });
    this.draw();
  }

  /** The number of ring lines shown. */
  get lines() {
    return this.#rings.reduce((sum, {visible, geometry}) => sum + (visible ? geometry.index.count / 2 : 0), 0);
  }

  setTurning(isTurning) {
    this.#controls.autoRotate = isTurning;
    this.draw();
  }

  /** Moves the camera, without rotating it, so that the whole model is visible. */
  frame() {
    if (!this.#model) return;
    this.#model.updateMatrixWorld(true);
    const sphere = new THREE.Box3().setFromObject(this.#model, true).getBoundingSphere(new THREE.Sphere()),
          {center} = sphere;
    const radius = Math.min(sphere.radius, farthest(this.#model, center));
    const size = radius > 0 ? radius : 1,
          half = Math.tan(THREE.MathUtils.degToRad(this.#camera.fov / 2)) * Math.min(1, this.#camera.aspect);
    const distance = size / Math.sin(Math.atan(half)) * 1.05;
    this.#camera.near = distance / 100;
    this.#camera.far = distance * 100;
    this.#camera.updateProjectionMatrix();
    this.#camera.position.sub(this.#controls.target).setLength(distance).add(center);
    this.#isFramed = true;
    this.#controls.minDistance = size / 20;
    this.#controls.maxDistance = distance * 8;
    this.#controls.target.copy(center);
    this.#controls.update();
    this.draw();
  }

  /** Draws the next frame, and all later frames while something moves. */
  draw() {
    if (this.#isWaiting) return;
    this.#isWaiting = true;
    requestAnimationFrame((time) => {
      this.#isWaiting = false;
      this.#clock.update(time);
      const seconds = Math.min(this.#clock.getDelta(), 0.1);
      this.#mixer?.update(seconds);
      this.#controls.update(seconds);
      this.#fadeRing();
      this.#renderer.render(this.#scene, this.#camera);
      if (this.#mixer || (this.#controls.autoRotate && this.#model)) this.draw();
    });
  }

  /**
   * Makes lines more transparent as they get shorter on the screen: opaque lines of about a pixel would hide the mesh.
   */
  #fadeRing() {
    const {position, fov} = this.#camera, height = this.#renderer.domElement.clientHeight;
    const seen = 2 * position.distanceTo(this.#controls.target) * Math.tan(THREE.MathUtils.degToRad(fov / 2));
    this.#ringMaterial.opacity = THREE.MathUtils.clamp(this.#ringLength * height / seen / 6, 0.1, 1);
  }

  #resize() {
    const {clientWidth, clientHeight} = this.#renderer.domElement;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.#renderer.setSize(clientWidth, clientHeight, false);
    this.#camera.aspect = clientWidth / clientHeight;
    this.#camera.updateProjectionMatrix();
    if (this.#isFramed) this.frame();
    this.draw();
  }

  #press(event) {
    const steps = {
      ArrowLeft: [-STEP, 0, 1],
      ArrowRight: [STEP, 0, 1],
      ArrowUp: [0, -STEP, 1],
      ArrowDown: [0, STEP, 1],
      "+": [0, 0, 1 / ZOOM],
      "-": [0, 0, ZOOM]
    };
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key === "Home") this.frame();
    const step = steps[event.key === "=" ? "+" : event.key];
    if (!step && event.key !== "Home") return;
    event.preventDefault();
    if (!step) return;
    this.#isFramed = false;
    const {target} = this.#controls, offset = this.#camera.position.clone().sub(target);
    const at = new THREE.Spherical().setFromVector3(offset);
    at.theta += step[0];
    at.phi += step[1];
    at.radius *= step[2];
    this.#camera.position.setFromSpherical(at.makeSafe()).add(target);
    this.#controls.update();
    this.draw();
  }
}
