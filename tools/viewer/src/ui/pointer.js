// SPDX-License-Identifier: Apache-2.0
import {by_id} from '../dom.js';
import {metres, number} from '../units.js';
import {between, lonlat} from '../world.js';
import {route_cursor} from './cursor.js';

const kReachPixels = 10;
const kTipPixels = 14;

/** Shows the route (moving the profiles' cursor), the solid and the ground under the pointer. */
export function build_pointer(view, world, store) {
  const {canvas} = view;
  let waiting = null;
  let pressed_at = null;
  canvas.addEventListener('pointerdown', (event) => {
    pressed_at = [event.offsetX, event.offsetY];
  });
  canvas.addEventListener('pointermove', (event) => {
    if (event.buttons !== 0) return;
    const place = [event.offsetX, event.offsetY];
    if (waiting === null) requestAnimationFrame(() => {
      const [x, y] = waiting;
      waiting = null;
      hover(x, y, view, world, store);
    });
    waiting = place;
  });
  canvas.addEventListener('pointerleave', () => { by_id('tip').hidden = true; });
  canvas.addEventListener('click', (event) => {
    const [x, y] = [event.offsetX, event.offsetY];
    // The end of a drag is not a click.
    if (!pressed_at || Math.hypot(x - pressed_at[0], y - pressed_at[1]) > 4) return;
    const found = nearest(x, y, view, world, store.state);
    if (found) choose(found, world, store);
  });
}

function hover(x, y, view, world, store) {
  const found = nearest(x, y, view, world, store.state);
  const tip = by_id('tip');
  if (found) {
    const {line, at} = found;
    if (line.result === store.state.selected) {
      store.set({cursor: route_cursor(found, world, store.state)});
    }
    tip.textContent = `${world.scene.results[line.result].name}: ${metres(at[2])} above sea`;
  } else {
    tip.textContent = view.solid_at(x, y) ?? '';
  }
  tip.hidden = tip.textContent === '';
  put_tip(tip, x, y, view.stage);
  by_id('readout').textContent = describe(view.ground_at(x, y), world.scene);
}

/** Beside the pointer, on the side where it is not cut. */
function put_tip(tip, x, y, {clientWidth, clientHeight}) {
  const beside = (at, size, side) => Math.max(0,
    at + kTipPixels + size > side ? at - kTipPixels - size : at + kTipPixels);
  tip.style.transform = `translate(${beside(x, tip.offsetWidth, clientWidth)}px,` +
    `${beside(y, tip.offsetHeight, clientHeight)}px)`;
}

function choose(found, world, store) {
  const {line} = found;
  const source = line.kind === 'track' ? 'flight' : 'route';
  store.set({selected: line.result, source});
  store.set({cursor: route_cursor(found, world, store.state)});
  if (line.kind === 'track') store.set({time: found.time, playing: false});
}

function describe(point, scene) {
  if (!point) return '';
  const [x, y, z] = point;
  const place = lonlat(scene, point);
  const parts = [`x ${number(x)}`, `y ${metres(y)}`];
  if (!Number.isNaN(z) && scene.ground) parts.push(`ground ${metres(z)}`);
  if (place) parts.push(`${place[1].toFixed(5)}°, ${place[0].toFixed(5)}°`);
  return parts.join(' · ');
}

/** The point of a visible line nearest to a pixel; null if none is within reach. */
function nearest(x, y, view, world, {shown}) {
  let best = null;
  let reach = kReachPixels;
  for (const line of world.lines) {
    if (!shown.has(line.key)) continue;
    let before = view.project(line.points[0]);
    for (let at = 1; at < line.points.length; at++) {
      const here = view.project(line.points[at]);
      const share = foot(x, y, before, here);
      const away = Math.hypot(before.x + share * (here.x - before.x) - x,
        before.y + share * (here.y - before.y) - y);
      if (away < reach && before.visible && here.visible) {
        reach = away;
        best = {line, leg: at - 1, share: along(share, before.depth, here.depth)};
      }
      before = here;
    }
  }
  if (!best) return null;
  const {line, leg, share} = best;
  return {...best, at: between(line.points[leg], line.points[leg + 1], share),
    time: line.times && line.times[leg] + share * (line.times[leg + 1] - line.times[leg])};
}

/** Fraction of a leg in the world for a fraction on the screen, which perspective shortens. */
function along(share, from_depth, to_depth) {
  return share * from_depth / ((1 - share) * to_depth + share * from_depth);
}

/** Fraction along `a` to `b` at the point nearest to (x, y). */
function foot(x, y, a, b) {
  const [dx, dy] = [b.x - a.x, b.y - a.y];
  const square = dx * dx + dy * dy;
  return square === 0 ? 0 : Math.min(1, Math.max(0, ((x - a.x) * dx + (y - a.y) * dy) / square));
}
