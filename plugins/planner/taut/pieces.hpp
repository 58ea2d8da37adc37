// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "edges.hpp"

namespace altiplan::taut {

/// A piece of an edge, with the side that a route around the edge comes from; or a place without an
/// edge: start, goal, and corners where free cells meet.
struct Piece {
  Vec3 middle;
  double half = 0;             ///< of its length
  const Edge* edge = nullptr;  ///< null: a place
  bool turns_back = false;     ///< the route goes around the edge the other way
  double slope = 0;            ///< estimated: the cosine between the piece and a route over it

  int axis() const { return edge == nullptr ? 0 : edge->axis; }
  Vec3 at(double along) const {
    Vec3 p = middle;
    p[axis()] += along;
    return p;
  }
  Vec3 low() const { return at(-half); }
  Vec3 high() const { return at(half); }
};

/// Lengths that differ by less are equal (m).
constexpr double kTouch = 1e-9;

/// True if part of `other` lies where the route comes from (`before`) or goes to that is taut
/// around the edge of the piece: beside the closed cells, neither behind nor in front of them.
inline bool is_beside(const Piece& piece, const Piece& other, bool before) {
  if (piece.edge == nullptr) {
    return true;
  }
  for (int n = 0; n < 2; ++n) {
    const int axis = (piece.axis() + 1 + n) % 3;
    const double reach = other.axis() == axis ? other.half : 0;
    const double towards_closed =
        piece.edge->closed[std::size_t(n)] * (other.middle[axis] - piece.middle[axis]);
    const bool has_to_be = (before == piece.turns_back) == (n == 0);
    if (has_to_be ? towards_closed + reach < -kTouch : towards_closed - reach > kTouch) {
      return false;
    }
  }
  return true;
}

/// True if both lie on one line.
inline bool are_in_line(const Piece& s, const Piece& t) {
  if (s.edge == nullptr || t.edge == nullptr || s.axis() != t.axis()) {
    return false;
  }
  const int u = (s.axis() + 1) % 3;
  const int v = (s.axis() + 2) % 3;
  return s.middle[u] == t.middle[u] && s.middle[v] == t.middle[v];
}
inline bool holds_an_end(const Piece& piece) {
  const int axis = piece.axis();
  return piece.low()[axis] <= piece.edge->low[axis] + kTouch ||
         piece.high()[axis] >= piece.edge->high[axis] - kTouch;
}

/// True if a shortest route may lead straight from one to the other, whatever is between them. At a
/// bend inside an edge its angles with the edge are equal before and after: along the line of an
/// edge it comes from an end of one and goes to an end of one.
inline bool may_follow(const Piece& s, const Piece& t) {
  if (are_in_line(s, t) && !(holds_an_end(s) && holds_an_end(t))) {
    return false;
  }
  return is_beside(s, t, false) && is_beside(t, s, true);
}

/// The distance between two pieces, or less.
inline double apart(const Piece& s, const Piece& t) {
  double square = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double reach = (s.axis() == axis ? s.half : 0) + (t.axis() == axis ? t.half : 0);
    const double d = std::max(0.0, std::abs(s.middle[axis] - t.middle[axis]) - reach);
    square += d * d;
  }
  return std::sqrt(square);
}

/// A lower bound of what legs from a place x of one piece to a place y of another cost: their
/// length
/// + slope x - slope y, x and y from the middles on. Over a path slopes cancel out, whatever they
/// are; near the cosines of the shortest route they make its cost depend little on x and y.
struct LegCost {
  double cost;
  double leaves;   ///< cosine between s and the leg that costs about the minimum
  double arrives;  ///< the same at t
};

inline LegCost leg_cost(const Piece& s, const Piece& t) {
  // The place that costs the minimum while the other end stays.
  const auto best = [](double along, double square, double slope) {
    const double across = std::sqrt(std::max(0.0, square - along * along));
    return along - across * slope / std::sqrt(1 - slope * slope);
  };
  const int s_axis = s.axis();
  const int t_axis = t.axis();
  double x = 0;
  double y = 0;
  Vec3 leg = t.middle - s.middle;
  for (int pass = 0; pass < 2; ++pass) {
    if (s.half > 0) {
      leg[s_axis] += x;
      x = std::clamp(best(leg[s_axis], leg.squaredNorm(), s.slope), -s.half, s.half);
      leg[s_axis] -= x;
    }
    if (t.half > 0) {
      leg[t_axis] -= y;
      y = std::clamp(best(-leg[t_axis], leg.squaredNorm(), -t.slope), -t.half, t.half);
      leg[t_axis] += y;
    }
  }
  const double length = leg.norm();
  const double leaves = length > kTouch && s.half > 0 ? leg[s_axis] / length : 0;
  const double arrives = length > kTouch && t.half > 0 ? leg[t_axis] / length : 0;
  if (s.slope == 0 && t.slope == 0) {
    return {apart(s, t), leaves, arrives};
  }
  if (length <= kTouch) {
    return {-std::abs(s.slope) * s.half - std::abs(t.slope) * t.half, leaves, arrives};
  }
  // The cost is convex: nowhere below its tangent at x and y, whose minimum this is.
  const double by_x = s.slope - leaves;
  const double by_y = arrives - t.slope;
  const double cost = length + s.slope * x - t.slope * y - std::abs(by_x) * s.half - by_x * x -
                      std::abs(by_y) * t.half - by_y * y;
  return {cost, leaves, arrives};
}
}  // namespace altiplan::taut
