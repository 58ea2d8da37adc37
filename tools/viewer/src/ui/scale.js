// SPDX-License-Identifier: Apache-2.0
import {by_id, element} from '../dom.js';
import {length_text} from '../units.js';

// Pixels.
const kLongest = 120;

/** A bar as long as a round length across the middle of the picture. */
export function build_scale(view) {
  const bar = element('i', {});
  const text = element('span', {});
  by_id('scale').append(text, bar);
  let shown = null;
  view.on_frame(() => {
    const longest = kLongest * view.metres_per_pixel();
    const power = 10 ** Math.floor(Math.log10(longest));
    const length = power * [5, 2, 1].find((factor) => factor * power <= longest * 1.000001);
    bar.style.width = `${(length / view.metres_per_pixel()).toFixed(1)}px`;
    if (length === shown) return;
    shown = length;
    text.textContent = length_text(length);
  });
}
