// SPDX-License-Identifier: Apache-2.0
import {read_iterations, read_trace} from './scene.js';
import {metres, number} from './units.js';

const kRemoved = 2;
const kRewired = 3;
const kIteration = 4;

/** The kept events of a trace and their lifetimes: event e is drawn while the number of events
 *  shown is above e and at most until[e]. A removal ends the event at its position, a rewiring
 *  replaces it; removals and iterations, which have no position, are never drawn. Routes drawn in
 *  an iteration of a population end with it. Playback steps through `stops`, numbers of events
 *  shown: whole iterations of a population, otherwise each event. */
export function playback_of(trace) {
  trace.playback ??= new_playback(trace);
  return trace.playback;
}

function new_playback(trace) {
  const {at, parent, kind, step, value} = read_trace(trace);
  const count = kind.length;
  const until = new Float32Array(count).fill(count);
  const iterations = iterations_of(trace, kind, step, value);
  const stops = [];
  const newest = new Map();
  let [begun, now] = [0, null];
  for (let event = 0; event < count; event++) {
    if (kind[event] === kIteration) now = iterations[begun++];
    const drawn_by = is_population(now) && event < now.end ? now : null;
    if (!drawn_by || event + 1 === drawn_by.end) stops.push(event + 1);
    if (kind[event] === kIteration || drawn_by) {
      until[event] = kind[event] === kIteration ? 0 : drawn_by.end;
      continue;
    }
    const place = `${step[event]} ${at[3 * event]} ${at[3 * event + 1]} ${at[3 * event + 2]}`;
    if (kind[event] === kRemoved || kind[event] === kRewired) {
      for (const earlier of newest.get(place) ?? []) until[earlier] = event;
      newest.delete(place);
    }
    if (kind[event] === kRemoved) until[event] = 0;
    else if (newest.has(place)) newest.get(place).push(event);
    else newest.set(place, [event]);
  }
  return {trace, count, at, parent, kind, step, until, iterations, stops};
}

/** True for an iteration of a population, which counts the members that found a route. */
export const is_population = (iteration) => iteration?.alive >= 0;

/** The kept iterations; each is over after `end` events. Every search numbers its iterations from
 *  the first: where the numbers do not increase, the next search begins. */
function iterations_of(trace, kind, step, value) {
  const {number: numbers, mean, alive} = read_iterations(trace);
  const found = [];
  let search = 0;
  for (let event = 0; event < kind.length; event++) {
    const before = found.at(-1);
    const is_next = kind[event] === kIteration;
    if (is_population(before) && before.end === Infinity &&
      (is_next || step[event] !== before.step)) before.end = event;
    if (!is_next) continue;
    const nth = found.length;
    if (before && (step[event] !== before.step || numbers[nth] <= before.number)) search++;
    found.push({event, end: alive[nth] >= 0 ? Infinity : event + 1, search, step: step[event],
      number: numbers[nth], best: value[event], mean: mean[nth], alive: alive[nth]});
  }
  if (found.at(-1)?.end === Infinity) found.at(-1).end = kind.length;
  return found;
}

/** The iteration in progress when that many events are shown. */
export const iteration_at = ({iterations}, shown) =>
  iterations.findLast(({event}) => event < shown);

/** All iterations of the search in progress; before the first one, of the first search. */
export function iterations_around(playback, shown) {
  const {search} = iteration_at(playback, shown) ?? {search: 0};
  return playback.iterations.filter((iteration) => iteration.search === search);
}

/** "Iteration 12 of 100: best 1,234 m, mean 1,300 m, 97 alive." */
export function told_of(iteration, last) {
  const population = is_population(iteration) ?
    `, mean ${metres(iteration.mean)}, ${number(iteration.alive)} alive` : '';
  const of_all = population && ` of ${number(last.number)}`;
  return `Iteration ${number(iteration.number)}${of_all}: best ${metres(iteration.best)}` +
    `${population}.`;
}

/** The note on the events left out of the trace. */
export function thinning(trace) {
  const [events, kept] = [trace.events, trace.kept].map((count) => number(count));
  if (trace.kept >= trace.events) return `All ${events} events shown.`;
  const every = Math.round(trace.events / Math.max(1, trace.kept));
  const nth = `${every}${ordinal(every)}`;
  return read_iterations(trace).alive.some((alive) => alive >= 0) ?
    `Thinned: every ${nth} route shown (${kept} of ${events} events kept).` :
    `Thinned: every ${nth} of ${events} events shown (${kept} kept).`;
}

function ordinal(count) {
  if (count % 100 >= 11 && count % 100 <= 13) return 'th';
  return ['th', 'st', 'nd', 'rd'][count % 10] ?? 'th';
}
