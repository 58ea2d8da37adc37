// SPDX-License-Identifier: Apache-2.0
import {BufferAttribute, BufferGeometry} from 'three';
import {clipped, span, surface} from '../shapes.js';

// The edges of more boxes than this would merge into grey.
export const kMaxEdgedBoxes = 20000;

// Each function below returns the part below the height `cut`: `faces`, a geometry; `edges`, end
// points of segments, or null; `shapes`, their number; `names`, which solid a triangle belongs to.

function geometry_of(values, index = null) {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(values, 3));
  if (index) geometry.setIndex(new BufferAttribute(index, 1));
  return geometry;
}

function local(values, frame) {
  const [cx, cy, cz] = frame.centre;
  const moved = new Float32Array(values.length);
  for (let at = 0; at < values.length; at += 3) {
    moved[at] = values[at] - cx;
    moved[at + 1] = values[at + 1] - cy;
    moved[at + 2] = values[at + 2] - cz;
  }
  return moved;
}

function append(target, values) {
  for (const value of values) target.push(value);
}

export function merged(things, frame, cut) {
  const [triangles, lines, names] = [[], [], []];
  for (const thing of things.filter((solid) => span(solid, frame.box)[0] < cut)) {
    const {triangles: faces, edges} = surface(thing, frame.box, cut);
    append(triangles, faces);
    append(lines, edges);
    names.push({end: triangles.length / 9, name: thing.name});
  }
  return {faces: geometry_of(local(triangles, frame)), edges: local(lines, frame),
    shapes: names.length, names};
}

/** The boxes that begin below the cut, truncated at it. */
function below(data, cut) {
  const kept = new Float32Array(data.length);
  let end = 0;
  for (let at = 0; at < data.length; at += 6) {
    if (data[at + 2] >= cut) continue;
    for (let value = 0; value < 6; value++) kept[end + value] = data[at + value];
    kept[end + 5] = Math.min(cut, data[at + 5]);
    end += 6;
  }
  return kept.subarray(0, end);
}

function box_edges(data) {
  const values = new Float32Array(data.length / 6 * 72);
  let end = 0;
  for (let at = 0; at < data.length; at += 6) {
    for (let axis = 0; axis < 3; axis++) {
      const [b, c] = [(axis + 1) % 3, (axis + 2) % 3];
      for (let corner = 0; corner < 4; corner++) {
        for (let side = 0; side < 2; side++, end += 3) {
          values[end + axis] = data[at + axis + 3 * side];
          values[end + b] = data[at + b + 3 * (corner & 1)];
          values[end + c] = data[at + c + 3 * (corner >> 1)];
        }
      }
    }
  }
  return values;
}

// Bits 1, 2, 4 of corner c select the box's maximum x, y, z; faces are oriented outwards.
const kBoxFaces = [0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
  2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5];

/** All boxes in one buffer and one draw call. Instances would be smaller, but software renderers
 *  draw them one by one: 200,000 take twelve seconds. */
export function box_field(boxes, frame, cut) {
  const data = local(cut < Infinity ? below(boxes.data, cut) : boxes.data, frame);
  const count = data.length / 6;
  const corners = new Float32Array(24 * count);
  const index = new Uint32Array(36 * count);
  for (let box = 0; box < count; box++) {
    for (let corner = 0; corner < 8; corner++) {
      for (let axis = 0; axis < 3; axis++) {
        corners[24 * box + 3 * corner + axis] = data[6 * box + axis + 3 * (corner >> axis & 1)];
      }
    }
    for (let at = 0; at < 36; at++) index[36 * box + at] = 8 * box + kBoxFaces[at];
  }
  const faces = geometry_of(corners, index);
  return {faces, edges: boxes.count > kMaxEdgedBoxes ? null : box_edges(data),
    shapes: faces.index.count / 36, names: null};
}

export function triangle_mesh({triangles, name}, frame, cut) {
  const kept = cut < Infinity ? clipped(triangles, cut) : triangles;
  return {faces: geometry_of(local(kept, frame)), edges: null, shapes: kept.length > 0 ? 1 : 0,
    names: [{end: Infinity, name}]};
}

/** Lowest and highest local z of all stationary obstacles. */
export function obstacle_heights({solids, boxes, meshes}, frame) {
  let [low, high] = [Infinity, -Infinity];
  const include = (values, first, stride) => {
    for (let at = first; at < values.length; at += stride) {
      low = Math.min(low, values[at]);
      high = Math.max(high, values[at]);
    }
  };
  const blocks = ({role}) => role === 'obstacle';
  for (const solid of solids.filter(blocks)) include(span(solid, frame.box), 0, 1);
  for (const {data} of boxes.filter(blocks)) include(data, 2, 3);
  for (const {triangles} of meshes.filter(blocks)) include(triangles, 2, 3);
  return [low, high].map((z) => z - frame.centre[2]);
}
