// SPDX-License-Identifier: Apache-2.0
// Rectangles {left, top, right, bottom} on the picture, in pixels from its top left.

const kGap = 3;
// Where a label stands beside its mark, in the order of preference.
const kSides = [[1, -1], [1, 1], [-1, -1], [-1, 1], [1, 0], [-1, 0], [0, -1], [0, 1]];
// Pixels between a mark and its label.
const kAway = [2, 20];

export const around = ([x, y], [width, height]) =>
  ({left: x - width / 2, top: y - height / 2, right: x + width / 2, bottom: y + height / 2});

export const apart = (a, b, gap = kGap) => a.left >= b.right + gap || b.left >= a.right + gap ||
  a.top >= b.bottom + gap || b.top >= a.bottom + gap;

/** What is taken of a picture of that size. */
export class Room {
  constructor(width, height, taken) {
    Object.assign(this, {width, height, taken: [...taken]});
  }

  take(rectangle) {
    this.taken.push(rectangle);
  }

  is_free(rectangle, gap = kGap) {
    return rectangle.left >= 0 && rectangle.top >= 0 && rectangle.right <= this.width &&
      rectangle.bottom <= this.height && this.taken.every((other) => apart(rectangle, other, gap));
  }

  /** `middle` moved into the picture. */
  inside([x, y], [width, height]) {
    const kept = (value, half, side) => Math.min(Math.max(value, half + kGap), side - half - kGap);
    return [kept(x, width / 2, this.width), kept(y, height / 2, this.height)];
  }
}

/** The middles of a label of `size` beside a mark at x, y, the best one first. */
export const places_beside = ([x, y], radius, [width, height]) => kAway.flatMap((away) =>
  kSides.map(([east, south]) => {
    // Beside the mark a label is only a little higher or lower, and not at its corner.
    const up = east === 0 ? radius + away : away / 2;
    return [x + east * (radius + away + width / 2), y + south * (up + height / 2)];
  }));
