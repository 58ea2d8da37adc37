// SPDX-License-Identifier: Apache-2.0
import {AmbientLight, BackSide, BufferAttribute, BufferGeometry, DirectionalLight, Group, Line,
  LineBasicMaterial, Matrix4, Mesh, MeshBasicMaterial, MeshLambertMaterial, Scene,
  Vector3} from 'three';
import {casing, route_color} from '../colors.js';
import {place_at} from '../world.js';

// Pixels from the middle of the sign to its nose.
const kNosePixels = 20;
// Seconds to each side in which the turn that banks it is measured, and the greatest bank.
const kTurnSeconds = 2;
const kMostBank = 0.9;
const kGravity = 9.81;

// A dart along x, left y, up z: nose, tips of the wings, notch, ridge.
const [kNose, kLeft, kRight, kNotch, kRidge] = [[1, 0, 0], [-0.75, 0.7, 0], [-0.75, -0.7, 0],
  [-0.42, 0, 0.02], [-0.42, 0, 0.3]];
const kFaces = [[kNose, kLeft, kRidge], [kNose, kRidge, kRight], [kLeft, kNotch, kRidge],
  [kRight, kRidge, kNotch], [kNose, kNotch, kLeft], [kNose, kRight, kNotch]];

/** The vehicle that is followed: a sign of constant size on the picture, in front of everything,
 *  turned and banked as it flies, and a line down to the ground. */
export class Vehicle {
  constructor(world) {
    this.world = world;
    const geometry = new BufferGeometry();
    geometry.setAttribute('position',
      new BufferAttribute(new Float32Array(kFaces.flat(2)), 3));
    this.body = new Mesh(geometry, new MeshLambertMaterial({flatShading: true}));
    this.rim = new Mesh(geometry, new MeshBasicMaterial({side: BackSide}));
    this.rim.scale.setScalar(1.22);
    this.sign = new Group().add(this.rim, this.body);
    const sun = new DirectionalLight(0xffffff, 1.6);
    sun.position.set(-1, 1, 2);
    // Drawn after the picture, without its depths.
    this.picture = new Scene().add(this.sign, sun, new AmbientLight(0xffffff, 1.6));
    this.plumb = new Line(new BufferGeometry(), new LineBasicMaterial({transparent: true,
      opacity: 0.7}));
    this.plumb.geometry.setAttribute('position', new BufferAttribute(new Float32Array(6), 3));
    this.plumb.frustumCulled = false;
    this.plumb.renderOrder = 6;
    this.plumb.visible = false;
  }

  update(line, {time, exaggeration, theme}, {eye, pixel_at}) {
    const {frame, scene} = this.world;
    const {at} = place_at(line, time);
    const local = frame.local(at);
    this.#plumb(local, scene.ground?.height(at[0], at[1]) ?? frame.box[0][2], frame, theme);
    this.sign.position.set(local[0], local[1], local[2] * exaggeration);
    this.sign.scale.setScalar(kNosePixels * pixel_at(this.sign.position.distanceTo(eye.position)));
    this.#turn(line, time, exaggeration);
    const color = route_color(line.result, theme);
    this.body.material.color.set(color);
    this.rim.material.color.set(casing(color));
  }

  #plumb([x, y, z], ground, frame, theme) {
    this.plumb.visible = !Number.isNaN(ground);
    this.plumb.geometry.attributes.position.set([x, y, z, x, y, ground - frame.centre[2]]);
    this.plumb.geometry.attributes.position.needsUpdate = true;
    this.plumb.material.color.set(theme === 'dark' ? 0xffffff : 0x15191f);
  }

  #turn(line, time, exaggeration) {
    const step = (from) => {
      const [a, b] = [from, from + kTurnSeconds].map((when) => place_at(line, when).at);
      return new Vector3(b[0] - a[0], b[1] - a[1], (b[2] - a[2]) * exaggeration);
    };
    const [before, after] = [step(time - kTurnSeconds), step(time)];
    const along = before.clone().add(after);
    // Where it hovers it stays turned as it was.
    if (Math.hypot(along.x, along.y) < 1e-3) return;
    const turned = Math.atan2(before.x * after.y - before.y * after.x,
      before.x * after.x + before.y * after.y) / kTurnSeconds;
    const bank = Math.atan(along.length() / (2 * kTurnSeconds) * turned / kGravity);
    const x = along.normalize();
    const y = new Vector3(-x.y, x.x, 0).normalize();
    const z = x.clone().cross(y);
    this.sign.quaternion.setFromRotationMatrix(new Matrix4().makeBasis(x, y, z));
    this.sign.rotateX(-Math.min(kMostBank, Math.max(-kMostBank, bank)));
  }
}
