// SPDX-License-Identifier: Apache-2.0
import {Vector3} from 'three';
import {chase_metres, course_at} from '../chase.js';
import {place_at} from '../world.js';
import {Skyline} from './skyline.js';

const kPitch = 15 * Math.PI / 180;
const kSteepest = 75 * Math.PI / 180;
// Of the distance: how far ahead of and above the vehicle the middle of the picture is, and how far
// the eye and its line of sight stay from what is below them.
const kAhead = 0.18;
const kAbove = 0.08;
const kEyeRoom = 0.1;
const kSightRoom = 0.015;
const kSightSamples = 16;
// Milliseconds of watching in which the eye rises over an obstacle, and in which it comes.
const kRiseMs = 500;
const kComeMs = 900;

/** The eye behind a vehicle: its offset from the course, which the user changes by orbiting. */
export class Chase {
  constructor(world) {
    this.world = world;
    this.offset = null;
    this.come_ms = kComeMs;
  }

  /** Begins to follow from where the eye is; at once if nothing shall move. */
  begin({eye, controls}, now, at_once) {
    this.from = at_once ? null : {since: now, position: eye.position.clone(),
      target: controls.target.clone()};
    this.offset = null;
    this.before = null;
  }

  /** The user has turned or moved the eye. */
  read(back) {
    if (!this.offset) return;
    this.offset.away = back.length();
    this.offset.pitch = Math.asin(back.z / back.length());
    this.offset.turn = Math.atan2(back.y, back.x) - this.course;
    this.rise = 0;
  }

  /** Where the eye is at `now`, and whether it would move on at the same time of flight. */
  pose(line, {time, speed, playing, filmed, exaggeration}, now) {
    const {frame} = this.world;
    this.offset ??= {away: chase_metres(line, speed, frame), pitch: kPitch, turn: Math.PI};
    const {away, turn} = this.offset;
    const [east, north] = course_at(line, time, speed);
    this.course = Math.atan2(north, east);
    const vehicle = place_at(line, time).at;
    const local = frame.local(vehicle);
    const target = new Vector3(local[0] + kAhead * away * east, local[1] + kAhead * away * north,
      local[2] * exaggeration + kAbove * away);
    const back = (pitch) => new Vector3(Math.cos(this.course + turn) * Math.cos(pitch),
      Math.sin(this.course + turn) * Math.cos(pitch), Math.sin(pitch)).multiplyScalar(away);
    const needed = this.#clear_pitch(vehicle, target, back, exaggeration) - this.offset.pitch;
    this.#rise_to(needed, now, playing || filmed);
    const position = target.clone().add(back(this.offset.pitch + this.rise));
    return this.#coming({position, target, moving: false}, now);
  }

  /** The least pitch from the offset's on at which nothing is in the way. */
  #clear_pitch(vehicle, target, back, exaggeration) {
    const {frame, scene} = this.world;
    this.skyline ??= new Skyline(scene, frame);
    const high = (x, y, all) => {
      const [wx, wy] = [x + frame.centre[0], y + frame.centre[1]];
      return (this.skyline.height(wx, wy, all) - frame.centre[2]) * exaggeration;
    };
    // Below a roof the obstacles are seen through.
    const all = vehicle[2] >= this.skyline.height(vehicle[0], vehicle[1], true);
    const is_clear = (pitch) => {
      const offset = back(pitch);
      for (let sample = 1; sample <= kSightSamples; sample++) {
        const share = sample / kSightSamples;
        const z = target.z + offset.z * share;
        const room = this.offset.away * (sample === kSightSamples ? kEyeRoom : kSightRoom);
        if (z < high(target.x + offset.x * share, target.y + offset.y * share, all) + room) return false;
      }
      return true;
    };
    const steps = 24;
    for (let step = 0; step < steps; step++) {
      const pitch = this.offset.pitch + (kSteepest - this.offset.pitch) * step / steps;
      if (pitch >= kSteepest || is_clear(pitch)) return pitch;
    }
    return Math.max(kSteepest, this.offset.pitch);
  }

  /** Eases towards the rise wanted while the flight is played, else is there at once. */
  #rise_to(wanted, now, playing) {
    const passed = this.before === null || !playing ? Infinity : Math.max(0, now - this.before);
    this.before = now;
    this.rise = this.rise === undefined || passed === Infinity ? wanted :
      this.rise + (wanted - this.rise) * (1 - Math.exp(-passed / kRiseMs));
  }

  /** On the way from where the eye was when it began. */
  #coming(pose, now) {
    if (!this.from) return pose;
    const share = Math.min(1, (now - this.from.since) / this.come_ms);
    if (share >= 1) {
      this.from = null;
      return pose;
    }
    const eased = share * share * (3 - 2 * share);
    return {position: this.from.position.clone().lerp(pose.position, eased),
      target: this.from.target.clone().lerp(pose.target, eased), moving: true};
  }
}
