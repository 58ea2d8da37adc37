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

  /** For tests: what must not grow while scenes follow each other. */
  memory() {
    return {listeners: this.#listeners.length};
  }

  off(listeners) {
    this.#listeners = this.#listeners.filter(({listener}) => !listeners.has(listener));
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

/** The store for a part that is built anew: `end` forgets the part's listeners. */
class Scope {
  #own = new Set();

  constructor(store) {
    this.store = store;
    this.state = store.state;
  }

  on(keys, listener) {
    this.#own.add(listener);
    this.store.on(keys, listener);
  }

  set(patch) {
    this.store.set(patch);
  }

  toggle(...change) {
    this.store.toggle(...change);
  }

  end() {
    this.store.off(this.#own);
  }
}

/** Builds a part of the page, and again whenever another scene is shown. */
export function keep_built(store, build) {
  let scope = new Scope(store);
  build(scope);
  store.on(['version'], () => {
    scope.end();
    scope = new Scope(store);
    build(scope);
  });
}
