// SPDX-License-Identifier: Apache-2.0
import {NoColorSpace, SRGBColorSpace, Texture, Vector2, Vector4} from 'three';
import {kLevelMetres, kPens} from '../contours.js';

// Code is inserted into three's materials at the includes of these chunks. The place of a vertex is
// its own in the frame, neither exaggerated nor pressed down.
const kPlaced = '#include <begin_vertex>';
const kColored = '#include <color_fragment>';

/** Adds a change to the shaders of `material`, with the uniforms that it reads. */
function patch(material, uniforms, {vertex = '', fragment = ''}) {
  const before = material.onBeforeCompile;
  material.onBeforeCompile = (shader, renderer) => {
    before.call(material, shader, renderer);
    Object.assign(shader.uniforms, uniforms);
    shader.vertexShader = shader.vertexShader
      .replace(/^/, 'varying vec3 own_place;\n' + declared(uniforms))
      .replace(kPlaced, `${kPlaced}\nown_place = position;\n${vertex}`);
    shader.fragmentShader = shader.fragmentShader
      .replace(/^/, 'varying vec3 own_place;\n' + declared(uniforms))
      .replace(kColored, `${kColored}\n${fragment}`);
  };
  material.customProgramCacheKey = () => vertex + fragment;
}

const kTypes = {cut: 'float', inside: 'vec3', heights: 'vec2', contours: 'vec2', basemap: 'sampler2D',
  basemap_place: 'vec4', basemap_shown: 'float'};
const declared = (uniforms) => Object.keys(uniforms)
  .map((name) => `uniform ${kTypes[name]} ${name};\n`).join('');

const kPressed = 'transformed.z = min(transformed.z, cut);';

/** Presses everything above `cut` down onto it. */
export function pressed_down(material, cut) {
  patch(material, {cut}, {vertex: kPressed});
}

// Its alpha is multiplied in.
const kBasemap = `vec2 at = (own_place.xy - basemap_place.xy) / basemap_place.zw;
  vec4 mapped = basemap_shown * float(at == clamp(at, 0.0, 1.0)) * texture2D(basemap, at);
  diffuseColor.rgb = mapped.rgb + (1.0 - mapped.a) * diffuseColor.rgb;\n`;

/** Draws a basemap, the uniforms of `basemap_on`, over the material's own colour. */
export function mapped(material, basemap) {
  if (basemap) patch(material, basemap, {fragment: kBasemap});
}

/** Shows nothing yet: `basemap_shown` is 0. */
export function basemap_on({frame, basemap, scene}) {
  if (!basemap) return null;
  const {box: [low, high], image} = basemap;
  const texture = new Texture(image);
  // The ground's colours are sRGB and stay so.
  texture.colorSpace = scene.ground ? NoColorSpace : SRGBColorSpace;
  texture.premultiplyAlpha = texture.needsUpdate = true;
  return {basemap: {value: texture}, basemap_shown: {value: 0}, basemap_place: {value:
    new Vector4(...frame.local([...low, 0]).slice(0, 2), high[0] - low[0], high[1] - low[1])}};
}

const strength_of = ({every, width, strength, close}) => `${strength} *
  clamp(${((width + 1) / 2).toFixed(1)} -
    ${every}.0 * abs(fract(level / ${every}.0 + 0.5) - 0.5) / per_pixel, 0.0, 1.0) *
  clamp(2.0 - ${close}.0 * per_pixel, 0.0, 1.0)`;
// As `contour_strength`.
const kContours = `if (contours.x > 0.0) {
  float level = (own_place.z + contours.y) / contours.x;
  float per_pixel = fwidth(level);
  if (per_pixel * contours.x > ${kLevelMetres}) {
    diffuseColor.rgb *= 1.0 - max(${kPens.map(strength_of)});
  }
}\n`;

/** Of the ground: pressed down, of the colour `inside` where it is cut; `contours` are the metres
 *  between them, 0 for none, and the height of the frame's middle. */
export function as_ground(material, {cut, inside, contours}, basemap) {
  patch(material, {cut, inside, contours, ...basemap}, {vertex: kPressed,
    fragment: (basemap ? kBasemap : '') + kContours +
      'if (own_place.z > cut) diffuseColor.rgb = inside;'});
}

/** Darker and cooler low, lighter and warmer high: adds depth to grey bodies. */
export function tinted_by_height(material, [low, high]) {
  patch(material, {heights: {value: new Vector2(low, Math.max(high, low + 1e-3))}}, {
    fragment: `float share = clamp((own_place.z - heights.x) / (heights.y - heights.x), 0.0, 1.0);
      diffuseColor.rgb *= mix(vec3(0.62, 0.7, 0.82), vec3(1.45, 1.4, 1.3), share);`});
}
