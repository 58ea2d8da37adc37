// SPDX-License-Identifier: Apache-2.0
import {by_id, element} from '../dom.js';
import {keep_built} from '../store.js';

const kButtons = [
  ['fit', '⌂', ' Overview', 'The whole box from the south-west (R)'],
  ['top', '⊤', ' Top view', 'Top view, north up (T)'],
  ['theme', '◐', ' Theme', 'Light or dark theme (D)'],
  ['help', '?', '', 'Keys and symbols (?)'],
];

export function build_bar(world, store, actions) {
  by_id('menu').onclick = actions.menu;
  by_id('actions').append(...kButtons.map(([name, sign, word, title]) =>
    element('button', {id: `do_${name}`, title, ariaLabel: title, onclick: actions[name]}, sign,
      element('span', {className: 'word'}, word))));
  by_id('north').onclick = actions.north;
  keep_built(store, () => show_verdict(world.scene.results));
}

function show_verdict(results) {
  const solved = results.filter(({status}) => status === 'solved').length;
  by_id('verdict').textContent = `${solved} of ${results.length} solved`;
  const unsolved = results.filter(({status}) => status !== 'solved');
  if (unsolved.length > 0 && solved === 0) show_failure(unsolved[0]);
  else if (by_id('alert').dataset.of === 'results') by_id('alert').hidden = true;
}

/** Shows the failure instead of the route if no result is solved. */
function show_failure({name, status, message}) {
  const alert = by_id('alert');
  alert.replaceChildren(element('strong', {}, `${name}: ${status.replaceAll('_', ' ')}. `), message,
    element('button', {title: 'Close', textContent: '×',
      onclick: () => { alert.hidden = true; }}));
  alert.dataset.of = 'results';
  alert.hidden = false;
}
