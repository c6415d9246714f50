// SPDX-License-Identifier: MIT
import * as THREE from 'three';

/** Sums of the normals of the triangles around each vertex, normalised. */
function updateNormals(positions, triangles, normals) {
  normals.fill(0);
  for (let t = 0; t < triangles.length; t += 3) {
    const a = 3 * triangles[t];
    const b = 3 * triangles[t + 1];
    const c = 3 * triangles[t + 2];
    const ux = positions[b] - positions[a];
    const uy = positions[b + 1] - positions[a + 1];
    const uz = positions[b + 2] - positions[a + 2];
    const vx = positions[c] - positions[a];
    const vy = positions[c + 1] - positions[a + 1];
    const vz = positions[c + 2] - positions[a + 2];
    const x = uy * vz - uz * vy;
    const y = uz * vx - ux * vz;
    const z = ux * vy - uy * vx;
    for (const v of [a, b, c]) {
      normals[v] += x;
      normals[v + 1] += y;
      normals[v + 2] += z;
    }
  }
  for (let v = 0; v < normals.length; v += 3) {
    const length = Math.hypot(normals[v], normals[v + 1], normals[v + 2]) || 1;
    normals[v] /= length;
    normals[v + 1] /= length;
    normals[v + 2] /= length;
  }
}

/** A bone from 0 to 1 along y: thickest at a fifth of its length. */
function boneGeometry() {
  const w = 0.09;
  const points = [0, 0, 0, w, 0.2, 0, 0, 0.2, w, -w, 0.2, 0, 0, 0.2, -w, 0, 1, 0];
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(points, 3));
  geometry.setIndex([0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 1, 5, 2, 1, 5, 3, 2, 5, 4, 3, 5, 1, 4]);
  const flat = geometry.toNonIndexed();
  flat.computeVertexNormals();
  return flat;
}

/** What bodies have in common: places on the grid, frame after frame. */
class Part {
  constructor(description, grid, places) {
    this.description = description;
    this.grid = grid;
    this.places = places;
    this.count = description.vertices;
    this.positions = new Float32Array(3 * this.count);
    this.group = new THREE.Group();
  }

  unpackFrame(frame) {
    const { offsets, step } = this.grid;
    for (let axis = 0; axis < 3; ++axis) {
      const offset = offsets[3 * frame + axis];
      const begin = (3 * frame + axis) * this.count;
      for (let v = 0; v < this.count; ++v) {
        this.positions[3 * v + axis] = offset + step * this.places[begin + v];
      }
    }
  }

  /** Mean over the vertices of a frame. */
  mean(frame) {
    const { offsets, step } = this.grid;
    return [0, 1, 2].map((axis) => {
      const begin = (3 * frame + axis) * this.count;
      let sum = 0;
      for (let v = 0; v < this.count; ++v) {
        sum += this.places[begin + v];
      }
      return offsets[3 * frame + axis] + (step * sum) / this.count;
    });
  }
}

