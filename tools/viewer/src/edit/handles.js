// SPDX-License-Identifier: Apache-2.0
import {by_id, element} from '../dom.js';
import {round_step} from '../units.js';
import {at_path} from './form.js';

// Of the box's diagonal: what an arrow key moves.
const kSteps = 200;
// After a key, before the whole plan is made.
const kStillMs = 400;
// Pixels by which a pointer may move in a click.
const kJitter = 4;
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
    const all = editor.movable.flatMap((item) => {
      const written = at_path(editor.state.scenario, item.key) ?? {};
      return [item, ...heading_of(item, written), ...size_of(item, written)];
    });
    const present = new Set(all.map(({key}) => key));
    for (const [key, {made}] of handles) {
      if (present.has(key)) continue;
      made.remove();
      handles.delete(key);
    }
    for (const item of all) {
      const Kind = {heading: Heading, radius: Radius, corner: Corner, vertex: Vertex}[item.kind] ?? Handle;
      const handle = handles.get(item.key) ?? new Kind(item, layer, {view, world, editor, place});
      handles.set(item.key, handle);
      handle.is(item, editor.selected === item.key);
    }
  };
  editor.on_change(reflect);
  view.on_frame(() => handles.forEach(place));
  reflect();
}

/** The heading of a point that has one, as something to turn. */
function heading_of({key, kind, name, at}, {heading_deg}) {
  return heading_deg === undefined || !['start', 'via', 'goal'].includes(kind) ? [] :
    [{key: `${key}.heading_deg`, of: key, kind: 'heading', name: `Heading at ${name}`, middle: at,
      degrees: Number(heading_deg), at}];
}

/** The radius of what is round, and the corners of a box or an outline, as something to pull. */
function size_of({key, name, at, kind}, written) {
  const part = {of: key, name: `Size of ${name}`, middle: at};
  const radius = ['radius_m', 'range_m'].find((one) => Number(written[one]) > 0);
  if (radius && !['start', 'via', 'goal'].includes(kind)) {
    return [{...part, key: `${key}.${radius}`, kind: 'radius', radius: Number(written[radius]), at}];
  }
  if (written.outline_m) {
    return written.outline_m.map(([x, y], nth) =>
      ({...part, key: `${key}.outline_m.${nth}`, kind: 'vertex', at: [Number(x), Number(y), at[2]]}));
  }
  return ['min_m', 'max_m'].filter((one) => written.min_m?.length >= 2 && written[one]?.length >= 2).map((one) =>
    ({...part, key: `${key}.${one}`, kind: 'corner', corner: written[one].map(Number),
      other: written[one === 'min_m' ? 'max_m' : 'min_m'].map(Number), at}));
}

class Handle {
  constructor(item, layer, surroundings) {
    Object.assign(this, surroundings, {item, gesture: null});
    this.at = this.rest(item);
    this.made = element('button', {className: 'handle', type: 'button',
      onpointerdown: (event) => this.#take(event), onpointermove: (event) => this.#drag(event),
      onpointerup: () => this.#drop(), onpointercancel: () => this.#drop(),
      onlostpointercapture: () => this.#drop(),
      onfocus: () => this.editor.select(this.item.of ?? this.item.key),
      onkeydown: (event) => this.#key(event)});
    layer.append(this.made);
  }

  is(item, selected) {
    this.item = item;
    this.made.classList.toggle('selected', selected);
    this.made.dataset.key = item.key;
    this.made.dataset.number = item.number || '';
    this.made.classList.toggle('size', ['radius', 'corner', 'vertex'].includes(item.kind));
    this.made.title = item.of ? `${item.name}: drag, or move it by the arrow keys.` :
      `${item.name}: drag; with Shift in height. Arrow keys, Page up and down move it.`;
    this.made.ariaLabel = `${item.name}, ${item.kind}`;
    // What is dragged is where the pointer is, which is ahead of the answers.
    if (this.gesture === null) this.at = this.rest(item);
    this.place(this);
  }

  /** Where the handle is while it is not dragged. */
  rest(item) {
    return item.at;
  }

  #take(event) {
    if (event.button !== 0) return;
    event.stopPropagation();
    this.made.setPointerCapture(event.pointerId);
    this.gesture = this.editor.new_gesture();
    this.editor.dragging = true;
    this.from = this.rest(this.item);
    this.begun = this.#pointed(event);
    this.grabbed = this.view.at_height(...this.begun, this.from[2]);
    this.by = null;
    this.editor.select(this.item.of ?? this.item.key);
  }

  /** The stage's pixel under the pointer. */
  #pointed({clientX, clientY}) {
    const {left, top} = this.view.stage.getBoundingClientRect();
    return [clientX - left, clientY - top];
  }

