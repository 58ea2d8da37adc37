// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "altiplan/environment.hpp"
#include "altiplan/ground.hpp"
#include "altiplan/kit/layers/field_within.hpp"
#include "altiplan/kit/layers/ground.hpp"
#include "altiplan/kit/layers/ground_body.hpp"

namespace altiplan::kit {

/// The posts of an elevation model, all in memory: the simplest model of a FieldLayer.
class ALTIPLAN_API WholeField {
 public:
  /// Throws Error for a void: each position over the posts must have ground.
  explicit WholeField(HeightField field);
  const HeightField& field() const { return field_; }
  const Box& bounds() const { return bounds_; }
  const HeightField& over(const Box&) const { return field_; }
  const HeightField& over(const Vec3&) const { return field_; }
  double to_edge(const Vec3&) const { return kInfinity; }

 private:
  HeightField field_;
  Box bounds_;
};

/// Ground from an elevation model without voids. Heights apply at the posts and are bilinear
/// between them; the solid is the volume below, between the posts. Beyond them nothing is known,
/// and nothing blocked.
///
/// The slope bounds every result: if it is at most s within a distance d of a point at height v
/// above its ground, the ground is at least min(d, v / sqrt(1 + s²)) away. A point beyond the
/// posts, at distance e from them, is at least hypot(e, c) from the ground, c the same bound for
/// the nearest position above the posts: from there any other one is seen at no less than a right
/// angle.
///
/// `Model` has what WholeField has: field(), posts that may be a part of the whole; over(box) and
/// over(p), a field that contains all posts within and around them; bounds() of the whole, its
/// heights left open; to_edge(p), the horizontal distance to the edge of the part in field(),
/// infinite if that is the whole.
template <class Model>
class FieldLayer : public Environment, public Ground {
 public:
  /// The arguments after the radius (m) of the vehicle are those of the model.
  template <class... Arguments>
  explicit FieldLayer(double vehicle_radius, Arguments&&... arguments)
      : model_(std::forward<Arguments>(arguments)...),
        vehicle_radius_(vehicle_radius),
        bounds_(model_.bounds()) {}
  const Model& model() const { return model_; }

 private:
  /// The nearest position over the posts, at the same height.
  Vec3 over_posts(const Vec3& p) const { return p.cwiseMax(bounds_.min).cwiseMin(bounds_.max); }
  /// Horizontal distance to the edge of the posts, for a position above them.
  double to_edge(const Vec3& p) const {
    return (p - bounds_.min).cwiseMin(bounds_.max - p).head<2>().minCoeff();
  }
  /// Ground height at the nearest position that has ground.
  double ground_near(const HeightField& field, double x, double y) const {
    return *field.at(std::clamp(x, bounds_.min.x(), bounds_.max.x()),
                     std::clamp(y, bounds_.min.y(), bounds_.max.y()));
  }

  Box do_bounds() const override { return bounds_; }
  const Ground* do_ground() const override { return this; }
  bool do_is_all() const override { return true; }
  std::optional<double> do_height(double x, double y) const override {
    return model_.over(Vec3(x, y, 0)).at(x, y);
  }
  double do_gap(const Vec3& a, const Vec3& b, double enough) const override {
    return model_.over(leg_box(a, b)).gap(a, b, enough);
  }
  double do_gap_max(const Vec3& a, const Vec3& b) const override {
    return model_.over(leg_box(a, b)).gap_max(a, b);
  }
  const HeightField* do_height_field() const override { return &model_.field(); }
  double do_slope(const Box& box) const override {
    return model_.field().void_posts() > 0 ? kInfinity : slope_within(model_.over(box), box);
  }

