// SPDX-License-Identifier: Apache-2.0
import {BufferAttribute, BufferGeometry, Color, Group, LineSegments, Points,
  ShaderMaterial} from 'three';
import {kKinds} from '../colors.js';

const kVertex = `
attribute vec2 life;
attribute float kind;
uniform float now;
uniform float size;
uniform vec3 colors[5];
varying vec3 shade;
varying float alive;
void main() {
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  gl_PointSize = size;
  shade = colors[int(kind)];
  alive = life.x < now && now <= life.y ? 1.0 : 0.0;
}`;
const kFragment = `
varying vec3 shade;
varying float alive;
uniform float opacity;
void main() {
  if (alive < 0.5) discard;
  gl_FragColor = vec4(shade, opacity);
  #include <colorspace_fragment>
}`;

function material(opacity) {
  return new ShaderMaterial({vertexShader: kVertex, fragmentShader: kFragment, transparent: true,
    depthWrite: false, uniforms: {now: {value: 0}, opacity: {value: opacity},
      size: {value: 3.5 * Math.min(2, devicePixelRatio)},
      colors: {value: kKinds.map((color) => new Color(color))}}});
}

/** The kept events of a search, each drawn until another one ends it. */
export class Search {
  constructor(playback, frame) {
    const {count, at, parent, kind, until} = playback;
    this.object = new Group();
    this.points = new Points(this.#geometry(count, [at], kind, until, frame), material(0.95));
    this.edges = new LineSegments(this.#geometry(count, [parent, at], kind, until, frame),
      material(0.6));
    this.points.renderOrder = this.edges.renderOrder = 6;
    this.object.add(this.edges, this.points);
  }

  #geometry(count, ends, kinds, until, frame) {
    const [position, life, kind] = [3, 2, 1].map((size) =>
      new Float32Array(count * ends.length * size));
    for (let event = 0, vertex = 0; event < count; event++) {
      for (const values of ends) {
        position.set(frame.local(values.subarray(3 * event, 3 * event + 3)), 3 * vertex);
        life.set([event, until[event]], 2 * vertex);
        kind[vertex++] = kinds[event];
      }
    }
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(position, 3));
    geometry.setAttribute('life', new BufferAttribute(life, 2));
    geometry.setAttribute('kind', new BufferAttribute(kind, 1));
    return geometry;
  }

  show(shown) {
    for (const part of [this.points, this.edges]) part.material.uniforms.now.value = shown;
  }
}
