// SPDX-License-Identifier: Apache-2.0
import {read_trace} from './scene.js';
import {number} from './units.js';

const kRemoved = 2;
const kRewired = 3;
const kIteration = 4;

/** The kept events of a trace and when each stops to hold: event e is drawn while the number of
 *  events shown is above e and at most until[e]. A removal ends what was at its place, a rewiring
 *  replaces it; a removal itself and an iteration, which has no place, are never drawn. */
export function playback_of(trace) {
  const {at, parent, kind, step} = read_trace(trace);
  const count = kind.length;
  const until = new Float32Array(count).fill(count);
  const newest = new Map();
  for (let event = 0; event < count; event++) {
    if (kind[event] === kIteration) {
      until[event] = 0;
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
  return {trace, count, at, parent, kind, step, until};
}

/** What the screen says of the events that are not there. */
export function thinning(trace) {
  const [events, kept] = [trace.events, trace.kept].map((count) => number(count));
  if (trace.kept >= trace.events) return `All ${events} events shown.`;
  const every = Math.round(trace.events / Math.max(1, trace.kept));
  return `Thinned: every ${every}${ordinal(every)} of ${events} events shown (${kept} kept).`;
}

function ordinal(count) {
  if (count % 100 >= 11 && count % 100 <= 13) return 'th';
  return ['th', 'st', 'nd', 'rd'][count % 10] ?? 'th';
}
