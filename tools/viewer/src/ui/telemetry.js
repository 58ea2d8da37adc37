// SPDX-License-Identifier: Apache-2.0
import {route_color} from '../colors.js';
import {by_id, element} from '../dom.js';
import {clock} from '../units.js';
import {flight_line, place_at} from '../world.js';
import {caption_at} from './happenings.js';

/** On the picture: speed, height and time of the flight that is looked at, and what has just
 *  happened to it. */
export function build_telemetry(world, store) {
  const panel = by_id('telemetry');
  panel.hidden = !flight_line(world, store.state);
  panel.replaceChildren();
  if (panel.hidden) return;
  const {ground} = world.scene;
  const name = element('b', {});
  const [speed, height, time] = ['Speed', ground ? 'Above ground' : 'Above sea', 'Time']
    .map((title) => {
      const value = element('output', {});
      panel.append(element('div', {}, element('small', {}, title), value));
      return value;
    });
  panel.prepend(name);
  const reflect = () => {
    const {state} = store;
    const line = flight_line(world, state);
    const now = Math.min(state.time, line.times.at(-1));
    const place = place_at(line, now);
    const below = ground ? ground.height(place.at[0], place.at[1]) : 0;
    const {title, results} = world.scene;
    name.textContent = `${state.filmed ? `${title}: ` : ''}${results[line.result].name}`;
    name.style.setProperty('--swatch', route_color(line.result, state.theme));
    speed.textContent = `${place.speed.toFixed(1)} m/s`;
    height.textContent = Number.isNaN(below) ? '–' :
      `${Math.round(place.at[2] - below).toLocaleString('en')} m`;
    time.textContent = clock(now);
    reflect_caption(line, state, world.scene);
  };
  store.on(['time', 'selected', 'theme', 'speed', 'playing', 'follow', 'filmed'], reflect);
  reflect();
}

/** Only while the flight is watched: at rest the marks of the clock say the same. */
function reflect_caption(line, {time, speed, playing, follow}, scene) {
  const caption = by_id('caption');
  const now = playing || follow ?
    caption_at(scene, line.result, {time, speed}, line.times.at(-1)) : null;
  caption.hidden = !now;
  caption.className = now?.kind ?? '';
  caption.textContent = now?.text ?? '';
}
