// SPDX-License-Identifier: Apache-2.0
import {kKindNames, kKinds} from '../colors.js';
import {by_id, element, swatch} from '../dom.js';
import {flight_line} from '../world.js';
import {next_cut} from './cut.js';

const kKeys = [
  ['Space', 'play or pause the flight'],
  ['← →', 'step the flight back or forward by 1 s (with Shift: 10 s)'],
  ['F', 'follow the vehicle, or stop'],
  ['1 … 9', 'show or hide a result'],
  ['R', 'overview: the whole box from the south-west'],
  ['T', 'top view'], ['N', 'from the south, north up'],
  ['[ ]', 'decrease or increase the vertical exaggeration'],
  [', .', 'lower or raise the cut: hide everything but routes above it'], ['C', 'cut off'],
  ['G', 'grid and box'], ['L', 'legend'], ['D', 'light or dark theme'],
  ['P M V S', 'profiles, metrics, violations, search'],
  ['B', 'results and layers (narrow screens)'], ['?', 'this list'],
];

/** Single-key commands, ignored while an input has the focus. */
export function listen_to_keys(world, store, actions) {
  const state = store.state;
  const exaggerate = (by) =>
    store.set({exaggeration: Math.min(5, Math.max(1, state.exaggeration + by))});
  const cut = (way) => store.set({cut: next_cut(state.cut, world.frame, way)});
  const tab = (name) => () => store.set({tab: name});
  const deeds = {
    r: actions.fit, t: actions.top, n: actions.north, d: actions.theme, b: actions.menu,
    '?': actions.help, '[': () => exaggerate(-0.5), ']': () => exaggerate(0.5),
    ',': () => cut(-1), '.': () => cut(1), c: () => store.set({cut: Infinity}),
    g: () => store.set({grid: !state.grid}), l: () => store.set({legend: !state.legend}),
    f: () => flight_line(world, state) && store.set({follow: !state.follow}),
    p: tab('profiles'), m: tab('metrics'),
    v: tab('violations'), s: tab('search'),
    ' ': () => store.set({playing: !state.playing}),
    ArrowLeft: (shift) => move_time(world, store, shift ? -10 : -1),
    ArrowRight: (shift) => move_time(world, store, shift ? 10 : 1),
  };
  addEventListener('keydown', (event) => {
    const {target} = event;
    if (event.ctrlKey || event.altKey || event.metaKey || by_id('help').open) return;
    if (target.matches('input[type=text]')) return;
    if (target.matches('select, input[type=range]') && !/^[a-z?[\],. ]$/.test(event.key)) return;
    if (event.key === ' ' && target.matches('button, input, summary')) return;
    const digit = Number(event.key);
    if (digit >= 1 && digit <= 9) toggle_result(digit - 1, world, store);
    else if (deeds[event.key.toLowerCase()] ?? deeds[event.key]) {
      (deeds[event.key.toLowerCase()] ?? deeds[event.key])(event.shiftKey);
      event.preventDefault();
    }
  });
  by_id('help').append(...help_text());
}

function move_time(world, store, by) {
  const ends = world.lines.map(({times}) => times?.at(-1) ?? 0);
  store.set({time: Math.min(Math.max(0, ...ends), Math.max(0, store.state.time + by)),
    playing: false});
}

function toggle_result(index, world, store) {
  const keys = world.lines.filter(({result, kind}) => result === index && kind !== 'attempt')
    .map(({key}) => key);
  const on = !keys.some((key) => store.state.shown.has(key));
  const shown = new Set(store.state.shown);
  for (const key of keys) if (on) shown.add(key); else shown.delete(key);
  store.set({shown});
}

function help_text() {
  return [
    element('h2', {}, 'Keys'),
    element('dl', {}, kKeys.flatMap(([key, what]) =>
      [element('dt', {}, element('kbd', {}, key)), element('dd', {}, what)])),
    element('h2', {}, 'Mouse and touch'),
    element('p', {}, 'Drag to rotate, drag with the right button or two fingers to pan, use the ' +
      'wheel or pinch to zoom; the scale is that of the middle of the picture. Point at a route to move the cursor of the profiles; click it to ' +
      'select that result. Click a profile of a flight to jump to that time, turn the wheel on it ' +
      'to zoom, drag it along, double-click it to see all again.'),
    element('h2', {}, 'Search events'),
    element('p', {className: 'kinds'}, kKindNames.slice(0, 4).flatMap((name, kind) =>
      element('span', {}, swatch(kKinds[kind]), name))),
    element('form', {method: 'dialog'}, element('button', {}, 'Close')),
  ];
}
