// SPDX-License-Identifier: MIT
import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

import { themeColor } from './dom.js';

/** Width of a square of the floor [m]. */
export const gridStep = 0.25;

/** The middle of every frame along the floor, smoothed, so that a camera may follow without haste. */
function smoothPath(centers, window) {
  return centers.map((_, k) => {
    const sum = [0, 0, 0];
    const begin = Math.max(0, k - window);
    const end = Math.min(centers.length, k + window + 1);
    for (let i = begin; i < end; ++i) {
      centers[i].forEach((value, axis) => (sum[axis] += value));
    }
    return sum.map((value) => value / (end - begin));
  });
}

/** Bodies side by side in one canvas, all seen by one camera. */
export class Stage {
  /**
   * `views`: per view the parts in it; `centers`: the middle of each frame; `box`: what the camera is to show: center, width,
   * height, aspect (to lay out panels), size (of one body), half (extents of one body), floor.
   */
  constructor(canvas, { up, views, centers, box, ground, isMotion, clipAxis }) {
    this.canvas = canvas;
    this.views = views;
    this.centers = centers;
    this.isDirty = true;
    this.isFollowing = false;
    this.frame = 0;
    this.path = isMotion ? smoothPath(centers, 12) : centers.map(() => [...centers[0]]);
    this.box = box;
    this.upAxis = up === 'z' ? 2 : 1;

    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
    this.renderer.setScissorTest(true);
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = THREE.PCFShadowMap;
    this.renderer.localClippingEnabled = true;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));

    this.camera = new THREE.PerspectiveCamera(26, 1, 0.01, 100);
    this.camera.up.set(0, this.upAxis === 1 ? 1 : 0, this.upAxis === 2 ? 1 : 0);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = true;
    this.controls.dampingFactor = 0.12;
    this.controls.addEventListener('change', () => this.invalidate());

    this.clip = new THREE.Plane();
    this.clipAxis = clipAxis ?? 0;
    this.cut = 0;
    this.scenes = views.map((parts) => this.makeScene(parts, ground));
    this.applyTheme();
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    this.shown = views.map((_, k) => k);
    this.resize();
    this.reset();
    const draw = () => {
      this.controls.update();
      if (this.isDirty) {
        this.render();
      }
      requestAnimationFrame(draw);
    };
    requestAnimationFrame(draw);
  }

  makeScene(parts, ground) {
    const scene = new THREE.Scene();
    const size = this.box.size;
    const up = this.camera.up;
    const sky = new THREE.HemisphereLight(0xffffff, 0xb8ada0, 1.5);
    sky.position.copy(up);
    scene.add(sky);
    const content = new THREE.Group();
    scene.add(content);
    parts.forEach((part) => content.add(part.group));
    const sun = new THREE.DirectionalLight(0xffffff, 1.1);
    sun.position.copy(up).multiplyScalar(2.4 * size).add(new THREE.Vector3(-0.5, 0.2, 0.9).multiplyScalar(size));
    sun.castShadow = true;
    sun.shadow.mapSize.set(1024, 1024);
    sun.shadow.radius = 5;
    sun.shadow.bias = -0.0006;
    sun.shadow.normalBias = 0.012 * size;
    const reach = 1.1 * size;
    Object.assign(sun.shadow.camera, { left: -reach, right: reach, top: reach, bottom: -reach, near: 0.01, far: 6 * size });
    scene.add(sun, sun.target);
    const lamp = new THREE.DirectionalLight(0xfff6ea, 1.25);
    scene.add(lamp, lamp.target);
    const floor = new THREE.Group();
    if (ground) {
      const shadow = new THREE.Mesh(new THREE.CircleGeometry(4 * size, 64), new THREE.ShadowMaterial({ opacity: 0.2, depthWrite: false }));
      shadow.receiveShadow = true;
      const grid = new THREE.GridHelper(32 * gridStep, 32);
      grid.material.transparent = true;
      grid.material.depthWrite = false;
      grid.material.onBeforeCompile = (shader) => {  // lines fade away from the body
        const place = 'varying vec2 floorPlace;\nvoid main() {';
        const fade = `smoothstep(${(0.15 * size).toFixed(3)}, ${(0.75 * size).toFixed(3)}, length(floorPlace))`;
        shader.vertexShader = shader.vertexShader.replace('void main() {', `${place}\nfloorPlace = position.xz;`);
        shader.fragmentShader = shader.fragmentShader.replace('void main() {', place)
          .replace('#include <opaque_fragment>', `#include <opaque_fragment>\ngl_FragColor.a *= 0.7 - 0.7 * ${fade};`);
      };
      floor.add(grid);
      const disc = new THREE.Group();
      shadow.rotation.x = -Math.PI / 2;
      disc.add(shadow);
      floor.add(disc);
      if (this.upAxis === 2) {
        floor.rotation.x = Math.PI / 2;
      }
      floor.position.fromArray(this.box.center).setComponent(this.upAxis, this.box.floor - 0.001 * size);
      scene.add(floor);
      scene.userData.grid = grid;
    }
    Object.assign(scene.userData, { content, lamp, sun, floor });
    return scene;
  }

  applyTheme() {
    const color = new THREE.Color(themeColor('--floor'));
    const isDark = document.documentElement.dataset.theme === 'dark';
    this.scenes.forEach((scene) => {
      const grid = scene.userData.grid;
      if (grid) {
        const colors = grid.geometry.attributes.color;
        for (let v = 0; v < colors.count; ++v) {
          colors.setXYZ(v, color.r, color.g, color.b);
        }
        colors.needsUpdate = true;
        scene.userData.floor.traverse((node) => {
          if (node.material instanceof THREE.ShadowMaterial) {
            node.material.opacity = isDark ? 0.5 : 0.17;
          }
        });
      }
    });
    this.invalidate();
  }

  invalidate() {
    this.isDirty = true;
  }

  /** Which views are seen, in order. */
  showViews(shown) {
    this.shown = shown;
    this.resize();
  }

  resize() {
    const { clientWidth, clientHeight } = this.canvas.parentElement;
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.invalidate();
  }

  /** Columns and rows of the panels: as wide as they are high, or higher. */
  get layout() {
    const count = Math.max(1, this.shown.length);
    const aspect = this.canvas.clientWidth / Math.max(1, this.canvas.clientHeight);
    const wanted = this.box.aspect;
    let best = { columns: count, rows: 1, scale: 0 };
    for (let columns = 1; columns <= count; ++columns) {
      const rows = Math.ceil(count / columns);
      const panel = (aspect * rows) / columns;
      const scale = Math.min(panel / wanted, 1) / rows;
      if (scale > best.scale * 1.0001) {
        best = { columns, rows, scale };
      }
    }
    return best;
  }

  /** Of each shown view: left, top, width, height in fractions of the canvas. */
  get panels() {
    const { columns, rows } = this.layout;
    return this.shown.map((_, k) => {
      const row = Math.floor(k / columns);
      const inRow = Math.min(columns, this.shown.length - row * columns);
      return { left: (k % columns) / inRow, top: row / rows, width: 1 / inRow, height: 1 / rows };
    });
  }

  reset() {
    const size = this.box.size;
    const aspect = (this.panels[0]?.width ?? 1) * this.canvas.clientWidth /
      Math.max(1, (this.panels[0]?.height ?? 1) * this.canvas.clientHeight);
    const half = Math.tan((this.camera.fov * Math.PI) / 360);
    const distance = 1.05 * Math.max(this.box.height / 2 / half, this.box.width / 2 / (half * aspect)) + this.box.width / 6;
    const direction = this.upAxis === 1 ? new THREE.Vector3(0.5, 0.14, 1) : new THREE.Vector3(0.62, -1, 0.5);
    this.controls.target.fromArray(this.box.center);
    this.camera.position.copy(this.controls.target).addScaledVector(direction.normalize(), distance);
    this.camera.near = 0.01 * size;
    this.camera.far = 40 * size;
    this.controls.minDistance = 0.1 * size;
    this.controls.maxDistance = 12 * size;
    this.controls.update();
    this.invalidate();
  }

  /** Cuts away a part of the bodies, from 0 (nothing) to 1. */
  setCut(cut) {
    this.cut = cut;
    this.views.flat().forEach((part) => part.setClipping(cut > 0 ? [this.clip] : []));
    this.invalidate();
  }

  show(frame) {
    this.frame = frame;
    const shift = [0, 0, 0];
    if (this.isFollowing) {
      [0, 1, 2].forEach((axis) => {
        if (axis !== this.upAxis) {
          shift[axis] = this.path[0][axis] - this.path[frame][axis];
        }
      });
    }
    this.scenes.forEach((scene) => {
      scene.userData.content.position.fromArray(shift);
      if (scene.userData.grid) {  // the lines of the floor go with the body, whole steps left out
        const along = this.upAxis === 1 ? [shift[0], shift[2]] : [shift[0], -shift[1]];
        scene.userData.grid.position.set(along[0] % gridStep, 0, along[1] % gridStep);
      }
    });
    this.invalidate();
  }

  render() {
    this.isDirty = false;
    this.canvas.dataset.renders = Number(this.canvas.dataset.renders ?? 0) + 1;
    const { renderer, camera } = this;
    const width = this.canvas.clientWidth;
    const height = this.canvas.clientHeight;
    renderer.setScissor(0, 0, width, height);
    renderer.setViewport(0, 0, width, height);
    renderer.setClearColor(0x000000, 0);
    renderer.clear();
    const axis = this.clipAxis;
    const middle = this.centers[this.frame][axis] + this.scenes[0].userData.content.position.getComponent(axis);
    this.clip.normal.set(0, 0, 0).setComponent(axis, -1);
    this.clip.constant = middle + (1 - 2 * this.cut) * 1.02 * this.box.half[axis];
    this.panels.forEach((panel, k) => {
      const scene = this.scenes[this.shown[k]];
      const x = Math.round(panel.left * width);
      const y = Math.round((1 - panel.top - panel.height) * height);
      const w = Math.round(panel.width * width);
      const h = Math.round(panel.height * height);
      camera.aspect = w / h;
      camera.updateProjectionMatrix();
      const { lamp, sun, content: bodies } = scene.userData;
      lamp.position.copy(camera.position);
      lamp.target.position.copy(this.controls.target);
      const center = this.isFollowing ? this.path[0] : this.path[this.frame];
      const place = new THREE.Vector3().fromArray(center);
      place.setComponent(this.upAxis, this.box.floor);
      sun.position.sub(sun.target.position).add(place);
      sun.target.position.copy(place);
      bodies.updateMatrixWorld();
      renderer.setViewport(x, y, w, h);
      renderer.setScissor(x, y, w, h);
      renderer.render(scene, camera);
    });
  }

  /** What lies under a place of the canvas (in pixels): view, part, vertex; or null. */
  pick(x, y) {
    const width = this.canvas.clientWidth;
    const height = this.canvas.clientHeight;
    const index = this.panels.findIndex((panel) => x >= panel.left * width && x < (panel.left + panel.width) * width &&
      y >= panel.top * height && y < (panel.top + panel.height) * height);
    if (index < 0) {
      return null;
    }
    const panel = this.panels[index];
    const place = new THREE.Vector2(2 * (x - panel.left * width) / (panel.width * width) - 1,
      1 - 2 * (y - panel.top * height) / (panel.height * height));
    this.camera.aspect = (panel.width * width) / (panel.height * height);
    this.camera.updateProjectionMatrix();
    const ray = new THREE.Raycaster();
    ray.setFromCamera(place, this.camera);
    const view = this.shown[index];
    const meshes = this.views[view].filter((part) => part.mesh && part.group.visible).map((part) => part.mesh);
    const hit = ray.intersectObjects(meshes, false)
      .find(({ point }) => this.cut === 0 || this.clip.distanceToPoint(point) >= 0);
    if (!hit) {
      return null;
    }
    const part = hit.object.userData.part;
    const local = hit.point.clone().sub(this.scenes[view].userData.content.position);
    const vertex = [hit.face.a, hit.face.b, hit.face.c].reduce((nearest, v) =>
      local.distanceToSquared(new THREE.Vector3().fromArray(part.positions, 3 * v)) <
      local.distanceToSquared(new THREE.Vector3().fromArray(part.positions, 3 * nearest)) ? v : nearest);
    return { view, part, vertex };
  }
}
