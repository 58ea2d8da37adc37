// SPDX-License-Identifier: Apache-2.0
import {by_id} from '../dom.js';
import {keep_built} from '../store.js';
import {build_bar} from './bar.js';
import {build_clock} from './clock.js';
import {build_dock} from './dock.js';
import {listen_to_keys} from './keys.js';
import {build_labels} from './labels.js';
import {build_legend} from './legend.js';
import {build_compass, build_marks} from './marks.js';
import {build_pointer} from './pointer.js';
import {build_scale} from './scale.js';
import {build_side} from './side.js';
import {build_telemetry} from './telemetry.js';

/** The panels around the picture and on it. Returns `labels`, what their canvases hold. */
export function build_panels(view, world, store) {
  const {scene} = world;
  document.title = by_id('title').textContent = scene.title;
  by_id('attribution').textContent = (scene.attribution ?? []).join(' · ');
  const actions = {
    fit: () => view.look('fit'),
    top: () => view.look('top'),
    north: () => view.look('north'),
    theme: () => store.switch_theme(),
    help: () => by_id('help').showModal(),
    menu: () => document.body.classList.toggle('side_open'),
  };
  build_bar(world, store, actions);
  keep_built(store, (part) => build_side(view, world, part));
  keep_built(store, (part) => build_clock(world, part));
  const {labels} = build_dock(view, world, store);
  build_legend(world, store);
  build_compass(view);
  build_scale(view);
  keep_built(store, (part) => build_telemetry(world, part));
  // After the panels on the picture, of which the labels stay clear.
  build_labels(view, world, store, build_marks(view, world, store));
  build_pointer(view, world, store);
  listen_to_keys(world, store, actions);
  return {labels};
}
