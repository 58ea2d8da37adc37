// SPDX-License-Identifier: Apache-2.0
import {round_step} from './units.js';

// Contours between the lowest and the highest ground, at most.
const kContours = 30;
const kMinStep = 1;
// Every fifth is an index contour, with its height beside it.
const kIndex = 5;
// Parts of the ground along each side; in each an index contour has one height.
const kParts = 8;

/** Widths in pixels, and how much darker they make the ground; the more contours a pixel has, the
 *  less: nothing from 2 / `close` on. */
export const kPens = [{every: 1, width: 1, strength: 0.4, close: 4},
  {every: kIndex, width: 2, strength: 0.7, close: 2}];
/** What changes less per pixel is level: its noise would be contours. */
export const kLevelMetres = 1e-3;

/** How much darker contours make a pixel at a level, counted in contours, that changes by so much to
 *  the next pixels. */
export function contour_strength(level, per_pixel) {
  let most = 0;
  for (const {every, width, strength, close} of kPens) {
    const away = Math.abs(level - every * Math.round(level / every)) / per_pixel;
    const near = (width + 1) / 2 - away;
    if (near <= 0) continue;
    const faded = Math.min(1, Math.max(0, 2 - close * per_pixel));
    most = Math.max(most, strength * Math.min(1, near) * faded);
  }
  return most;
}

/** Metres between contours; null where the ground crosses none. */
export function contour_step(ground) {
  if (!(ground?.max > ground?.min)) return null;
  const step = Math.max(kMinStep, round_step(ground.max - ground.min, kContours));
  return Math.floor(ground.max / step) > Math.floor(ground.min / step) ? step : null;
}

/** Places on the index contours, for their heights. */
export function contour_places({nx, ny, x0, y0, dx, dy, z}, step) {
  const places = new Map();
  const apart = kIndex * step;
  for (let j = 0, post = 0; j < ny; j++, post++) {
    for (let i = 0; i + 1 < nx; i++, post++) {
      const [a, b] = [z[post], z[post + 1]];
      const nth = Math.floor(Math.max(a, b) / apart);
      // Nothing is below NaN.
      if (!(Math.min(a, b) < nth * apart)) continue;
      const part = Math.floor(i / nx * kParts) + kParts * Math.floor(j / ny * kParts);
      const key = nth * kParts * kParts + part;
      if (places.has(key)) continue;
      places.set(key, [x0 + (i + (nth * apart - a) / (b - a)) * dx, y0 + j * dy, nth * apart]);
    }
  }
  return [...places.values()];
}
