// SPDX-License-Identifier: Apache-2.0
import {element} from '../dom.js';
import {kTools, surroundings} from './tools.js';

// Pixels between pressing and letting go of a click.
const kStill = 4;

/** Places what a tool adds: by clicks on the picture, corners until Enter or a double click. */
export function build_placing(view, world, store, editor) {
  const hint = element('p', {className: 'note', ariaLive: 'polite'});
  let [tool, places, pressed] = [null, [], null];

  const end = () => {
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
    const assignments = add(places, surroundings(world, store));
    end();
    editor.set(assignments);
  };
  const click = (x, y) => {
    const at = view.ground_at(x, y) ?? view.at_height(x, y, world.frame.box[0][2]);
    if (!at) return;
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
