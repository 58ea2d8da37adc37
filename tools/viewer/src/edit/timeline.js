// SPDX-License-Identifier: Apache-2.0
import {by_id} from '../dom.js';

/** Events with a time are dragged along the clock's rail. */
export function build_timeline(editor) {
  let held = null;
  const second_at = (clientX) =>
    Math.max(0, Math.min(1, (clientX - held.left) / held.width)) * held.last;
  const ask = (event, quick) => editor.change({
    set: [`scenario.events.${held.event}.at_s=${second_at(event.clientX).toFixed(1)}`],
    gesture: held.gesture, quick});
  by_id('clock').addEventListener('pointerdown', (event) => {
    const mark = event.target.closest('[data-event]');
    if (!mark || editor.state.scenario.events?.[mark.dataset.event]?.at_s === undefined) return;
    event.preventDefault();
    // The rail is made anew at every answer, or is gone without a flight: it stays that of the drag.
    const {left, width} = mark.parentElement.getBoundingClientRect();
    held = {event: mark.dataset.event, left, width, last: Number(by_id('time').max),
      gesture: editor.new_gesture(), moved: false};
  });
  addEventListener('pointermove', (event) => {
    if (!held) return;
    held.moved = true;
    ask(event, true);
  });
  addEventListener('pointerup', (event) => {
    if (held?.moved) ask(event, false);
    held = null;
  });
}
