// SPDX-License-Identifier: Apache-2.0
import {BufferAttribute, BufferGeometry, Group, LineBasicMaterial, LineSegments} from 'three';
import {grid_lines} from '../world.js';
import {pressed_down} from './shaders.js';

const kSamples = 400;

/** Grid lines on the ground, or on the floor of the box where there is none. */
function draped(frame, ground) {
  const [low, high] = frame.box;
  const values = [];
  const point = (x, y) => {
    const height = ground ? ground.height(x, y) : low[2];
    return Number.isNaN(height) ? null : frame.local([x, y, height]);
  };
  for (const axis of [0, 1]) {
    const other = 1 - axis;
    for (const at of grid_lines(frame.box, axis).lines) {
      let before = null;
      for (let sample = 0; sample <= kSamples; sample++) {
        const along = low[other] + (high[other] - low[other]) * sample / kSamples;
        const here = axis === 0 ? point(at, along) : point(along, at);
        if (before && here) values.push(...before, ...here);
        before = here;
      }
    }
  }
  return new Float32Array(values);
}

function box_edges(frame) {
  const [x, y, z] = frame.size.map((length) => length / 2);
  const values = [];
  for (const [a, b] of [[-1, -1], [1, -1], [1, 1], [-1, 1]]) {
    values.push(a * x, b * y, -z, a * x, b * y, z);
    const [c, d] = [-b, a];
    for (const height of [-z, z]) values.push(a * x, b * y, height, c * x, d * y, height);
  }
  return new Float32Array(values);
}

function segments(values, opacity) {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(values, 3));
  const lines = new LineSegments(geometry,
    new LineBasicMaterial({transparent: true, opacity, depthWrite: false}));
  lines.renderOrder = 1;
  return lines;
}

export class Grid {
  constructor(frame, ground, cut) {
    this.lines = segments(draped(frame, ground), 0.22);
    // Lines on the ground are cut with it.
    pressed_down(this.lines.material, cut);
    this.edges = segments(box_edges(frame), 0.35);
    this.object = new Group().add(this.lines, this.edges);
    this.on_ground = Boolean(ground);
  }

  update({grid, theme}) {
    this.object.visible = grid;
    const color = theme === 'dark' ? 0xdfe5ec : 0x1b2430;
    this.lines.material.color.set(this.on_ground ? 0x10161d : color);
    this.edges.material.color.set(color);
  }
}
