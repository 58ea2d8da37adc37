// SPDX-License-Identifier: Apache-2.0
import {element} from '../dom.js';
import {metres, round_step} from '../units.js';

/** The slider is at its top while the cut is off. */
export function cut_slider({box: [low, high]}, store) {
  const [floor, top] = [low[2], high[2]];
  const value = element('output', {});
  const input = element('input', {type: 'range', id: 'cut', min: floor, max: top, step: 'any',
    title: 'Hide everything but routes above this altitude, to look inside (, and .)',
    oninput: () => {
      const height = Number(input.value);
      store.set({cut: height < top ? height : Infinity});
    }});
  const reflect = () => {
    const {cut} = store.state;
    input.value = Math.min(cut, top);
    value.textContent = cut < Infinity ? metres(cut) : 'off';
  };
  reflect();
  store.on(['cut'], reflect);
  return element('label', {className: 'slider'}, 'Cut above', input, value);
}

/** The next round height below (`way` -1) or above (1) the cut, which is off above the box. */
export function next_cut(cut, {box: [low, high], size}, way) {
  const step = round_step(size[2], 20);
  // A cut may differ from a multiple of the step by a rounding error.
  const steps = Math.min(cut, high[2]) / step;
  const next = step * (way > 0 ? Math.floor(steps + 1e-6) + 1 : Math.ceil(steps - 1e-6) - 1);
  return next < high[2] ? Math.max(low[2], next) : Infinity;
}
