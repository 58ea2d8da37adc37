// SPDX-License-Identifier: Apache-2.0
import {BufferAttribute, BufferGeometry, DoubleSide, Group, Mesh, MeshBasicMaterial} from 'three';
import {Line2} from 'three/addons/lines/Line2.js';
import {LineGeometry} from 'three/addons/lines/LineGeometry.js';
import {LineMaterial} from 'three/addons/lines/LineMaterial.js';
import {casing, mix, route_color} from '../colors.js';
import {dots} from './dots.js';

// Pixels, and the drawing order: a flown track is a band under the route, so that both are visible
// where they coincide.
const kWidth = {route: 3.2, attempt: 2, track: 4.8};
const kOrder = {track: 1, route: 3, attempt: 3};
// More dots than this would hide their line.
const kMaxDots = 80;

/** A casing writes no depth, so that it does not flicker with the line on top of it. */
function stroke(geometry, width, order, dash, depthWrite = true) {
  // Those drawn later are pulled a little to the eye, or they would flicker where lines coincide.
  const material = new LineMaterial({linewidth: width, dashed: Boolean(dash), dashSize: dash,
    gapSize: dash, depthWrite, polygonOffset: true, polygonOffsetFactor: 0,
    polygonOffsetUnits: -8 * order});
  const made = new Line2(geometry, material);
  made.renderOrder = order;
  return made;
}

/** A translucent curtain from the line down to the ground, which shows its height. */
function curtain(line, ground, frame) {
  const bottom = (point) => {
    const height = ground ? ground.height(point[0], point[1]) : frame.box[0][2];
    return [point[0], point[1], Number.isNaN(height) ? frame.box[0][2] : height];
  };
  const walls = [];
  for (let at = 0; at + 1 < line.points.length; at++) {
    const [a, b] = [line.points[at], line.points[at + 1]].map((point) => frame.local(point));
    const [c, d] = [line.points[at], line.points[at + 1]].map((point) =>
      frame.local(bottom(point)));
    walls.push(...a, ...b, ...d, ...a, ...d, ...c);
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(new Float32Array(walls), 3));
  const made = new Mesh(geometry, new MeshBasicMaterial({side: DoubleSide, transparent: true,
    opacity: 0.16, depthWrite: false}));
  made.renderOrder = 5;
  return made;
}

/** A route, an attempt (dashed) or a track (a light band), with its casing and dots. */
class Line {
  constructor(line, ground, frame) {
    this.line = line;
    this.object = new Group();
    const flat = frame.flat(line.points);
    const dash = line.kind === 'attempt' ? frame.diagonal / 150 : 0;
    if (line.points.length > 1) {
      this.geometry = new LineGeometry();
      this.geometry.setPositions(flat);
      const order = kOrder[line.kind];
      this.stroke = stroke(this.geometry, kWidth[line.kind], order + 0.5, dash,
        line.kind !== 'track');
      if (dash) this.stroke.computeLineDistances();
      else this.casing = stroke(this.geometry, kWidth[line.kind] + 2.2, order, 0, false);
      this.object.add(this.stroke, ...(this.casing ? [this.casing] : []));
    }
    const waypoints = line.waypoints?.map((at) => line.points[at]) ?? line.points;
    if (line.kind !== 'track' && waypoints.length <= kMaxDots) {
      this.dots = dots(frame.flat(waypoints), 6, 4.5);
      this.object.add(this.dots);
    }
    if (line.kind === 'route') {
      this.curtain = curtain(line, ground, frame);
      this.object.add(this.curtain);
    }
    this.frame = frame;
  }

  update({shown, selected, theme}) {
    const {kind, key, result} = this.line;
    const color = route_color(result, theme);
    const around = casing(color);
    this.object.visible = shown.has(key);
    this.stroke?.material.color.set(kind === 'track' ? mix(color, '#ffffff', 0.65) : color);
    this.casing?.material.color.set(kind === 'track' ? color : around);
    this.dots?.material.uniforms.color.value.set(color);
    this.dots?.material.uniforms.rim.value.set(around);
    if (this.curtain) {
      this.curtain.visible = result === selected;
      this.curtain.material.color.set(color);
    }
  }

  /** The end points of the segments in the buffer. */
  drawn() {
    if (!this.geometry) return this.line.points.map((point) => [...point]);
    const {array} = this.geometry.attributes.instanceStart.data;
    const points = [];
    for (let at = 0; at < array.length; at += 6) points.push(array.subarray(at, at + 3));
    points.push(array.subarray(array.length - 3));
    return points.map((point) => this.frame.world(point));
  }
}

export class Lines {
  constructor(lines, ground, frame) {
    this.object = new Group();
    this.lines = lines.map((line) => new Line(line, ground, frame));
    for (const {object} of this.lines) this.object.add(object);
  }

  update(state) {
    for (const line of this.lines) line.update(state);
  }

  drawn() {
    const visible = this.lines.filter(({object}) => object.visible);
    const read = (line) => ({result: line.line.result, step: line.line.step,
      points: line.drawn()});
    return {routes: visible.filter(({line}) => line.kind !== 'track').map(read),
      tracks: visible.filter(({line}) => line.kind === 'track').map(read)};
  }
}
