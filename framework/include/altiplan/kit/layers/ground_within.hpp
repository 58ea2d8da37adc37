// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "altiplan/geometry.hpp"

/// \file Distance between a leg and the ground below it.
namespace altiplan::kit {

/// The ground over a rectangle around (x, y): at most `off` metres above or below the plane of
/// height z and slopes dx, dy, and nowhere above `top`, where it is truncated.
struct GroundPiece {
  double x, y, z;
  double dx, dy;
  double off;
  double top = kInfinity;
};

/// A position along a leg, as a fraction of it, a map position, and the distance between the two.
struct LegToPlane {
  double distance;
  double share;
  double x, y;
};

/// Minimum distance between the leg a–b and the piece's plane over the rectangle that extends
/// half_x, half_y to each side of the piece's centre.
ALTIPLAN_API LegToPlane leg_to_plane(const Vec3& a, const Vec3& b, const GroundPiece& piece,
                                     double half_x, double half_y);

/// Tests for ground nearer than a given distance to a leg that lies nowhere below it, or finds the
/// minimum distance, by branch and bound: rectangles are halved as long as they may change the
/// result by more than 1e-8 m.
class GroundWithin {
 public:
  enum class Until { found, nearest };
  GroundWithin(const Vec3& a, const Vec3& b, double distance, Until until = Until::found)
      : a_(a), b_(b), box_(leg_box(a, b)), distance_(distance), until_(until) {}

  bool found() const { return found_; }
  /// Distance of the nearest ground found, else the distance asked for.
  double distance() const { return distance_; }
  /// That ground's position, with Until::nearest; none if there is none so near.
  const std::optional<Vec3>& nearest() const { return nearest_; }
  /// Contains all ground near enough, horizontally.
  Box reach() const { return box_.grown(distance_); }

  /// True if the search continues, and ground no higher than `top` over the rectangle may be near
  /// enough.
  bool may_be_in(double x0, double y0, double x1, double y1, double top) const {
    return !found_ && at_least(x0, y0, x1, y1, top) < distance_;
  }

  /// Searches the rectangle; piece_of(x0, y0, x1, y1) is the ground over a rectangle within it,
  /// with the same centre.
  template <class PieceOf>
  void search(double x0, double y0, double x1, double y1, const PieceOf& piece_of) {
    const double half_x = (x1 - x0) / 2;
    const double half_y = (y1 - y0) / 2;
    GroundPiece piece = piece_of(x0, y0, x1, y1);
    double rise = std::abs(piece.dx) * half_x + std::abs(piece.dy) * half_y + piece.off;
    if (piece.z - rise >= piece.top) {
      piece = {piece.x, piece.y, piece.top, 0, 0, 0};
      rise = 0;
    }
    if (!may_be_in(x0, y0, x1, y1, std::min(piece.z + rise, piece.top))) {
      return;
    }
    if (std::min(above(a_, piece), above(b_, piece)) - piece.off >= distance_ &&
        piece.z + rise <= piece.top) {
      return;
    }
    const LegToPlane found = leg_to_plane(a_, b_, piece, half_x, half_y);
    double bound = found.distance - piece.off;
    if (piece.z + rise > piece.top) {  // truncated somewhere
      const GroundPiece flat{piece.x, piece.y, piece.top, 0, 0, 0};
      bound = std::min(bound, leg_to_plane(a_, b_, flat, half_x, half_y).distance);
    }
    if (bound >= distance_) {
      return;
    }
    const auto way_to = [&](double x, double y) {
      const GroundPiece there = piece_of(x, y, x, y);
      return Vec3(a_ + found.share * (b_ - a_) - Vec3(x, y, std::min(there.z, there.top)));
    };
    Vec3 way = way_to(found.x, found.y);
    if (piece.z + rise > piece.top && way.squaredNorm() > 0) {
      // The edge of the truncation lies up or down the plane, and may be nearer.
      const double slope2 = piece.dx * piece.dx + piece.dy * piece.dy;
      const double below =
          piece.top - piece.z - piece.dx * (found.x - piece.x) - piece.dy * (found.y - piece.y);
      const double run = slope2 > 0 ? below / slope2 : 0;
      const Vec3 to_edge = way_to(std::clamp(found.x + run * piece.dx, x0, x1),
                                  std::clamp(found.y + run * piece.dy, y0, y1));
      way = to_edge.squaredNorm() < way.squaredNorm() ? to_edge : way;
      bound = std::max(bound, apart(off_the_leg(way, found.share), piece, half_x, half_y));
    }
    const double here = way.norm();
    const bool is_smallest = std::max(half_x, half_y) < kSmallest;
    if (until_ == Until::nearest) {
      if (here < distance_) {
        distance_ = here;
        nearest_ = a_ + found.share * (b_ - a_) - way;
      }
    } else {
      found_ = here < distance_ + kFine || is_smallest;
    }
    if (found_ || is_smallest || bound >= distance_ - kFine) {
      return;
    }
    search_halves(x0, y0, x1, y1, piece, found, piece_of);
  }

