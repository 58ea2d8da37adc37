// SPDX-License-Identifier: Apache-2.0
import {set_series} from './colors.js';
import {layers_of, lines_of} from './world.js';

// What stays as the page was opened with: its terrain and frame are drawn once.
const kFixed = new Set(['ground', 'box', 'corners_lonlat']);

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
  const is_new = ({key, kind}) => !before.has(key) && kind !== 'attempt';
  const appeared = world.lines.filter(is_new).map(({key}) => key);
  const unknown = layers_of(world.scene).filter(({key, role}) => role === 'unknown' && !layers.has(key));
  store.set({
    ...appeared.length > 0 && {shown: new Set([...shown, ...appeared])},
    ...unknown.length > 0 && {hidden: new Set([...hidden, ...unknown.map(({key}) => key)])},
    selected: Math.min(selected, Math.max(0, results.length - 1)),
    version: version + 1,
  });
}
