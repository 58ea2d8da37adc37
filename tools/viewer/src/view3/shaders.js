// SPDX-License-Identifier: Apache-2.0
import {Vector2} from 'three';

// Code is inserted into three's materials at the includes of these chunks. The z of a vertex is its
// height, not yet exaggerated.
const kPlaced = '#include <begin_vertex>';
const kColored = '#include <color_fragment>';

/** Adds a change to the shaders of `material`, with the uniforms that it reads. */
function patch(material, uniforms, {vertex, fragment = ''}) {
  const before = material.onBeforeCompile;
  material.onBeforeCompile = (shader, renderer) => {
    before.call(material, shader, renderer);
    Object.assign(shader.uniforms, uniforms);
    shader.vertexShader = shader.vertexShader
      .replace(/^/, 'varying float own_height;\n' + declared(uniforms))
      .replace(kPlaced, `${kPlaced}\nown_height = position.z;\n${vertex}`);
    shader.fragmentShader = shader.fragmentShader
      .replace(/^/, 'varying float own_height;\n' + declared(uniforms))
      .replace(kColored, `${kColored}\n${fragment}`);
  };
  material.customProgramCacheKey = () => vertex + fragment;
}

const kTypes = {cut: 'float', inside: 'vec3', heights: 'vec2'};
const declared = (uniforms) => Object.keys(uniforms)
  .map((name) => `uniform ${kTypes[name]} ${name};\n`).join('');

/** Presses everything above `cut` down onto it: hills become flat tops of the colour `inside`. */
export function pressed_down(material, cut, inside = null) {
  patch(material, inside ? {cut, inside} : {cut}, {
    vertex: 'transformed.z = min(transformed.z, cut);',
    fragment: inside ? 'if (own_height > cut) diffuseColor.rgb = inside;' : ''});
}

/** Darker and cooler low, lighter and warmer high: adds depth to grey bodies. */
export function tinted_by_height(material, [low, high]) {
  patch(material, {heights: {value: new Vector2(low, Math.max(high, low + 1e-3))}}, {vertex: '',
    fragment: `float share = clamp((own_height - heights.x) / (heights.y - heights.x), 0.0, 1.0);
      diffuseColor.rgb *= mix(vec3(0.62, 0.7, 0.82), vec3(1.45, 1.4, 1.3), share);`});
}
