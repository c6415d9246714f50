// SPDX-License-Identifier: MIT
import { Skeleton, Surface } from './body.js';
import { Clock } from './clock.js';
import { element, formatNumber, icon } from './dom.js';
import { noValue, Scale } from './scale.js';
import { Stage } from './stage.js';
import { unpackIndices, unpackPositions, unpackValues } from './unpack.js';

/** Everything of the scene out of its arrays: the parts of each view. */
async function unpackParts(scene, buffers) {
  const topologies = await Promise.all(scene.topologies.map((each) => unpackIndices(buffers[each.buffer], each.count)));
  const parts = [];
  const places = [];
  for (const mesh of scene.meshes) {  // a reference comes before those that refer to it
    const reference = mesh.reference >= 0 ? places[mesh.reference] : null;
    places.push(await unpackPositions(buffers[mesh.positions], scene.times.length, mesh.vertices, reference));
    const values = new Map();
    for (const { field, buffer } of mesh.values) {
      values.set(field, await unpackValues(buffers[buffer], scene.times.length, mesh.vertices));
    }
    const topology = topologies[mesh.topology];
    parts.push(mesh.is_skeleton ? new Skeleton(mesh, scene.grid, places.at(-1), topology)
      : new Surface(mesh, scene.grid, places.at(-1), topology, values));
  }
  return parts;
}

/** The middle of each frame and what a camera must see of all. */
function measure(scene, parts) {
  const count = scene.times.length;
  const up = scene.up === 'z' ? 2 : 1;
  const { offsets, step } = scene.grid;
  const centers = [];
  const half = [0, 0, 0];
  const all = { min: [Infinity, Infinity, Infinity], max: [-Infinity, -Infinity, -Infinity] };
  for (let frame = 0; frame < count; ++frame) {
    const center = [0, 0, 0];
    for (let axis = 0; axis < 3; ++axis) {
      let low = Infinity;
      let high = -Infinity;
      for (const part of parts) {
        const begin = (3 * frame + axis) * part.count;
        for (let i = begin; i < begin + part.count; ++i) {
          const place = part.places[i];
          low = place < low ? place : low;
          high = place > high ? place : high;
        }
      }
      low = offsets[3 * frame + axis] + step * low;
      high = offsets[3 * frame + axis] + step * high;
      center[axis] = 0.5 * (low + high);
      half[axis] = Math.max(half[axis], 0.5 * (high - low));
      all.min[axis] = Math.min(all.min[axis], low);
      all.max[axis] = Math.max(all.max[axis], high);
    }
    centers.push(center);
  }
  const sides = up === 1 ? [0, 2] : [0, 1];
  const size = 2 * Math.max(...half);
  const travel = Math.hypot(...sides.map((axis) => all.max[axis] - all.min[axis] - 2 * half[axis]));
  const isTravelling = scene.is_motion && travel > 0.35 * size;
  const center = [0, 1, 2].map((axis) => 0.5 * (all.min[axis] + all.max[axis]));
  const height = all.max[up] - all.min[up];
  if (isTravelling) {
    sides.forEach((axis) => (center[axis] = centers[0][axis]));
  }
  const [across, deep] = sides.map((axis) => (isTravelling ? 2 * half[axis] : all.max[axis] - all.min[axis]));
  const width = 0.9 * across + 0.45 * deep;  // as the camera sees them at first
  return { centers, isTravelling, box: { center, width, height, aspect: width / height, size, half, floor: all.min[up] } };
}

const pretty = (text) => text.charAt(0).toUpperCase() + text.slice(1);

export class Viewer {
  static async make(scene, buffers) {
    const viewer = new Viewer();
    await viewer.load(scene, buffers);
    return viewer;
  }

  async load(scene, buffers) {
    this.scene = scene;
    this.parts = await unpackParts(scene, buffers);
    this.views = scene.views.map((_, view) => this.parts.filter((part) => part.description.view === view));
    this.scales = scene.fields.map((field) => new Scale(field));
    this.clock = new Clock(scene.times, scene.is_motion, scene.poster);
    this.field = 0;
    this.shownViews = scene.views.map((view, k) => (view.is_shown ? k : -1)).filter((k) => k >= 0);
    this.shownLayers = new Set(scene.layers.map((layer, k) => (layer.is_shown ? k : -1)).filter((k) => k >= 0));
    this.build();
  }

  build() {
    this.canvas = element('canvas', { class: 'canvas', tabindex: '0', 'aria-label': '3D view: drag to turn, scroll to zoom, right drag to move' });
    this.labels = element('div', { class: 'labels' });
    this.tip = element('div', { class: 'tip', hidden: true });
    this.stageNode = element('div', { class: 'stage' }, this.canvas, this.labels, this.tip);
    this.node = element('section', { class: 'card viewer' }, this.stageNode, this.buildPanel(), this.buildTransport());
  }

