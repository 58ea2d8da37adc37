// SPDX-License-Identifier: Apache-2.0
import {last_before, place_at} from '../world.js';

const track_of = ({lines}, selected) =>
  lines.find(({kind, result}) => kind === 'track' && result === selected);

/** The profile shown: that of the route over distance, or of the flight over time. */
export function profile_of(world, {selected, source}) {
  const result = world.scene.results[selected];
  const flight = result?.flight?.profile;
  const route = result?.profile;
  if (flight && (source === 'flight' || !route)) {
    return {...flight, kind: 'flight', x: flight.t, line: track_of(world, selected)};
  }
  return route ? {...route, kind: 'route', x: route.s} : null;
}

/** A cursor at sample `index` of a profile, with its position in the world. */
export function profile_cursor(profile, index) {
  const x = profile.x[index];
  return {x, index,
    at: profile.kind === 'route' ? profile.at[index] : place_at(profile.line, x).at};
}

/** Where the vehicle is in a profile: of a route at the sample nearest to it, once it flies; null
 *  without a flight. */
export function vehicle_cursor(profile, world, {selected, time}) {
  if (profile.kind === 'flight') return {x: time, index: last_before(profile.x, time)};
  const line = track_of(world, selected);
  if (!line || time === 0) return null;
  const index = nearest_sample(profile.at, place_at(line, time).at);
  return {x: profile.x[index], index};
}

/** A cursor at a point of a line, with the sample of the profile if that is of the same line. */
export function route_cursor({line, at, time}, world, state) {
  const profile = profile_of(world, state);
  if (!profile || profile.line === undefined && line.kind === 'track' ||
    profile.kind === 'flight' && line.kind !== 'track') return {at, x: null, index: null};
  const index = profile.kind === 'flight' ? last_before(profile.x, time) :
    nearest_sample(profile.at, at);
  return {at, x: profile.kind === 'flight' ? time : profile.x[index], index};
}

function nearest_sample(samples, at) {
  let [best, least] = [0, Infinity];
  samples.forEach((sample, index) => {
    const away = Math.hypot(sample[0] - at[0], sample[1] - at[1], sample[2] - at[2]);
    if (away < least) [best, least] = [index, away];
  });
  return best;
}
