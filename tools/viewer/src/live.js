// SPDX-License-Identifier: Apache-2.0
import {set_series} from './colors.js';
import {layers_of, lines_of} from './world.js';

// What stays as the page was opened with: its terrain and frame are drawn once.
const kFixed = new Set(['ground', 'box', 'corners_lonlat']);

/** What was tried where there is no route: it shows where it fails. */
export const tried_lines = (lines, results) =>
  lines.filter(({kind, result}) => kind === 'attempt' && !results[result].route?.length)
    .map(({key}) => key);

/** Shows another scene in the open page: all that `scene` has, the rest stays. The user's choices
 *  stay too; a line that was not there before is shown unless it is an attempt. */
export function show_scene(world, store, scene) {
  const before = new Set(world.lines.map(({key}) => key));
  const layers = new Set(layers_of(world.scene).map(({key}) => key));
  for (const [key, value] of Object.entries(scene)) {
    if (!kFixed.has(key)) world.scene[key] = value;
  }
  const {results} = world.scene;
  set_series(results);
  world.lines.splice(0, Infinity, ...lines_of(results));
  const {shown, hidden, selected, version} = store.state;
  const keys = new Set(world.lines.map(({key}) => key));
  const appeared = world.lines.filter(({key, kind}) => kind !== 'attempt' && !before.has(key));
  const tried = tried_lines(world.lines, results);
  const kept = [...shown].filter((key) => keys.has(key) && !world.tried.has(key));
  world.tried = new Set(tried.filter((key) => !kept.includes(key)));
  const now = new Set([...kept, ...appeared.map(({key}) => key), ...tried]);
  const is_same = now.size === shown.size && [...now].every((key) => shown.has(key));
  const unknown = layers_of(world.scene).filter(({key, role}) => role === 'unknown' && !layers.has(key));
  store.set({
    ...!is_same && {shown: now},
    ...unknown.length > 0 && {hidden: new Set([...hidden, ...unknown.map(({key}) => key)])},
    selected: Math.min(selected, Math.max(0, results.length - 1)),
    version: version + 1,
  });
}
