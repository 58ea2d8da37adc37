// SPDX-License-Identifier: Apache-2.0
import {span} from '../shapes.js';
import {drift} from '../world.js';

const kMaxPaintedTriangles = 20000;

/** Number of shapes of `thing` that begin below `cut`. From above, shapes cannot be cut. */
export function count_below(thing, cut, box, time) {
  if (thing.triangles) return thing.triangles.some((z, at) => at % 3 === 2 && z < cut) ? 1 : 0;
  if (thing.data) {
    let count = 0;
    for (let at = 2; at < thing.data.length; at += 6) if (thing.data[at] < cut) count++;
    return count;
  }
  const up = thing.velocity ? drift(thing, time)[2] : 0;
  return span(thing, box)[0] + up < cut ? 1 : 0;
}

/** The boxes or triangles that begin below `cut`, as one path; `pixel` projects. */
export function path_of_many({data, triangles}, cut, pixel) {
  const path = new Path2D();
  for (let at = 0; at < (data?.length ?? 0); at += 6) {
    if (data[at + 2] >= cut) continue;
    const low = pixel(data.subarray(at, at + 2));
    const high = pixel(data.subarray(at + 3, at + 5));
    path.rect(low.x, high.y, high.x - low.x, low.y - high.y);
  }
  const end = Math.min(triangles?.length ?? 0, 9 * kMaxPaintedTriangles);
  for (let at = 0; at < end; at += 9) {
    if ([2, 5, 8].every((corner) => triangles[at + corner] >= cut)) continue;
    const [a, b, c] = [0, 3, 6].map((corner) =>
      pixel(triangles.subarray(at + corner, at + corner + 2)));
    // The same orientation for all: top and bottom of a body must not cancel out.
    const turns_left = (b.x - a.x) * (c.y - a.y) > (b.y - a.y) * (c.x - a.x);
    const [second, third] = turns_left ? [b, c] : [c, b];
    path.moveTo(a.x, a.y);
    path.lineTo(second.x, second.y);
    path.lineTo(third.x, third.y);
  }
  return path;
}
