// SPDX-License-Identifier: Apache-2.0
import uPlot from 'uplot';
import {style_of} from '../colors.js';
import {element, swatch} from '../dom.js';
import {is_population, iteration_at, iterations_around} from '../playback.js';
import {length_unit, metres, number} from '../units.js';
import {fit, labels_of, new_cell, new_plot, put_cursor, range_of} from './chart.js';

// Up to this many iterations, each is also drawn as a point.
const kFew = 40;
// Spacings of marks along x: whole numbers of iterations.
const kApart = [1, 10, 100, 1e3, 1e4, 1e5, 1e6, 1e7].flatMap((power) => [1, 2, 5].map((factor) =>
  factor * power));
const kLength = {key: 'length', title: 'Length by iteration', unit: 'm', span: 1, curves: [
  {key: 'best', title: 'best', color: '--accent', mark: 'line', read: metres},
  {key: 'mean', title: 'mean', color: '--good', mark: 'line attempt', dash: [5, 4], read: metres}]};
const kBest = {...kLength, title: 'Best length by iteration', curves: kLength.curves.slice(0, 1)};
const kAlive = {key: 'alive', title: 'Alive', zero: true, span: 1, curves: [
  {key: 'alive', title: '', color: '--quiet', read: number}]};

/** Charts of the best length over the iterations and, for a population, its mean length and the
 *  number of members that found a route. A click on an iteration calls `go_to` with it. */
export function build_convergence(store, go_to) {
  const charts = element('div', {className: 'charts convergence', hidden: true});
  const made = {pane: charts, show, labels: () => drawn.flatMap(({plot}) => labels_of(plot))};
  let [playback, shown, looked, drawn, hovered] = [null, null, null, [], null];

  /** Shows the search in progress of a playback. */
  function show(next) {
    playback = next;
    rebuild();
  }
  function rebuild() {
    for (const {plot} of drawn) plot.destroy();
    [drawn, hovered] = [[], null];
    charts.replaceChildren();
    shown = playback?.iterations.length ? iterations_around(playback, seen()) : [];
    looked = shown[0]?.search;
    charts.hidden = shown.length === 0;
    if (charts.hidden) return;
    const population = is_population(shown[0]);
    drawn = (population ? [kLength, kAlive] : [kBest]).map(draw);
    charts.classList.toggle('one', !population);
    fit(drawn);
  }
  const seen = () => store.state.search === playback ? store.state.searched : playback.count;
  function draw(chart) {
    const value = element('span', {});
    const link = {silent: false};
    const data = [shown.map((iteration) => iteration.number), ...chart.curves.map(({key}) =>
      shown.map((iteration) => Number.isFinite(iteration[key]) ? iteration[key] : null))];
    const colors = chart.curves.map(({color}) => style_of(color));
    const series = [{}, ...chart.curves.map(({dash}, nth) => curve(colors[nth], dash))];
    const range = range_of(chart, data);
    const up = length_unit(chart.unit === 'm' ? Math.max(...range) : 0);
    const cell = new_cell({...chart, unit: chart.unit && up.name}, value);
    charts.append(cell);
    const plot = new_plot(cell, data, series, {dots: colors, incrs: kApart, metres: [1, up.metres],
      scales: {x: {range: (_, low, high) => low === high ? [low - 1, high + 1] : [low, high]},
        y: {range}},
      hooks: {draw: [reflect], setCursor: [(self) => {
        if (!link.silent && self.cursor.event) hover(shown[self.cursor.idx] ?? null);
      }]}});
    plot.over.addEventListener('click', () => {
      if (shown[plot.cursor.idx]) go_to(shown[plot.cursor.idx]);
    });
    plot.over.addEventListener('pointerleave', () => hover(null));
    return {chart, cell, value, plot, link};
  }
  /** Stepped for a best length: it lasts until a better one is found. */
  function curve(stroke, dash) {
    const stepped = is_population(shown[0]) ? {} : {paths: uPlot.paths.stepped({align: 1})};
    return {stroke, dash, width: 2, spanGaps: false, ...stepped,
      points: {show: shown.length < kFew, size: 5, fill: stroke}};
  }
  function hover(iteration) {
    if (hovered === iteration) return;
    hovered = iteration;
    reflect();
  }
  function reflect() {
    const iteration = hovered ?? iteration_at(playback, seen());
    for (const {chart, value, plot, link} of drawn) {
      put_cursor(plot, link, iteration?.number ?? null);
      value.replaceChildren(...chart.curves.flatMap((curve) => reading(curve, iteration)));
    }
  }
  const reading = ({key, title, color, mark, read}, iteration) => element('span',
    {className: 'reading'}, mark ? swatch(style_of(color), mark) : null, ` ${title} `,
    element('output', {}, iteration ? read(iteration[key]) : ''));

  new ResizeObserver(() => fit(drawn)).observe(charts);
  store.on(['theme'], rebuild);
  store.on(['search', 'searched'], () => {
    if (!playback) return;
    const now = iteration_at(playback, seen()) ?? playback.iterations[0];
    if (now?.search !== looked) rebuild();
    else reflect();
  });
  return made;
}
