// SPDX-License-Identifier: Apache-2.0
import {by_id, element} from '../dom.js';
import {round_step} from '../units.js';

// Of the box's diagonal: what an arrow key moves.
const kSteps = 200;
// After a key, before the whole plan is made.
const kStillMs = 400;
const kArrows = {ArrowUp: [0, 1, 0], ArrowDown: [0, -1, 0], ArrowLeft: [-1, 0, 0], ArrowRight: [1, 0, 0],
  PageUp: [0, 0, 1], PageDown: [0, 0, -1]};

/** A handle on everything that can be moved: dragged in its plane, with Shift in height, or moved by
 *  the arrow keys. */
export function build_handles(view, world, editor) {
  const layer = element('div', {id: 'handles'});
  by_id('marks').after(layer);
  const handles = new Map();
  const place = ({made, at}) => {
    const {x, y, visible} = view.project(at);
    made.hidden = !visible;
    made.style.transform = `translate(${x.toFixed(1)}px,${y.toFixed(1)}px)`;
  };
  const reflect = () => {
    const present = new Set(editor.movable.map(({key}) => key));
    for (const [key, {made}] of handles) {
      if (present.has(key)) continue;
      made.remove();
      handles.delete(key);
    }
    for (const item of editor.movable) {
      const handle = handles.get(item.key) ?? new Handle(item, layer, {view, world, editor, place});
      handles.set(item.key, handle);
      handle.is(item, editor.selected === item.key);
    }
  };
  editor.on_change(reflect);
  view.on_frame(() => handles.forEach(place));
  reflect();
}

class Handle {
  constructor(item, layer, surroundings) {
    Object.assign(this, surroundings, {item, at: item.at, gesture: null});
    this.made = element('button', {className: 'handle', type: 'button',
      onpointerdown: (event) => this.#take(event), onpointermove: (event) => this.#drag(event),
      onpointerup: () => this.#drop(), onpointercancel: () => this.#drop(),
      onfocus: () => this.editor.select(this.item.key),
      onkeydown: (event) => this.#key(event)});
    layer.append(this.made);
  }

  is(item, selected) {
    this.item = item;
    this.made.classList.toggle('selected', selected);
    this.made.dataset.key = item.key;
    this.made.title = `${item.name}: drag; with Shift in height. Arrow keys, Page up and down move it.`;
    this.made.ariaLabel = `${item.name}, ${item.kind}`;
    // What is dragged is where the pointer is, which is ahead of the answers.
    if (this.gesture === null) this.at = item.at;
    this.place(this);
  }

  #take(event) {
    if (event.button !== 0) return;
    event.stopPropagation();
    this.made.setPointerCapture(event.pointerId);
    this.gesture = this.editor.new_gesture();
    this.editor.dragging = true;
    this.from = this.item.at;
    this.begun = this.#pointed(event);
    this.by = null;
    this.editor.select(this.item.key);
  }

  /** The stage's pixel under the pointer. */
  #pointed({clientX, clientY}) {
    const {left, top} = this.view.stage.getBoundingClientRect();
    return [clientX - left, clientY - top];
  }

  #drag(event) {
    if (this.gesture === null) return;
    const [x, y] = this.#pointed(event);
    const by = event.shiftKey ? this.#up(y) : this.#across(x, y);
    if (!by) return;
    this.by = by;
    this.at = this.from.map((value, axis) => value + by[axis]);
    this.place(this);
    this.editor.move(this.item.key, by, this.gesture, true);
  }

  #across(x, y) {
    const height = this.from[2];
    const [from, to] = [this.begun, [x, y]].map((pixel) => this.view.at_height(...pixel, height));
    return from && to && [to[0] - from[0], to[1] - from[1], 0];
  }

  #up(y) {
    const [foot, head] = [0, 1].map((up) =>
      this.view.project([this.from[0], this.from[1], this.from[2] + up]));
    const pixels = Math.hypot(head.x - foot.x, head.y - foot.y);
    // From above, a height has no length on the picture.
    const metres = pixels > 1e-3 ? 1 / pixels : this.view.metres_per_pixel();
    return [0, 0, (this.begun[1] - y) * metres];
  }

  async #drop() {
    const {gesture, by} = this;
    if (gesture === null) return;
    this.editor.dragging = false;
    if (by) await this.editor.move(this.item.key, by, gesture, false);
    this.gesture = null;
    this.is(this.item, this.editor.selected === this.item.key);
  }

  #key(event) {
    const way = kArrows[event.key];
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    if (way) {
      event.preventDefault();
      event.stopPropagation();
      this.#step(way, event.shiftKey ? 10 : 1);
    } else if (event.key === 'Delete') {
      event.stopPropagation();
      this.editor.remove(this.item);
    }
  }

  /** Steps one after the other are one gesture. */
  #step(way, times) {
    if (this.gesture === null) {
      this.gesture = this.editor.new_gesture();
      this.from = this.item.at;
      this.by = [0, 0, 0];
    }
    const step = times * round_step(this.world.frame.diagonal, kSteps);
    this.by = this.by.map((value, axis) => value + way[axis] * step * (axis === 2 ? 0.2 : 1));
    this.at = this.from.map((value, axis) => value + this.by[axis]);
    this.place(this);
    this.editor.move(this.item.key, this.by, this.gesture, true);
    clearTimeout(this.still);
    this.still = setTimeout(() => this.#drop(), kStillMs);
  }
}