  /** Once the page shows the node. */
  start() {
    const { centers, box, isTravelling } = measure(this.scene, this.parts);
    try {
      this.stage = new Stage(this.canvas, { up: this.scene.up, views: this.views, centers, box,
        ground: this.scene.has_ground, isMotion: this.scene.is_motion, clipAxis: 0 });
    } catch (error) {
      this.stageNode.replaceChildren(element('p', { class: 'excuse' },
        `This browser shows no 3D graphics (WebGL): ${error.message}. Plots and tables are below.`));
      this.transport.remove();
      return;
    }
    this.setFollowing(isTravelling);
    this.follow.hidden = !isTravelling;
    this.clock.listen(() => this.update());
    this.canvas.addEventListener('pointermove', (event) => this.hover(event));
    this.canvas.addEventListener('pointerleave', () => (this.tip.hidden = true));
    this.canvas.addEventListener('pointerdown', () => (this.tip.hidden = true));
    this.canvas.addEventListener('dblclick', () => this.stage.reset());
    this.applyVisibility();
    this.stage.reset();
  }

  buildPanel() {
    const { scene } = this;
    const groups = [];
    const group = (title, ...content) => groups.push(element('div', { class: 'group' }, element('h4', {}, title), content));
    if (scene.fields.length > 0) {
      this.legend = element('div', { class: 'legend' });
      const choices = [...scene.fields.map((field) => pretty(field.name)), 'None'];
      this.fieldButtons = choices.map((name, k) => element('button', { class: 'choice', 'data-field': k,
        click: () => this.setField(k < scene.fields.length ? k : -1) }, name));
      group('Colour', element('div', { class: 'choices' }, this.fieldButtons), this.legend);
      this.updateLegend();
    }
    if (scene.views.length > 1) {
      this.viewButtons = scene.views.map((view, k) => element('button', { class: 'choice', 'data-view': k,
        click: () => this.toggleView(k) }, view.name));
      group('Side by side', element('div', { class: 'choices' }, this.viewButtons));
    }
    this.layerButtons = scene.layers.map((layer, k) => {
      const swatch = element('span', { class: 'dot' });
      swatch.style.setProperty('--color', layer.color);
      const toggle = element('button', { class: 'layer', 'data-layer': k, click: () => this.toggleLayer(k) }, swatch,
        element('span', { class: 'name' }, layer.name), layer.key ? element('kbd', {}, layer.key.toUpperCase()) : '');
      return toggle;
    });
    this.opacities = scene.layers.map((layer, k) => element('input', { type: 'range', min: 0.05, max: 1, step: 0.05,
      value: layer.opacity, class: 'opacity', title: `Opacity of ${layer.name.toLowerCase()}`,
      'aria-label': `Opacity of ${layer.name.toLowerCase()}`,
      input: (event) => this.setOpacity(k, Number(event.target.value)) }));
    group('Layers', this.layerButtons.map((button, k) => element('div', { class: 'layer-row' }, button,
      scene.layers.length > 1 ? this.opacities[k] : '')));
    this.cut = element('input', { type: 'range', min: 0, max: 1, step: 0.005, value: 0, 'aria-label': 'Cut through the body',
      input: (event) => this.stage.setCut(Number(event.target.value)) });
    this.lines = element('button', { class: 'choice', click: () => this.toggleLines() }, 'Mesh lines', element('kbd', {}, 'L'));
    this.follow = element('button', { class: 'choice', hidden: true, click: () => this.setFollowing(!this.stage.isFollowing) },
      'Follow', element('kbd', {}, 'F'));
    const reset = element('button', { class: 'choice', title: 'Camera back to its place (R)', click: () => this.stage.reset() },
      'Reset view', element('kbd', {}, 'R'));
    group('View', element('div', { class: 'choices' }, this.lines, this.follow, reset),
      scene.layers.length > 1 ? element('label', { class: 'cut' }, 'Cut', this.cut) : '');
    return element('aside', { class: 'panel' }, groups);
  }

