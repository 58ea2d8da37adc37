// SPDX-License-Identifier: Apache-2.0
import {ShapeUtils, Vector2} from 'three';

const kCircleSides = 48;
const kSphereRings = 16;
// Vertical edges are drawn where an outline turns by more than this: not on facets of a circle.
const kSharp = Math.cos(20 * Math.PI / 180);

/** The solid's outline as seen from above: rings, the outer one first. */
export function outline(solid) {
  switch (solid.shape) {
    case 'prism': return [solid.outline, ...(solid.holes ?? [])];
    case 'box': {
      const [[west, south], [east, north]] = [solid.min, solid.max];
      return [[[west, south], [east, south], [east, north], [west, north]]];
    }
    default: return [circle(solid.at, solid.radius)];
  }
}

function circle([x, y], radius) {
  return Array.from({length: kCircleSides}, (_, side) => {
    const angle = 2 * Math.PI * side / kCircleSides;
    return [x + radius * Math.cos(angle), y + radius * Math.sin(angle)];
  });
}

/** Floor and ceiling; those of the drawn box where the solid has none. */
export function span(solid, box) {
  if (solid.shape === 'sphere') return [solid.at[2] - solid.radius, solid.at[2] + solid.radius];
  if (solid.shape === 'box') return [solid.min[2], solid.max[2]];
  return [solid.floor ?? box[0][2], solid.ceiling ?? box[1][2]];
}

/** Triangles and edges of a solid's part below `cut`: flat x, y, z in world coordinates. */
export function surface(solid, box, cut = Infinity) {
  if (solid.shape === 'sphere') return sphere(solid, cut);
  const [floor, ceiling] = span(solid, box);
  return prism(outline(solid).map(open_ring), floor, Math.min(ceiling, cut));
}

/** The parts of triangles below `cut`, left open where it cuts them. */
export function clipped(triangles, cut) {
  const kept = [];
  for (let at = 0; at < triangles.length; at += 9) {
    const corners = [0, 3, 6].map((corner) => triangles.subarray(at + corner, at + corner + 3));
    const polygon = corners.flatMap((here, corner) => {
      const next = corners[(corner + 1) % 3];
      const crosses = (here[2] < cut) !== (next[2] < cut);
      const share = (cut - here[2]) / (next[2] - here[2]);
      return [...(here[2] < cut ? [[...here]] : []), ...(crosses ?
        [[0, 1, 2].map((axis) => here[axis] + share * (next[axis] - here[axis]))] : [])];
    });
    for (let corner = 2; corner < polygon.length; corner++) {
      kept.push(...polygon[0], ...polygon[corner - 1], ...polygon[corner]);
    }
  }
  return new Float32Array(kept);
}

function open_ring(ring) {
  const [first, last] = [ring[0], ring.at(-1)];
  return ring.length > 1 && first[0] === last[0] && first[1] === last[1] ? ring.slice(0, -1) : ring;
}

const area = (ring) => ring.reduce((sum, [x, y], at) => {
  const [next_x, next_y] = ring[(at + 1) % ring.length];
  return sum + x * next_y - next_x * y;
}, 0);

function prism(rings, floor, ceiling) {
  // The outer ring counter-clockwise and holes clockwise, so that every wall faces out.
  const turned = rings.map((ring, at) => (area(ring) > 0) === (at === 0) ? ring :
    [...ring].reverse());
  const [triangles, edges] = [[], []];
  const flat = turned.flat();
  const [contour, ...holes] = turned.map((ring) => ring.map(([x, y]) => new Vector2(x, y)));
  for (const [a, b, c] of ShapeUtils.triangulateShape(contour, holes)) {
    triangles.push(...flat[a], ceiling, ...flat[b], ceiling, ...flat[c], ceiling,
      ...flat[a], floor, ...flat[c], floor, ...flat[b], floor);
  }
  for (const ring of turned) {
    ring.forEach((here, at) => {
      const next = ring[(at + 1) % ring.length];
      triangles.push(...here, floor, ...next, floor, ...next, ceiling,
        ...here, floor, ...next, ceiling, ...here, ceiling);
      edges.push(...here, floor, ...next, floor, ...here, ceiling, ...next, ceiling);
      if (is_sharp(ring.at(at - 1), here, next)) edges.push(...here, floor, ...here, ceiling);
    });
  }
  return {triangles, edges};
}

function is_sharp(before, here, next) {
  const [ax, ay, bx, by] = [here[0] - before[0], here[1] - before[1], next[0] - here[0],
    next[1] - here[1]];
  return ax * bx + ay * by < kSharp * Math.hypot(ax, ay) * Math.hypot(bx, by);
}

function sphere({at, radius}, cut) {
  const [triangles, edges] = [[], []];
  // Rings above the cut become the flat top, none of them wider than the section.
  const section = Math.sqrt(Math.max(0, radius * radius - (cut - at[2]) ** 2));
  const point = (ring, side) => {
    const polar = Math.PI * ring / kSphereRings;
    const angle = 2 * Math.PI * side / kCircleSides;
    const height = at[2] - radius * Math.cos(polar);
    const wide = radius * Math.sin(polar);
    const away = height > cut ? Math.min(wide, section) : wide;
    return [at[0] + away * Math.cos(angle), at[1] + away * Math.sin(angle), Math.min(height, cut)];
  };
  for (let ring = 0; ring < kSphereRings; ring++) {
    for (let side = 0; side < kCircleSides; side++) {
      const [a, b] = [point(ring, side), point(ring, side + 1)];
      const [c, d] = [point(ring + 1, side + 1), point(ring + 1, side)];
      if (ring > 0) triangles.push(...a, ...b, ...c);
      if (ring < kSphereRings - 1) triangles.push(...a, ...c, ...d);
      // The equator and two meridians.
      if (ring === kSphereRings / 2) edges.push(...a, ...b);
      if (side % (kCircleSides / 4) === 0) edges.push(...a, ...d);
    }
  }
  return {triangles, edges};
}
