// SPDX-License-Identifier: Apache-2.0
import {AmbientLight, Color, DirectionalLight, Group, Raycaster, Scene, Vector2, Vector3,
  WebGLRenderer} from 'three';
import {style_of} from '../colors.js';
import {event_times, flight_line} from '../world.js';
import {Bodies} from './bodies.js';
import {Camera} from './camera.js';
import {Chase} from './chase.js';
import {Floor} from './floor.js';
import {Goals} from './goals.js';
import {Grid} from './grid.js';
import {Lines} from './lines.js';
import {Search} from './search.js';
import {basemap_on} from './shaders.js';
import {Solids} from './solids.js';
import {Terrain} from './terrain.js';
import {Vehicle} from './vehicle.js';

// A full frame that takes longer than this is replaced by a coarse one while the picture moves.
const kSlowMs = 60;
const kRestMs = 160;
const kHair = 1e-4;
// Above everything: shaders may not support infinity.
const kNowhere = 1e9;

/** The world in three dimensions. Its root is stretched vertically by the exaggeration. */
export class View3 {
  constructor(stage, world, store, for_picture) {
    // The clock of what moves by itself, in milliseconds.
    Object.assign(this, {stage, world, store, listeners: [], now: () => performance.now()});
    this.draws_followed = true;
    const {scene, frame, lines} = world;
    const software = is_software();
    this.renderer = new WebGLRenderer({antialias: for_picture || !software,
      powerPreference: 'high-performance'});
    this.renderer.setPixelRatio(Math.min(2, devicePixelRatio));
    // Checking each shader waits for its compiler: a third of the first frame.
    this.renderer.debug.checkShaderErrors = false;
    this.canvas = this.renderer.domElement;
    this.canvas.tabIndex = 0;
    stage.prepend(this.canvas);
    this.root = new Group();
    this.picture = new Scene().add(this.root, ...lights());
    this.camera = new Camera(this.canvas, frame, () => this.draw());
    this.cut = {value: kNowhere};
    this.camera.turned = () => this.chase.read(this.camera.back());
    this.chase = new Chase(world);
    this.vehicle = new Vehicle(world);
    this.contours = {value: new Vector2(0, frame.centre[2])};
    this.basemap = basemap_on(world);
    this.terrain = scene.ground ? new Terrain(scene.ground, frame, this.cut, this.contours, this.basemap) : null;
    this.floor = scene.ground ? null : new Floor(frame, this.basemap);
    this.solids = new Solids(scene, frame);
    this.lines = new Lines(lines, scene.ground, frame);
    this.grid = new Grid(frame, scene.ground, this.cut);
    this.goals = new Goals(scene, frame);
    this.bodies = new Bodies(scene, frame);
    this.root.add((this.terrain ?? this.floor).object, this.grid.object, this.vehicle.plumb,
      this.goals.object, this.solids.object, this.lines.object, this.bodies.object);
    this.full_frame_ms = 0;
    this.#rest_after_motion();
    new ResizeObserver(() => this.resize()).observe(stage);
    this.resize();
    this.update(store.state, new Set(['theme', 'exaggeration']));
    this.look('fit');
    // Shaders compile while the panels are built.
    this.renderer.compile(this.picture, this.camera.eye);
    store.on(['version'], () => this.#rebuild());
    store.on(['shown', 'hidden', 'selected', 'time', 'everything', 'grid', 'contours', 'basemap', 'bodies', 'theme',
      'exaggeration', 'cut', 'search', 'searched', 'follow'], (state, changed) => this.update(state, changed));
  }

  /** Everything that depends on the scene, but for its ground. */
  #rebuild() {
    const {scene, frame, lines} = this.world;
    this.#replace('lines', new Lines(lines, scene.ground, frame));
    this.#replace('goals', new Goals(scene, frame));
    if (scene.body) this.#replace('bodies', new Bodies(scene, frame));
    if (!this.solids.is_of(scene)) {
      this.#replace('solids', new Solids(scene, frame));
      this.chase.skyline = null;
    }
    this.update(this.store.state, new Set());
  }

