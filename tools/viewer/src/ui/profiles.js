// SPDX-License-Identifier: Apache-2.0
import uPlot from 'uplot';
import {kind_colors, route_color, style_of} from '../colors.js';
import {element, swatch} from '../dom.js';
import {metres, number} from '../units.js';
import {last_before} from '../world.js';
import {fit, new_cell, new_plot, put_cursor, range_of} from './chart.js';
import {profile_cursor, profile_of} from './cursor.js';

// The shown range is at least `span`, so that a level line looks level.
const kCharts = [
  {key: 'altitude', title: 'Altitude above sea', unit: 'm', span: 5},
  {key: 'clearance', title: 'Clearance', unit: 'm', limit: 'clearance_m', zero: true, span: 1},
  {key: 'speed', title: 'Speed', unit: 'm/s', zero: true, span: 1},
  {key: 'turn', title: 'Turn at waypoints', unit: '°', limit: 'turn_deg', zero: true, span: 10},
];

/** Charts over the distance of the route or the time of the flight, with one cursor. */
export function build_profiles(world, store) {
  const pane = element('div', {});
  const choice = element('div', {className: 'choice'});
  const charts = element('div', {className: 'charts'});
  pane.append(choice, charts);
  let drawn = [];

  const rebuild = () => {
    for (const {plot} of drawn) plot.destroy();
    const profile = profile_of(world, store.state);
    choice.replaceChildren(...sources(world, store, profile));
    charts.replaceChildren();
    drawn = profile ? kCharts.map((chart) => draw(chart, profile, charts, world, store)) : [];
    reflect_when_drawn();
    fit(drawn);
  };
  const reflect = () => {
    const profile = profile_of(world, store.state);
    for (const chart of drawn) show_cursor(chart, profile, store.state);
  };
  // A chart has screen positions only once it has been drawn.
  const reflect_when_drawn = () => {
    for (const chart of drawn) chart.redrawn = reflect;
  };
  new ResizeObserver(() => fit(drawn)).observe(charts);
  store.on(['selected', 'source', 'theme'], rebuild);
  store.on(['cursor', 'time'], reflect);
  rebuild();
  return pane;
}

function sources(world, store, profile) {
  const result = world.scene.results[store.state.selected];
  if (!profile) {
    const fate = result?.status === 'solved' ? 'is not shown' : 'has no route';
    return [element('span', {className: 'empty'}, `${result?.name ?? 'This result'} ${fate}` +
      (result?.message ? `: ${result.message}` : '.'))];
  }
  const button = (kind, text) => element('button', {textContent: text,
    ariaPressed: String(profile.kind === kind),
    onclick: () => store.set({source: kind, cursor: null})});
  const both = result.profile && result.flight?.profile;
  return [element('b', {}, result.name), ...(both ? [button('route', 'Route'),
    button('flight', 'Flight')] : []), element('span', {className: 'note'},
    profile.kind === 'route' ? 'over distance, m' : 'over time, s')];
}

function draw(chart, profile, charts, world, store) {
  const value = element('span', {});
  const cell = new_cell(chart, value);
  charts.append(cell);
  const result = world.scene.results[store.state.selected];
  const limit = chart.limit ? result.limits?.[chart.limit] ?? null : null;
  const color = route_color(store.state.selected, store.state.theme);
  const {data, series, names} = curves(chart, profile, limit, color, result.limits);
  const link = {silent: false};
  const made = {};
  // The cursor's dot is on the curve itself, not on ground and limits beside it.
  const plot = new_plot(cell, data, series, {dots: [color], scales: {y: {range: range_of(chart,
    seen(chart, data, limit))}}, hooks: {drawClear: [(self) => {
    if (chart.key === 'altitude') draw_solids(self, profile);
  }], draw: [() => made.redrawn?.()], setCursor: [(self) => {
    if (!link.silent && self.cursor.event) follow(self, profile, store);
  }]}});
  plot.over.addEventListener('click', () => {
    const index = plot.cursor.idx;
    if (profile.kind === 'flight' && index !== null && index !== undefined) {
      store.set({time: profile.x[index], playing: false});
    }
  });
  plot.over.addEventListener('pointerleave', () => store.set({cursor: null}));
  Object.assign(made, {plot, cell, value, chart, link, names});
  return made;
}

