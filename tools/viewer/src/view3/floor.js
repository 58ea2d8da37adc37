// SPDX-License-Identifier: Apache-2.0
import {BufferAttribute, BufferGeometry, DoubleSide, Mesh, MeshBasicMaterial} from 'three';
import {mapped} from './shaders.js';

const kColor = {light: 0xf6f5f1, dark: 0x2b323a};

/** A plane where a world has no terrain: the floor of the box. */
export class Floor {
  constructor(frame, basemap) {
    this.frame = frame;
    const [[west, south, low], [east, north]] = frame.box.map((corner) => frame.local(corner));
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(new Float32Array([
      west, south, low, east, south, low, east, north, low, west, north, low]), 3));
    geometry.setIndex([0, 1, 2, 0, 2, 3]);
    // Pushed back, so that the grid and outlines on it are seen.
    this.object = new Mesh(geometry, new MeshBasicMaterial({side: DoubleSide,
      polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 4}));
    mapped(this.object.material, basemap);
    this.object.renderOrder = -1;
  }

  paint({theme}) {
    this.object.material.color.set(kColor[theme]);
  }

  /** Two corners, read from the buffer. */
  drawn() {
    const {array} = this.object.geometry.attributes.position;
    return [0, 6].map((at) => this.frame.world([...array.subarray(at, at + 3)]));
  }
}
