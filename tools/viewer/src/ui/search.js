// SPDX-License-Identifier: Apache-2.0
import {kKindNames, kKinds} from '../colors.js';
import {checkbox, element, swatch} from '../dom.js';
import {iteration_at, iterations_around, playback_of, thinning, told_of} from '../playback.js';
import {number} from '../units.js';
import {build_convergence} from './convergence.js';

const kSeconds = 12;

/** Playback of a search: position, result, and what is left out. */
export function build_search(world, store) {
  const traced = world.scene.results.map((result, index) => ({result, index}))
    .filter(({result}) => result.trace);
  if (traced.length === 0) {
    return {labels: () => [], pane: element('div', {}, element('p', {className: 'empty'},
      'No result has a trace of its search (altiplan run --trace).'))};
  }
  const choice = element('select', {id: 'searched_result', onchange: () => show(true)},
    traced.map(({result, index}) => element('option', {value: index}, result.name)));
  const visible = checkbox('Show the search', false, (on) => show(on));
  visible.input.id = 'search_shown';
  const slider = element('input', {type: 'range', id: 'searched', min: 0, step: 1,
    ariaLabel: 'Events shown', oninput: () => {
      playing = false;
      const wanted = Number(slider.value);
      if (!store.state.search) show(true);
      stop_at(wanted);
    }});
  const told = element('output', {id: 'search_text'});
  const play = element('button', {id: 'search_play', textContent: '▶', title: 'Play the search',
    onclick: () => {
      playing = !playing;
      if (playing) run();
    }});
  const convergence = build_convergence(store, (iteration) => {
    playing = false;
    if (!store.state.search) show(true);
    store.set({searched: iteration.end});
  });
  let playing = false;

  const trace = () => world.scene.results[Number(choice.value)].trace;
  const stop_at = (nth) => store.set({searched: store.state.search.stops[nth - 1] ?? 0});
  function show(on) {
    visible.input.checked = on;
    if (!on) {
      playing = false;
      store.set({search: null});
      return;
    }
    const search = playback_of(trace());
    slider.max = search.stops.length;
    convergence.show(search);
    store.set({search, searched: search.count});
  }
  /** Number of stops of the playback that have been passed. */
  function passed({search, searched}) {
    const next = search.stops.findIndex((stop) => stop > searched);
    return next < 0 ? search.stops.length : next;
  }
  function run() {
    if (!store.state.search) show(true);
    const {count, stops} = store.state.search;
    if (store.state.searched >= count) store.set({searched: 0});
    let before = performance.now();
    let exact = passed(store.state);
    const step = (now) => {
      if (!playing || !store.state.search) return;
      exact = Math.min(stops.length, exact + Math.max(0, now - before) / 1000 * stops.length /
        kSeconds);
      before = now;
      stop_at(Math.floor(exact));
      if (exact < stops.length) requestAnimationFrame(step);
      else playing = false;
      reflect();
    };
    requestAnimationFrame(step);
  }
  const reflect = () => {
    const {search, searched} = store.state;
    play.textContent = playing ? '❚❚' : '▶';
    if (!search) {
      told.textContent = thinning(trace());
      return;
    }
    slider.value = passed(store.state);
    const step = searched > 0 ? `, step ${trace().steps[search.step[searched - 1]]}` : '';
    const now = iteration_at(search, searched);
    const iteration = now ? told_of(now, iterations_around(search, searched).at(-1)) + ' ' : '';
    told.textContent = `${iteration}${number(searched)} of ${number(search.count)}${step}. ` +
      thinning(trace());
  };
  store.on(['search', 'searched'], reflect);
  // A trace takes time to decode, so its chart is built when the pane is opened.
  store.on(['tab'], ({tab}) => {
    if (tab === 'search') convergence.show(playback_of(trace()));
  });
  reflect();
  const pane = element('div', {}, element('div', {className: 'controls'},
    element('div', {className: 'row'}, traced.length > 1 ? choice : null, visible.row),
    element('div', {className: 'row'}, play, slider),
    element('div', {className: 'row'}, told),
    element('div', {className: 'row kinds'}, kKindNames.slice(0, 4).flatMap((name, kind) =>
      element('span', {}, swatch(kKinds[kind]), name)))),
  convergence.pane);
  return {pane, labels: convergence.labels};
}
