// SPDX-License-Identifier: Apache-2.0
import {BufferAttribute, BufferGeometry, Color, DoubleSide, Group, LinearSRGBColorSpace, Mesh,
  MeshBasicMaterial, Sphere, Vector3} from 'three';
import {shaded} from '../ground.js';
import {as_ground, pressed_down} from './shaders.js';

// Posts of the coarse terrain drawn in motion if a full frame takes too long.
const kCoarsePosts = 40000;
// Posts along the side of a tile: those out of the picture are not drawn.
const kTile = 64;
// Colour of the ground's interior, seen at its sides and where it is cut.
const kInsideColor = {light: 0x8d949d, dark: 0x48505a};

function every(count, stride) {
  const picked = [];
  for (let at = 0; at < count - 1; at += stride) picked.push(at);
  picked.push(count - 1);
  return picked;
}

/** Two triangles per cell between the picked columns and rows if all its four posts exist. */
function cells({nx, z, whole}, columns, rows) {
  const index = new Uint32Array(6 * (columns.length - 1) * (rows.length - 1));
  let end = 0;
  for (let row = 0; row + 1 < rows.length; row++) {
    const [south, north] = [rows[row] * nx, rows[row + 1] * nx];
    for (let column = 0; column + 1 < columns.length; column++) {
      const west = columns[column];
      const east = columns[column + 1];
      const [sw, se, ne, nw] = [south + west, south + east, north + east, north + west];
      // A sum that contains NaN is NaN.
      if (!whole && Number.isNaN(z[sw] + z[se] + z[ne] + z[nw])) continue;
      index[end] = index[end + 3] = sw;
      index[end + 1] = se;
      index[end + 2] = index[end + 4] = ne;
      index[end + 5] = nw;
      end += 6;
    }
  }
  return index.subarray(0, end);
}

function positions(ground, frame) {
  const {nx, ny, x0, y0, dx, dy, z} = ground;
  const [cx, cy, cz] = frame.centre;
  const values = new Float32Array(3 * nx * ny);
  for (let j = 0, at = 0; j < ny; j++) {
    const y = y0 + j * dy - cy;
    for (let i = 0; i < nx; i++, at += 3) {
      values[at] = x0 + i * dx - cx;
      values[at + 1] = y;
      values[at + 2] = z[at / 3] - cz;
    }
  }
  return values;
}

/** Walls down from the four sides, which make the terrain a block instead of a sheet. */
function skirt({nx, ny}, values, base) {
  const row = (j) => Array.from({length: nx}, (_, i) => j * nx + i);
  const column = (i) => Array.from({length: ny}, (_, j) => j * nx + i);
  const walls = [];
  for (const side of [row(0), column(nx - 1), row(ny - 1), column(0)]) {
    for (let at = 0; at + 1 < side.length; at++) {
      const [a, b] = [side[at], side[at + 1]].map((post) =>
        values.subarray(3 * post, 3 * post + 3));
      if (Number.isNaN(a[2] + b[2])) continue;
      walls.push(a[0], a[1], base, b[0], b[1], base, ...b, a[0], a[1], base, ...b, ...a);
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(new Float32Array(walls), 3));
  return new Mesh(geometry, new MeshBasicMaterial({side: DoubleSide,
    polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 4}));
}

/** Pieces of `kTile` of the picked columns or rows, each beginning where the one before it ends. */
function pieces(picked) {
  const all = [];
  for (let at = 0; at + 1 < picked.length; at += kTile) all.push(picked.slice(at, at + kTile + 1));
  return all;
}

/** A sphere around all posts of a tile. */
function sphere_around({nx}, values, columns, rows) {
  const corner = (column, row) => new Vector3(...values.subarray(3 * (row * nx + column),
    3 * (row * nx + column) + 2), 0);
  const [low, high] = [corner(columns[0], rows[0]), corner(columns.at(-1), rows.at(-1))];
  [low.z, high.z] = [Infinity, -Infinity];
  for (const row of rows) {
    for (const column of columns) {
      const height = values[3 * (row * nx + column) + 2];
      if (height < low.z) low.z = height;
      if (height > high.z) high.z = height;
    }
  }
  return new Sphere(low.clone().add(high).multiplyScalar(0.5), low.distanceTo(high) / 2);
}

/** Tiles of one mesh; light and height colours are in its vertices. */
export class Terrain {
  /** `cut` is a uniform with the local height of the cut, `contours` and `basemap` are those of `as_ground`. */
  constructor(ground, frame, cut, contours, basemap) {
    this.ground = ground;
    this.frame = frame;
    this.position = new BufferAttribute(positions(ground, frame), 3);
    this.color = new BufferAttribute(shaded(ground, 1), 4, true);
    const {nx, ny} = ground;
    const stride = Math.max(1, Math.ceil(Math.sqrt(nx * ny / kCoarsePosts)));
    // Pushed back a little, so that lines on the ground are visible.
    const material = new MeshBasicMaterial({vertexColors: true, side: DoubleSide,
      polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 2});
    // The colours are already sRGB.
    material.onBeforeCompile = (shader) => {
      shader.fragmentShader = shader.fragmentShader.replace('#include <colorspace_fragment>', '');
    };
    this.inside = {value: new Color()};
    as_ground(material, {cut, inside: this.inside, contours}, basemap);
    const tile = (columns, rows) => {
      const geometry = new BufferGeometry();
      geometry.setAttribute('position', this.position);
      geometry.setAttribute('color', this.color);
      geometry.setIndex(new BufferAttribute(cells(ground, columns, rows), 1));
      geometry.boundingSphere = sphere_around(ground, this.position.array, columns, rows);
      return new Mesh(geometry, material);
    };
    const tiles = (step) => new Group().add(...pieces(every(ny, step)).flatMap((rows) =>
      pieces(every(nx, step)).map((columns) => tile(columns, rows))));
    this.fine = tiles(1);
    this.coarse = stride > 1 ? tiles(stride) : null;
    this.skirt = skirt(ground, this.position.array, frame.base(ground) - frame.centre[2]);
    pressed_down(this.skirt.material, cut);
    this.object = new Group().add(this.fine, this.skirt);
    if (this.coarse) this.object.add(this.coarse);
    this.show_coarse(false);
  }

  show_coarse(coarse) {
    this.fine.visible = !(coarse && this.coarse);
    if (this.coarse) this.coarse.visible = !this.fine.visible;
  }

  paint({theme}) {
    this.skirt.material.color.set(kInsideColor[theme]);
    // Already sRGB, like the vertices' colours.
    this.inside.value.setHex(kInsideColor[theme], LinearSRGBColorSpace);
  }

  light(exaggeration) {
    this.color.array.set(shaded(this.ground, exaggeration));
    this.color.needsUpdate = true;
  }

  /** The dimensions, heights and corners in the vertex buffer. */
  drawn() {
    const {array, count} = this.position;
    let [nx, min, max] = [0, Infinity, -Infinity];
    while (nx < count && array[3 * nx + 1] === array[1]) nx++;
    for (let at = 2; at < array.length; at += 3) {
      if (array[at] < min) min = array[at];
      if (array[at] > max) max = array[at];
    }
    const post = (at) => this.frame.world(array.subarray(3 * at, 3 * at + 3));
    return {nx, ny: count / nx, min: min + this.frame.centre[2], max: max + this.frame.centre[2],
      cells: this.fine.children.reduce((sum, {geometry}) => sum + geometry.index.count / 6, 0),
      corners: [0, nx - 1, count - nx, count - 1].map(post)};
  }
}
