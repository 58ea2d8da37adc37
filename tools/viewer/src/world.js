// SPDX-License-Identifier: Apache-2.0
import {length_unit, round_step} from './units.js';

/** Coordinates relative to the centre of the box: in 32 bits a point 50 km from it is accurate to
 *  2 mm; one 5,000 km from the origin of the map would be accurate to half a metre. */
export class Frame {
  constructor(box) {
    this.box = box;
    this.centre = [0, 1, 2].map((axis) => (box[0][axis] + box[1][axis]) / 2);
    this.size = [0, 1, 2].map((axis) => Math.max(box[1][axis] - box[0][axis], 1e-3));
    this.diagonal = Math.hypot(...this.size);
  }

  local(point) {
    return [0, 1, 2].map((axis) => point[axis] - this.centre[axis]);
  }

  world(point) {
    return [0, 1, 2].map((axis) => point[axis] + this.centre[axis]);
  }

  /** The height of the bottom of the terrain block. */
  base(ground) {
    if (!ground || !(ground.max >= ground.min)) return this.box[0][2];
    const depth = Math.max((ground.max - ground.min) * 0.1, this.diagonal * 0.01);
    return Math.min(ground.min - depth, this.box[0][2]);
  }

  /** Local x, y, z of all points, as a flat list. */
  flat(points) {
    const values = new Float32Array(points.length * 3);
    points.forEach((point, at) => values.set(this.local(point), 3 * at));
    return values;
  }
}

/** Every line that can be shown: each result's route, its steps' routes and its track. */
export function lines_of(results) {
  const lines = [];
  results.forEach((result, index) => {
    if (result.route?.length) {
      lines.push({key: `${index}`, kind: 'route', result: index, step: null,
        points: result.route, waypoints: result.waypoints});
    }
    result.steps.forEach((step, at) => {
      if (step.route?.length) {
        lines.push({key: `${index}.${at}`, kind: 'attempt', result: index, step: step.id,
          points: step.route, waypoints: step.waypoints});
      }
    });
    const track = result.flight?.track;
    if (track?.length) {
      lines.push({key: `${index}.flight`, kind: 'track', result: index, step: null,
        points: track.map((sample) => sample.slice(1, 4)), times: track.map(([t]) => t)});
    }
  });
  return lines;
}

export const layer_key = (thing) => `${thing.layer}|${thing.role}|${thing.known}`;

/** The layers, each once, in the order of the scene. */
export function layers_of(scene) {
  const layers = new Map();
  for (const thing of [...scene.solids, ...scene.boxes, ...scene.meshes, ...scene.moving]) {
    const key = layer_key(thing);
    const layer = layers.get(key) ?? {key, name: thing.layer, role: thing.role,
      known: thing.known, events: new Set(), count: 0};
    if (thing.added_by !== null) layer.events.add(thing.added_by);
    layer.count += thing.count ?? 1;
    layers.set(key, layer);
  }
  return [...layers.values()];
}

/** Unknown space would hide everything known: it is hidden at first. */
export const hidden_at_first = (scene) =>
  new Set(layers_of(scene).filter(({role}) => role === 'unknown').map(({key}) => key));

/** True if `thing` is in the world at `time` of the flight whose events happened at `times`; before
 *  and without a flight the world is as at the start. */
export function present(thing, times, {time, everything}) {
  if (everything) return true;
  const happened = (event) =>
    event !== null && event !== undefined && (times?.[event] ?? Infinity) <= time;
  const added = thing.added_by === null || thing.added_by === undefined ||
    happened(thing.added_by);
  return added && !happened(thing.removed_by);
}

/** Displacement of a moving obstacle's shape at `time` from its position at since_s. */
export function drift(moving, time) {
  const passed = Math.max(0, time - moving.since_s);
  return moving.velocity.map((speed) => speed * passed);
}

/** The goal and the via points that have a tolerance. */
export const tolerances = (scene) => [scene.goal, ...(scene.via ?? [])]
  .filter((goal) => goal?.tolerance > 0);

/** Horizontal circles in the plan: around goals with a tolerance, and where vehicles loiter. */
export const circles = (scene) => [
  ...tolerances(scene).map(({at, tolerance}) => ({at, radius: tolerance})),
  ...(scene.loiters ?? [])];

export function event_times(scene, selected) {
  return scene.results[selected]?.flight?.event_times ?? null;
}

/** Index of the last entry of `values` (rising) that is ≤ value, at least 0. */
export function last_before(values, value) {
  let [low, high] = [0, values.length - 1];
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (values[middle] <= value) low = middle; else high = middle - 1;
  }
  return low;
}

export const between = (a, b, share) => a.map((value, axis) => value + (b[axis] - value) * share);

/** Position of a flight at `time`, a position ahead of it, the speed, and the leg. */
export function place_at(line, time) {
  const from = Math.min(last_before(line.times, time), Math.max(0, line.points.length - 2));
  const to = Math.min(from + 1, line.points.length - 1);
  const span = line.times[to] - line.times[from];
  const share = span > 0 ? Math.min(1, Math.max(0, (time - line.times[from]) / span)) : 0;
  const at = between(line.points[from], line.points[to], share);
  const [a, b] = [line.points[from], line.points[to]];
  const speed = span > 0 ? Math.hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]) / span : 0;
  return {at, ahead: between(at, b, share < 1 ? 1 : 0), speed, from};
}

/** Longitude and latitude of (x, y): bilinear between the directions of the box's corners from the
 * Earth's middle, which have no jump at 180 degrees and none at a pole. */
export function lonlat(scene, [x, y]) {
  if (!scene.corners_lonlat) return null;
  const [low, high] = scene.box;
  const u = (x - low[0]) / (high[0] - low[0]);
  const v = (y - low[1]) / (high[1] - low[1]);
  const shares = [(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v];
  const radian = 180 / Math.PI;
  const sum = [0, 0, 0];
  scene.corners_lonlat.forEach(([lon, lat], corner) => {
    const across = shares[corner] * Math.cos(lat / radian);
    sum[0] += across * Math.cos(lon / radian);
    sum[1] += across * Math.sin(lon / radian);
    sum[2] += shares[corner] * Math.sin(lat / radian);
  });
  return [Math.atan2(sum[1], sum[0]) * radian,
    Math.atan2(sum[2], Math.hypot(sum[0], sum[1])) * radian];
}

/** The grid's step and its lines: round coordinates within the box. */
export function grid_lines(box, axis) {
  const length = Math.max(box[1][0] - box[0][0], box[1][1] - box[0][1], 1e-3);
  const step = round_step(length, 8);
  const lines = [];
  for (let at = Math.ceil(box[0][axis] / step) * step; at <= box[1][axis] + step * 1e-6;
    at += step) lines.push(at);
  return {step, lines};
}

/** The unit of the grid's numbers. */
export function grid_unit(box) {
  const all = [0, 1].flatMap((axis) => grid_lines(box, axis).lines.map(Math.abs));
  return length_unit(Math.max(0, ...all));
}

/** The line of the flight that is looked at: of the selected result, else the first. */
export function flight_line({lines}, {selected}) {
  const tracks = lines.filter(({kind}) => kind === 'track');
  return tracks.find(({result}) => result === selected) ?? tracks[0] ?? null;
}
