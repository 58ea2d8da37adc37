// SPDX-License-Identifier: Apache-2.0
import {contour_places} from '../contours.js';
import {by_id, element} from '../dom.js';
import {mark_text} from '../units.js';
import {grid_lines, grid_unit} from '../world.js';
import {around, places_beside, Room} from './place.js';

// Pixels between an edge of the box, its numbers and its name.
const kFromEdge = 6;
const kFromNumbers = 4;
// Between two numbers, more than between other labels: they are no one number.
const kBetween = 6;
// Between two heights of contours.
const kBetweenHeights = 80;
// The share of the box's diagonal within which the ground at a pixel is that of a contour there.
const kNear = 0.01;
// A number farther from its line than this would seem to belong to another.
const kReach = 30;
// Where along an edge its name may stand.
const kShares = [0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8, 0.1, 0.9, 0, 1];
// Every n-th number is shown, for the least n of these with which none is on another.
const kEvery = [1, 2, 5, 10];
const kPanels = ['legend', 'attribution', 'north', 'scale', 'readout', 'telemetry', 'caption', 'alert'];

/** Places all labels on the picture at each frame: those of the marks, then the grid's numbers and
 *  the axes' names, where there is room. None is on another one, on a panel, or cut. */
export function build_labels(view, world, store, marks) {
  const axes = [0, 1].map((axis) => axis_of(axis, world));
  const heights = heights_of(world);
  let readout = null;
  const place_all = () => {
    const stage = by_id('stage');
    // All are read before one is written: each change in between would cost a layout.
    const panels = panels_on(stage);
    // Its place is kept when the pointer leaves: labels would jump.
    if (!(readout?.left <= panels.readout?.left)) readout = panels.readout ?? readout;
    const room = new Room(stage.clientWidth, stage.clientHeight,
      [...Object.values(panels), ...(readout ? [readout] : [])]);
    for (const mark of marks) mark.size = size_of(mark);
    for (const label of [...axes.flatMap(({numbers, name}) => [...numbers, name]), ...heights]) {
      label.size = size_of(label);
    }
    place_marks(marks, view, room, Object.values(panels));
    // From near by, numbers on far edges would lie on what is in front of these.
    const {contours, grid, follow} = store.state;
    for (const axis of axes) place_axis(axis, view, room, grid && !follow);
    place_heights(heights, view, room, contours && !follow);
  };
  view.on_frame(place_all);
  // All else that matters draws a frame.
  store.on(['cursor', 'legend'], place_all);
  new ResizeObserver(place_all).observe(by_id('telemetry'));
}

/** The size of a label does not change; it has none while the page is hidden. */
const size_of = ({size, span}) => size?.[0] > 0 ? size : [span.offsetWidth, span.offsetHeight];

/** The panels on the picture, by their names. */
function panels_on(stage) {
  const {left, top} = stage.getBoundingClientRect();
  return Object.fromEntries(kPanels.map((id) => [id, by_id(id).getBoundingClientRect()])
    .filter(([, {width}]) => width > 0)
    .map(([id, panel]) => [id, {left: panel.left - left, top: panel.top - top,
      right: panel.right - left, bottom: panel.bottom - top}]));
}

const holds = ({left, top, right, bottom}, x, y) => x >= left && x <= right && y >= top && y <= bottom;

function place_marks(marks, view, room, panels) {
  for (const mark of marks) {
    const point = mark.place();
    const seen = point && view.project(point);
    mark.made.hidden = !seen?.visible;
    mark.at = seen?.visible ? [seen.x, seen.y] : null;
    if (!mark.at) continue;
    mark.made.style.transform = `translate(${seen.x.toFixed(1)}px,${seen.y.toFixed(1)}px)`;
  }
  const labelled = marks.filter(({at, size}) => at && size[0] > 0);
  for (const {at, radius} of labelled) room.take(around(at, [2 * radius, 2 * radius]));
  for (const mark of labelled) {
    const {at: [x, y], size, span, radius} = mark;
    const places = places_beside([x, y], radius, size);
    // Where it stood before, so that it does not jump while the picture moves.
    const order = [mark.stood ?? 0, ...places.keys()];
    // A label beside a panel would not say that its mark is below it.
    const is_there = x >= 0 && y >= 0 && x <= room.width && y <= room.height &&
      !panels.some((panel) => holds(panel, x, y));
    mark.stood = is_there ? order.find((nth) => room.is_free(around(places[nth], size), 1)) : undefined;
    span.hidden = mark.stood === undefined;
    if (span.hidden) continue;
    const taken = around(places[mark.stood], size);
    room.take(taken);
    span.style.transform = `translate(${Math.round(taken.left - x)}px,${Math.round(taken.top - y)}px)`;
  }
}

function tick(text, name = 'tick') {
  const span = element('span', {}, text);
  const made = element('div', {className: `mark ${name}`}, span);
  by_id('marks').append(made);
  return {span, made};
}

/** The numbers and the name of x (0) or y (1). */
function axis_of(axis, {frame, scene}) {
  const {step, lines} = grid_lines(frame.box, axis);
  const unit = grid_unit(frame.box);
  const numbers = lines.map((value) => ({...tick(mark_text(value, step, unit.metres)), value,
    nth: Math.round(value / step)}));
  const name = tick(`${['x east', 'y north'][axis]}, ${unit.name}`);
  return {axis, numbers, name, frame, base: frame.base(scene.ground)};
}