  double do_clearance(const Vec3& p) const override {
    const Vec3 q = over_posts(p);
    const HeightField& field = model_.over(q);
    const double above =
        std::max((q.z() - ground_near(field, q.x(), q.y())) / std::hypot(1, field.max_slope()),
                 q.z() - field.max_height());
    const double beyond = (p - q).norm();
    const double clearance = beyond > 0   ? std::hypot(beyond, std::max(above, 0.0))
                             : above >= 0 ? above
                                          : std::max(above, -to_edge(p));
    // Slope and height are those of the part that was read, or of the whole: neither is trusted
    // beyond the distance at which they change over.
    const double known = model_.to_edge(p);
    return std::clamp(clearance, -known, known);
  }

  bool do_blocked(const Vec3& a, const Vec3& b, double r) const override {
    const HeightField& field = model_.over(leg_box(a, b).grown(std::max(r, 0.0)));
    if (std::min(a.z(), b.z()) - field.max_height() >= r - kLengthTolerance) {
      return false;
    }
    // Divides the leg into parts that lie over the posts or beyond one side or corner of them.
    std::array<double, 6> at{0, 1, 1, 1, 1, 1};
    int count = 1;
    for (int axis = 0; axis < 2; ++axis) {
      for (const double side : {bounds_.min[axis], bounds_.max[axis]}) {
        const double t = (side - a[axis]) / (b[axis] - a[axis]);
        if (t > 0 && t < 1) {
          at[std::size_t(count++)] = t;
        }
      }
    }
    std::sort(at.begin(), at.end());
    for (int n = 0; n < count; ++n) {
      const double t0 = at[std::size_t(n)];
      const double t1 = at[std::size_t(n) + 1];
      const Vec3 from = t0 > 0 ? Vec3(a + t0 * (b - a)) : a;
      const Vec3 to = n + 1 < count ? Vec3(a + t1 * (b - a)) : b;
      const Vec3 middle = (from + to) / 2;
      const bool over = bounds_.contains(middle) && to_edge(middle) > 0;
      if (over ? too_low(field, over_posts(from), over_posts(to), r)
               : too_near(field, from, to, r)) {
        return true;
      }
    }
    return false;
  }

  bool do_meets(const SweptVolume& volume) const override {
    const Box box = volume.box().intersected(bounds_);
    return !box.is_empty() && meets_ground(volume, model_.over(box));
  }

  /// True if a leg over the posts is too near to the ground below it.
  bool too_low(const HeightField& field, const Vec3& a, const Vec3& b, double r) const {
    const auto gap = [&](const Vec3& from, const Vec3& to, double enough) {
      return field.gap(from, to, enough);
    };
    const auto slope = [&](const Vec3& from, const Vec3& to, double within) {
      return slope_near(field, from, to, within);
    };
    const double keep = r - kLengthTolerance;
    const double enough = height_for(keep, field.max_slope());
    const auto low = part_below(a, b, field.max_height() + keep);
    if (!low || field.gap(low->first, low->second, enough) >= enough) {
      return false;
    }
    // From here on only the ground near the leg counts.
    const auto meets = [&](const Vec3& from, const Vec3& to, double within) {
      GroundWithin ground(from, to, within);
      search_field(ground, field);
      return ground.found();
    };
    return too_near_ground(a, b, r, {top_near(field, a, b, r), enough},
                           std::max(field.spacing()[0], field.spacing()[1]), gap, slope, meets);
  }

  /// True if a leg beyond one side or corner of the posts is too near to their edge or the ground
  /// behind it: by the bound above, halving the leg where that is in doubt.
  bool too_near(const HeightField& field, const Vec3& a, const Vec3& b, double r) const {
    const double keep = r - kLengthTolerance;
    const Vec3 from = over_posts(a);
    const Vec3 to = over_posts(b);
    // The minimum horizontal distance to the posts, exactly beyond a side or from a corner.
    const Vec3 flat(1, 1, 0);
    const double beyond = from.head<2>() == to.head<2>()
                              ? point_leg_distance(from.cwiseProduct(flat), a.cwiseProduct(flat),
                                                   b.cwiseProduct(flat))
                              : (a - from).cwiseAbs().cwiseMin((b - to).cwiseAbs()).norm();
    if (beyond >= keep) {
      return false;
    }
    const double top = top_near(field, from, to, r);
    const double steepness = std::hypot(1, slope_near(field, from, to, r));
    // Lower bound of the depth of the ground below a position at that height above it and above sea
    // level.
    const auto above = [&](double height, double z) {
      return std::max({height / steepness, z - top, 0.0});
    };
    if (std::hypot(beyond, above(field.gap(from, to), std::min(a.z(), b.z()))) >= keep) {
      return false;
    }
    const auto is_hit = [&](const Vec3& p, const Vec3& q) {
      return std::hypot((p - q).norm(), above(p.z() - ground_near(field, q.x(), q.y()), p.z())) <
             keep;
    };
    if (is_hit(a, from) || is_hit(b, to) || (b - a).norm() <= kInDoubt / 2) {
      return true;
    }
    const Vec3 middle = (a + b) / 2;
    return too_near(field, a, middle, r) || too_near(field, middle, b, r);
  }

