// SPDX-License-Identifier: Apache-2.0
import {Quaternion, Vector3} from 'three';
import {metres} from './units.js';

/** The results with a body on their route: the key of that line, and the places. */
export const bodies_of = (scene) => scene.results.flatMap((result, index) =>
  result.body ? [{result: index, key: `${index}`, ...result.body}] : []);

/** What stands beside a body at the closest place. */
export function closeness({layer, body_clearance_m, proven}) {
  if (body_clearance_m <= 0) return `body meets '${layer}'`;
  return `body: ${proven ? '' : 'at most '}${metres(body_clearance_m)} from '${layer}'`;
}

/** The greatest distance of the body from its reference point. */
export function outer_of(triangles) {
  let most = 0;
  for (let at = 0; at < triangles.length; at += 3) {
    most = Math.max(most, Math.hypot(triangles[at], triangles[at + 1], triangles[at + 2]));
  }
  return most;
}

/** The triangles of a body at a place whose upper side is seen from above: [x, y] of each corner.
 *  Together they are its outline. */
export function from_above(triangles, at, turned) {
  const rotation = new Quaternion(...turned);
  const corner = new Vector3();
  const seen = [];
  for (let first = 0; first < triangles.length; first += 9) {
    const [a, b, c] = [0, 3, 6].map((from) => {
      corner.fromArray(triangles, first + from).applyQuaternion(rotation);
      return [at[0] + corner.x, at[1] + corner.y];
    });
    const turns_left = (b[0] - a[0]) * (c[1] - a[1]) > (b[1] - a[1]) * (c[0] - a[0]);
    if (turns_left) seen.push([a, b, c]);
  }
  return seen;
}
