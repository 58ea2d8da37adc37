// SPDX-License-Identifier: Apache-2.0
import {PerspectiveCamera, Vector3} from 'three';
import {OrbitControls} from 'three/addons/controls/OrbitControls.js';

const kFieldDeg = 40;
const kFlightMs = 700;
const kRadians = Math.PI / 180;

/** The eye: its position, its target and its moves. */
export class Camera {
  constructor(canvas, frame, changed) {
    this.frame = frame;
    this.changed = changed;
    this.eye = new PerspectiveCamera(kFieldDeg, 1, 1, 10);
    this.eye.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.eye, canvas);
    this.controls.maxPolarAngle = 0.495 * Math.PI;
    this.controls.screenSpacePanning = false;
    this.controls.minDistance = frame.diagonal / 2000;
    this.controls.maxDistance = frame.diagonal * 6;
    this.controls.addEventListener('change', () => {
      if (this.placing) return;
      this.turned?.();
      changed();
    });
    this.flight = null;
  }

  resize(width, height) {
    this.eye.aspect = width / height;
    this.eye.updateProjectionMatrix();
  }

  /** The eye at `azimuth` (degrees clockwise from north), looking down at `pitch`, so far back that
   *  the whole box is in the picture. */
  fit(exaggeration, azimuth_deg = 225, pitch_deg = 35, margin = 1.04) {
    const [azimuth, pitch] = [azimuth_deg * kRadians, Math.min(pitch_deg, 89.9) * kRadians];
    const back = new Vector3(Math.sin(azimuth) * Math.cos(pitch),
      Math.cos(azimuth) * Math.cos(pitch), Math.sin(pitch));
    const right = new Vector3(0, 0, 1).cross(back).normalize();
    const up = back.clone().cross(right);
    const [x, y, z] = this.frame.size.map((length) => length / 2);
    const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((bits) => new Vector3(bits & 1 ? x : -x,
      bits & 2 ? y : -y, (bits & 4 ? z : -z) * exaggeration));
    const high = Math.tan(kFieldDeg / 2 * kRadians) / margin;
    const wide = high * this.eye.aspect;
    const target = new Vector3();
    let distance = 0;
    // Perspective moves the box's centre off the picture's: aim at the centre of the visible part.
    for (let round = 0; round < 8; round++) {
      const seen = corners.map((corner) => corner.clone().sub(target));
      distance = Math.max(...seen.map((corner) => corner.dot(back) +
        Math.max(Math.abs(corner.dot(right)) / wide, Math.abs(corner.dot(up)) / high)));
      for (const axis of [right, up]) {
        const at = seen.map((corner) => corner.dot(axis) / (distance - corner.dot(back)));
        target.addScaledVector(axis, (Math.min(...at) + Math.max(...at)) / 2 * distance);
      }
    }
    return {target, position: target.clone().addScaledVector(back, distance)};
  }

  put(pose) {
    this.flight = null;
    this.place(pose);
    this.changed();
  }

  /** The same during a frame: asks for no other one. */
  place({target, position}) {
    this.controls.target.copy(target);
    this.eye.position.copy(position);
    this.placing = true;
    this.controls.update();
    this.placing = false;
    this.eye.updateMatrixWorld();
  }

  /** Moves smoothly, or at once if the user prefers reduced motion. */
  fly({target, position}) {
    if (matchMedia('(prefers-reduced-motion: reduce)').matches) {
      this.put({target, position});
      return;
    }
    this.flight = {since: performance.now(), target, position,
      from_target: this.controls.target.clone(), from_position: this.eye.position.clone()};
    this.changed();
  }

  /** Flies to `target`, seen from the same side and close enough to see its surroundings. */
  fly_to(target, away = this.frame.diagonal * 0.22) {
    const back = this.back();
    back.setLength(Math.min(back.length(), away));
    this.fly({target, position: target.clone().add(back)});
  }

  /** Makes one step of the flight; true while it continues. */
  advance(now) {
    if (!this.flight) return false;
    const share = Math.min(1, (now - this.flight.since) / kFlightMs);
    const eased = share * share * (3 - 2 * share);
    this.controls.target.lerpVectors(this.flight.from_target, this.flight.target, eased);
    this.eye.position.lerpVectors(this.flight.from_position, this.flight.position, eased);
    if (share === 1) this.flight = null;
    this.placing = true;
    this.controls.update();
    this.placing = false;
    return share < 1;
  }

  /** Sets near and far planes close around the scene, which keeps depth resolution. */
  before_frame(exaggeration) {
    const distance = this.eye.position.distanceTo(this.controls.target);
    this.eye.near = distance / 100;
    this.eye.far = distance + this.frame.diagonal * (1 + exaggeration);
    this.eye.updateProjectionMatrix();
  }

  /** Metres that a pixel is wide that far in front of the eye. */
  pixel_at(depth, height) {
    return 2 * depth * Math.tan(kFieldDeg / 2 * kRadians) / height;
  }

  /** From the target to the eye. */
  back() {
    return this.eye.position.clone().sub(this.controls.target);
  }

  /** Azimuth of the eye, in degrees clockwise from north. */
  heading_deg() {
    return this.controls.getAzimuthalAngle() / kRadians;
  }
}
