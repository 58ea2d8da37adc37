// SPDX-License-Identifier: Apache-2.0
import {BufferAttribute, BufferGeometry, EdgesGeometry, Group, InstancedMesh, LineBasicMaterial,
  LineSegments, Matrix4, Mesh, MeshLambertMaterial, Quaternion, Vector3} from 'three';
import {bodies_of} from '../body.js';
import {casing, route_color} from '../colors.js';

const kOpacity = 0.3;
const kSharpDeg = 20;

/** The body along one route, translucent, and where it is closest to an obstacle. */
class BodyOnRoute {
  constructor(body, faces, edges, frame) {
    this.body = body;
    this.frame = frame;
    this.along = new InstancedMesh(faces, new MeshLambertMaterial({flatShading: true,
      transparent: true, opacity: kOpacity, depthWrite: false}), body.at.length);
    // After the solids, behind which it is hidden.
    this.along.renderOrder = 14;
    const [one, rotation] = [new Vector3(1, 1, 1), new Quaternion()];
    body.at.forEach((at, place) => this.along.setMatrixAt(place, new Matrix4().compose(
      new Vector3(...frame.local(at)), rotation.set(...body.turned[place]), one)));
    this.object = new Group().add(this.along);
    if (body.nearest) this.#add_nearest(faces, edges);
  }

  #add_nearest(faces, edges) {
    const {at, turned} = this.body.nearest;
    this.nearest = new Mesh(faces, new MeshLambertMaterial({flatShading: true}));
    this.edges = new LineSegments(edges, new LineBasicMaterial());
    const group = new Group().add(this.nearest, this.edges);
    group.position.set(...this.frame.local(at));
    group.quaternion.set(...turned);
    this.object.add(group);
  }

  update({bodies, shown, theme}) {
    const color = route_color(this.body.result, theme);
    this.object.visible = bodies && shown.has(this.body.key);
    this.along.material.color.set(color);
    this.nearest?.material.color.set(color);
    this.edges?.material.color.set(casing(color));
  }

  /** Places and sizes, read from the buffers. */
  drawn() {
    const matrix = new Matrix4();
    const at = this.body.at.map((_, place) => {
      this.along.getMatrixAt(place, matrix);
      return this.frame.world(new Vector3().setFromMatrixPosition(matrix).toArray());
    });
    const corners = this.nearest && [...this.nearest.geometry.attributes.position.array];
    this.nearest?.updateWorldMatrix(true, false);
    const points = [];
    for (let from = 0; from < (corners?.length ?? 0); from += 3) {
      const local = new Vector3().fromArray(corners, from)
        .applyMatrix4(this.nearest.parent.matrix);
      points.push(this.frame.world(local.toArray()));
    }
    return {result: this.body.result, at, nearest: points};
  }
}

/** The vehicle's body on all routes, in one geometry. */
export class Bodies {
  constructor(scene, frame) {
    this.object = new Group();
    this.all = [];
    if (!scene.body) return;
    const faces = new BufferGeometry();
    faces.setAttribute('position', new BufferAttribute(scene.body, 3));
    const edges = new EdgesGeometry(faces, kSharpDeg);
    this.all = bodies_of(scene).map((body) => new BodyOnRoute(body, faces, edges, frame));
    for (const {object} of this.all) this.object.add(object);
  }

  update(state) {
    for (const body of this.all) body.update(state);
  }

  drawn() {
    return this.all.filter(({object}) => object.visible).map((body) => body.drawn());
  }
}
