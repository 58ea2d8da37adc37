// SPDX-License-Identifier: Apache-2.0
//
// The distance from a leg of the line is convex along a leg of the route: the part within a
// distance of it is an interval. A leg is kept if these intervals, of all legs of the line, cover
// it.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "altiplan/constraint.hpp"
#include "altiplan/environment.hpp"
#include "altiplan/error.hpp"
#include "altiplan/plugin.hpp"
#include "altiplan/request.hpp"

namespace altiplan::line_distance {
namespace {

using Corner = std::array<double, 2>;
using Plane = Eigen::Vector2d;

struct Params {
  std::vector<Corner> line_m;
  std::vector<Corner> line_lonlat;
  double within_m = 0;
  AppliesTo applies_to = AppliesTo::both;

  void describe(Fields& f) {
    f("line_m", line_m).unit("m").doc("corners [x, y] of the line, in order");
    f("line_lonlat", line_lonlat).unit("deg").doc("corners [longitude, latitude] instead");
    f("within_m", within_m)
        .unit("m")
        .greater_than(0)
        .at_most(1e6)
        .required()
        .doc("maximum horizontal distance between the route and the line");
    f("applies_to", applies_to,
      {{"both", AppliesTo::both}, {"route", AppliesTo::route}, {"track", AppliesTo::track}})
        .doc(
            "what it restricts: a smaller value for the route than for the track leaves a margin "
            "for the flight");
    f.check(line_m.empty() != line_lonlat.empty(), "expected either line_m or line_lonlat");
    f.check(std::max(line_m.size(), line_lonlat.size()) != 1, "expected two corners or more");
  }
};

/// Shares of a leg; none where `from` is above `to`.
struct Interval {
  double from = kInfinity;
  double to = -kInfinity;

  void add(const Interval& other) {
    if (other.from <= other.to) {
      from = std::min(from, other.from);
      to = std::max(to, other.to);
    }
  }
};

/// Where begin + t * slope lies between two values.
Interval between(double begin, double slope, double low, double high) {
  if (slope == 0) {
    return begin >= low && begin <= high ? Interval{0, 1} : Interval{};
  }
  const double a = (low - begin) / slope;
  const double b = (high - begin) / slope;
  return {std::min(a, b), std::max(a, b)};
}

/// Where the leg is within a distance of a point.
Interval near_point(const Plane& from, const Plane& way, const Plane& point, double distance) {
  const Plane off = from - point;
  const double a = way.squaredNorm();
  const double b = off.dot(way);
  const double c = off.squaredNorm() - distance * distance;
  if (a == 0) {
    return c <= 0 ? Interval{0, 1} : Interval{};
  }
  const double square = b * b - a * c;
  if (square < 0) {
    return {};
  }
  const double root = std::sqrt(square);
  return {(-b - root) / a, (-b + root) / a};
}

/// Where the leg is within a distance of a leg of the line: near its ends, or beside it.
Interval near_leg(const Plane& from, const Plane& way, const Plane& a, const Plane& b,
                  double distance) {
  const double length = (b - a).norm();
  const Plane along = (b - a) / length;
  const Plane aside(-along.y(), along.x());
  const Interval across = between((from - a).dot(aside), way.dot(aside), -distance, distance);
  const Interval abreast = between((from - a).dot(along), way.dot(along), 0, length);
  Interval all{std::max(across.from, abreast.from), std::min(across.to, abreast.to)};
  all = all.from <= all.to ? all : Interval{};
  all.add(near_point(from, way, a, distance));
  all.add(near_point(from, way, b, distance));
  return all;
}

class LineDistance final : public Constraint {
 public:
  LineDistance(const Params& params, const Site& site)
      : params_(params), limit_(params.within_m + kLengthTolerance) {
    const bool is_local = !params.line_m.empty();
    for (const Corner& corner : is_local ? params.line_m : params.line_lonlat) {
      Point point;
      point.form = is_local ? Point::Form::metres : Point::Form::lonlat;
      point.at = {corner[0], corner[1], 0};
      point.has_height = true;
      const Plane p = site.resolve(point).head<2>();
      if (line_.empty() || (p - line_.back()).norm() > kLengthTolerance) {
        line_.push_back(p);
      }
    }
    if (line_.size() < 2) {
      throw ParameterError(is_local ? "line_m" : "line_lonlat", "the line has no length");
    }
  }

 private:
  AppliesTo do_applies_to() const override { return params_.applies_to; }

  bool do_admits(const Motion& leg) const override {
    return is_finite(leg.from) && is_finite(leg.to) && first_gap(leg.from, leg.to).from >= 1;
  }

  /// The first part of a leg that is too far from the line; from 1 on: none.
  Interval first_gap(const Vec3& a, const Vec3& b) const {
    const Plane from = a.head<2>();
    const Plane way = (b - a).head<2>();
    std::vector<Interval> near;
    for (std::size_t i = 1; i < line_.size(); ++i) {
      if (const Interval part = near_leg(from, way, line_[i - 1], line_[i], limit_);
          part.from <= part.to && part.to >= 0) {
        near.push_back(part);
      }
    }
    std::sort(near.begin(), near.end(),
              [](const Interval& p, const Interval& q) { return p.from < q.from; });
    double kept = 0;  // all before it is near the line
    for (const Interval& part : near) {
      if (part.from > kept) {
        return {kept, std::min(part.from, 1.0)};
      }
      kept = std::max(kept, part.to);
    }
    // A leg that ends within rounding of what is near does so within the tolerance.
    return near.empty() ? Interval{0, 1} : Interval{kept, 1};
  }

  double distance(const Vec3& p) const {
    double nearest = kInfinity;
    for (std::size_t i = 1; i < line_.size(); ++i) {
      const auto flat = [](const Plane& q) { return Vec3(q.x(), q.y(), 0); };
      nearest = std::min(nearest,
                         point_leg_distance({p.x(), p.y(), 0}, flat(line_[i - 1]), flat(line_[i])));
    }
    return nearest;
  }

  /// do_admits refuses legs; this adds where, and by how much: of the first place of each refused
  /// leg that is too far, and its ends, the farthest.
  std::vector<Violation> do_violations(const Polyline& route, const Request&) const override {
    Violation worst;
    for (std::size_t i = 0; i + 1 < route.size(); ++i) {
      const Interval gap = first_gap(route[i], route[i + 1]);
      if (gap.from >= 1) {
        continue;
      }
      const Vec3 way = route[i + 1] - route[i];
      for (const Vec3& at :
           {Vec3(route[i] + (gap.from + gap.to) / 2 * way), route[i], route[i + 1]}) {
        if (const double away = distance(at); away > std::max(worst.value, limit_)) {
          worst = {"", i, away, params_.within_m, sentence(at, away), "", "m"};
        }
      }
    }
    return worst.message.empty() ? std::vector<Violation>{} : std::vector{worst};
  }

  std::string sentence(const Vec3& at, double away) const {
    char text[200];
    std::snprintf(text, sizeof text,
                  "at (%.1f, %.1f, %.1f) the route is %.2f m from the line; at most %.2f m are "
                  "permitted",
                  at.x(), at.y(), at.z(), away, params_.within_m);
    return text;
  }

  Params params_;
  double limit_;  ///< with the tolerance of the judge
  std::vector<Plane> line_;
};
}  // namespace
}  // namespace altiplan::line_distance

ALTIPLAN_PLUGIN(Constraint, "line_distance", altiplan::line_distance::LineDistance,
                altiplan::line_distance::Params,
                "Keeps the route within a horizontal distance of a line, such as a corridor's")
