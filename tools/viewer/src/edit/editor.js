// SPDX-License-Identifier: Apache-2.0
import {decode} from '../scene.js';
import {show_scene} from '../live.js';
import {build_handles} from './handles.js';
import {build_panel} from './panel.js';
import {build_timeline} from './timeline.js';

// How many changes' times are kept, for who looks at them.
const kTimes = 1000;

/** The changes of the page's scenario: each is asked of the server, which plans and judges again. */
export class Editor {
  #listeners = [];
  #waiting = [];
  #quick_asked = false;
  #shown = -1;
  #gesture = Date.now();

  constructor(world, store, say) {
    // `open`: the steps whose parameters are unfolded, "pipeline.step".
    Object.assign(this, {world, store, say, selected: null, dragging: false, open: new Set(), times: []});
    this.state = world.scene.edit;
    this.movable = world.scene.movable;
  }

  /** `listener` is called when what can be edited has changed, or what is selected. */
  on_change(listener) {
    this.#listeners.push(listener);
  }

  #notify() {
    for (const listener of this.#listeners) listener();
  }

  select(key) {
    this.selected = key;
    this.#notify();
  }

  item(key) {
    return this.movable.find((one) => one.key === key) ?? null;
  }

  new_gesture() {
    this.#gesture += 1;
    return this.#gesture;
  }

  /** Moves what stands at `key` by [east, north, up] from where it was when the gesture began. */
  move(key, by, gesture, quick) {
    return this.change({move: {key, by}, gesture, quick});
  }

  /** Assignments as of `--set`, to the steps of one pipeline or to the scenario. */
  set(assignments, pipeline = 0) {
    return this.change({set: assignments, pipeline});
  }

  undo() {
    return this.change({history: 'undo'});
  }

  redo() {
    return this.change({history: 'redo'});
  }

  /** Asks for a change; resolves when its answer is drawn, or when a newer one has replaced it. While
   *  the quick answer of a drag is awaited, only the newest wish of that drag waits. */
  change(wish) {
    return new Promise((resolve) => {
      const last = this.#waiting.at(-1);
      const replaces = last && last.wish.gesture && last.wish.gesture === wish.gesture;
      if (replaces) this.#waiting.pop().resolve();
      this.#waiting.push({wish, resolve, asked: performance.now()});
      this.#go_on();
    });
  }

  async #go_on() {
    if (this.#quick_asked || this.#waiting.length === 0) return;
    const {wish, resolve, asked} = this.#waiting.shift();
    this.#quick_asked = true;
    const answer = this.#ask('edit', {...wish, world: this.state.world});
    if (!wish.quick && wish.gesture) this.#quick_asked = false;
    const json = await answer;
    this.#quick_asked = false;
    this.#go_on();
    await this.#show(json, asked);
    resolve();
  }

  async #show(json, asked) {
    if (json.error) {
      this.say(json.error);
      this.#notify();
      return;
    }
    if (json.superseded || json.number < this.#shown) return;
    this.#shown = json.number;
    this.say('');
    const {answers, ...state} = json;
    this.state = state;
    const {movable, ...first} = answers[0];
    this.movable = movable;
    const scene = {...first, results: answers.flatMap(({results}) => results)};
    const answered = performance.now();
    decode(scene);
    show_scene(this.world, this.store, scene);
    this.#notify();
    await new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn)));
    this.times = [...this.times.slice(1 - kTimes),
      {number: json.number, quick: json.quick, asked, answered, drawn: performance.now()}];
  }

  async #ask(path, wish) {
    try {
      const response = await fetch(path, {method: 'POST', body: JSON.stringify(wish)});
      return await response.json();
    } catch (error) {
      return {error: `altiplan edit does not answer: ${error.message}`};
    }
  }

  async save(as) {
    const json = await this.#ask('save', as ? {as} : {});
    const files = json.files?.join(', ');
    if (files && !as) await this.change({});
    this.say(json.error ?? (files ? `Saved: ${files}` : 'There is nothing to save.'), Boolean(json.error));
    return json;
  }

  async compare() {
    const json = await this.#ask('compare', {});
    if (json.error) this.say(json.error);
    else await this.change({});
  }

  /** A mission file of a pipeline's route. */
  async export_to(to, pipeline) {
    const response = await fetch('export', {method: 'POST', body: JSON.stringify({to, pipeline})});
    if (!response.ok) {
      this.say((await response.json()).error);
      return null;
    }
    return response.blob();
  }

  async upload(address, pipeline) {
    this.say('Uploading …', false);
    const json = await this.#ask('upload', {address, pipeline});
    this.say(json.error || json.said || 'Uploaded.', Boolean(json.error));
  }

  /** The plugins with their parameters, asked for once; none where the server has ended meanwhile. */
  plugins() {
    this.known_plugins ??= fetch('plugins').then((response) => response.json()).catch(() => []);
    return this.known_plugins;
  }
}

/** Keeps the server running while the page is open. */
async function stay() {
  try {
    const {body} = await fetch('alive');
    const reader = body.getReader();
    while (!(await reader.read()).done);
  } catch {
    return;
  }
}

export function build_editor(view, world, store) {
  const message = document.createElement('p');
  const editor = new Editor(world, store, (text, is_problem = true) => {
    message.textContent = text;
    message.className = is_problem ? 'message' : 'note';
  });
  document.body.classList.add('editing');
  build_handles(view, world, editor);
  build_timeline(editor);
  build_panel(view, world, store, editor, message);
  stay();
  view.resize();
  view.look('fit');
  return editor;
}