 private:
  static constexpr double kFine = 1e-8;
  static constexpr double kSmallest = 1e-5;

  /// Splits the longer edge; the half with the point found comes first.
  template <class PieceOf>
  void search_halves(double x0, double y0, double x1, double y1, const GroundPiece& piece,
                     const LegToPlane& found, const PieceOf& piece_of) {
    const bool east = found.x > piece.x;
    const bool north = found.y > piece.y;
    if (x1 - x0 > y1 - y0) {
      search(east ? piece.x : x0, y0, east ? x1 : piece.x, y1, piece_of);
      search(east ? x0 : piece.x, y0, east ? piece.x : x1, y1, piece_of);
    } else {
      search(x0, north ? piece.y : y0, x1, north ? y1 : piece.y, piece_of);
      search(x0, north ? y0 : piece.y, x1, north ? piece.y : y1, piece_of);
    }
  }

  /// Signed distance of the point above the piece's plane.
  static double above(const Vec3& p, const GroundPiece& piece) {
    return (p.z() - piece.z - piece.dx * (p.x() - piece.x) - piece.dy * (p.y() - piece.y)) /
           std::sqrt(1 + piece.dx * piece.dx + piece.dy * piece.dy);
  }

  /// The unit vector toward the leg there, rotated if a small rotation suffices so that no other
  /// point of the leg lies farther back along it.
  Vec3 off_the_leg(const Vec3& way, double share) const {
    const Vec3 leg = b_ - a_;
    const double along = way.dot(leg);
    const bool is_end = (share <= 0 && along >= 0) || (share >= 1 && along <= 0);
    const Vec3 across = is_end ? way : Vec3(way - along / leg.squaredNorm() * leg);
    return across.squaredNorm() > 0 ? Vec3(across.normalized()) : Vec3(way.normalized());
  }

  /// Separation of the leg and a truncated piece along the unit vector n: the piece lies below its
  /// plane and below its top. Near the edge of the truncation, where neither of them comes near the
  /// ground, this is the only usable bound.
  double apart(const Vec3& n, const GroundPiece& piece, double half_x, double half_y) const {
    const double slope2 = piece.dx * piece.dx + piece.dy * piece.dy;
    const double uphill = -(n.x() * piece.dx + n.y() * piece.dy);
    // n = of_plane (-dx, -dy, 1) + of_top (0, 0, 1) + a horizontal remainder.
    const double of_plane = slope2 > 0 ? std::clamp(uphill / slope2, 0.0, std::max(n.z(), 0.0)) : 0;
    const double of_top = n.z() - of_plane;
    if (of_top < 0) {
      return 0;
    }
    const double rest_x = n.x() + of_plane * piece.dx;
    const double rest_y = n.y() + of_plane * piece.dy;
    const double of_piece =
        of_plane * (piece.z + piece.off - piece.dx * piece.x - piece.dy * piece.y) +
        of_top * piece.top + rest_x * piece.x + rest_y * piece.y + std::abs(rest_x) * half_x +
        std::abs(rest_y) * half_y;
    return std::min(n.dot(a_), n.dot(b_)) - of_piece;
  }

  double at_least(double x0, double y0, double x1, double y1, double top) const {
    const double dx = std::max({x0 - box_.max.x(), box_.min.x() - x1, 0.0});
    const double dy = std::max({y0 - box_.max.y(), box_.min.y() - y1, 0.0});
    const double dz = std::max(box_.min.z() - top, 0.0);
    return std::sqrt(dx * dx + dy * dy + dz * dz);
  }

  Vec3 a_, b_;
  Box box_;
  double distance_;
  Until until_;
  std::optional<Vec3> nearest_;
  bool found_ = false;
};
}  // namespace altiplan::kit