  buildTransport() {
    const { clock } = this;
    if (clock.count < 2) {
      this.transport = element('div', { hidden: true });
      return this.transport;
    }
    this.playButton = element('button', { class: 'play', 'aria-label': 'Play or pause (space)', title: 'Play or pause (space)',
      click: () => clock.toggle() }, icon('play'));
    this.slider = element('input', { type: 'range', class: 'scrub', min: 0, max: clock.count - 1, step: 1, value: clock.frame,
      'aria-label': 'Frame', input: () => {
        const frame = Number(this.slider.value);  // before pausing puts the slider back
        clock.pause();
        clock.show(frame);
      } });
    this.place = element('output', { class: 'place' });
    this.speeds = element('div', { class: 'speeds', role: 'group', 'aria-label': 'Speed' },
      [0.1, 0.25, 0.5, 1].map((speed) => element('button', { class: 'choice', 'data-speed': speed, click: () => {
        clock.speed = speed;
        this.updateTransport();
      } }, `${speed}×`)));
    this.transport = element('div', { class: 'transport' }, this.playButton, this.slider, this.place,
      this.scene.is_motion ? this.speeds : '');
    this.updateTransport();
    return this.transport;
  }

  frameLabel(frame) {
    const { scene } = this;
    if (scene.labels.length > 0) {
      return scene.labels[frame];
    }
    return `${scene.times[frame].toFixed(2)} s`;
  }

  updateTransport() {
    const { clock, scene } = this;
    if (clock.count < 2) {
      return;
    }
    this.playButton.replaceChildren(icon(clock.isPlaying ? 'pause' : 'play'));
    this.slider.value = clock.frame;
    this.slider.style.setProperty('--done', `${(100 * clock.frame) / (clock.count - 1)}%`);
    const end = scene.labels.length > 0 ? `${clock.frame + 1} of ${clock.count}` : `of ${scene.times.at(-1).toFixed(2)} s`;
    this.place.replaceChildren(element('b', {}, this.frameLabel(clock.frame)), ` ${end}`);
    for (const button of this.speeds.children) {
      button.setAttribute('aria-pressed', Number(button.dataset.speed) === clock.speed);
    }
  }

  updateLegend() {
    const scale = this.scales[this.field];
    this.fieldButtons.forEach((button, k) =>
      button.setAttribute('aria-pressed', k === this.field || (this.field < 0 && k === this.scales.length)));
    if (!scale) {
      this.legend.replaceChildren();
      return;
    }
    const { field } = scale;
    const bar = element('div', { class: 'bar' });
    bar.style.background = scale.gradient;
    this.needle = element('div', { class: 'needle', hidden: true });
    bar.append(this.needle);
    const count = 4;
    const digits = (field.high - field.low) / count >= 1 && Number.isInteger((field.high - field.low) / count) ? 0 : null;
    const ticks = Array.from({ length: count + 1 }, (_, k) => {
      const value = field.low + (k / count) * (field.high - field.low);
      const text = formatNumber(Math.abs(value) < 1e-12 ? 0 : value, digits);
      return element('span', {}, k === count && field.is_open ? `≥ ${text}` : text);
    });
    const nothing = element('span', { class: 'dot' });
    nothing.style.setProperty('--color', field.nothing);
    this.legend.replaceChildren(bar, element('div', { class: 'ticks' }, ticks),
      element('p', { class: 'unit' }, `${field.note || pretty(field.name)}${field.unit ? ` [${field.unit}]` : ''}`));
  }

  setField(field) {
    this.field = field;
    this.updateLegend();
    this.update();
  }

  setFollowing(isFollowing) {
    this.stage.isFollowing = isFollowing;
    this.follow.setAttribute('aria-pressed', isFollowing);
    this.stage.show(this.clock.frame);
  }

  toggleView(view) {
    const isShown = this.shownViews.includes(view);
    if (isShown && this.shownViews.length === 1) {
      return;
    }
    this.shownViews = isShown ? this.shownViews.filter((each) => each !== view) : [...this.shownViews, view].sort((a, b) => a - b);
    this.applyVisibility();
    this.stage.reset();
  }

  toggleLayer(layer) {
    if (this.shownLayers.has(layer)) {
      this.shownLayers.delete(layer);
    } else {
      this.shownLayers.add(layer);
    }
    this.applyVisibility();
  }

  setOpacity(layer, opacity) {
    this.parts.filter((part) => part.description.layer === layer).forEach((part) => part.setOpacity(opacity));
    this.stage.invalidate();
  }

  toggleLines() {
    const isOn = this.lines.getAttribute('aria-pressed') !== 'true';
    this.lines.setAttribute('aria-pressed', isOn);
    this.parts.forEach((part) => part.lines && (part.lines.visible = isOn));
    this.stage.invalidate();
  }

