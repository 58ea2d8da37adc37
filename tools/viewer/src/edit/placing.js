// SPDX-License-Identifier: Apache-2.0
import {by_id, element} from '../dom.js';
import {kTools, surroundings} from './tools.js';

// Pixels between pressing and letting go of a click.
const kStill = 4;

/** Places what a tool adds: by clicks on the picture, corners until Enter or a double click. */
export function build_placing(view, world, store, editor) {
  const hint = element('p', {className: 'note', ariaLive: 'polite'});
  let [tool, places, pressed] = [null, [], null];
  const corners = [];

  /** Marks a clicked corner until the tool ends. */
  const corner = (at) => {
    const made = element('i', {className: 'corner'});
    corners.push({made, at});
    by_id('handles').append(made);
    put_corners();
  };
  const put_corners = () => {
    for (const {made, at} of corners) {
      const {x, y, visible} = view.project(at);
      made.hidden = !visible;
      made.style.transform = `translate(${x.toFixed(1)}px,${y.toFixed(1)}px)`;
    }
  };
  view.on_frame(put_corners);
  const end = () => {
    for (const {made} of corners.splice(0)) made.remove();
    [tool, places] = [null, []];
    hint.textContent = '';
    document.body.classList.remove('placing');
  };
  const finish = () => {
    const {add, places: wanted} = kTools[tool];
    if (wanted === 0 && places.length < 3) {
      hint.textContent = 'A zone has at least three corners: click more of them, or Esc.';
      return;
    }
    const known = surroundings(world, store);
    const assignments = add(places, known);
    // A pop-up is not there before its time.
    if (tool === 'pop_up') store.set({time: known.time, playing: false});
    end();
    const before = new Set(editor.movable.map(({key}) => key));
    editor.set(assignments).then(() => {
      const added = editor.movable.find(({key}) => !before.has(key));
      if (added) editor.select(added.key);
    });
  };
  const click = (x, y) => {
    const at = view.ground_at(x, y) ?? view.at_height(x, y, world.frame.box[0][2]);
    const [low, high] = world.frame.box;
    if (!at || [0, 1].some((axis) => at[axis] < low[axis] || at[axis] > high[axis])) {
      hint.textContent = 'That is beside the world: click within its frame, or Esc.';
      return;
    }
    corner(at);
    const ground = world.scene.ground?.height(at[0], at[1]) ?? NaN;
    places.push([at[0], at[1], ground]);
    const {places: wanted} = kTools[tool];
    if (places.length === wanted) finish();
    else hint.textContent = `${places.length} corners; Enter ends, Esc cancels.`;
  };
  view.canvas.addEventListener('pointerdown', (event) => {
    pressed = [event.offsetX, event.offsetY];
  });
  view.canvas.addEventListener('click', (event) => {
    if (!tool || !pressed) return;
    const moved = Math.hypot(event.offsetX - pressed[0], event.offsetY - pressed[1]);
    if (moved > kStill) return;
    event.stopImmediatePropagation();
    if (event.detail === 2 && kTools[tool].places === 0) finish();
    else click(event.offsetX, event.offsetY);
  }, true);
  addEventListener('keydown', (event) => {
    if (!tool) return;
    if (event.key === 'Escape') end();
    else if (event.key === 'Enter') finish();
    else return;
    event.preventDefault();
    event.stopPropagation();
  }, true);
  return {hint, begin(name) {
    tool = name;
    places = [];
    document.body.classList.add('placing');
    hint.textContent = kTools[name].places === 1 ? 'Click where it shall be; Esc cancels.' :
      'Click its corners; Enter ends, Esc cancels.';
    view.canvas.focus();
  }};
}
