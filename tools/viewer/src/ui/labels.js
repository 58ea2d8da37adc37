// SPDX-License-Identifier: Apache-2.0
import {by_id, element} from '../dom.js';
import {number} from '../units.js';
import {grid_lines} from '../world.js';

// Pixels. A number farther from its line would seem to belong to another.
const kReach = {number: 60, name: 200};
const kGap = 3;
// Not the readout, which would make labels jump whenever the pointer enters or leaves.
const kPanels = ['legend', 'attribution', 'north'];

/** The grid's numbers and the axes' names, all within the picture. */
export function build_labels(view, world, store) {
  const labels = texts(world.frame, world.scene.ground).map((label) => {
    const span = element('span', {}, label.text);
    const made = element('div', {className: 'mark tick'}, span);
    by_id('marks').append(made);
    return {...label, made, size: [span.offsetWidth, span.offsetHeight]};
  });
  const place_all = () => {
    const stage = by_id('stage');
    const panels = panels_on(stage);
    const numbers = [];
    for (const {kind, point, size, made} of labels) {
      const wish = store.state.grid ? view.project(point) : null;
      const place = wish?.visible ? free_place(wish, size, stage,
        kind === 'name' ? [...panels, ...numbers] : panels, kReach[kind]) : null;
      made.hidden = !place;
      if (!place) continue;
      made.style.transform = `translate(${place.x.toFixed(1)}px,${place.y.toFixed(1)}px)`;
      if (kind === 'number') numbers.push(around(place, size));
    }
  };
  view.on_frame(place_all);
  store.on(['grid', 'legend'], place_all);
}

/** Numbers along the south and the west side, the axes' names beside them. */
function texts(frame, ground) {
  const {box: [low, high], box} = frame;
  const base = frame.base(ground);
  // From both sides: a share of one side would place them far from a long and narrow box.
  const side = Math.sqrt(frame.size[0] * frame.size[1]);
  const beside = (share, axis) => low[axis] - side * share;
  const middle = (axis) => (low[axis] + high[axis]) / 2;
  const on_south = grid_lines(box, 0).lines.map((x) =>
    ({kind: 'number', point: [x, beside(0.02, 1), base], text: number(x)}));
  const on_west = grid_lines(box, 1).lines.map((y) =>
    ({kind: 'number', point: [beside(0.03, 0), y, base], text: number(y)}));
  return [...on_south, ...on_west,
    {kind: 'name', point: [middle(0), beside(0.1, 1), base], text: 'x east, m'},
    {kind: 'name', point: [beside(0.17, 0), middle(1), base], text: 'y north, m'}];
}

/** The panels on the picture, in pixels from the stage's top left. */
function panels_on(stage) {
  const {left, top} = stage.getBoundingClientRect();
  return kPanels.map((id) => by_id(id).getBoundingClientRect())
    .filter(({width}) => width > 0)
    .map((panel) => ({left: panel.left - left, top: panel.top - top,
      right: panel.right - left, bottom: panel.bottom - top}));
}

/** The rectangle of a label with the middle of its top at x, y. */
const around = ({x, y}, [width, height]) =>
  ({left: x - width / 2, top: y, right: x + width / 2, bottom: y + height});

const apart = (a, b) => a.left >= b.right + kGap || b.left >= a.right + kGap ||
  a.top >= b.bottom + kGap || b.top >= a.bottom + kGap;

/** The position nearest to `wish` inside the picture and clear of `taken`; null if there is none
 *  within `reach`. */
function free_place(wish, [width, height], stage, taken, reach) {
  const inside = ({x, y}) => ({
    x: Math.min(Math.max(x, width / 2 + kGap), stage.clientWidth - width / 2 - kGap),
    y: Math.min(Math.max(y, kGap), stage.clientHeight - height - kGap)});
  const start = inside(wish);
  const beside = taken.flatMap(({left, top, right, bottom}) => [
    {x: start.x, y: top - height - kGap}, {x: start.x, y: bottom + kGap},
    {x: right + width / 2 + kGap, y: start.y}, {x: left - width / 2 - kGap, y: start.y}]);
  const away = ({x, y}) => Math.hypot(x - wish.x, y - wish.y);
  const free = [start, ...beside.map(inside)].filter((place) => away(place) <= reach &&
    taken.every((other) => apart(around(place, [width, height]), other)));
  return free.sort((a, b) => away(a) - away(b))[0] ?? null;
}
