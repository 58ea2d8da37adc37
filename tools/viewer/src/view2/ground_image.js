// SPDX-License-Identifier: Apache-2.0
import {contour_strength, kLevelMetres} from '../contours.js';
import {shaded} from '../ground.js';

/** The shaded ground as an image with one pixel per post. */
export function ground_image(ground) {
  const {nx, ny} = ground;
  const colors = shaded(ground, 1);
  const image = new ImageData(nx, ny);
  // Image rows start in the north.
  for (let row = 0; row < ny; row++) {
    image.data.set(colors.subarray(4 * nx * row, 4 * nx * (row + 1)), 4 * nx * (ny - 1 - row));
  }
  return canvas_of(image);
}

function canvas_of(image) {
  const canvas = Object.assign(document.createElement('canvas'), {width: image.width, height: image.height});
  canvas.getContext('2d').putImageData(image, 0, 0);
  return canvas;
}

/** Contours on a picture whose top left is at (west, north), with so many metres per pixel. */
export function contour_image(ground, step, [width, height], [west, north], metres) {
  const image = new ImageData(width, height);
  let row = new Float64Array(width + 1);
  let next = new Float64Array(width + 1);
  for (let y = -1; y < height; y++) {
    for (let x = 0; x <= width; x++) {
      next[x] = ground.height(west + (x + 0.5) * metres, north - (y + 1.5) * metres);
    }
    for (let x = 0; x < width && y >= 0; x++) {
      const change = Math.abs(row[x + 1] - row[x]) + Math.abs(next[x] - row[x]);
      // Not beside missing posts, either.
      if (change > kLevelMetres) {
        image.data[4 * (y * width + x) + 3] = 255 * contour_strength(row[x] / step, change / step);
      }
    }
    [row, next] = [next, row];
  }
  return canvas_of(image);
}