function curves(chart, profile, limit, color, limits) {
  const values = profile[chart.key];
  const own = {stroke: color, width: 2, spanGaps: false, points: {show: false}};
  if (chart.key === 'turn') {
    Object.assign(own, {paths: uPlot.paths.bars({size: [0, 3], align: 0}), fill: color});
  }
  const data = [profile.x, values];
  const series = [{}, own];
  if (chart.key === 'altitude') {
    const line = style_of('--ground_line');
    data.splice(1, 0, profile.ground);
    series.splice(1, 0, {stroke: line, width: 1, fill: style_of('--ground_fill'),
      points: {show: false}});
    if (limits?.ground_clearance_m) {
      data.push(profile.ground.map((height) => height === null ? null :
        height + limits.ground_clearance_m));
      series.push(limit_line());
    }
    for (const key of ['lowest', 'highest']) {
      if (profile[key]?.some((height) => height !== null)) {
        data.push(profile[key]);
        series.push({...limit_line(), spanGaps: false});
      }
    }
  }
  const names = [];
  if (chart.key === 'clearance') {
    // Behind the minimum, which coincides with one of them everywhere.
    for (const {name, color: stroke, values: its, dash} of compared(profile, color)) {
      names.push([name, stroke, its, dash ? 'line attempt' : 'line']);
      data.splice(-1, 0, its);
      series.splice(-1, 0, {stroke, dash, width: 1.5, spanGaps: false, points: {show: false}});
    }
  }
  if (limit !== null) {
    data.push(profile.x.map(() => limit));
    series.push(limit_line());
  }
  return {data, series, names};
}

/** The clearances, whose minimum is the main curve, and the height above the ground. */
function compared(profile, color) {
  const kinds = Object.keys(profile.to ?? {});
  const colors = kind_colors(color);
  const made = kinds.map((name, nth) => ({name, color: colors[nth % colors.length],
    values: profile.to[name]}));
  if (profile.ground.some((height) => height !== null)) {
    made.push({name: 'above ground', color: style_of('--ground_line'), dash: [4, 2],
      values: profile.ground.map((height, index) => height === null ? null :
        profile.altitude[index] - height)});
  }
  return made;
}

/** The heights that obstacles and zones fill below, at and above the route. */
function draw_solids({ctx, bbox, data, valToPos}, profile) {
  const [x] = data;
  const pixel = (nth) => valToPos(x[Math.max(0, Math.min(nth, x.length - 1))], 'x', true);
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  ctx.fillStyle = style_of('--solid_fill');
  for (const spans of Object.values(profile.solid ?? {})) {
    spans.forEach((its, nth) => its.forEach(([low, high]) => {
      const left = (pixel(nth - 1) + pixel(nth)) / 2;
      const right = (pixel(nth) + pixel(nth + 1)) / 2;
      const top = valToPos(high, 'y', true);
      ctx.fillRect(left, top, right - left, valToPos(low, 'y', true) - top);
    }));
  }
  ctx.restore();
}

/** The columns that set the chart's range; clearances from distant kinds may exceed it. */
const seen = (chart, data, limit) => chart.key !== 'clearance' ? data :
  [data[0], data.at(limit === null ? -1 : -2), ...limit === null ? [] : [[limit]]];

const limit_line = () => ({stroke: style_of('--limit'), width: 1.2, dash: [5, 4],
  points: {show: false}});

function follow(plot, profile, store) {
  const index = plot.cursor.idx;
  if (index !== null && index !== undefined && plot.cursor.left >= 0) {
    store.set({cursor: profile_cursor(profile, index)});
  }
}

/** Shows the cursor, or else the flight's time, as a line and a value on a chart. */
function show_cursor({plot, value, chart, link, names}, profile, {cursor, time}) {
  const x = cursor?.x ?? (profile.kind === 'flight' ? time : null);
  put_cursor(plot, link, x);
  const index = x === null ? null : cursor?.index ?? last_before(profile.x, x);
  if (names.length > 0) {
    value.replaceChildren(...names.map(([name, color, values, line]) => element('span', {},
      swatch(color, line), ` ${name}${index === null ? '' : ` ${metres(values[index])}`}`)));
    return;
  }
  if (index === null) {
    value.textContent = '';
    return;
  }
  const reading = number(profile[chart.key][index], chart.unit);
  const ground = chart.key === 'altitude' ? profile.ground[index] : null;
  value.textContent = ground === null || ground === undefined ? reading :
    `${reading}, ${metres(profile.altitude[index] - ground)} over ground`;
}
