// SPDX-License-Identifier: Apache-2.0
/** What the user has chosen; who draws it listens for the keys that matter to it. */
export class Store {
  #listeners = [];
  #changed = new Set();

  constructor(state) {
    this.state = state;
  }

  on(keys, listener) {
    this.#listeners.push({keys, listener});
  }

  /** Listeners run once for all that changes in one go. */
  set(patch) {
    for (const [key, value] of Object.entries(patch)) {
      if (this.state[key] !== value) {
        this.state[key] = value;
        if (this.#changed.size === 0) queueMicrotask(() => this.#notify());
        this.#changed.add(key);
      }
    }
  }

  /** Puts `member` into the set under `key`, or takes it out. */
  toggle(key, member, present = !this.state[key].has(member)) {
    const next = new Set(this.state[key]);
    if (present) next.add(member); else next.delete(member);
    this.set({[key]: next});
  }

  #notify() {
    const changed = this.#changed;
    this.#changed = new Set();
    for (const {keys, listener} of this.#listeners) {
      if (keys.some((key) => changed.has(key))) listener(this.state, changed);
    }
  }
}
