// SPDX-License-Identifier: Apache-2.0
import {BufferAttribute, BufferGeometry, Group, LineBasicMaterial, LineSegments} from 'three';
import {surface} from '../shapes.js';
import {tolerances} from '../world.js';

/** Ends of 64 chords of a horizontal circle, in pairs. */
function ring([x, y, z], radius) {
  const at = (n) => {
    const angle = 2 * Math.PI * n / 64;
    return [x + radius * Math.cos(angle), y + radius * Math.sin(angle), z];
  };
  return Array.from({length: 64}, (_, n) => [...at(n), ...at(n + 1)]).flat();
}

/** The tolerance spheres of the goal and the via points, and the loiter circles. */
export class Goals {
  constructor(scene, frame) {
    this.object = new Group();
    this.material = new LineBasicMaterial({transparent: true, opacity: 0.8});
    const spheres = tolerances(scene).map(({at, tolerance}) =>
      surface({shape: 'sphere', at: frame.local(at), radius: tolerance}, frame.box).edges);
    const rings = (scene.loiters ?? []).map(({at, radius}) => ring(frame.local(at), radius));
    for (const edges of [...spheres, ...rings]) {
      const geometry = new BufferGeometry();
      geometry.setAttribute('position', new BufferAttribute(new Float32Array(edges), 3));
      this.object.add(new LineSegments(geometry, this.material));
    }
  }

  update({theme}) {
    this.material.color.set(theme === 'dark' ? 0xffffff : 0x15191f);
  }
}
