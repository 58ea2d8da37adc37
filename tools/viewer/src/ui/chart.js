// SPDX-License-Identifier: Apache-2.0
import uPlot from 'uplot';
import {style_of} from '../colors.js';
import {element} from '../dom.js';

/** The cell of a chart, with `value` beside its title. */
export const new_cell = ({key, title, unit}, value) => element('div', {className: `chart ${key}`},
  element('div', {className: 'caption'}, element('b', {}, unit ? `${title}, ${unit}` : title),
    value));

/** A plot in its cell; series whose colours are among `dots` have a dot at the cursor. `incrs`: the
 *  allowed spacings of marks along x. */
export function new_plot(cell, data, series, {dots, scales, hooks, incrs}) {
  return new uPlot({width: 200, height: 100, padding: [6, 10, 0, 0], legend: {show: false},
    cursor: {y: false, drag: {setScale: false, x: false}, points: {show: dot_on(dots)}},
    scales: {...scales, x: {time: false, ...scales.x}}, axes: axes(incrs), series, hooks}, data, cell);
}

function dot_on(colors) {
  return (plot, index) => {
    const color = plot.series[index].stroke?.();
    if (!colors.includes(color)) return undefined;
    const dot = element('div', {className: 'u-cursor-pt dot'});
    dot.style.background = color;
    return dot;
  };
}

/** The range of the plotted values with a margin, from 0 for quantities with a meaningful 0. */
export function range_of(chart, [, ...columns]) {
  const values = columns.flat().filter((value) => value !== null && Number.isFinite(value));
  let [low, high] = [Infinity, -Infinity];
  for (const value of values) {
    low = Math.min(low, value);
    high = Math.max(high, value);
  }
  if (low > high) return [0, 1];
  if (chart.zero) low = Math.min(0, low);
  const missing = Math.max(0, chart.span - (high - low));
  // On both sides of the curve; from 0 only upwards.
  const [under, over] = chart.zero && low === 0 ? [0, missing] : [missing / 2, missing / 2];
  [low, high] = [low - under, high + over];
  const room = (high - low) * 0.08;
  return [chart.zero && low === 0 ? 0 : low - room, high + room];
}

function axes(incrs) {
  const look = {stroke: style_of('--quiet'), font: '11px system-ui, sans-serif',
    grid: {stroke: style_of('--hair'), width: 1}, ticks: {show: false}};
  return [{...look, size: 22, gap: 3, space: 60, ...incrs && {incrs}}, {...look, size: 46, gap: 4, space: 26}];
}

/** Resizes charts to their cells. */
export function fit(drawn) {
  for (const {plot, cell} of drawn) {
    const {clientWidth: width, clientHeight: height} = cell;
    if (width > 0) plot.setSize({width, height: Math.max(70, height - 18)});
  }
}

/** Puts the cursor at x, or removes it. `link` is silent meanwhile, so that a cursor set from
 *  elsewhere is not sent back there as a new one. */
export function put_cursor(plot, link, x) {
  link.silent = true;
  plot.setCursor(x === null ? {left: -10, top: -10} : {left: plot.valToPos(x, 'x'), top: 4}, false);
  link.silent = false;
}
