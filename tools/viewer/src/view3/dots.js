// SPDX-License-Identifier: Apache-2.0
import {BufferAttribute, BufferGeometry, Color, Points, ShaderMaterial} from 'three';

const kVertex = `
uniform float size;
void main() {
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  gl_PointSize = size;
}`;
const kFragment = `
uniform vec3 color;
uniform vec3 rim;
void main() {
  float away = length(gl_PointCoord - 0.5);
  if (away > 0.5) discard;
  gl_FragColor = vec4(away > 0.32 ? rim : color, 1.0);
  #include <colorspace_fragment>
}`;

/** Round dots of `size` pixels with a rim, at a flat list of local x, y, z. */
export function dots(values, size, order) {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(values, 3));
  const uniforms = {size: {value: size * Math.min(2, devicePixelRatio)},
    color: {value: new Color()}, rim: {value: new Color()}};
  const made = new Points(geometry, new ShaderMaterial({uniforms, vertexShader: kVertex,
    fragmentShader: kFragment}));
  made.renderOrder = order;
  return made;
}
