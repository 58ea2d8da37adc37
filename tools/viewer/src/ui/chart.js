// SPDX-License-Identifier: Apache-2.0
import uPlot from 'uplot';
import {style_of} from '../colors.js';
import {element} from '../dom.js';
import {mark_text} from '../units.js';

const kFont = '11px system-ui, sans-serif';
const kFontPixels = 11;
// Pixels between the plot and the numbers of x and of y.
const kGap = [6, 5];

const ruler = document.createElement('canvas').getContext('2d');
const widest = (texts) => {
  ruler.font = kFont;
  return Math.ceil(Math.max(0, ...texts.map((text) => ruler.measureText(text).width)));
};

/** The cell of a chart: a title with a legend beside it, and the values at the cursor below. */
export const new_cell = ({key, title, unit}, value, legend = []) => element('div',
  {className: `chart ${key}`}, element('div', {className: 'caption'},
    element('b', {}, unit ? `${title}, ${unit}` : title), element('span', {className: 'legend'}, legend),
    Object.assign(value, {className: 'values'})));

/** A plot in its cell; series whose colours are among `dots` have a dot at the cursor. `metres`: of
 *  how many the numbers of x and of y are, 1 for other quantities; `incrs`: the allowed spacings of
 *  marks along x. */
export function new_plot(cell, data, series, {dots, scales, hooks, incrs, metres = [1, 1]}) {
  return new uPlot({width: 200, height: 100, padding: [8, room_at_right, 0, 0],
    legend: {show: false},
    cursor: {y: false, drag: {setScale: false, x: false}, points: {show: dot_on(dots)}},
    scales: {...scales, x: {time: false, ...scales.x}}, axes: axes(incrs, metres), series, hooks}, data,
  cell);
}

/** The last number along x may stand at the end of the plot. */
const room_at_right = (plot) => Math.ceil(widest(plot.axes[0]._values ?? []) / 2) + 3;

function dot_on(colors) {
  return (plot, index) => {
    const color = plot.series[index].stroke?.();
    if (!colors.includes(color)) return undefined;
    const dot = element('div', {className: 'u-cursor-pt dot'});
    dot.style.background = color;
    return dot;
  };
}

/** The range of the plotted values with a margin, from 0 for quantities with a meaningful 0, and
 *  from `floor` where there is one below. */
export function range_of(chart, [, ...columns]) {
  const values = columns.flat().filter((value) => value !== null && Number.isFinite(value));
  let [low, high] = [Infinity, -Infinity];
  for (const value of values) {
    low = Math.min(low, value);
    high = Math.max(high, value);
  }
  if (low > high) return [0, 1];
  const bottom = chart.zero ? 0 : chart.floor ?? Infinity;
  low = Math.min(bottom, low);
  const missing = Math.max(0, chart.span - (high - low));
  // On both sides of the curve; from the bottom only upwards.
  const [under, over] = low === bottom ? [0, missing] : [missing / 2, missing / 2];
  [low, high] = [low - under, high + over];
  const room = (high - low) * 0.08;
  return [low === bottom ? low : low - room, high + room];
}

function axes(incrs, metres) {
  const look = {stroke: style_of('--quiet'), font: kFont,
    grid: {stroke: style_of('--hair'), width: 1}, ticks: {show: false}};
  const values = (of) => (plot, marks, axis, space, step) =>
    marks.map((value) => value === null ? '' : mark_text(value, step, of));
  return [{...look, size: kGap[0] + kFontPixels + 6, gap: kGap[0], space: 60, values: values(metres[0]),
    ...incrs && {incrs}},
  {...look, size: (plot, texts) => widest(texts ?? []) + kGap[1] + 4, gap: kGap[1], space: 26,
    values: values(metres[1])}];
}

/** Resizes charts to what their captions leave of their cells. */
export function fit(drawn) {
  const sizes = drawn.map(({cell}) => ({width: cell.clientWidth,
    height: Math.max(60, cell.clientHeight - cell.firstChild.offsetHeight)}));
  drawn.forEach(({plot}, nth) => {
    if (sizes[nth].width > 0) plot.setSize(sizes[nth]);
  });
}

/** Puts the cursor at x, or removes it. `link` is silent meanwhile, so that a cursor set from
 *  elsewhere is not sent back there as a new one. */
export function put_cursor(plot, link, x) {
  link.silent = true;
  plot.setCursor(x === null ? {left: -10, top: -10} : {left: plot.valToPos(x, 'x'), top: 4}, false);
  link.silent = false;
}

/** The numbers that a plot has drawn on its canvas, with their rectangles and that of the canvas:
 *  left, top, right, bottom on the page. For tests, which cannot find them there. */
export function labels_of(plot) {
  const canvas = plot.ctx.canvas.getBoundingClientRect();
  const over = plot.over.getBoundingClientRect();
  const within = [canvas.left, canvas.top, canvas.right, canvas.bottom];
  if (canvas.width === 0) return [];
  return plot.axes.flatMap((axis, nth) => (axis._values ?? []).map((text, mark) => {
    const at = plot.valToPos(axis._splits[mark], axis.scale);
    const wide = widest([text]);
    const [left, top] = nth === 0 ?
      [over.left + at - wide / 2, canvas.top + axis._pos + kGap[0]] :
      [canvas.left + axis._pos - kGap[1] - wide, over.top + at - kFontPixels / 2];
    return {text, box: [left, top, left + wide, top + kFontPixels], within};
  }).filter(({text}) => text !== ''));
}
