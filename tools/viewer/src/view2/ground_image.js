// SPDX-License-Identifier: Apache-2.0
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
  const canvas = Object.assign(document.createElement('canvas'), {width: nx, height: ny});
  canvas.getContext('2d').putImageData(image, 0, 0);
  return canvas;
}
