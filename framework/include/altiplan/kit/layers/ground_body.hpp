// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "altiplan/height_field.hpp"
#include "altiplan/kit/layers/ground_within.hpp"
#include "altiplan/swept_volume.hpp"

/// \file Bodies and the ground below them.
namespace altiplan::kit {

/// True if the volume meets what lies below the piece's plane, moved up by `up`, in the rectangle
/// that extends half_x, half_y to each side of the piece's centre.
ALTIPLAN_API bool meets_below(const SweptVolume& volume, const GroundPiece& piece, double half_x,
                              double half_y, double up);

/// True if the volume shares a point with the ground over the rectangle, or reaches below it.
/// piece_of(x0, y0, x1, y1) is the ground over a rectangle within it, with the same centre; its
/// `off` is to fall with the square of the rectangle's size.
template <class PieceOf>
bool meets_ground(const SweptVolume& volume, double x0, double y0, double x1, double y1,
                  const PieceOf& piece_of) {
  const Box& box = volume.box();
  if (x0 > box.max.x() || x1 < box.min.x() || y0 > box.max.y() || y1 < box.min.y()) {
    return false;
  }
  const GroundPiece piece = piece_of(x0, y0, x1, y1);
  const double half_x = (x1 - x0) / 2;
  const double half_y = (y1 - y0) / 2;
  if (!meets_below(volume, piece, half_x, half_y, piece.off)) {
    return false;
  }
  if (piece.off <= kBodyTolerance / 2 || meets_below(volume, piece, half_x, half_y, -piece.off)) {
    return true;
  }
  const double x = piece.x;
  const double y = piece.y;
  return meets_ground(volume, x0, y0, x, y, piece_of) ||
         meets_ground(volume, x, y0, x1, y, piece_of) ||
         meets_ground(volume, x0, y, x, y1, piece_of) ||
         meets_ground(volume, x, y, x1, y1, piece_of);
}

/// The same over all posts of an elevation model.
ALTIPLAN_API bool meets_ground(const SweptVolume& volume, const HeightField& field);
}  // namespace altiplan::kit
