// SPDX-License-Identifier: Apache-2.0
/** The user's choices; each view listens for the keys that it depends on. */
export class Store {
  #listeners = [];
  #changed = new Set();

  constructor(state) {
    this.state = state;
  }

  on(keys, listener) {
    this.#listeners.push({keys, listener});
  }

  /** Listeners run once per call, for all its changes. */
  set(patch) {
    for (const [key, value] of Object.entries(patch)) {
      if (this.state[key] !== value) {
        this.state[key] = value;
        if (this.#changed.size === 0) queueMicrotask(() => this.#notify());
        this.#changed.add(key);
      }
    }
  }

  /** Adds `member` to the set under `key`, or removes it. */
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
