// SPDX-License-Identifier: Apache-2.0
import {ramp} from './ramp.js';

/** Heights on a grid: post (i, j) is at x0 + i dx, y0 + j dy; NaN marks a missing post. */
export class Ground {
  constructor({nx, ny, x0, y0, dx, dy, heights}) {
    Object.assign(this, {nx, ny, x0, y0, dx, dy, z: heights});
    this.min = Infinity;
    this.max = -Infinity;
    this.whole = true;
    for (const z of heights) {
      if (z < this.min) this.min = z;
      if (z > this.max) this.max = z;
      if (z !== z) this.whole = false;
    }
  }

  /** Bilinear between the four posts around (x, y); NaN outside and next to missing posts. */
  height(x, y) {
    const i = (x - this.x0) / this.dx;
    const j = (y - this.y0) / this.dy;
    if (!(i >= 0 && j >= 0 && i <= this.nx - 1 && j <= this.ny - 1)) return NaN;
    const west = Math.min(Math.floor(i), this.nx - 2);
    const south = Math.min(Math.floor(j), this.ny - 2);
    const [u, v, post] = [i - west, j - south, south * this.nx + west];
    const z = this.z;
    return (z[post] * (1 - u) + z[post + 1] * u) * (1 - v) +
      (z[post + this.nx] * (1 - u) + z[post + this.nx + 1] * u) * v;
  }

  /** First point of origin + t direction, 0 ≤ t ≤ reach, on or below the ground as drawn, which is
   *  cut off at `cut`; returned with the uncut height of the ground. */
  hit(origin, direction, reach, cut) {
    const at = (t) => [0, 1, 2].map((axis) => origin[axis] + t * direction[axis]);
    const above = (t) => {
      const [x, y, z] = at(t);
      const ground = this.height(x, y);
      return Number.isNaN(ground) ? Infinity : z - Math.min(ground, cut);
    };
    const step = Math.max(Math.min(this.dx, this.dy) * 0.7, reach / 4000);
    for (let t = 0; t <= reach; t += step) {
      if (above(t) <= 0) {
        let [low, high] = [Math.max(0, t - step), t];
        for (let halving = 0; halving < 20; halving++) {
          const middle = (low + high) / 2;
          if (above(middle) <= 0) high = middle; else low = middle;
        }
        const [x, y] = at(high);
        return [x, y, this.height(x, y)];
      }
    }
    return null;
  }
}

// Light from the north-west at 45°, as on maps, so that hollows do not look like hills.
const kSun = [-0.5, 0.5, Math.SQRT1_2];
const kShadow = 0.38;
const kBrightest = 1.12;

/** RGBA, four bytes per post from the south-west: the shaded colour of its height. */
export function shaded(ground, exaggeration) {
  const {nx, ny, z, min, max} = ground;
  const colors = new Uint8Array(nx * ny * 4);
  const scale = max > min ? 255 / (max - min) : 0;
  const per_x = exaggeration / (2 * ground.dx);
  const per_y = exaggeration / (2 * ground.dy);
  for (let j = 0, post = 0; j < ny; j++) {
    const south = j > 0 ? -nx : 0;
    const north = j < ny - 1 ? nx : 0;
    for (let i = 0; i < nx; i++, post++) {
      const height = z[post];
      if (height !== height) continue;
      let slope_x = (z[i < nx - 1 ? post + 1 : post] - z[i > 0 ? post - 1 : post]) * per_x;
      let slope_y = (z[post + north] - z[post + south]) * per_y;
      // Next to a missing post: flat.
      if (slope_x !== slope_x) slope_x = 0;
      if (slope_y !== slope_y) slope_y = 0;
      const facing = (kSun[2] - kSun[0] * slope_x - kSun[1] * slope_y) /
        Math.sqrt(1 + slope_x * slope_x + slope_y * slope_y);
      const light = Math.min(kBrightest,
        kShadow + (1 - kShadow) * Math.max(0, facing) / kSun[2]);
      const entry = 3 * ((height - min) * scale | 0);
      colors[4 * post] = Math.min(255, ramp[entry] * light);
      colors[4 * post + 1] = Math.min(255, ramp[entry + 1] * light);
      colors[4 * post + 2] = Math.min(255, ramp[entry + 2] * light);
      colors[4 * post + 3] = 255;
    }
  }
  return colors;
}
