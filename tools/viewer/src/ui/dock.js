// SPDX-License-Identifier: Apache-2.0
import {by_id, element} from '../dom.js';
import {build_metrics} from './metrics.js';
import {build_profiles} from './profiles.js';
import {build_search} from './search.js';
import {build_violations, violations_of} from './violations.js';

/** The four panes under the picture, one at a time. Returns `labels`, what its charts draw. */
export function build_dock(view, world, store) {
  const profiles = build_profiles(world, store);
  const search = build_search(world, store);
  const panes = {
    profiles: ['Profiles', profiles.pane],
    metrics: ['Metrics', element('div', {})],
    violations: ['Violations', element('div', {})],
    search: ['Search', search.pane],
  };
  const tabs = element('div', {className: 'tabs', role: 'tablist'});
  const dock = by_id('dock');
  dock.append(tabs);
  for (const [name, [title, pane]] of Object.entries(panes)) {
    pane.classList.add('pane', name);
    tabs.append(element('button', {id: `tab_${name}`, role: 'tab', textContent: title,
      onclick: () => store.set({tab: name})}));
    dock.append(pane);
  }
  const fold = element('button', {id: 'fold', title: 'Fold or unfold', textContent: '▾',
    onclick: () => document.body.classList.toggle('folded')});
  tabs.append(fold);
  const reflect = () => {
    for (const [name, [, pane]] of Object.entries(panes)) {
      pane.hidden = name !== store.state.tab;
      by_id(`tab_${name}`).ariaSelected = String(name === store.state.tab);
    }
  };
  store.on(['tab'], () => {
    document.body.classList.remove('folded');
    reflect();
  });
  reflect();
  // Tables take time: while scenes follow each other, what is behind another tab waits for it.
  const fill = ({tab}, changed) => {
    const is_due = (name) => tab === name || !changed.has('version');
    by_id('tab_violations').textContent = `Violations (${violations_of(world).length})`;
    if (is_due('metrics')) panes.metrics[1].replaceChildren(build_metrics(world, store.state));
    if (is_due('violations')) panes.violations[1].replaceChildren(build_violations(view, world, store));
  };
  store.on(['version', 'theme', 'tab'], fill);
  fill(store.state, new Set());
  return {labels: () => [...profiles.labels(), ...search.labels()]};
}
