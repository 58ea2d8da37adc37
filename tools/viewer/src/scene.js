// SPDX-License-Identifier: Apache-2.0
import {Ground} from './ground.js';
import {bytes, parse_packed} from './packed.js';

const kVersion = 1;

function floats(text, count, what) {
  const raw = bytes(text);
  if (raw.length !== 4 * count) {
    throw new Error(`The scene's ${what} have ${raw.length} bytes, expected ${4 * count}.`);
  }
  return new Float32Array(raw.buffer);
}

function triangle_corners(text) {
  const raw = bytes(text);
  return new Float32Array(raw.buffer, 0, Math.floor(raw.length / 36) * 9);
}

const joined = (lists) => new Float32Array(lists.flatMap((list) => [...list]));

/** The scene of the page with its binary parts decoded; throws a one-sentence error if invalid. */
export function read_scene(text) {
  if (text.trim() === '' || text.trimStart().startsWith('/*')) {
    throw new Error('This page contains no scene: create one with `altiplan view RESULT -o page.html`.');
  }
  const scene = parse_packed(text);
  if (scene.altiplan_scene !== kVersion) {
    throw new Error(`This page reads scenes of version ${kVersion}, found ` +
      `${JSON.stringify(scene.altiplan_scene)}.`);
  }
  decode(scene);
  return scene;
}

/** Decodes the binary parts that are there: a scene that replaces another has no ground. */
export function decode(scene) {
  const {ground} = scene;
  if (ground) {
    ground.heights = floats(ground.heights, ground.nx * ground.ny, 'heights');
    scene.ground = Object.assign(new Ground(ground), {of: ground.of ?? null});
  }
  for (const boxes of scene.boxes ?? []) {
    boxes.data = floats(boxes.data, 6 * boxes.count, 'boxes');
  }
  for (const mesh of scene.meshes ?? []) {
    mesh.triangles = triangle_corners(mesh.triangles);
  }
  if (scene.body) scene.body = joined(scene.body.map(({triangles}) => triangle_corners(triangles)));
  for (const moving of scene.moving ?? []) {
    Object.assign(moving, {layer: 'moving', role: 'obstacle', name: moving.id, ...moving});
  }
}

/** Decodes a trace on first use: it is large and seldom viewed. */
export function read_trace(trace) {
  trace.decoded ??= {
    step: bytes(trace.step), kind: bytes(trace.kind),
    at: floats(trace.at, 3 * trace.kept, 'points of the trace'),
    parent: floats(trace.parent, 3 * trace.kept, 'parents of the trace'),
    value: floats(trace.value, trace.kept, 'values of the trace'),
  };
  return trace.decoded;
}

/** The numbers, means and counts of the iterations, in order; few compared with all events. */
export function read_iterations(trace) {
  const decode = (text) => new Float32Array(bytes(text).buffer);
  trace.decoded_iterations ??= Object.fromEntries(Object.entries(trace.iterations)
    .map(([key, text]) => [key, decode(text)]));
  return trace.decoded_iterations;
}
