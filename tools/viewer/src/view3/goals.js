// SPDX-License-Identifier: Apache-2.0
import {BufferAttribute, BufferGeometry, Group, LineBasicMaterial, LineSegments} from 'three';
import {surface} from '../shapes.js';
import {tolerances} from '../world.js';

/** The tolerance spheres of the goal and the via points. */
export class Goals {
  constructor(scene, frame) {
    this.object = new Group();
    this.material = new LineBasicMaterial({transparent: true, opacity: 0.8});
    for (const {at, tolerance} of tolerances(scene)) {
      const {edges} = surface({shape: 'sphere', at: frame.local(at), radius: tolerance}, frame.box);
      const geometry = new BufferGeometry();
      geometry.setAttribute('position', new BufferAttribute(new Float32Array(edges), 3));
      this.object.add(new LineSegments(geometry, this.material));
    }
  }

  update({theme}) {
    this.material.color.set(theme === 'dark' ? 0xffffff : 0x15191f);
  }
}
