// SPDX-License-Identifier: Apache-2.0
import {decode, read_scene} from './scene.js';
import {set_series} from './colors.js';
import {contour_step} from './contours.js';
import {build_editor} from './edit/editor.js';
import {by_id} from './dom.js';
import {show_scene, tried_lines} from './live.js';
import {Store} from './store.js';
import {Frame, hidden_at_first, lines_of} from './world.js';
import {build_film} from './ui/film.js';
import {build_panels} from './ui/panels.js';
import {follow_theme} from './ui/theme.js';
import {View2} from './view2/view.js';
import {View3} from './view3/view.js';

const query = new URLSearchParams(location.search);
const altiplan = window.altiplan = {ready: false, ready_ms: null, errors: []};

function complain(sentence) {
  altiplan.errors.push(sentence);
  const alert = by_id('alert');
  alert.textContent = sentence;
  alert.hidden = false;
}
addEventListener('error', (event) => complain(event.message));
addEventListener('unhandledrejection', (event) => complain(String(event.reason)));

/** The altitude in the address; everything but lines is hidden above it. */
function asked_cut(text) {
  const height = Number(text);
  if (text.trim() !== '' && Number.isFinite(height)) return height;
  complain(`The address says cut=${text}: expected a height in metres.`);
  return Infinity;
}

function first_state(scene, lines) {
  const shown = new Set(lines.filter(({kind}) => kind !== 'attempt').map(({key}) => key));
  const with_route = scene.results.findIndex(({route, flight}) => route?.length || flight);
  const selected = scene.selected ?? Math.max(0, with_route);
  const exaggeration = Math.min(5, Math.max(1, Number(query.get('z')) || 1));
  const cut = query.has('cut') ? asked_cut(query.get('cut')) : Infinity;
  return {shown, hidden: hidden_at_first(scene), selected, source: 'route', time: 0, playing: false, speed: 1,
    follow: false, filmed: false, zoom: null, cursor: null, exaggeration, cut, grid: true, contours: true,
    basemap: true, bodies: true, version: 0,
    everything: false, theme: 'light', tab: 'profiles',
    search: null, searched: 0, legend: query.has('still') || innerWidth > 820};
}

function make_view(stage, world, store) {
  if (query.has('flat')) return new View2(stage, world, store);
  try {
    return new View3(stage, world, store, query.has('still') || query.has('film'));
  } catch (error) {
    if (!/WebGL/i.test(error.message)) throw error;
    by_id('readout').dataset.note = '2-D: this browser has no WebGL';
    return new View2(stage, world, store);
  }
}

/** The picture without panels, after all events, seen from the south-west at 35°. */
function still(view, store) {
  document.body.classList.add('still');
  const last = Math.max(0, ...view.world.lines.map(({times}) => times?.at(-1) ?? 0));
  store.set({time: last});
  view.resize();
  view.look('fit');
}

/** Shows another scene, or a part of one; resolves when it is drawn. */
function show(next, view, world, store) {
  decode(next);
  show_scene(world, store, next);
  return new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve)));
}

/** The basemap with its image decoded; null without one. */
async function decoded(basemap) {
  if (!basemap) return null;
  const image = Object.assign(new Image(), {src: basemap.image});
  await image.decode();
  return {...basemap, image};
}

async function start() {
  const scene = read_scene(by_id('scene').textContent);
  set_series(scene.results);
  const lines = lines_of(scene.results);
  const tried = new Set(scene.edit ? tried_lines(lines, scene.results) : []);
  const world = {scene, frame: new Frame(scene.box), lines, tried, contour_step: contour_step(scene.ground),
    basemap: await decoded(scene.basemap)};
  const store = new Store(first_state(scene, lines));
  store.set({shown: new Set([...store.state.shown, ...tried])});
  follow_theme(store, query.get('theme'));
  for (const alone of ['still', 'film']) if (query.has(alone)) document.body.classList.add(alone);
  const view = make_view(by_id('stage'), world, store);
  const {labels} = build_panels(view, world, store);
  if (query.has('still')) still(view, store);
  Object.assign(altiplan, {drawn: () => view.drawn(), camera: () => view.where(),
    project: (point) => view.project(point), memory: () => ({...view.memory(), ...store.memory()}), labels, state: store.state, still: () => still(view, store),
    film: build_film(view, world, store), show: (next) => show(next, view, world, store)});
  if (scene.edit && !query.has('still') && !query.has('film')) {
    altiplan.editor = build_editor(view, world, store, complain);
  }
  view.first_frame();
  altiplan.ready_ms = performance.now();
  altiplan.ready = true;
}

start().catch((error) => complain(error.message));
