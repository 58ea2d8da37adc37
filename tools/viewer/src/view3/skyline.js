// SPDX-License-Identifier: Apache-2.0
import {outline, span} from '../shapes.js';

// Of the longer side of the box.
const kCells = 256;

/** The tops of ground and obstacles on a grid, slightly too high: what an eye must stay above. */
export class Skyline {
  constructor({ground, solids, boxes, meshes}, {box}) {
    Object.assign(this, {ground, box});
    this.cell = Math.max(box[1][0] - box[0][0], box[1][1] - box[0][1]) / kCells || 1;
    this.tops = new Float32Array((kCells + 1) ** 2).fill(-Infinity);
    const blocks = ({role}) => role === 'obstacle';
    for (const solid of solids.filter(blocks)) {
      const [xs, ys] = [0, 1].map((axis) => outline(solid)[0].map((point) => point[axis]));
      this.#raise(Math.min(...xs), Math.min(...ys), Math.max(...xs), Math.max(...ys),
        span(solid, box)[1]);
    }
    for (const {data} of boxes.filter(blocks)) {
      for (let at = 0; at < data.length; at += 6) {
        this.#raise(data[at], data[at + 1], data[at + 3], data[at + 4], data[at + 5]);
      }
    }
    for (const {triangles} of meshes.filter(blocks)) {
      for (let at = 0; at < triangles.length; at += 9) {
        const [xs, ys, zs] = [0, 1, 2].map((axis) => [0, 3, 6].map((corner) =>
          triangles[at + corner + axis]));
        this.#raise(Math.min(...xs), Math.min(...ys), Math.max(...xs), Math.max(...ys),
          Math.max(...zs));
      }
    }
  }

  #index(value, axis) {
    return Math.min(kCells, Math.max(0, Math.floor((value - this.box[0][axis]) / this.cell)));
  }

  #raise(west, south, east, north, top) {
    const [first, last] = [this.#index(west, 0), this.#index(east, 0)];
    for (let row = this.#index(south, 1); row <= this.#index(north, 1); row++) {
      for (let column = first; column <= last; column++) {
        const cell = row * (kCells + 1) + column;
        this.tops[cell] = Math.max(this.tops[cell], top);
      }
    }
  }

  /** The highest of what is at x, y; the obstacles only if `all`. */
  height(x, y, all) {
    const ground = this.ground?.height(x, y) ?? this.box[0][2];
    const top = all ? this.tops[this.#index(y, 1) * (kCells + 1) + this.#index(x, 0)] : -Infinity;
    return Math.max(Number.isNaN(ground) ? this.box[0][2] : ground, top);
  }
}
