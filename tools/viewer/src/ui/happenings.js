// SPDX-License-Identifier: Apache-2.0
/** The handovers, replans and events of a result's flight, each with its time and text, by time. */
export function happenings({results, events}, selected) {
  const flight = results[selected]?.flight;
  if (!flight) return [];
  return [
    ...(flight.handovers ?? []).map(({at_s, to, why}) =>
      ({at_s, kind: 'handover', text: `Handover to ${to}: ${why}`})),
    ...(flight.replans ?? []).map(({at_s, step, status, message}) =>
      ({at_s, kind: 'replan', text: `Replan with ${step}, ${status}: ${message}`})),
    ...(flight.event_times ?? []).map((at_s, event) =>
      ({at_s, kind: 'event', event, text: events[event]?.text ?? ''})),
  ].filter(({at_s}) => at_s !== null).sort((a, b) => a.at_s - b.at_s);
}

// Seconds of watching for which a caption stays.
const kShown = 4;

/** What has just happened at `time` when a second of watching shows `speed` seconds: the last of the
 *  happenings, or how the flight ended. */
export function caption_at(scene, selected, {time, speed}, last) {
  const {flight} = scene.results[selected];
  const all = [...happenings(scene, selected),
    {at_s: last, kind: flight.reached ? 'reached' : 'ended', text: ending(flight)}];
  const now = all.findLast(({at_s}) => at_s <= time);
  return now && time - now.at_s <= kShown * speed ? now : null;
}

const ending = ({reached, status, message}) =>
  (reached ? 'Goal reached' : 'The flight ended') + (status === 'solved' ? '' : `: ${message}`);
