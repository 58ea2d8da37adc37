// SPDX-License-Identifier: Apache-2.0
import uPlot from 'uplot';
import {kind_colors, route_color, style_of} from '../colors.js';
import {element, swatch} from '../dom.js';
import {length_unit, metres, number} from '../units.js';
import {fit, labels_of, new_cell, new_plot, put_cursor, range_of} from './chart.js';
import {profile_cursor, profile_of, vehicle_cursor} from './cursor.js';
import {draw_solids, obstacle_heights_of, solids_legend} from './profile_solids.js';
import {listen_to_zoom, scaled, scrolled} from './zoom.js';

// The shown range is at least `span`, so that a level line looks level.
const kCharts = [
  {key: 'altitude', title: 'Altitude above sea', unit: 'm', span: 5},
  {key: 'clearance', title: 'Clearance', unit: 'm', limit: 'clearance_m', zero: true, span: 1},
  {key: 'speed', title: 'Speed', unit: 'm/s', zero: true, span: 1},
  {key: 'turn', title: 'Turn at waypoints', unit: '°', limit: 'turn_deg', zero: true, span: 10},
];
const kStep = 1.6;  // of the buttons that zoom

/** Charts over the distance of the route or the time of the flight, with one cursor. */
export function build_profiles(world, store) {
  const pane = element('div', {});
  const choice = element('div', {className: 'choice'});
  const charts = element('div', {className: 'charts'});
  pane.append(choice, charts);
  let [drawn, profile, whole] = [[], null, null];

  const rebuild = () => {
    for (const {plot} of drawn) plot.destroy();
    profile = profile_of(world, store.state);
    whole = profile && [profile.x[0], profile.x.at(-1)];
    choice.replaceChildren(...sources(world, store, profile, zoom_by));
    charts.replaceChildren();
    drawn = profile ? kCharts.map((chart) => draw(chart, profile, charts, world, store)) : [];
    // A chart has screen positions only once it has been drawn.
    for (const chart of drawn) chart.redrawn = reflect;
    fit(drawn);
    show_part();
  };
  const reflect = () => {
    const at = profile && (store.state.cursor ?? vehicle_cursor(profile, world, store.state));
    for (const chart of drawn) show_cursor(chart, profile, at ?? {x: null, index: null});
  };
  const zoom_by = (factor) => {
    const middle = (store.state.zoom ?? whole).reduce((a, b) => a + b) / 2;
    const at = store.state.cursor?.x ?? vehicle_cursor(profile, world, store.state)?.x ?? middle;
    store.set({zoom: scaled(store.state.zoom, whole, at, factor)});
  };
  const show_part = () => {
    const [min, max] = store.state.zoom ?? whole ?? [];
    for (const {plot} of drawn) plot.setScale('x', {min, max});
  };
  const scroll = ({zoom, playing}) => {
    if (!profile || !zoom) return;
    const at = vehicle_cursor(profile, world, store.state);
    if (at) store.set({zoom: scrolled(zoom, whole, at.x, playing)});
  };
  new ResizeObserver(() => fit(drawn)).observe(charts);
  store.on(['selected', 'source'], () => store.set({zoom: null}));
  store.on(['selected', 'source', 'theme', 'version'], rebuild);
  store.on(['cursor', 'time'], reflect);
  store.on(['time'], scroll);
  store.on(['zoom'], show_part);
  rebuild();
  return {pane, labels: () => drawn.flatMap(({plot}) => labels_of(plot))};
}

function sources(world, store, profile, zoom_by) {
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
  const zoom = (text, title, factor) => element('button', {textContent: text, title,
    ariaLabel: title, onclick: () => zoom_by(factor)});
  return [element('b', {}, result.name), ...(both ? [button('route', 'Route'),
    button('flight', 'Flight')] : []), element('span', {className: 'note'},
    profile.kind === 'route' ? `over distance, ${unit_along(profile).name}` : 'over time, s'),
  element('span', {className: 'zoom'}, zoom('−', 'Show more of the profiles', kStep),
    zoom('+', 'Show a part of the profiles', 1 / kStep))];
}

const unit_along = ({kind, x}) => length_unit(kind === 'route' ? x.at(-1) : 0);

function draw(chart, profile, charts, world, store) {
  const value = element('span', {});
  const {scene, frame} = world;
  const result = scene.results[store.state.selected];
  const limit = chart.limit ? result.limits?.[chart.limit] ?? null : null;
  const color = route_color(store.state.selected, store.state.theme);
  const {data, series, names} = curves(chart, profile, limit, color, result.limits);
  const is_height = chart.key === 'altitude';
  const obstacles = is_height ? obstacle_heights_of(profile, scene) : [];
  // Buildings stand on the floor where there is no ground.
  const floor = obstacles.length > 0 && !scene.ground ? frame.box[0][2] : undefined;
  const range = range_of({...chart, floor}, [...seen(chart, data, limit), obstacles]);
  const up = length_unit(chart.unit === 'm' ? Math.max(...range.map(Math.abs)) : 0);
  const cell = new_cell({...chart, unit: chart.unit === 'm' ? up.name : chart.unit}, value,
    is_height ? [...solids_legend(profile, scene), ...limits_legend(series)] : names.map(entry));
  charts.append(cell);
  const link = {silent: false};
  const made = {};
  // The cursor's dot is on the curve itself, not on ground and limits beside it.
  const plot = new_plot(cell, data, series, {dots: [color], scales: {y: {range}},
    metres: [unit_along(profile).metres, up.metres], hooks: {drawClear: [(self) => {
      if (is_height) draw_solids(self, profile, scene);
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
  listen_to_zoom(plot, [profile.x[0], profile.x.at(-1)], store);
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
      series.push({...limit_line(), limits: true});
    }
    for (const key of ['lowest', 'highest']) {
      if (profile[key]?.some((height) => height !== null)) {
        data.push(profile[key]);
        series.push({...limit_line(), spanGaps: false, limits: true});
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

const entry = ([text, color, , line]) =>
  element('span', {className: 'reading'}, swatch(color, line), ` ${text}`);

/** Names the limits of heights where there are any. */
const limits_legend = (series) => series.some(({limits}) => limits) ?
  [entry(['allowed', style_of('--limit'), null, 'line attempt'])] : [];

/** Shows a sample as a line and as values on a chart. */
function show_cursor({plot, value, chart, link, names}, profile, {x, index}) {
  put_cursor(plot, link, x);
  if (names.length > 0) {
    value.replaceChildren(...index === null ? [] : names.map(([, color, values, line]) =>
      entry([metres(values[index]), color, values, line])));
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
