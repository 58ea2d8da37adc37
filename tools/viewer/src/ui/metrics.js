// SPDX-License-Identifier: Apache-2.0
import {route_color} from '../colors.js';
import {element, swatch} from '../dom.js';
import {number} from '../units.js';
import {pill} from './side.js';

const kStraight = 1e8;  // metres
const kUnits = {m: 'm', deg: '°', rad: 'rad', s: 's'};

/** `min_clearance_m` → Min clearance, m. */
function label(key) {
  const unit = kUnits[key.split('_').at(-1)];
  const words = (unit ? key.slice(0, key.lastIndexOf('_')) : key).replaceAll('_', ' ');
  return words[0].toUpperCase() + words.slice(1) + (unit ? `, ${unit}` : '');
}

/** A table with a column per result. */
export function build_metrics({scene: {results}}, {theme}) {
  const head = element('tr', {}, element('th', {}), results.map(({name}, index) => {
    const mark = swatch('#000', 'line');
    mark.style.setProperty('--swatch', route_color(index, theme));
    return element('th', {}, mark, name);
  }));
  const rows = [
    row('Status', results.map(({status}) => pill(status))),
    row('Message', results.map(({message}) => message)),
    row('Judged', results.map(({check}) => verdict(check))),
    row('Seed', results.map(({seed}) => String(seed ?? '–'))),
    ...number_rows(results.map(({metrics, body}) => body ?
      {...metrics, body_clearance_m: body.nearest?.body_clearance_m} : metrics)),
  ];
  if (results.some(({flight}) => flight)) {
    const flights = results.map(({flight}) => flight);
    rows.push(element('tr', {}, element('th', {className: 'part', colSpan: results.length + 1},
      'Flight')),
    row('Status', flights.map((flight) => flight ? pill(flight.status) : '–')),
    row('Message', flights.map((flight) => flight?.message ?? '–')),
    row('Judged', flights.map((flight) => verdict(flight?.check))),
    ...number_rows(flights.map((flight) => flight && {...flight.metrics,
      min_separation_m: flight.min_separation_m, collisions: flight.collisions,
      handovers: flight.handovers?.length, replans: flight.replans?.length})));
  }
  return element('div', {}, element('table', {}, element('thead', {}, head),
    element('tbody', {}, rows)));
}

function row(name, values) {
  return element('tr', {}, element('th', {scope: 'row'}, name),
    values.map((value) => element('td', {}, value)));
}

function number_rows(columns) {
  const keys = new Set(columns.flatMap((column) => Object.keys(column ?? {})));
  return [...keys].map((key) => row(label(key), columns.map((column) => reading(key, column?.[key]))));
}

/** A radius beyond kStraight is rounding noise: the route does not turn. */
function reading(key, value) {
  return key.endsWith('radius_m') && value >= kStraight ? 'straight' : number(value);
}

function verdict(check) {
  if (!check) return '–';
  return check.ok ? 'no violations' :
    `${check.violations.length} violation${check.violations.length === 1 ? '' : 's'}`;
}
