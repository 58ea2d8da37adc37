// SPDX-License-Identifier: Apache-2.0
import {bodies_of, closeness} from '../body.js';
import {route_color} from '../colors.js';
import {by_id, element} from '../dom.js';
import {between, place_at} from '../world.js';
import {violations_of} from './violations.js';

const kMaxViolations = 200;

/** Marks of constant screen size: start, goal, vehicles, the cursor. */
export function build_marks(view, world, store) {
  const {scene} = world;
  const marks = [];
  const add = (name, text, place, shape) => {
    const made = element('div', {className: `mark ${name}`}, shape ?? '',
      element('span', {}, text));
    by_id('marks').append(made);
    marks.push({made, place});
    return made;
  };
  if (scene.start) add('start', 'Start', () => scene.start);
  (scene.via ?? []).forEach(({at}, index) => add('via', `Via ${index + 1}`, () => at));
  if (scene.goal) add('goal', 'Goal', () => scene.goal.at);
  for (const {place, line} of violations_of(world).slice(0, kMaxViolations)) {
    add('violation', '', () => store.state.shown.has(line) ? place : null);
  }
  for (const line of world.lines.filter(({kind}) => kind === 'track')) {
    add_vehicle(line, add, view, store);
  }
  for (const {key, nearest} of bodies_of(scene).filter((body) => body.nearest)) {
    add('body', closeness(nearest), () =>
      store.state.bodies && store.state.shown.has(key) ? nearest.at : null);
  }
  add('cursor', '', () => store.state.cursor?.at ?? null);

  const north = by_id('north');
  north.append(element('span', {}, 'N'));
  const place_all = () => {
    for (const {made, place} of marks) {
      const point = place();
      const seen = point && view.project(point);
      made.hidden = !seen?.visible;
      if (seen) made.style.transform = `translate(${seen.x.toFixed(1)}px,${seen.y.toFixed(1)}px)`;
    }
    north.style.transform = `rotate(${view.north_deg()}deg)`;
  };
  view.on_frame(place_all);
  store.on(['cursor', 'time', 'shown', 'bodies', 'theme'], place_all);
}

function add_vehicle(line, add, view, store) {
  const arrow = element('i', {});
  const made = add('vehicle', '', () => {
    if (!store.state.shown.has(line.key)) return null;
    const {at, ahead} = place_at(line, store.state.time);
    const [here, next] = [view.project(at), view.project(between(at, ahead, 0.05))];
    const moved = Math.hypot(next.x - here.x, next.y - here.y) > 1e-6;
    if (moved) {
      made.heading = Math.atan2(next.x - here.x, here.y - next.y);
      arrow.style.transform = `rotate(${made.heading}rad)`;
    }
    made.style.setProperty('--swatch', route_color(line.result, store.state.theme));
    return at;
  }, arrow);
}
