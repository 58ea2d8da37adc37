// SPDX-License-Identifier: Apache-2.0
import {kKindNames, kKinds} from '../colors.js';
import {checkbox, element, swatch} from '../dom.js';
import {playback_of, thinning} from '../playback.js';

const kSeconds = 12;

/** The search played back: how far, of which result, and what is not shown. */
export function build_search(world, store) {
  const traced = world.scene.results.map((result, index) => ({result, index}))
    .filter(({result}) => result.trace);
  if (traced.length === 0) {
    return element('div', {}, element('p', {className: 'empty'},
      'No result has a trace of its search (altiplan run --trace).'));
  }
  const choice = element('select', {id: 'searched_result', onchange: () => show(true)},
    traced.map(({result, index}) => element('option', {value: index}, result.name)));
  const visible = checkbox('Show the search', false, (on) => show(on));
  visible.input.id = 'search_shown';
  const slider = element('input', {type: 'range', id: 'searched', min: 0, step: 1,
    ariaLabel: 'Events shown', oninput: () => {
      playing = false;
      store.set({searched: Number(slider.value)});
    }});
  const told = element('output', {id: 'search_text'});
  const play = element('button', {id: 'search_play', textContent: '▶', title: 'Play the search',
    onclick: () => {
      playing = !playing;
      if (playing) run();
    }});
  let playing = false;

  const trace = () => world.scene.results[Number(choice.value)].trace;
  function show(on) {
    visible.input.checked = on;
    if (!on) {
      playing = false;
      store.set({search: null});
      return;
    }
    const search = playback_of(trace());
    slider.max = search.count;
    store.set({search, searched: search.count});
  }
  function run() {
    if (!store.state.search) show(true);
    const {count} = store.state.search;
    if (store.state.searched >= count) store.set({searched: 0});
    let before = performance.now();
    let exact = store.state.searched;
    const step = (now) => {
      if (!playing || !store.state.search) return;
      exact = Math.min(count, exact + Math.max(0, now - before) / 1000 * count / kSeconds);
      before = now;
      store.set({searched: Math.floor(exact)});
      if (exact < count) requestAnimationFrame(step);
      else playing = false;
      reflect();
    };
    requestAnimationFrame(step);
  }
  const reflect = () => {
    const {search, searched} = store.state;
    slider.value = searched;
    play.textContent = playing ? '❚❚' : '▶';
    const step = search && searched > 0 ? trace().steps[search.step[searched - 1]] : null;
    told.textContent = search ? `${searched} of ${search.count}${step ? `, step ${step}` : ''}. ` +
      thinning(trace()) : thinning(trace());
  };
  store.on(['search', 'searched'], reflect);
  reflect();
  return element('div', {},
    element('div', {className: 'row'}, traced.length > 1 ? choice : null, visible.row),
    element('div', {className: 'row'}, play, slider),
    element('div', {className: 'row'}, told),
    element('div', {className: 'row kinds'}, kKindNames.slice(0, 4).flatMap((name, kind) =>
      element('span', {}, swatch(kKinds[kind]), name))));
}
