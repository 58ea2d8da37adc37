// SPDX-License-Identifier: Apache-2.0
import {kRoleNames, role_color} from '../colors.js';
import {element, swatch} from '../dom.js';
import {layers_of} from '../world.js';

// Of heights that are filled where the vehicle is, and of those beside it.
const kOpacity = {obstacle: [0.85, 0.4], other: [0.45, 0.18]};

const role_of = (scene, name) =>
  layers_of(scene).find((layer) => layer.name === name)?.role ?? 'obstacle';

const opacity = (role, beside) => (kOpacity[role] ?? kOpacity.other)[beside ? 1 : 0];

/** The heights that obstacles and zones fill along a profile, those beside it first. */
export function draw_solids(plot, profile, scene) {
  const {ctx, bbox} = plot;
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  for (const list of ['beside', 'solid']) {
    for (const [layer, samples] of Object.entries(profile[list] ?? {})) {
      const role = role_of(scene, layer);
      ctx.fillStyle = role_color(role);
      ctx.globalAlpha = opacity(role, list === 'beside');
      ctx.fill(path_of(plot, samples));
    }
  }
  ctx.restore();
}

/** Each sample's heights, half way to its neighbours. */
function path_of({data: [x], valToPos}, samples) {
  const pixel = (nth) => valToPos(x[Math.max(0, Math.min(nth, x.length - 1))], 'x', true);
  const path = new Path2D();
  samples.forEach((spans, nth) => spans.forEach(([low, high]) => {
    const [left, right] = [(pixel(nth - 1) + pixel(nth)) / 2, (pixel(nth) + pixel(nth + 1)) / 2];
    const top = valToPos(high, 'y', true);
    path.rect(left, top, right - left, valToPos(low, 'y', true) - top);
  }));
  return path;
}

/** The heights of the tops and feet of the obstacles; zones may be of any height. */
export const obstacle_heights_of = (profile, scene) => [profile.solid, profile.beside]
  .flatMap((list) => Object.entries(list ?? {}))
  .filter(([layer]) => role_of(scene, layer) === 'obstacle')
  .flatMap(([, samples]) => samples.flat(2));

/** What the colours are, and how far beside the profile the pale ones. */
export function solids_legend(profile, scene) {
  const roles = (list) => new Set(Object.keys(list ?? {}).map((layer) => role_of(scene, layer)));
  const entry = (role, text, beside) => {
    const mark = swatch(role_color(role));
    mark.style.opacity = opacity(role, beside);
    return element('span', {className: 'reading'}, mark, ` ${text}`);
  };
  const below = [...roles(profile.solid)].map((role) => entry(role, kRoleNames[role], false));
  const [only] = [...roles(profile.beside)];
  return only ? [...below, entry(only, `≤ ${Math.round(profile.beside_m)} m beside`, true)] : below;
}
