// SPDX-License-Identifier: Apache-2.0
import {bodies_of, from_above} from '../body.js';
import {chase_metres} from '../chase.js';
import {casing, kKinds, mix, role_color, route_color, style_of} from '../colors.js';
import {by_id} from '../dom.js';
import {outline} from '../shapes.js';
import {circles, drift, event_times, flight_line, grid_lines, layer_key, place_at,
  present} from '../world.js';
import {contour_image, ground_image} from './ground_image.js';
import {count_below, path_of_many} from './paths.js';

const kOpacity = {obstacle: 0.6, keep_out: 0.25, keep_in: 0.06, threat: 0.25,
  unknown: 0.15};
// Pixels around the box: for its numbers, the names of its axes, and the compass.
const kMargins = {side: 74, bottom: 48, top: 26};

/** The world from above, for browsers without WebGL. Same methods as View3. */
export class View2 {
  constructor(stage, world, store) {
    Object.assign(this, {stage, world, store, listeners: []});
    this.canvas = document.createElement('canvas');
    this.canvas.tabIndex = 0;
    stage.prepend(this.canvas);
    document.body.classList.add('flat');
    this.context = this.canvas.getContext('2d');
    this.image = world.scene.ground && ground_image(world.scene.ground);
    this.#listen();
    new ResizeObserver(() => this.resize()).observe(stage);
    this.resize();
    this.look('fit');
    store.on(['version', 'shown', 'hidden', 'selected', 'time', 'everything', 'cut', 'grid', 'contours', 'basemap', 'bodies', 'theme',
      'search', 'searched'], () => this.draw());
    store.on(['follow', 'time', 'selected'], (state, changed) => this.#follow(state, changed));
  }

  /** Keeps the vehicle in the middle. */
  #follow(state, changed) {
    const line = state.follow && flight_line(this.world, state);
    if (!line) return;
    if (changed.has('follow')) {
      const across = 3 * chase_metres(line, state.speed, this.world.frame);
      this.scale = Math.max(this.scale,
        Math.min(this.stage.clientWidth, this.stage.clientHeight) / across);
    }
    this.middle = place_at(line, state.time).at.slice(0, 2);
    this.draw();
  }

  on_frame(listener) {
    this.listeners.push(listener);
  }

  resize() {
    const {clientWidth: width, clientHeight: height} = this.stage;
    if (width === 0 || height === 0) return;
    this.ratio = Math.min(2, devicePixelRatio);
    this.canvas.width = width * this.ratio;
    this.canvas.height = height * this.ratio;
    Object.assign(this.canvas.style, {width: `${width}px`, height: `${height}px`});
    if (this.scale) this.#paint();
  }

