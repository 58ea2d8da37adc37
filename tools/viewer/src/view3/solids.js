// SPDX-License-Identifier: Apache-2.0
import {BackSide, BufferAttribute, BufferGeometry, DoubleSide, FrontSide, Group,
  LineBasicMaterial, LineDashedMaterial, LineSegments, Mesh, MeshBasicMaterial,
  MeshLambertMaterial, Vector3} from 'three';
import {mix, role_color} from '../colors.js';
import {drift, layer_key, present} from '../world.js';
import {tinted_by_height} from './shaders.js';
import {box_field, kMaxEdgedBoxes, merged, obstacle_heights, triangle_mesh} from './shapes3.js';

const kOpacity = {obstacle: 0.72, keep_out: 0.3, keep_in: 0.1, threat: 0.3,
  unknown: 0.2};

/** Obstacles hide everything inside and behind them in the same layer (a depth-only pass comes
 *  first), so that a city looks like houses; zones and threats are translucent, and only the far
 *  walls of a keep-in zone are drawn. */
function bodies(thing, heights) {
  const solid = thing.role === 'obstacle';
  const look = {transparent: true, polygonOffset: true, polygonOffsetFactor: 1,
    polygonOffsetUnits: 1, side: thing.triangles ? DoubleSide : FrontSide};
  if (thing.role === 'keep_in') look.side = BackSide;
  const opacity = kOpacity[thing.role] * (thing.known ? 1 : 0.6);
  const seen = new Mesh(new BufferGeometry(), new MeshLambertMaterial({...look, flatShading: true,
    color: role_color(thing.role), opacity, depthWrite: false}));
  seen.renderOrder = solid ? 11 : 12;
  if (!solid) return [seen];
  tinted_by_height(seen.material, heights);
  if (thing.count > kMaxEdgedBoxes) {
    // A single pass for very many boxes.
    seen.material.depthWrite = true;
    return [seen];
  }
  const depth = new Mesh(new BufferGeometry(), new MeshBasicMaterial({...look,
    colorWrite: false}));
  depth.renderOrder = 10;
  return [depth, seen];
}

function edge_lines(thing, diagonal) {
  const look = {transparent: true, opacity: thing.role === 'obstacle' ? 0.55 : 0.9};
  const lines = new LineSegments(new BufferGeometry(), thing.known ? new LineBasicMaterial(look) :
    new LineDashedMaterial({...look, dashSize: diagonal / 200, gapSize: diagonal / 300}));
  lines.renderOrder = 13;
  return lines;
}

/** Shapes of one look that appear and disappear together. `make(cut)` returns their buffers. */
class Body {
  constructor(thing, make, frame, heights, moving = null) {
    Object.assign(this, {thing, make, moving});
    this.faces = bodies(thing, heights);
    this.edges = edge_lines(thing, frame.diagonal);
    this.object = new Group().add(...this.faces, this.edges);
  }

  /** Rebuilds the buffers without everything above `height`. */
  cut(height) {
    if (this.height === height) return;
    this.height = height;
    const {faces, edges, shapes, names} = this.make(height);
    Object.assign(this, {shapes, names});
    this.faces[0].geometry.dispose();
    for (const mesh of this.faces) mesh.geometry = faces;
    this.edges.visible = edges !== null;
    if (!edges) return;
    this.edges.geometry.dispose();
    this.edges.geometry = new BufferGeometry();
    this.edges.geometry.setAttribute('position', new BufferAttribute(edges, 3));
    if (!this.thing.known) this.edges.computeLineDistances();
  }

  update(state, times) {
    const {thing, object, edges, moving} = this;
    const moved = moving ? drift(moving, state.time) : [0, 0, 0];
    object.position.set(...moved);
    this.cut(state.cut - moved[2]);
    object.visible = this.shapes > 0 && !state.hidden.has(layer_key(thing)) &&
      present(thing, times, state);
    edges.material.color.set(mix(role_color(thing.role),
      state.theme === 'dark' ? '#ffffff' : '#000000', 0.3));
  }

  bounds() {
    const {geometry} = this.faces[0];
    geometry.computeBoundingBox();
    return geometry.boundingBox.clone().translate(this.object.position);
  }
}

const same_fate = (thing) => `${layer_key(thing)}|${thing.added_by}|${thing.removed_by}`;

const parts_of = ({solids, boxes, meshes, moving}) => [solids, boxes, meshes, moving];

/** All obstacles, zones and moving shapes; those added or removed by events follow the time. */
export class Solids {
  constructor(scene, frame) {
    this.frame = frame;
    this.parts = parts_of(scene);
    this.object = new Group();
    this.bodies = [];
    const heights = obstacle_heights(scene, frame);
    const add = (thing, make, moving) => {
      const body = new Body(thing, make, frame, heights, moving);
      this.bodies.push(body);
      this.object.add(body.object);
    };
    const groups = new Map();
    for (const solid of scene.solids) {
      const fate = same_fate(solid);
      if (groups.has(fate)) groups.get(fate).push(solid);
      else groups.set(fate, [solid]);
    }
    for (const things of groups.values()) add(things[0], (cut) => merged(things, frame, cut));
    for (const boxes of scene.boxes) add(boxes, (cut) => box_field(boxes, frame, cut));
    for (const mesh of scene.meshes) add(mesh, (cut) => triangle_mesh(mesh, frame, cut));
    for (const moving of scene.moving) add(moving, (cut) => merged([moving], frame, cut), moving);
  }

  /** True if these are the scene's. */
  is_of(scene) {
    return parts_of(scene).every((part, nth) => part === this.parts[nth]);
  }

  update(state, times) {
    for (const body of this.bodies) body.update(state, times);
  }

  #visible() {
    return this.bodies.filter(({object}) => object.visible);
  }

  /** The number of visible shapes in the buffers and the height of the highest. */
  drawn() {
    const tops = this.#visible().map((body) => body.bounds().max.z + this.frame.centre[2]);
    return {solids: this.#visible().reduce((sum, {shapes}) => sum + shapes, 0),
      highest: tops.length > 0 ? Math.max(...tops) : null};
  }

  /** Positions of the moving shapes: the centres of their buffers. */
  moved() {
    return this.#visible().filter(({moving}) => moving).map((body) => ({id: body.moving.id,
      at: this.frame.world(body.bounds().getCenter(new Vector3()).toArray())}));
  }

  /** The name of the first solid hit by `caster`; null if none. */
  name_at(caster) {
    const named = this.#visible().filter(({names}) => names);
    const [hit] = caster.intersectObjects(named.map(({faces}) => faces[0]), false);
    return named.find(({faces}) => faces[0] === hit?.object)?.names
      .find(({end}) => hit.faceIndex < end)?.name ?? null;
  }
}
