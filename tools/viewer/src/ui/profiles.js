// SPDX-License-Identifier: Apache-2.0
import uPlot from 'uplot';
import {route_color, style_of} from '../colors.js';
import {element} from '../dom.js';
import {metres, number} from '../units.js';
import {last_before} from '../world.js';
import {profile_cursor, profile_of} from './cursor.js';

// Where values differ by less than `span`, that much is shown: a level line should look level.
const kCharts = [
  {key: 'altitude', title: 'Altitude above sea', unit: 'm', span: 5},
  {key: 'clearance', title: 'Clearance', unit: 'm', limit: 'clearance_m', zero: true, span: 1},
  {key: 'speed', title: 'Speed', unit: 'm/s', zero: true, span: 1},
  {key: 'turn', title: 'Turn at waypoints', unit: '°', limit: 'turn_deg', zero: true, span: 10},
];

/** Charts over the distance of the route or the time of the flight; one cursor for all. */
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
    fit();
  };
  const fit = () => {
    for (const {plot, cell} of drawn) {
      const {clientWidth: width, clientHeight: height} = cell;
      if (width > 0) plot.setSize({width, height: Math.max(70, height - 18)});
    }
  };
  const reflect = () => {
    const profile = profile_of(world, store.state);
    for (const chart of drawn) show_cursor(chart, profile, store.state);
  };
  // A chart knows where a value is on the screen once it has been drawn.
  const reflect_when_drawn = () => {
    for (const chart of drawn) chart.redrawn = reflect;
  };
  new ResizeObserver(fit).observe(charts);
  store.on(['selected', 'source', 'theme'], rebuild);
  store.on(['cursor', 'time'], reflect);
  rebuild();
  return pane;
}

function sources(world, store, profile) {
  const result = world.scene.results[store.state.selected];
  if (!profile) {
    const fate = result?.status === 'solved' ? 'is not drawn' : 'has no route';
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
  const cell = element('div', {className: `chart ${chart.key}`},
    element('div', {className: 'caption'},
      element('b', {}, `${chart.title}, ${chart.unit}`), value));
  charts.append(cell);
  const result = world.scene.results[store.state.selected];
  const limit = chart.limit ? result.limits?.[chart.limit] ?? null : null;
  const color = route_color(store.state.selected, store.state.theme);
  const {data, series} = curves(chart, profile, limit, color, result.limits);
  // Set while the cursor comes from elsewhere: it must not go back there as if it were new.
  const link = {silent: false};
  const made = {};
  const plot = new uPlot({width: 200, height: 100, padding: [6, 10, 0, 0], legend: {show: false},
    cursor: {y: false, drag: {setScale: false, x: false}, points: {show: dot_on(color)}},
    scales: {x: {time: false}, y: {range: range_of(chart, data)}},
    axes: axes(), series,
    hooks: {draw: [() => made.redrawn?.()], setCursor: [(self) => {
      if (!link.silent && self.cursor.event) follow(self, profile, store);
    }]}}, data, cell);
  plot.over.addEventListener('click', () => {
    const index = plot.cursor.idx;
    if (profile.kind === 'flight' && index !== null && index !== undefined) {
      store.set({time: profile.x[index], playing: false});
    }
  });
  plot.over.addEventListener('pointerleave', () => store.set({cursor: null}));
  Object.assign(made, {plot, cell, value, chart, link});
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
  }
  if (limit !== null) {
    data.push(profile.x.map(() => limit));
    series.push(limit_line());
  }
  return {data, series};
}

const limit_line = () => ({stroke: style_of('--limit'), width: 1.2, dash: [5, 4],
  points: {show: false}});

/** From the least to the greatest of what is drawn, with room; from 0 where 0 means something. */
function range_of(chart, [, ...columns]) {
  const values = columns.flat().filter((value) => value !== null && Number.isFinite(value));
  let [low, high] = [Infinity, -Infinity];
  for (const value of values) {
    low = Math.min(low, value);
    high = Math.max(high, value);
  }
  if (low > high) return [0, 1];
  if (chart.zero) low = Math.min(0, low);
  const missing = Math.max(0, chart.span - (high - low));
  // Around the curve; from 0 only upwards.
  const [under, over] = chart.zero && low === 0 ? [0, missing] : [missing / 2, missing / 2];
  [low, high] = [low - under, high + over];
  const room = (high - low) * 0.08;
  return [chart.zero && low === 0 ? 0 : low - room, high + room];
}

/** The cursor's dot is for the curve itself, not for ground and limits beside it. */
function dot_on(color) {
  return (plot, index) => {
    if (plot.series[index].stroke?.() !== color) return undefined;
    const dot = element('div', {className: 'u-cursor-pt dot'});
    dot.style.background = color;
    return dot;
  };
}

function axes() {
  const look = {stroke: style_of('--quiet'), font: '11px system-ui, sans-serif',
    grid: {stroke: style_of('--hair'), width: 1}, ticks: {show: false}};
  return [{...look, size: 22, gap: 3, space: 60}, {...look, size: 46, gap: 4, space: 26}];
}

function follow(plot, profile, store) {
  const index = plot.cursor.idx;
  if (index !== null && index !== undefined && plot.cursor.left >= 0) {
    store.set({cursor: profile_cursor(profile, index)});
  }
}

/** The cursor, or else the flight's time, as a line and a number on every chart. */
function show_cursor({plot, value, chart, link}, profile, {cursor, time}) {
  const x = cursor?.x ?? (profile.kind === 'flight' ? time : null);
  link.silent = true;
  plot.setCursor(x === null ? {left: -10, top: -10} : {left: plot.valToPos(x, 'x'), top: 4}, false);
  link.silent = false;
  if (x === null) {
    value.textContent = '';
    return;
  }
  const index = cursor?.index ?? last_before(profile.x, x);
  const reading = number(profile[chart.key][index], chart.unit);
  const ground = chart.key === 'altitude' ? profile.ground[index] : null;
  value.textContent = ground === null || ground === undefined ? reading :
    `${reading}, ${metres(profile.altitude[index] - ground)} over ground`;
}