/** A surface of triangles, coloured by a field where it has values of it. */
export class Surface extends Part {
  constructor(description, grid, places, triangles, values) {
    super(description, grid, places);
    this.values = values;  // by field
    this.triangles = triangles;
    const geometry = new THREE.BufferGeometry();
    this.geometry = geometry;
    this.normals = new Float32Array(3 * this.count);
    this.colors = new Float32Array(3 * this.count).fill(1);
    geometry.setIndex(new THREE.BufferAttribute(triangles, 1));
    for (const [name, array] of [['position', this.positions], ['normal', this.normals], ['color', this.colors]]) {
      geometry.setAttribute(name, new THREE.BufferAttribute(array, 3).setUsage(THREE.DynamicDrawUsage));
    }
    this.plain = new THREE.Color(description.color);
    this.material = new THREE.MeshStandardMaterial({
      vertexColors: true, roughness: 0.72, side: THREE.DoubleSide, forceSinglePass: true,
      polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
    });
    this.mesh = new THREE.Mesh(geometry, this.material);
    this.mesh.castShadow = true;
    this.mesh.frustumCulled = false;
    this.mesh.userData.part = this;
    // Where it is transparent, its own back must not shine through: depth first.
    this.depth = new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({ colorWrite: false, side: THREE.DoubleSide,
      polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 }));
    this.depth.frustumCulled = false;
    this.lines = new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({ wireframe: true, transparent: true,
      opacity: 0.16, color: 0x000000, depthWrite: false }));
    this.lines.frustumCulled = false;
    this.lines.visible = false;
    this.group.add(this.depth, this.mesh, this.lines);
    this.setOpacity(description.opacity);
  }

  setOpacity(opacity) {
    const isTransparent = opacity < 1;
    this.material.opacity = opacity;
    if (this.material.transparent !== isTransparent) {
      this.material.transparent = isTransparent;
      this.material.needsUpdate = true;
    }
    this.depth.visible = isTransparent;
    this.depth.renderOrder = 1;
    this.mesh.renderOrder = isTransparent ? 2 : 0;
    this.lines.renderOrder = 3;
  }

  setClipping(planes) {
    [this.material, this.depth.material, this.lines.material].forEach((material) => {
      if ((material.clippingPlanes?.length ?? 0) !== planes.length) {
        material.needsUpdate = true;
      }
      material.clippingPlanes = planes;
      material.clipShadows = true;
    });
  }

  codes(frame, field) {
    const values = this.values.get(field);
    return values ? values.subarray(frame * this.count, (frame + 1) * this.count) : null;
  }

  show(frame, field, scale) {
    this.unpackFrame(frame);
    updateNormals(this.positions, this.triangles, this.normals);
    const codes = this.codes(frame, field);
    for (let v = 0; v < this.count; ++v) {
      if (codes) {
        const place = 3 * codes[v];
        this.colors[3 * v] = scale.table[place];
        this.colors[3 * v + 1] = scale.table[place + 1];
        this.colors[3 * v + 2] = scale.table[place + 2];
      } else {
        this.plain.toArray(this.colors, 3 * v);
      }
    }
    for (const attribute of Object.values(this.geometry.attributes)) {
      attribute.needsUpdate = true;
    }
    this.geometry.boundingSphere = null;
    this.geometry.boundingBox = null;
  }
}

/** Joints and the bones between them. */
export class Skeleton extends Part {
  constructor(description, grid, places, pairs) {
    super(description, grid, places);
    this.pairs = pairs;
    this.values = new Map();
    const material = new THREE.MeshStandardMaterial({ color: description.color, roughness: 0.6 });
    this.bones = new THREE.InstancedMesh(boneGeometry(), material, pairs.length / 2);
    this.joints = new THREE.InstancedMesh(new THREE.SphereGeometry(1, 16, 12), material, this.count);
    for (const mesh of [this.bones, this.joints]) {
      mesh.castShadow = true;
      mesh.frustumCulled = false;
      this.group.add(mesh);
    }
  }

  setOpacity() {}
  setClipping() {}
  codes() {
    return null;
  }

  show(frame) {
    this.unpackFrame(frame);
    const point = (v) => new THREE.Vector3().fromArray(this.positions, 3 * v);
    const up = new THREE.Vector3(0, 1, 0);
    const matrix = new THREE.Matrix4();
    const turn = new THREE.Quaternion();
    for (let k = 0; k < this.pairs.length / 2; ++k) {
      const begin = point(this.pairs[2 * k]);
      const along = point(this.pairs[2 * k + 1]).sub(begin);
      const length = Math.max(along.length(), 1e-9);
      turn.setFromUnitVectors(up, along.multiplyScalar(1 / length));
      const width = Math.min(length, 0.32);
      this.bones.setMatrixAt(k, matrix.compose(begin, turn, new THREE.Vector3(width, length, width)));
    }
    for (let v = 0; v < this.count; ++v) {
      this.joints.setMatrixAt(v, matrix.makeScale(0.012, 0.012, 0.012).setPosition(point(v)));
    }
    this.bones.instanceMatrix.needsUpdate = true;
    this.joints.instanceMatrix.needsUpdate = true;
  }
}
