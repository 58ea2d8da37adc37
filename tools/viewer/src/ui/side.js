// SPDX-License-Identifier: Apache-2.0
import {outer_of} from '../body.js';
import {kRoleNames, role_color, route_color} from '../colors.js';
import {by_id, checkbox, element, swatch} from '../dom.js';
import {layers_of} from '../world.js';
import {cut_slider} from './cut.js';

// Distance of the eye from a body, in radii.
const kBodiesAway = 9;

const kStatusClass = (status) => status === 'solved' ? 'good' : 'bad';

export function pill(status) {
  return element('span', {className: `pill ${kStatusClass(status)}`},
    status.replaceAll('_', ' '));
}

/** The left panel: the results with their lines, and the world's layers. */
export function build_side(view, world, store) {
  const side = by_id('side');
  const was_open = [...side.querySelectorAll('.result details')].map(({open}) => open);
  side.replaceChildren(
    element('h2', {}, 'Results'),
    ...world.scene.results.map((result, index) => result_card(result, index, world, store)),
    element('h2', {}, 'World'), ...world_controls(view, world, store), ...notes(world.scene));
  side.querySelectorAll('.result details').forEach((steps, nth) => { steps.open = was_open[nth] ?? false; });
}

function result_card(result, index, world, store) {
  const lines = world.lines.filter((line) => line.result === index);
  const name = element('button', {className: 'name', textContent: result.name,
    title: `Show the profiles of ${result.file}`,
    onclick: () => store.set({selected: index, cursor: null})});
  const mark = swatch('#000', 'line');
  const card = element('section', {className: 'result'},
    element('div', {className: 'head'}, mark, name, pill(result.status)),
    result.status === 'solved' ? null : element('p', {className: 'message'}, result.message));
  const attempts = element('details', {}, element('summary', {}, 'Steps'));
  for (const line of lines) {
    const label = {route: 'Route', track: 'Flown track',
      attempt: attempt_label(result.steps.find(({id}) => id === line.step))}[line.kind];
    const {input, row} = checkbox(label, false, (on) => store.toggle('shown', line.key, on));
    input.dataset.line = line.key;
    const reflect = () => { input.checked = store.state.shown.has(line.key); };
    reflect();
    store.on(['shown'], reflect);
    (line.kind === 'attempt' ? attempts : card).append(row);
  }
  for (const step of result.steps.filter(({route}) => !route?.length)) {
    attempts.append(element('p', {className: 'note'}, attempt_label(step), ' ',
      step.accepted ? '' : step.message));
  }
  if (result.steps.length > 0) card.append(attempts);
  if (result.flight && result.flight.status !== 'solved') {
    card.append(element('p', {className: 'message'}, `Flight: ${result.flight.message}`));
  }
  const reflect = () => {
    card.classList.toggle('selected', store.state.selected === index);
    mark.style.setProperty('--swatch', route_color(index, store.state.theme));
  };
  reflect();
  store.on(['selected', 'theme'], reflect);
  return card;
}

function attempt_label(step) {
  if (!step) return '';
  const stand_in = step.instead_of ? `, instead of ${step.instead_of}` : '';
  const fate = step.accepted ? '' : ` (${step.status.replaceAll('_', ' ')})`;
  return `${step.id}: ${step.verb} ${step.plugin}${stand_in}${fate}`;
}

function world_controls(view, world, store) {
  const {scene} = world;
  const rows = [exaggeration_slider(store), cut_slider(world.frame, store)];
  for (const layer of layers_of(scene)) rows.push(layer_row(layer, scene, store));
  const grid = checkbox('Grid and box', true, (on) => store.set({grid: on}));
  store.on(['grid'], () => { grid.input.checked = store.state.grid; });
  const legend = checkbox('Legend', store.state.legend, (on) => store.set({legend: on}));
  store.on(['legend'], () => { legend.input.checked = store.state.legend; });
  const optional = (key, label) => {
    const {input, row} = checkbox(label, store.state[key], (on) => store.set({[key]: on}));
    input.id = `show_${key}`;
    return row;
  };
  rows.push(grid.row, legend.row);
  if (world.contour_step) rows.push(optional('contours', 'Contours'));
  if (world.basemap) rows.push(optional('basemap', `Basemap ${world.basemap.name}`));
  if (scene.body) rows.push(body_row(view, scene, store));
  if (layers_of(scene).some(({events}) => events.size > 0)) {
    rows.push(checkbox('Shapes of all events, at any time', false,
      (on) => store.set({everything: on})).row);
  }
  return rows;
}

/** Shows the bodies; the button flies to the closest place of the selected result. */
function body_row(view, scene, store) {
  const {input, row} = checkbox('Body', store.state.bodies, (on) => store.set({bodies: on}));
  input.id = 'show_bodies';
  const button = element('button', {textContent: 'Closest place', title: 'Fly there',
    onclick: () => {
      store.set({bodies: true});
      store.toggle('shown', `${store.state.selected}`, true);
      view.fly_to(scene.results[store.state.selected].body.nearest.at,
        kBodiesAway * outer_of(scene.body));
    }});
  const reflect = () => {
    input.checked = store.state.bodies;
    button.disabled = !scene.results[store.state.selected]?.body?.nearest;
  };
  reflect();
  store.on(['bodies', 'selected'], reflect);
  return element('div', {className: 'bodies'}, row, button);
}

function layer_row(layer, scene, store) {
  const {input, row} = checkbox(layer.name, !store.state.hidden.has(layer.key),
    (on) => store.toggle('hidden', layer.key, !on), swatch(role_color(layer.role)));
  input.dataset.layer = layer.key;
  const remarks = [kRoleNames[layer.role]];
  if (layer.count > 1) remarks.push(`${layer.count.toLocaleString('en')} shapes`);
  if (!layer.known) remarks.push('unknown to the planner');
  for (const event of layer.events) remarks.push(`appears with “${scene.events[event]?.text}”`);
  row.append(element('small', {}, remarks.join(', ')));
  return row;
}

function exaggeration_slider(store) {
  const value = element('output', {});
  const input = element('input', {type: 'range', id: 'exaggeration', min: 1, max: 5, step: 0.1,
    oninput: () => store.set({exaggeration: Number(input.value)})});
  const reflect = () => {
    input.value = store.state.exaggeration;
    value.textContent = `${store.state.exaggeration.toFixed(1)}×`;
  };
  reflect();
  store.on(['exaggeration'], reflect);
  return element('label', {className: 'slider stretch'}, 'Exaggeration', input, value);
}

function notes({notes: lines, ground}) {
  const all = [...(lines ?? [])];
  if (ground?.of) {
    all.push(`Ground drawn with ${ground.nx} × ${ground.ny} of ${ground.of[0]} × ` +
      `${ground.of[1]} posts.`);
  }
  return all.map((line) => element('p', {className: 'note'}, line));
}
