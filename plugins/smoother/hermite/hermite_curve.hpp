// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <optional>
#include <vector>

#include "altiplan/route.hpp"

/// \file The curve itself; symbols of hermite.cpp.
namespace altiplan {

enum class Tangents { parabola, chord };

/// The part of a leg between two nodes.
struct Span {
  double from, to;                 ///< metres along the leg
  std::optional<Vec3> bend_first;  ///< empty if it leaves along the leg
  std::optional<Vec3> bend_last;   ///< empty if it arrives along the leg
  bool straight() const { return !bend_first && !bend_last; }
};

/// A curve through waypoints. Leg i leads from waypoint i to the next one. Each waypoint is either
/// rounded or left sharp, with straight legs in and out.
class HermiteCurve {
 public:
  /// The waypoints must contain no consecutive duplicates. Initially every corner is rounded,
  /// except those of legs that reverse direction, and no node is inserted.
  HermiteCurve(Polyline waypoints, Tangents tangents)
      : p_(std::move(waypoints)), tangents_(tangents), corners_(p_.size()) {
    for (std::size_t i = 0; i + 1 < p_.size(); ++i) {
      const Vec3 leg = p_[i + 1] - p_[i];
      lengths_.push_back(leg.norm());
      d_.push_back(leg / lengths_.back());
      const double turn = i == 0 ? 0 : turn_angle_in_space(d_[i - 1], d_[i]);
      turns_ += turn > kAngleTolerance ? 1 : 0;
      if (turn > kAngleTolerance && turn < kPi - kAngleTolerance) {
        corners_[i] = {lengths_[i - 1], lengths_[i], true};
      }
    }
  }

  const Polyline& waypoints() const { return p_; }
  std::size_t legs() const { return d_.size(); }
  double length(std::size_t leg) const { return lengths_[leg]; }
  bool rounded(std::size_t waypoint) const { return corners_[waypoint].rounded; }
  /// Number of corners, and of rounded ones.
  std::int64_t turns() const { return turns_; }
  std::int64_t rounded() const {
    return std::count_if(corners_.begin(), corners_.end(),
                         [](const Corner& c) { return c.rounded; });
  }

  /// Halves the bend of the leg at one of its ends: inserts a node, or moves it half way to the
  /// corner. If it would get shorter than `minimum`, the corner is left sharp. False if nothing
  /// bends it.
  bool halve(std::size_t leg, std::size_t corner, double minimum) {
    if (!rounded(corner)) {
      return false;
    }
    double& reach = corner == leg ? corners_[corner].behind : corners_[corner].before;
    const double half = reach / 2;
    if (half < minimum) {
      straighten(corner);
    } else if (reach == lengths_[leg]) {
      corners_[leg].behind = corners_[leg + 1].before = half;
    } else {
      reach = half;
    }
    return true;
  }
  void straighten(std::size_t corner) { corners_[corner].rounded = false; }

  std::vector<Span> spans(std::size_t leg) const {
    const double all = lengths_[leg];
    const std::optional<Vec3> first = bend(leg, leg);
    const std::optional<Vec3> last = bend(leg, leg + 1);
    const double to = first ? corners_[leg].behind : 0;
    const double from = all - (last ? corners_[leg + 1].before : 0);
    if (to == all || from == 0) {
      return {{0, all, first, last}};
    }
    std::vector<Span> spans;
    if (first) {
      spans.push_back({0, to, first, {}});
    }
    if (to < from) {
      spans.push_back({to, from, {}, {}});
    }
    if (last) {
      spans.push_back({from, all, {}, last});
    }
    return spans;
  }

  /// Point of a span at t in [0, 1]: its position on the leg, offset by the bends.
  Vec3 at(std::size_t leg, const Span& span, double t) const {
    if (t == 1 && span.to == lengths_[leg]) {
      return p_[leg + 1];
    }
    const double h = span.to - span.from;
    Vec3 p = p_[leg] + (span.from + t * h) * d_[leg];
    if (span.bend_first) {
      p += h * t * (1 - t) * (1 - t) * *span.bend_first;
    }
    if (span.bend_last) {
      p -= h * t * t * (1 - t) * *span.bend_last;
    }
    return p;
  }

  /// Radius of curvature at the same point.
  double radius_at(std::size_t leg, const Span& span, double t) const {
    const Vec3 first = span.bend_first.value_or(Vec3::Zero());
    const Vec3 last = span.bend_last.value_or(Vec3::Zero());
    const Vec3 velocity = d_[leg] + (1 - t) * (1 - 3 * t) * first - t * (2 - 3 * t) * last;
    const Vec3 acceleration = ((6 * t - 4) * first + (6 * t - 2) * last) / (span.to - span.from);
    return std::pow(velocity.norm(), 3) / velocity.cross(acceleration).norm();
  }

 private:
  struct Corner {
    double before = 0;  ///< a: metres back to the next node
    double behind = 0;  ///< b: metres on to the next node
    bool rounded = false;
  };

  /// m - d at one end of a leg.
  std::optional<Vec3> bend(std::size_t leg, std::size_t corner) const {
    const auto& [a, b, is_rounded] = corners_[corner];
    if (!is_rounded) {
      return std::nullopt;
    }
    const Vec3& into = d_[corner - 1];
    const Vec3& out_of = d_[corner];
    const Vec3 m = tangents_ == Tangents::parabola ? Vec3((b * into + a * out_of) / (a + b))
                                                   : Vec3((a * into + b * out_of) / (a + b));
    return m - d_[leg];
  }

  Polyline p_;
  Tangents tangents_;
  std::vector<Corner> corners_;  ///< of all waypoints
  std::vector<double> lengths_;  ///< of legs
  std::vector<Vec3> d_;          ///< of legs
  std::int64_t turns_ = 0;
};

/// Measures of the curve.
struct CurveShape {
  std::int64_t spans = 0;
  std::int64_t straight = 0;      ///< number of straight spans
  std::int64_t inserted = 0;      ///< nodes that are not waypoints
  double step = 0;                ///< the longest leg of a divided bent span, metres
  double min_radius = kInfinity;  ///< of the curve itself

  /// `pieces` gives the number of legs into which a span is divided.
  template <class Pieces>
  CurveShape(const HermiteCurve& curve, const Pieces& pieces) {
    for (std::size_t i = 0; i < curve.legs(); ++i) {
      const std::vector<Span> all = curve.spans(i);
      spans += std::int64_t(all.size());
      inserted += std::int64_t(all.size()) - 1;
      for (const Span& span : all) {
        straight += span.straight() ? 1 : 0;
        if (!span.straight()) {
          add_bent(curve, i, span, pieces(span));
        }
      }
    }
  }

 private:
  void add_bent(const HermiteCurve& curve, std::size_t leg, const Span& span, int pieces) {
    for (int k = 0; k < pieces; ++k) {
      const Vec3 from = curve.at(leg, span, double(k) / pieces);
      step = std::max(step, (curve.at(leg, span, double(k + 1) / pieces) - from).norm());
    }
    constexpr int kPlaces = 64;  // regardless of the samples
    for (int k = 0; k <= kPlaces; ++k) {
      min_radius = std::min(min_radius, curve.radius_at(leg, span, double(k) / kPlaces));
    }
  }
};
}  // namespace altiplan
