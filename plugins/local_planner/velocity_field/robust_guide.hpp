// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "altiplan/request.hpp"
#include "field.hpp"

namespace velocity_field {

/// A straight leg, or an arc about `centre` where `sense` is +1 (to the left) or -1 (to the right).
struct GuidePiece {
  Vec2 from{0, 0};
  Vec2 to{0, 0};
  Vec2 centre{0, 0};
  double radius = 0;
  int sense = 0;
  double begins_m = 0;  ///< position on the whole guide
  double length_m = 0;
};

/// A line of legs and arcs with continuous direction; the virtual target moves along it ahead of
/// the vehicle.
class Guide {
 public:
  void add_leg(const Vec2& from, const Vec2& to);
  void add_arc(const Vec2& from, const Vec2& to, const Vec2& centre, int sense, double angle);

  bool empty() const { return pieces_.empty(); }
  double length_m() const;
  Vec2 at(double metres) const;
  /// Position along the guide of its point beside `p`, searched from `metres` on.
  double beside(const Vec2& p, double metres) const;
  std::span<const GuidePiece> pieces() const { return pieces_; }

 private:
  std::size_t piece_at(double metres) const;

  std::vector<GuidePiece> pieces_;
};

/// Start of a guide. With a course it begins with a turn, or none, from that course.
struct GuideStart {
  Vec2 at{0, 0};
  std::optional<Vec2> course;
  double turn_radius_m = 0;
};

/// Limits of a guide search; records if they were too low.
struct GuideEffort {
  altiplan::Budget budget;  ///< its deadline and its stop token
  bool given_up = false;
};

/// The shortest line from start to goal that enters none of the discs; empty if there is none, or
/// if the search was given up. With more than 200 discs it may be 2 % longer.
std::optional<Guide> shortest_guide(std::span<const Disc> discs, const GuideStart& start,
                                    const Vec2& goal, GuideEffort* effort = nullptr);

/// v rotated and scaled as x must be to become y.
inline Vec2 turned_as(const Vec2& v, const Vec2& x, const Vec2& y) {
  const Vec2 z = Vec2(x.dot(y), cross(x, y)) / x.squaredNorm();
  return z.x() * v + z.y() * left_of(v);
}
/// Square of the distance from p to the leg a-b.
inline double square_to_leg(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 ab = b - a;
  const double square = ab.squaredNorm();
  const double t = square > 0 ? std::clamp((p - a).dot(ab) / square, 0.0, 1.0) : 0;
  return (a + t * ab - p).squaredNorm();
}
}  // namespace velocity_field
