// SPDX-License-Identifier: Apache-2.0
import {bodies_of} from '../body.js';
import {kRoleNames, role_color, route_color} from '../colors.js';
import {by_id, element, swatch} from '../dom.js';
import {thinning} from '../playback.js';
import {ramp_gradient} from '../ramp.js';
import {length_text, mark_text, metres, number} from '../units.js';
import {grid_lines, grid_unit, layers_of} from '../world.js';
import {violations_of} from './violations.js';

/** The legend of colours and lines, with units. */
export function build_legend(world, store) {
  const reflect = () => by_id('legend').replaceChildren(...heights(world, store.state),
    ...routes(world, store.state), ...roles(world.scene, store.state), ...violations(world, store.state),
    ...body(world.scene, store.state), grid(world, store.state), ...search(store.state));
  store.on(['version', 'theme', 'shown', 'hidden', 'grid', 'contours', 'basemap', 'bodies', 'exaggeration', 'cut', 'search'], reflect);
  reflect();
  const fold = () => {
    by_id('legend').hidden = !store.state.legend;
  };
  store.on(['legend'], fold);
  fold();
}

function heights({scene: {ground}, basemap}, state) {
  if (!ground || basemap && state.basemap) return [];
  const bar = element('div', {className: 'ramp'});
  bar.style.background = ramp_gradient();
  return [element('div', {className: 'heights'}, element('span', {}, number(ground.min)), bar,
    element('span', {}, `${metres(ground.max)} above sea`))];
}

function routes({scene, lines}, {shown, theme}) {
  return lines.filter(({key}) => shown.has(key)).map(({kind, result, step}) => {
    const what = {route: 'route', track: 'flown', attempt: step}[kind];
    return element('div', {}, swatch(route_color(result, theme), `line ${kind}`),
      `${scene.results[result].name}, ${what}`);
  });
}

function roles(scene, {hidden}) {
  const seen = new Map(layers_of(scene).filter(({key}) => !hidden.has(key)).map(({role, known}) => [`${role}${known}`, {role, known}]));
  return [...seen.values()].map(({role, known}) => element('div', {},
    swatch(role_color(role), known ? 'fill' : 'fill unknown'),
    `${kRoleNames[role] ?? role}${known ? '' : ', unknown to the planner'}`));
}

function violations(world, {shown}) {
  if (!violations_of(world).some(({line, place}) => place && shown.has(line))) return [];
  return [element('div', {}, element('span', {className: 'swatch violation'}), 'Violation')];
}

function body(scene, {bodies, shown, theme}) {
  const seen = bodies && bodies_of(scene).find(({key}) => shown.has(key));
  return seen ? [element('div', {}, swatch(route_color(seen.result, theme), 'fill body'),
    'Body, to scale; opaque at its closest place')] : [];
}

/** While a search is shown, reports how much of it is left out, whichever pane is open. */
function search({search: shown}) {
  return shown ? [element('div', {className: 'note'}, `Search. ${thinning(shown.trace)}`)] : [];
}

function grid({frame, scene, contour_step: apart}, state) {
  const [{step}, unit] = [grid_lines(frame.box, 0), grid_unit(frame.box)];
  const parts = state.grid ? [`Grid ${mark_text(step, step, unit.metres)} ${unit.name}`] : [];
  if (apart && state.contours) parts.push(`contours every ${length_text(apart)}`);
  if (!scene.ground && !document.body.classList.contains('flat')) {
    parts.push(`floor drawn at ${metres(frame.box[0][2])}`);
  }
  if (state.exaggeration > 1) parts.push(`vertical exaggeration ${state.exaggeration.toFixed(1)}×`);
  if (state.cut < Infinity) parts.push(`cut above ${metres(state.cut)}`);
  return element('div', {className: 'note'}, parts.join(', '));
}