  #listen() {
    let held = null;
    this.canvas.onpointerdown = (event) => {
      held = [event.offsetX, event.offsetY];
      this.canvas.setPointerCapture(event.pointerId);
    };
    this.canvas.onpointerup = () => { held = null; };
    this.canvas.onpointermove = (event) => {
      if (!held) return;
      this.store.set({follow: false});
      this.middle[0] -= (event.offsetX - held[0]) / this.scale;
      this.middle[1] += (event.offsetY - held[1]) / this.scale;
      held = [event.offsetX, event.offsetY];
      this.draw();
    };
    this.canvas.onwheel = (event) => {
      event.preventDefault();
      const under = this.ground_at(event.offsetX, event.offsetY);
      this.scale *= Math.exp(-event.deltaY * 0.0015);
      const moved = this.ground_at(event.offsetX, event.offsetY);
      this.middle = this.middle.map((value, axis) => value + under[axis] - moved[axis]);
      this.draw();
    };
  }

  look(from) {
    if (from !== 'fit' && from !== 'top') return;
    this.store.set({follow: false});
    const {box, size} = this.world.frame;
    const {clientWidth: width, clientHeight: height} = this.stage;
    const {side, top} = kMargins;
    const scale_in = ({left, bottom}) => Math.min(Math.max(1, width - left - side) / size[0],
      Math.max(1, height - bottom - top) / size[1]);
    const [best] = this.#margins().sort((a, b) => scale_in(b) - scale_in(a));
    this.scale = scale_in(best);
    this.middle = [(box[0][0] + box[1][0]) / 2 - (best.left - side) / 2 / this.scale,
      (box[0][1] + box[1][1]) / 2 - (best.bottom - top) / 2 / this.scale];
    this.draw();
  }

  /** What is left free for numbers and panels: beside the legend, or above it. */
  #margins() {
    const legend = by_id('legend');
    // The names of sources go on below the box.
    const below = kMargins.bottom + by_id('attribution').offsetHeight;
    const right_of = legend.offsetWidth > 0 ? legend.offsetLeft + legend.offsetWidth : 0;
    return [{left: right_of + kMargins.side, bottom: below},
      {left: kMargins.side, bottom: Math.max(below, legend.offsetHeight + kMargins.bottom + 10)}];
  }

  fly_to([x, y], away = this.world.frame.diagonal / 4) {
    this.store.set({follow: false});
    this.middle = [x, y];
    this.scale = Math.max(this.scale, Math.min(this.stage.clientWidth,
      this.stage.clientHeight) / away);
    this.draw();
  }

  draw() {
    this.wanted ??= requestAnimationFrame(() => {
      this.wanted = null;
      this.#paint();
    });
  }

  first_frame() {
    this.resize();
    this.look('fit');
    this.#paint();
    this.context.getImageData(0, 0, 1, 1);
  }

  project([x, y]) {
    return {x: this.stage.clientWidth / 2 + (x - this.middle[0]) * this.scale,
      y: this.stage.clientHeight / 2 - (y - this.middle[1]) * this.scale,
      depth: 1, visible: true};
  }

  ground_at(x, y) {
    const at = [this.middle[0] + (x - this.stage.clientWidth / 2) / this.scale,
      this.middle[1] - (y - this.stage.clientHeight / 2) / this.scale];
    const height = this.world.scene.ground?.height(...at);
    return [...at, height ?? NaN];
  }

  at_height(x, y, z) {
    return [...this.ground_at(x, y).slice(0, 2), z];
  }

  solid_at(x, y) {
    const {context, ratio} = this;
    return this.#present().find((solid) => solid.shape &&
      context.isPointInPath(this.#path(solid), x * ratio, y * ratio, 'evenodd'))?.name ?? null;
  }

  north_deg() {
    return 0;
  }

  metres_per_pixel() {
    return 1 / this.scale;
  }

  /** The sides of the box at which its numbers are: west and south. */
  near_side() {
    return [-1, -1];
  }

  where() {
    return {position: [...this.middle, this.scale], target: [...this.middle, 0],
      flying: false, following: this.store.state.follow};
  }

  memory() {
    return {marks: this.stage.querySelectorAll('.mark').length};
  }

  /** The current drawing: the points that its paths were made of, since 2-D has no buffers. */
  drawn() {
    const lines = this.world.lines.filter(({key}) => this.store.state.shown.has(key))
      .map(({kind, result, step, points}) => ({kind, result, step, points}));
    const {ground} = this.world.scene;
    return {view: '2d', routes: lines.filter(({kind}) => kind !== 'track'),
      tracks: lines.filter(({kind}) => kind === 'track'),
      moving: this.#present().filter(({velocity}) => velocity).map((moving) => ({
        id: moving.id,
        at: drift(moving, this.store.state.time)
          .map((by, axis) => by + (moving.at?.[axis] ?? 0))})),
      bodies: this.#bodies().map(({result, at, nearest}) => ({result, at, nearest: nearest ?
        from_above(this.world.scene.body, nearest.at, nearest.turned).flat() : []})),
      solids: this.#present().reduce((sum, thing) => sum + this.#count(thing), 0),
      ground: ground && {nx: ground.nx, ny: ground.ny, min: ground.min, max: ground.max},
      searched: this.store.state.search ? this.store.state.searched : null};
  }

  #present() {
    const {scene} = this.world;
    const state = this.store.state;
    const times = event_times(scene, state.selected);
    return [...scene.solids, ...scene.boxes, ...scene.meshes, ...scene.moving].filter((thing) =>
      !state.hidden.has(layer_key(thing)) && present(thing, times, state) &&
      this.#count(thing) > 0);
  }

  #count(thing) {
    const {cut, time} = this.store.state;
    return count_below(thing, cut, this.world.frame.box, time);
  }

  #paint() {
    const {context, canvas, ratio} = this;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.fillStyle = style_of('--sky');
    context.fillRect(0, 0, canvas.width, canvas.height);
    this.#paint_ground();
    const {basemap, contours, grid} = this.store.state;
    if (basemap && this.world.basemap) this.#paint_basemap(this.world.basemap);
    if (contours && this.world.contour_step) this.#paint_contours(this.world.contour_step);
    if (grid) this.#paint_grid();
    for (const thing of this.#present()) this.#paint_solid(thing);
    this.#paint_circles();
    this.#paint_search();
    // A track is a band under the route.
    const under = ({kind}) => kind === 'track' ? 0 : 1;
    for (const line of this.world.lines.toSorted((a, b) => under(a) - under(b))) {
      this.#paint_line(line);
    }
    for (const body of this.#bodies()) this.#paint_body(body);
    for (const listener of this.listeners) listener();
  }

  #paint_ground() {
    const {ground} = this.world.scene;
    if (!ground) return;
    // The pixel of a post extends half a cell to each side of it.
    const corner = this.project([ground.x0 - ground.dx / 2,
      ground.y0 + (ground.ny - 0.5) * ground.dy]);
    this.context.drawImage(this.image, corner.x, corner.y,
      ground.nx * ground.dx * this.scale, ground.ny * ground.dy * this.scale);
  }

  #paint_basemap({box: [low, high], image}) {
    const corner = this.project([low[0], high[1]]);
    this.context.drawImage(image, corner.x, corner.y,
      (high[0] - low[0]) * this.scale, (high[1] - low[1]) * this.scale);
  }

  #paint_contours(step) {
    const {clientWidth, clientHeight} = this.stage;
    this.context.drawImage(contour_image(this.world.scene.ground, step, [clientWidth, clientHeight],
      this.ground_at(0, 0), 1 / this.scale), 0, 0);
  }

  #stroke(points, width, color, dash = []) {
    const {context} = this;
    context.beginPath();
    for (const point of points) {
      const {x, y} = this.project(point);
      context.lineTo(x, y);
    }
    context.setLineDash(dash);
    Object.assign(context, {lineWidth: width, strokeStyle: color, lineJoin: 'round',
      lineCap: 'round'});
    context.stroke();
    context.setLineDash([]);
  }

  #paint_grid() {
    const [low, high] = this.world.frame.box;
    this.context.globalAlpha = 0.25;
    const color = style_of('--ink');
    for (const x of grid_lines([low, high], 0).lines) {
      this.#stroke([[x, low[1]], [x, high[1]]], 1, color);
    }
    for (const y of grid_lines([low, high], 1).lines) {
      this.#stroke([[low[0], y], [high[0], y]], 1, color);
    }
    this.context.globalAlpha = 1;
    this.#stroke([low, [high[0], low[1]], high, [low[0], high[1]], low], 1, color);
  }

  #paint_circles() {
    for (const {at, radius} of circles(this.world.scene)) {
      const {x, y} = this.project(at);
      this.context.beginPath();
      this.context.arc(x, y, radius * this.scale, 0, 2 * Math.PI);
      Object.assign(this.context, {lineWidth: 1, strokeStyle: style_of('--ink')});
      this.context.stroke();
    }
  }

  #path(solid) {
    const path = new Path2D();
    const [east, north] = solid.velocity ? drift(solid, this.store.state.time) : [0, 0];
    for (const ring of outline(solid)) {
      for (const [at, [x, y]] of ring.entries()) {
        const pixel = this.project([x + east, y + north]);
        if (at === 0) path.moveTo(pixel.x * this.ratio, pixel.y * this.ratio);
        else path.lineTo(pixel.x * this.ratio, pixel.y * this.ratio);
      }
      path.closePath();
    }
    return path;
  }

  #paint_solid(thing) {
    const {context, ratio} = this;
    const color = role_color(thing.role);
    const path = thing.shape ? this.#path(thing) : this.#many(thing);
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.fillStyle = color;
    context.globalAlpha = kOpacity[thing.role];
    context.fill(path, thing.shape ? 'evenodd' : 'nonzero');
    if (thing.shape) {
      context.globalAlpha = 1;
      context.setLineDash(thing.known ? [] : [6 * ratio, 4 * ratio]);
      Object.assign(context, {lineWidth: ratio * 1.2, strokeStyle: mix(color, '#000000', 0.3)});
      context.stroke(path);
      context.setLineDash([]);
    }
    context.globalAlpha = 1;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
  }

  #many(thing) {
    return path_of_many(thing, this.store.state.cut, (point) => {
      const {x, y} = this.project(point);
      return {x: x * this.ratio, y: y * this.ratio};
    });
  }

  #paint_search() {
    const {search, searched} = this.store.state;
    if (!search) return;
    const edges = kKinds.map(() => new Path2D());
    const points = kKinds.map(() => new Path2D());
    for (let event = 0; event < searched; event++) {
      if (searched > search.until[event]) continue;
      const [from, to] = [search.parent, search.at].map((values) =>
        this.project(values.subarray(3 * event, 3 * event + 2)));
      edges[search.kind[event]].moveTo(from.x, from.y);
      edges[search.kind[event]].lineTo(to.x, to.y);
      points[search.kind[event]].rect(to.x - 1.5, to.y - 1.5, 3, 3);
    }
    kKinds.forEach((color, kind) => {
      Object.assign(this.context, {lineWidth: 0.7, strokeStyle: color, fillStyle: color});
      this.context.stroke(edges[kind]);
      this.context.fill(points[kind]);
    });
  }

  #bodies() {
    const {bodies, shown} = this.store.state;
    return bodies ? bodies_of(this.world.scene).filter(({key}) => shown.has(key)) : [];
  }

  #paint_body({result, at, turned, nearest}) {
    const color = route_color(result, this.store.state.theme);
    const {context} = this;
    context.globalAlpha = 0.3;
    at.forEach((place, n) => this.#fill_body(place, turned[n], color));
    context.globalAlpha = 1;
    if (nearest) this.#fill_body(nearest.at, nearest.turned, color);
  }

  #fill_body(at, turned, color) {
    const path = new Path2D();
    for (const corners of from_above(this.world.scene.body, at, turned)) {
      const [first, ...others] = corners.map((corner) => this.project(corner));
      path.moveTo(first.x, first.y);
      for (const {x, y} of others) path.lineTo(x, y);
    }
    this.context.fillStyle = color;
    this.context.fill(path);
  }

  #paint_line({key, kind, result, points}) {
    const {shown, theme} = this.store.state;
    if (!shown.has(key)) return;
    const color = route_color(result, theme);
    if (kind === 'attempt') {
      this.#stroke(points, 2, color, [7, 6]);
    } else {
      const [around, core] = kind === 'track' ? [color, mix(color, '#ffffff', 0.65)] :
        [casing(color), color];
      const width = kind === 'track' ? 4.8 : 3;
      this.#stroke(points, width + 2.2, around);
      this.#stroke(points, width, core);
    }
  }
}
