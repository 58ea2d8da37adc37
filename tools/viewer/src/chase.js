// SPDX-License-Identifier: Apache-2.0
import {place_at} from './world.js';

// Seconds of flight between the eye and the vehicle, and how much of this way the vehicle may fly in
// a second of watching.
const kBehindSeconds = 12;
const kWaysPerSecond = 1.2;
// Of the box's diagonal.
const kFarthest = 0.25;
// Seconds to each side, of flight and of watching, over which the course is smoothed.
const kSmoothFlown = 4;
const kSmoothWatched = 1.2;
const kSamples = 6;

const duration = ({times}) => Math.max(times.at(-1) - times[0], 1e-6);

function mean_speed(line) {
  line.mean_speed ??= line.points.reduce((flown, [x, y, z], at, all) => {
    const [x0, y0, z0] = all[Math.max(0, at - 1)];
    return flown + Math.hypot(x - x0, y - y0, z - z0);
  }, 0) / duration(line);
  return line.mean_speed;
}

/** How far behind the vehicle the eye is, when a second of watching shows `rate` seconds. */
export function chase_metres(line, rate, {diagonal}) {
  const speed = mean_speed(line);
  const behind = speed * Math.max(kBehindSeconds, rate / kWaysPerSecond);
  return Math.min(Math.max(behind, diagonal / 500), diagonal * kFarthest);
}

/** The course around `time`, [x, y] of length 1: from the mean of the places before to that of the
 *  places after, so that it turns smoothly and depends on nothing but the time. */
export function course_at(line, time, rate) {
  const speed = mean_speed(line);
  let window = Math.max(kSmoothFlown, kSmoothWatched * rate);
  for (; window < 9 * duration(line); window *= 3) {
    const [before, after] = [-1, 1].map((way) => mean_place(line, time, way * window));
    const [x, y] = [after[0] - before[0], after[1] - before[1]];
    const length = Math.hypot(x, y);
    // Less is hovering: look farther.
    if (length > 0.02 * speed * window) return [x / length, y / length];
  }
  return [0, 1];
}

function mean_place(line, time, window) {
  const sum = [0, 0];
  for (let sample = 0; sample <= kSamples; sample++) {
    const {at} = place_at(line, time + window * sample / kSamples);
    for (const axis of [0, 1]) sum[axis] += at[axis] / (kSamples + 1);
  }
  return sum;
}