/** The heights of index contours, each with its place. */
function heights_of({scene, contour_step: apart}) {
  return apart ? contour_places(scene.ground, apart).map((place) =>
    ({...tick(mark_text(place[2], apart), 'tick height'), place})) : [];
}

/** Where there is room, and no ground in front. */
function place_heights(heights, view, room, wanted) {
  for (const label of heights) {
    const seen = wanted ? view.project(label.place) : null;
    const taken = seen?.visible && around([seen.x, seen.y], label.size);
    const ground = taken && room.is_free(taken, kBetweenHeights) && view.ground_at(seen.x, seen.y);
    const is_there = ground && kNear * view.world.frame.diagonal >
      Math.hypot(...ground.map((value, axis) => value - label.place[axis]));
    show(label, is_there ? [seen.x, seen.y] : null);
    if (is_there) room.take(taken);
  }
}

/** A place on the edge of the box nearer to the eye, as pixels, with the direction away from the
 *  box there; null if it is behind the eye. */
function on_edge({axis, frame, base}, value, view) {
  const side = view.near_side()[1 - axis];
  const [low, high] = frame.box;
  const point = (out) => {
    const place = [0, 0, base];
    place[axis] = value;
    place[1 - axis] = (side > 0 ? high : low)[1 - axis] + side * out;
    return view.project(place);
  };
  // Across the edge on the picture, to the side on which a place farther out is.
  const [at, out] = [point(0), point(frame.diagonal * 1e-3)];
  const along = [...frame.box[0].slice(0, 2), base];
  along[1 - axis] = (side > 0 ? high : low)[1 - axis];
  along[axis] = value + frame.diagonal * 1e-3;
  const next = view.project(along);
  if (!at.visible || !out.visible || !next.visible) return null;
  const length = Math.hypot(next.x - at.x, next.y - at.y) || 1;
  const across = [-(next.y - at.y) / length, (next.x - at.x) / length];
  const way = Math.sign(across[0] * (out.x - at.x) + across[1] * (out.y - at.y)) || 1;
  return {at: [at.x, at.y], away: across.map((part) => way * part)};
}

/** Half of what a label takes in a direction. */
const half = ([width, height], [x, y]) => Math.abs(x) * width / 2 + Math.abs(y) * height / 2;

/** The middle of a label `from` pixels away from a place on the edge, moved into the picture. */
function beside({at, away}, size, from, room) {
  const wish = at.map((value, side) => value + away[side] * (from + half(size, away)));
  const middle = room.inside(wish, size);
  return Math.hypot(middle[0] - wish[0], middle[1] - wish[1]) <= kReach ? middle : null;
}

function show(label, middle) {
  label.made.hidden = !middle;
  if (!middle) return;
  const [left, top] = middle.map((value, side) => Math.round(value - label.size[side] / 2));
  label.made.style.transform = `translate(${left}px,${top}px)`;
}

function place_axis(axis, view, room, wanted) {
  for (const label of [...axis.numbers, axis.name]) show(label, null);
  if (!wanted) return;
  const placed = numbers_shown(axis, view, room);
  for (const {label, middle} of placed) {
    show(label, middle);
    room.take(around(middle, label.size));
  }
  const widest = Math.max(0, ...placed.map(({label, edge}) => 2 * half(label.size, edge.away)));
  // Beyond the numbers, else among them, else within the box.
  const wishes = [() => kFromEdge + widest + kFromNumbers, () => kFromEdge,
    (edge) => -kFromEdge - 2 * half(axis.name.size, edge.away)];
  const middle = wishes.reduce((found, from) => found ?? place_of_name(axis, from, view, room), null);
  show(axis.name, middle);
  if (middle) room.take(around(middle, axis.name.size));
}

/** Free for the name of an axis, `from` pixels out from its edge; null if there is no such place. */
function place_of_name({axis, frame, name: {size}, ...edge_of}, from, view, room) {
  const [low, high] = [0, 1].map((end) => frame.box[end][axis]);
  for (const share of kShares) {
    const edge = on_edge({axis, frame, ...edge_of}, low + share * (high - low), view);
    const middle = edge && beside(edge, size, from(edge), room);
    if (middle && room.is_free(around(middle, size))) return middle;
  }
  return null;
}

function numbers_shown(axis, view, room) {
  const all = axis.numbers.map((label) => {
    const edge = on_edge(axis, label.value, view);
    return {label, edge, middle: edge && beside(edge, label.size, kFromEdge, room)};
  }).filter(({label, middle}) => middle && room.is_free(around(middle, label.size), kBetween));
  for (const every of kEvery) {
    const some = all.filter(({label}) => label.nth % every === 0);
    const free = new Room(room.width, room.height, []);
    const fits = some.every(({label, middle}) => {
      const taken = around(middle, label.size);
      const is_free = free.is_free(taken, kBetween);
      free.take(taken);
      return is_free;
    });
    if (fits) return some;
  }
  return [];
}