  #drag(event) {
    if (this.gesture === null) return;
    const [x, y] = this.#pointed(event);
    if (!this.by && Math.hypot(x - this.begun[0], y - this.begun[1]) < kJitter) return;
    const by = event.shiftKey ? this.#up(y) : this.#across(x, y);
    if (!by) return;
    this.by = by;
    this.at = this.from.map((value, axis) => value + by[axis]);
    this.place(this);
    this.ask(true);
  }

  /** Asks for what has been dragged so far. */
  ask(quick) {
    return this.editor.move(this.item.key, this.by, this.gesture, quick);
  }

  #across(x, y) {
    // The place is kept, not its pixel: the picture's size may change meanwhile.
    const [from, to] = [this.grabbed, this.view.at_height(x, y, this.from[2])];
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
    if (this.gesture === null || this.dropping) return;
    this.dropping = true;
    this.editor.dragging = false;
    if (this.by) await this.ask(false);
    else this.editor.select(this.item.of ?? this.item.key);
    this.dropping = false;
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
    } else if (event.key === 'Delete' && !this.item.of) {
      event.stopPropagation();
      this.editor.remove(this.item);
    }
  }

  /** Steps one after the other are one gesture. */
  #step(way, times) {
    if (this.gesture === null) {
      this.gesture = this.editor.new_gesture();
      this.from = this.rest(this.item);
      this.by = [0, 0, 0];
    }
    const step = times * round_step(this.world.frame.diagonal, kSteps);
    this.by = this.by.map((value, axis) => value + way[axis] * step * (axis === 2 ? 0.2 : 1));
    this.at = this.from.map((value, axis) => value + this.by[axis]);
    this.place(this);
    this.ask(true);
    clearTimeout(this.still);
    this.still = setTimeout(() => this.#drop(), kStillMs);
  }
}

// Of the box's diagonal, from a point to the handle of its heading.
const kArm = 1 / 22;

/** A heading, turned around its point. */
class Heading extends Handle {
  rest({middle, degrees}) {
    const [angle, arm] = [degrees * Math.PI / 180, this.world.frame.diagonal * kArm];
    return [middle[0] + arm * Math.sin(angle), middle[1] + arm * Math.cos(angle), middle[2]];
  }

  ask(quick) {
    const {middle, of} = this.item;
    const degrees = Math.atan2(this.at[0] - middle[0], this.at[1] - middle[1]) * 180 / Math.PI;
    return this.editor.change({set: [`scenario.${of}.heading_deg=${((degrees + 360) % 360).toFixed(1)}`],
      gesture: this.gesture, quick});
  }
}

// The least radius, and edge of a box (m).
const kLeastSize = 0.1;

/** A radius, pulled at the point in the east. */
class Radius extends Handle {
  rest({middle, radius}) {
    return [middle[0] + radius, middle[1], middle[2]];
  }

  ask(quick) {
    const {middle, key} = this.item;
    const radius = Math.max(kLeastSize, Math.hypot(this.at[0] - middle[0], this.at[1] - middle[1]));
    return this.editor.change({set: [`scenario.${key}=${radius.toFixed(1)}`], gesture: this.gesture, quick});
  }
}

/** A corner of a box, pulled while the opposite one stays. */
class Corner extends Handle {
  rest({middle, corner}) {
    return [corner[0], corner[1], middle[2]];
  }

  ask(quick) {
    const {key, corner, other} = this.item;
    const pulled = corner.map((value, axis) => {
      const way = Math.sign(value - other[axis]) || 1;
      return axis === 2 ? value : other[axis] + way * Math.max(kLeastSize, way * (this.at[axis] - other[axis]));
    });
    const text = pulled.map((value) => Number(value.toFixed(2))).join(', ');
    return this.editor.change({set: [`scenario.${key}=[${text}]`], gesture: this.gesture, quick});
  }
}

/** A corner of an outline. */
class Vertex extends Handle {
  ask(quick) {
    const at = this.at.slice(0, 2).map((value) => Number(value.toFixed(1)));
    return this.editor.change({set: [`scenario.${this.item.key}=[${at.join(', ')}]`], gesture: this.gesture, quick});
  }
}