  static double slope_within(const HeightField& field, const Box& box) {
    return field.max_slope(box.min.x(), box.min.y(), box.max.x(), box.max.y());
  }
  static double slope_near(const HeightField& field, const Vec3& a, const Vec3& b, double within) {
    return slope_within(field, leg_box(a, b).grown(within));
  }

  /// Highest ground within a horizontal distance of the leg, or slightly farther.
  double top_near(const HeightField& field, const Vec3& a, const Vec3& b, double within) const {
    const Box box = leg_box(a, b).grown(std::max(within, 0.0)).intersected(bounds_);
    return field.max_height(box.min.x(), box.min.y(), box.max.x(), box.max.y());
  }

  void do_near(const Vec3& p, double reach, const NearSink& sink) const override {
    const Vec3 over = over_posts(p);
    const double beyond = (p - over).norm();
    const double gap = p.z() - ground_near(model_.over(over), over.x(), over.y());
    if (gap <= kLengthTolerance) {
      if (beyond > 0) {  // beside the edge
        if (beyond <= reach) {
          sink({over, beyond, (p - over) / beyond, 0});
        }
        return;
      }
      // The way out is up; the depth is a lower bound, as clearance requires.
      sink({{p.x(), p.y(), p.z() - gap}, do_clearance(p), {0, 0, 1}, 0});
      return;
    }
    // No ground is nearer than the ground below.
    const HeightField& field = model_.over(Box{over, over}.grown(std::hypot(beyond, gap)));
    if (std::hypot(beyond, std::max(p.z() - field.max_height(), 0.0)) > reach) {
      return;
    }
    const auto ground = [&](double x, double y) {
      const double height = ground_near(field, x, y);
      return beyond > 0 ? std::min(height, p.z()) : height;  // higher ground is met at its edge
    };
    const auto highest = [&](double x0, double y0, double x1, double y1) {
      return field.max_height(x0, y0, x1, y1);
    };
    const NearestGround nearest(p, bounds_, ground, highest);
    if (nearest.distance() <= reach) {
      sink({nearest.point(), nearest.distance(), (p - nearest.point()) / nearest.distance(), 0});
    }
  }

  void do_rasterize(VoxelGrid& grid) const override {
    rasterize_ground(grid, [this](double x0, double y0, double x1, double y1) {
      const Box part = Box{{x0, y0, 0}, {x1, y1, 0}}.intersected(bounds_);
      return part.is_empty() ? -kInfinity
                             : model_.over(part).max_height(part.min.x(), part.min.y(),
                                                            part.max.x(), part.max.y());
    });
  }

  // The slope bound may reject a sphere of the vehicle's size although the ground is slightly
  // farther away than its radius.
  double do_over_approximation() const override {
    return vehicle_radius_ * (std::hypot(1, model_.field().max_slope()) - 1) + kInDoubt;
  }

  std::optional<Drawing> do_drawing() const override { return Drawing{}; }

  static constexpr double kInDoubt =
      1e-4;  ///< metres: legs below this length are not halved further

  Model model_;
  double vehicle_radius_;
  Box bounds_;
};
}  // namespace altiplan::kit