  applyVisibility() {
    const { scene } = this;
    this.layerButtons.forEach((button, k) => {
      button.setAttribute('aria-pressed', this.shownLayers.has(k));
      this.opacities[k].disabled = !this.shownLayers.has(k);
    });
    this.viewButtons?.forEach((button, k) => button.setAttribute('aria-pressed', this.shownViews.includes(k)));
    this.parts.forEach((part) => (part.group.visible = this.shownLayers.has(part.description.layer)));
    this.stage.showViews(this.shownViews);
    this.labels.replaceChildren(...this.stage.panels.map((panel, k) => {
      const view = scene.views[this.shownViews[k]];
      const label = element('div', { class: 'label', 'data-view': this.shownViews[k] }, element('b', {}, view.name),
        element('span', {}, view.caption), element('span', { class: 'measure' }));
      label.style.left = `${100 * panel.left}%`;
      label.style.top = `${100 * panel.top}%`;
      label.style.width = `${100 * panel.width}%`;
      label.style.height = `${100 * panel.height}%`;
      label.classList.toggle('inner', panel.left > 0);
      return label;
    }));
    this.update();
  }

  /** What the colours of a view come to in this frame. */
  summary(view) {
    const scale = this.scales[this.field];
    const part = scale && this.views[view].find((each) => each.group.visible && each.codes(this.clock.frame, this.field));
    if (!part) {
      return '';
    }
    let [sum, count, high, low] = [0, 0, 0, 254];
    for (const code of part.codes(this.clock.frame, this.field)) {
      if (code !== noValue) {
        sum += code;
        ++count;
        high = Math.max(high, code);
        low = Math.min(low, code);
      }
    }
    if (count === 0) {
      return '';
    }
    const tell = (code) => scale.tell(scale.value(code));
    const { unit, is_signed, is_open } = scale.field;
    const more = is_open && high === 254 ? '≥ ' : '';
    return is_signed ? `${tell(low)} … ${more}${tell(high)} ${unit}` : `mean ${tell(sum / count)}, max ${more}${tell(high)} ${unit}`;
  }

  update() {
    this.updateTransport();
    if (!this.stage) {
      return;
    }
    const scale = this.scales[this.field];
    for (const view of this.shownViews) {
      for (const part of this.views[view]) {
        if (part.group.visible) {
          part.show(this.clock.frame, this.field, scale);
        }
      }
    }
    for (const label of this.labels.children) {
      label.querySelector('.measure').textContent = this.summary(Number(label.dataset.view));
    }
    this.stage.show(this.clock.frame);
  }

  hover(event) {
    if (event.buttons !== 0 || this.clock.isPlaying || this.isHovering) {
      return;
    }
    this.isHovering = true;
    requestAnimationFrame(() => {
      this.isHovering = false;
      const box = this.canvas.getBoundingClientRect();
      const x = event.clientX - box.left;
      const y = event.clientY - box.top;
      const hit = this.stage.pick(x, y);
      this.tip.hidden = !hit;
      if (this.needle) {
        this.needle.hidden = true;
      }
      if (!hit) {
        return;
      }
      const codes = hit.part.codes(this.clock.frame, this.field);
      const scale = this.scales[this.field];
      const layer = this.scene.layers[hit.part.description.layer].name;
      let value = '';
      if (codes && scale && codes[hit.vertex] !== noValue) {
        const code = codes[hit.vertex];
        value = `${scale.field.is_open && code === 254 ? '≥ ' : ''}${scale.tell(scale.value(code))} ${scale.field.unit}`;
        this.needle.hidden = false;
        this.needle.style.left = `${(100 * code) / 254}%`;
      }
      this.tip.replaceChildren(value ? element('b', {}, value) : '', element('span', {}, `${layer}, vertex ${hit.vertex}`));
      this.tip.style.transform = `translate(${Math.min(x + 14, box.width - 150)}px, ${Math.max(y - 44, 6)}px)`;
    });
  }

  /** Whether the key meant something here. */
  press(key, isShifted) {
    const { clock, scene } = this;
    const far = Math.max(1, Math.round(clock.count / 10));
    const layer = scene.layers.findIndex((each) => each.key && each.key === key);
    if (key === ' ') {
      clock.toggle();
    } else if (key === 'arrowright') {
      clock.step(isShifted ? far : 1);
    } else if (key === 'arrowleft') {
      clock.step(isShifted ? -far : -1);
    } else if (key === 'home') {
      clock.pause();
      clock.show(0);
    } else if (key === 'end') {
      clock.pause();
      clock.show(clock.count - 1);
    } else if (key === 'r') {
      this.stage.reset();
    } else if (key === 'l') {
      this.toggleLines();
    } else if (key === 'f' && !this.follow.hidden) {
      this.setFollowing(!this.stage.isFollowing);
    } else if (layer >= 0) {
      this.toggleLayer(layer);
    } else if (/^[1-9]$/.test(key) && Number(key) <= scene.views.length && scene.views.length > 1) {
      this.toggleView(Number(key) - 1);
    } else {
      return false;
    }
    return true;
  }
}
