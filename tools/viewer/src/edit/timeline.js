// SPDX-License-Identifier: Apache-2.0
import {by_id} from '../dom.js';

/** Events with a time are dragged along the clock's rail. */
export function build_timeline(editor) {
  let held = null;
  const second_at = (clientX) => {
    const {left, width} = held.rail.getBoundingClientRect();
    return Math.max(0, Math.min(1, (clientX - left) / width)) * held.last;
  };
  const ask = (event, quick) => editor.change({
    set: [`scenario.events.${held.event}.at_s=${second_at(event.clientX).toFixed(1)}`],
    gesture: held.gesture, quick});
  by_id('clock').addEventListener('pointerdown', (event) => {
    const mark = event.target.closest('[data-event]');
    if (!mark || editor.state.scenario.events?.[mark.dataset.event]?.at_s === undefined) return;
    event.preventDefault();
    // The marks are made anew at every answer; the rail's length in seconds stays that of the drag.
    held = {event: mark.dataset.event, rail: mark.parentElement, last: Number(by_id('time').max),
      gesture: editor.new_gesture(), moved: false};
  });
  addEventListener('pointermove', (event) => {
    if (!held) return;
    if (!held.rail.isConnected) held.rail = document.querySelector('#clock .rail .marks') ?? held.rail;
    held.moved = true;
    ask(event, true);
  });
  addEventListener('pointerup', (event) => {
    if (held?.moved) ask(event, false);
    held = null;
  });
}
