// SPDX-License-Identifier: Apache-2.0
import {bodies_of, closeness} from '../body.js';
import {route_color} from '../colors.js';
import {by_id, element} from '../dom.js';
import {keep_built} from '../store.js';
import {between, flight_line, place_at} from '../world.js';
import {violations_of} from './violations.js';

const kMaxViolations = 200;
const kToldViolations = 3;
// Of a longer mission every second, third, … item has its number.
const kMaxNumbers = 200;
// Pixels from a mark's middle to its rim.
const kRadius = 8;
const kBodyRadius = 11;

/** Marks of constant screen size: start, goal, vehicles, the cursor. Returns them with their labels,
 *  the most important first: {made, span, place, radius}; `build_labels` places both. */
export function build_marks(view, world, store) {
  const marks = [];
  keep_built(store, () => {
    const stood = new Map(marks.map((mark) => [mark.span.textContent, mark.stood]));
    for (const {made} of marks) made.remove();
    marks.length = 0;
    fill(marks, view, world, store);
    // A label stays where it stood.
    for (const mark of marks) mark.stood = stood.get(mark.span.textContent);
  });
  return marks;
}

function fill(marks, view, world, store) {
  const {scene} = world;
  const add = (name, text, place, {shape = '', radius = kRadius} = {}) => {
    const span = element('span', {}, text);
    const made = element('div', {className: `mark ${name}`}, shape, span);
    by_id('marks').append(made);
    marks.push({made, span, place, radius});
    return made;
  };
  if (scene.start) add('start', 'Start', () => scene.start);
  if (scene.goal) add('goal', 'Goal', () => scene.goal.at);
  for (const {key, nearest} of bodies_of(scene).filter((body) => body.nearest)) {
    add('body', closeness(nearest), () =>
      store.state.bodies && store.state.shown.has(key) ? nearest.at : null, {radius: kBodyRadius});
  }
  (scene.via ?? []).forEach(({at}, index) => add('via', `Via ${index + 1}`, () => at));
  violations_of(world).slice(0, kMaxViolations).forEach(({place, line, message}, nth) => {
    // While one edits, the first ones say by how much.
    const text = scene.edit && nth < kToldViolations ? message : '';
    add('violation', text, () => store.state.shown.has(line) ? place : null);
  });
  const numbered = scene.numbered ?? [];
  const every = Math.ceil(numbered.length / kMaxNumbers);
  numbered.filter((_, nth) => nth % every === 0).forEach(({number, at}) => add('via', `${number}`, () => at));
  for (const line of world.lines.filter(({kind}) => kind === 'track')) {
    add_vehicle(line, add, view, world, store);
  }
  add('cursor', '', () => store.state.cursor?.at ?? null);
}

function add_vehicle(line, add, view, world, store) {
  const arrow = element('i', {});
  const made = add('vehicle', '', () => {
    const {state} = store;
    // The followed one is a part of the picture in three dimensions.
    if (!state.shown.has(line.key) || view.draws_followed && state.follow &&
      flight_line(world, state) === line) return null;
    const {at, ahead} = place_at(line, state.time);
    const [here, next] = [view.project(at), view.project(between(at, ahead, 0.05))];
    const moved = Math.hypot(next.x - here.x, next.y - here.y) > 1e-6;
    if (moved) {
      made.heading = Math.atan2(next.x - here.x, here.y - next.y);
      arrow.style.transform = `rotate(${made.heading}rad)`;
    }
    made.style.setProperty('--swatch', route_color(line.result, state.theme));
    return at;
  }, {shape: arrow});
}

/** The needle, and the N at its head, which stays upright. */
export function build_compass(view) {
  const needle = element('i', {});
  const letter = element('span', {}, 'N');
  by_id('north').append(needle, letter);
  view.on_frame(() => {
    const turned = view.north_deg();
    needle.style.transform = `rotate(${turned}deg)`;
    letter.style.transform = `rotate(${turned}deg) translateY(var(--head)) rotate(${-turned}deg)`;
  });
}
