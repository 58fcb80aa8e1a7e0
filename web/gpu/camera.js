// A camera that orbits a sphere, controlled by mouse, touch and keys.

/** The product of two matrices, which are arrays of 16 numbers, column by column. */
function multiply(a, b) {
  return Array.from(
    {length: 16}, (_, i) => [0, 1, 2, 3].reduce((sum, k) => sum + a[4 * k + (i & 3)] * b[4 * (i >> 2) + k], 0));
}

export class Orbit {
  yaw = 0.5;
  pitch = 0.35;
  zoom = 1;

  /** bounds: { center, radius } of the sphere. */
  constructor(bounds) {
    this.bounds = bounds;
  }

  turn(dx, dy) {
    this.yaw -= dx;
    this.pitch = Math.max(-1.55, Math.min(1.55, this.pitch + dy));
  }

  scale(factor) {
    this.zoom = Math.max(0.05, Math.min(20, this.zoom * factor));
  }

  /** Returns { clipFromWorld, eye }. aspect: width / height of the picture. */
  matrices(aspect) {
    const {center, radius} = this.bounds, field = 0.6 / Math.min(aspect, 1);
    const distance = 2 * radius * this.zoom / field;
    const [sy, cy, sp, cp] = [Math.sin(this.yaw), Math.cos(this.yaw), Math.sin(this.pitch), Math.cos(this.pitch)];
    const back = [sy * cp, sp, cy * cp], right = [cy, 0, -sy], up = [-sy * sp, cp, -cy * sp];
    const eye = center.map((c, k) => c + distance * back[k]);
    const along = (axis) => -axis.reduce((sum, x, k) => sum + x * eye[k], 0);
    const view = [
      right[0], up[0], back[0], 0, right[1], up[1], back[1], 0, right[2], up[2], back[2], 0, along(right), along(up),
      along(back), 1
    ];
    const near = Math.max(distance - 1.2 * radius, 0.02 * radius), far = distance + 1.2 * radius, f = 2 / field;
    const project = [f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, far / (near - far), -1, 0, 0, near * far / (near - far), 0];
    return {clipFromWorld: multiply(project, view), eye};
  }

  /**
   * Rotates by mouse, one finger or arrow keys, zooms by wheel, two fingers, + and -; calls `changed` after each
   * input.
   */
  listen(element, changed) {
    const pointers = new Map();
    const spread = () => {
      const [a, b] = [...pointers.values()];
      return b ? Math.hypot(a.x - b.x, a.y - b.y) : 0;
    };
    element.addEventListener("pointerdown", (event) => {
      element.setPointerCapture(event.pointerId);
      pointers.set(event.pointerId, {x: event.clientX, y: event.clientY});
    });
    element.addEventListener("pointermove", (event) => {
      const last = pointers.get(event.pointerId), before = spread();
      if (!last) return;
      pointers.set(event.pointerId, {x: event.clientX, y: event.clientY});
      if (pointers.size === 1) this.turn((event.clientX - last.x) * 0.01, (event.clientY - last.y) * 0.01);
      if (pointers.size === 2) this.scale(before / Math.max(spread(), 1));
      changed();
    });
    for (const type of ["pointerup", "pointercancel"])
      element.addEventListener(type, ({pointerId}) => pointers.delete(pointerId));
    element.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.scale(Math.exp(event.deltaY * 0.001));
      changed();
    }, {passive: false});
    element.addEventListener("keydown", ({key}) => {
      const turns = {ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1]};
      if (turns[key]) this.turn(...turns[key]);
      if (key === "+" || key === "-") this.scale(key === "+" ? 0.9 : 1.1);
      changed();
    });
  }
}