  #replace(name, made) {
    this.root.remove(this[name].object);
    this[name].object.traverse(({geometry, material}) => {
      geometry?.dispose();
      for (const one of [material].flat()) one?.dispose();
    });
    this[name] = made;
    this.root.add(made.object);
  }

  on_frame(listener) {
    this.listeners.push(listener);
  }

  resize() {
    const {clientWidth: width, clientHeight: height} = this.stage;
    if (width === 0 || height === 0 || width === this.width && height === this.height) return;
    Object.assign(this, {width, height});
    this.renderer.setSize(width, height);
    this.camera.resize(width, height);
    if (this.overview) this.look('fit');
    // Paint now: an empty canvas would flicker.
    if (this.started) this.#paint();
  }

  update(state, changed) {
    this.root.scale.z = state.exaggeration;
    this.root.updateMatrixWorld();
    // Slightly lower than the tops of cut solids: in the same plane the two would flicker.
    const {centre, diagonal} = this.world.frame;
    this.cut.value = Math.min(kNowhere, state.cut - centre[2] - kHair * diagonal);
    this.contours.value.x = state.contours ? this.world.contour_step ?? 0 : 0;
    if (this.basemap) this.basemap.basemap_shown.value = Number(state.basemap);
    this.lines.update(state);
    this.solids.update(state, event_times(this.world.scene, state.selected));
    this.grid.update(state);
    this.goals.update(state);
    this.bodies.update(state);
    (this.terrain ?? this.floor).paint(state);
    if (changed.has('follow')) this.#begin_or_end(state.follow);
    if (changed.has('theme')) this.picture.background = new Color(style_of('--sky'));
    if (changed.has('exaggeration')) this.#stretched(state.exaggeration);
    if (changed.has('search')) this.#replace_search(state.search);
    this.search?.show(state.searched);
    this.draw();
  }

  /** Keeps everything in the picture until the user moves the eye. The hillshade is updated when
   *  the slider rests. */
  #stretched(exaggeration) {
    if (this.overview) this.look('fit');
    clearTimeout(this.relighting);
    if (!this.terrain || exaggeration === (this.lit ?? 1)) return;
    this.relighting = setTimeout(() => {
      this.lit = exaggeration;
      this.terrain.light(exaggeration);
      this.draw();
    }, 120);
  }

  #replace_search(playback) {
    if (this.search) this.root.remove(this.search.object);
    this.search = playback && new Search(playback, this.world.frame);
    if (this.search) this.root.add(this.search.object);
  }

  #rest_after_motion() {
    const {controls} = this.camera;
    controls.addEventListener('start', () => {
      this.moving = true;
      this.overview = false;
    });
    controls.addEventListener('end', () => {
      this.moving = false;
      this.draw();
    });
    // A wheel event starts and ends at once but counts as motion.
    this.canvas.addEventListener('wheel', () => { this.moved = performance.now(); });
  }

  /** How long the eye is on its way when it begins to follow. */
  comes_in(milliseconds) {
    this.chase.come_ms = milliseconds;
  }

  #begin_or_end(follow) {
    this.camera.controls.enablePan = !follow;
    this.vehicle.plumb.visible = false;
    if (!follow) return;
    this.overview = false;
    this.camera.flight = null;
    this.chase.begin(this.camera, this.now(), !this.store.state.filmed &&
      matchMedia('(prefers-reduced-motion: reduce)').matches);
  }

  /** Puts the eye behind the vehicle; true if it moves on by itself. */
  #follow() {
    const {state} = this.store;
    const line = state.follow && flight_line(this.world, state);
    if (!line) return false;
    const pose = this.chase.pose(line, state, this.now());
    this.camera.place(pose);
    this.vehicle.update(line, state, {eye: this.camera.eye,
      pixel_at: (depth) => this.camera.pixel_at(depth, this.height)});
    return pose.moving;
  }

  /** Requests a frame; several requests share one. */
  draw() {
    if (!this.started) return;
    this.wanted ??= requestAnimationFrame((now) => {
      this.wanted = null;
      const moving = this.camera.advance(now) || this.#follow();
      this.#paint(moving);
      // A film asks for each frame.
      if (moving && !this.store.state.filmed) this.draw();
    });
  }

  #paint(flying = false) {
    const state = this.store.state;
    const in_motion = flying || this.moving || state.playing ||
      performance.now() - (this.moved ?? -Infinity) < kRestMs;
    const coarse = in_motion && this.full_frame_ms > kSlowMs;
    this.terrain?.show_coarse(coarse);
    clearTimeout(this.resting);
    if (coarse) this.resting = setTimeout(() => this.draw(), kRestMs + 20);
    this.camera.before_frame(state.exaggeration);
    this.renderer.render(this.picture, this.camera.eye);
    if (state.follow) this.#paint_vehicle();
    for (const listener of this.listeners) listener();
  }

  /** In front of all that is drawn. */
  #paint_vehicle() {
    this.renderer.autoClear = false;
    this.renderer.clearDepth();
    this.renderer.render(this.vehicle.picture, this.camera.eye);
    this.renderer.autoClear = true;
  }

  /** Draws everything and waits until it is in the picture's buffer. */
  first_frame() {
    const since = performance.now();
    // The panels have their final sizes by now.
    this.resize();
    this.look('fit');
    this.started = true;
    this.#paint();
    const gl = this.renderer.getContext();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    // About half of the first frame is the upload of the buffers, which is not repeated.
    this.full_frame_ms = (performance.now() - since) / 2;
  }

  #place(point) {
    const local = this.world.frame.local(point);
    local[2] *= this.store.state.exaggeration;
    return new Vector3(...local);
  }

  /** Pixels from the stage's top left, depth in front of the eye, and visibility. */
  project(point) {
    const {eye} = this.camera;
    const before_eye = this.#place(point).applyMatrix4(eye.matrixWorldInverse);
    const depth = -before_eye.z;
    const seen = before_eye.applyMatrix4(eye.projectionMatrix);
    return {depth, x: (seen.x + 1) / 2 * this.stage.clientWidth,
      y: (1 - seen.y) / 2 * this.stage.clientHeight, visible: seen.z < 1 && seen.z > -1};
  }

  #ray(x, y) {
    const caster = new Raycaster();
    caster.setFromCamera(new Vector2(2 * x / this.stage.clientWidth - 1,
      1 - 2 * y / this.stage.clientHeight), this.camera.eye);
    return caster;
  }

  /** The point of the ground, or of the box's floor where there is none, at a pixel. */
  ground_at(x, y) {
    const {frame, scene} = this.world;
    if (!scene.ground) return this.at_height(x, y, frame.box[0][2]);
    const [from, along] = this.#sight(x, y);
    return scene.ground.hit(from, along, this.camera.eye.far, this.store.state.cut);
  }

  /** The point at a height under a pixel; null where one looks away from it. */
  at_height(x, y, z) {
    const [from, along] = this.#sight(x, y);
    const t = (z - from[2]) / along[2];
    return t > 0 ? from.map((value, axis) => value + t * along[axis]) : null;
  }

  /** The eye and the direction of a pixel, in the world. */
  #sight(x, y) {
    const {origin, direction} = this.#ray(x, y).ray;
    const stretch = this.store.state.exaggeration;
    return [this.world.frame.world([origin.x, origin.y, origin.z / stretch]),
      [direction.x, direction.y, direction.z / stretch]];
  }

  /** The name of the solid at a pixel. */
  solid_at(x, y) {
    return this.solids.name_at(this.#ray(x, y));
  }

  look(from) {
    const stretch = this.store.state.exaggeration;
    this.store.set({follow: false});
    this.overview = from === 'fit';
    if (from === 'fit') this.camera.put(this.camera.fit(stretch));
    if (from === 'top') this.camera.fly(this.camera.fit(stretch, 180, 90));
    if (from === 'north') {
      const pitch = 90 - this.camera.controls.getPolarAngle() * 180 / Math.PI;
      this.camera.fly(this.camera.fit(stretch, 180, pitch));
    }
  }

  /** `away` limits the distance from the eye. */
  fly_to(point, away) {
    this.overview = false;
    this.store.set({follow: false});
    this.camera.fly_to(this.#place(point), away);
  }

  /** Clockwise rotation of the north arrow. */
  north_deg() {
    return this.camera.heading_deg();
  }

  /** In the middle of the picture. */
  metres_per_pixel() {
    return this.camera.pixel_at(this.camera.back().length(), this.height);
  }

  /** The sides of the box nearer to the eye: of x and of y -1 for the lower, 1 for the upper. */
  near_side() {
    const hair = kHair * this.world.frame.diagonal;
    return this.camera.eye.position.toArray().slice(0, 2).map((at) => at > hair ? 1 : -1);
  }

  where() {
    const {eye, controls} = this.camera;
    return {position: eye.position.toArray(), target: controls.target.toArray(),
      flying: this.camera.flight !== null, following: this.store.state.follow};
  }

  memory() {
    return {geometries: this.renderer.info.memory.geometries, marks: this.stage.querySelectorAll('.mark').length};
  }

  drawn() {
    return {view: '3d', ...this.lines.drawn(), ...this.solids.drawn(),
      moving: this.solids.moved(), bodies: this.bodies.drawn(),
      ground: this.terrain?.drawn() ?? null, floor: this.floor?.drawn() ?? null, searched: this.search ?
        this.search.points.material.uniforms.now.value : null};
  }
}

function lights() {
  const sun = new DirectionalLight(0xffffff, 1.7);
  sun.position.set(-1, 1, 1.6);
  return [sun, new AmbientLight(0xffffff, 1.7)];
}

/** True for a software renderer, where multisampling takes longer than everything else. */
function is_software() {
  const gl = document.createElement('canvas').getContext('webgl2');
  if (!gl) throw new Error('no WebGL');
  const info = gl.getExtension('WEBGL_debug_renderer_info');
  const name = info ? gl.getParameter(info.UNMASKED_RENDERER_WEBGL) : '';
  gl.getExtension('WEBGL_lose_context')?.loseContext();
  return /swiftshader|llvmpipe|softpipe|software/i.test(name);
}
