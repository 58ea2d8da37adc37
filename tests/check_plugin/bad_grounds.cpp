// SPDX-License-Identifier: Apache-2.0
// Grounds broken on purpose, one thing each.
#include <algorithm>
#include <cmath>

#include "altiplan/ground.hpp"
#include "altiplan/height_field.hpp"
#include "misdeeds.hpp"

namespace {
using namespace altiplan;
using namespace altiplan::bad;

/// Which answer about the ground is wrong.
enum class Flaw { none, distance, ground, gap, gap_max, enough, slope, steepest, holes, air, edge };

/// A small model of posts, solid below; nothing is wrong with it.
class SoundGround final : public Environment, public Ground {
 public:
  SoundGround() : field_({0, 0}, {50, 50}, 9, 8, heights()) {}

 private:
  static std::vector<float> heights() {
    RandomStream random(3);
    std::vector<float> all(72);
    for (float& height : all) {
      height = float(random.uniform(0, 60));
    }
    return all;
  }
  Box do_bounds() const override { return {{0, 0, -kInfinity}, {400, 350, 60}}; }
  double do_clearance(const Vec3& p) const override {
    const double x = std::clamp(p.x(), 0.0, 400.0);
    const double y = std::clamp(p.y(), 0.0, 350.0);
    const double inside = std::min({p.x(), 400 - p.x(), p.y(), 350 - p.y()});
    const double beside = inside < 0 ? std::hypot(p.x() - x, p.y() - y) : -inside;
    const double above = (p.z() - *field_.at(x, y)) / std::hypot(1, field_.max_slope());
    return std::max(above, beside);
  }
  const Ground* do_ground() const override { return this; }
  std::optional<double> do_height(double x, double y) const override { return field_.at(x, y); }
  double do_gap(const Vec3& a, const Vec3& b, double) const override { return field_.gap(a, b); }
  double do_gap_max(const Vec3& a, const Vec3& b) const override { return field_.gap_max(a, b); }
  double do_slope(const Box&) const override { return field_.max_slope(); }
  const HeightField* do_height_field() const override { return &field_; }

  HeightField field_;
};

template <Flaw kFlaw>
class SpoiltGround final : public Environment, public Ground {
 public:
  SpoiltGround(const NoParams&, const Site&) {}

 private:
  Box do_bounds() const override { return sound_.bounds(); }
  double do_clearance(const Vec3& p) const override { return sound_.clearance(p); }
  bool do_blocked(const Vec3& a, const Vec3& b, double r) const override {
    if (kFlaw == Flaw::holes && is_beyond(a, b)) {
      return true;
    }
    // The slack of legs would reach beyond the ground.
    return a == b ? kFlaw != Flaw::air && sound_.clearance(a) < r - kLengthTolerance
                  : sound_.blocked(a, b, r);
  }
  const Ground* do_ground() const override { return this; }
  std::optional<double> do_height(double x, double y) const override {
    const auto at = sound_.height(x, y);
    return at && kFlaw == Flaw::ground ? std::optional(*at + 1e-3) : at;
  }
  double do_gap(const Vec3& a, const Vec3& b, double enough) const override {
    const bool beyond = is_beyond(a, b);
    const double gap = sound_.gap(a, b);
    return kFlaw == Flaw::edge && beyond             ? 0
           : kFlaw == Flaw::gap && a != b && !beyond ? std::min(sound_.gap(a, a), sound_.gap(b, b))
           : kFlaw == Flaw::enough && enough < kInfinity ? std::max(enough, gap)
                                                         : gap;
  }
  double do_gap_max(const Vec3& a, const Vec3& b) const override {
    return kFlaw == Flaw::gap_max && a != b ? sound_.gap_max(a, a) : sound_.gap_max(a, b);
  }
  double do_slope(const Box& box) const override {
    const bool small = (box.max - box.min).head<2>().maxCoeff() < 0.01;
    return sound_.slope(box) * (kFlaw == Flaw::slope && !small     ? 0.2
                                : kFlaw == Flaw::steepest && small ? 0.5
                                                                   : 1);
  }
  bool do_is_all() const override { return kFlaw == Flaw::distance; }
  std::optional<double> do_distance(const Vec3& a, const Vec3& b) const override {
    return kFlaw == Flaw::distance ? std::optional(sound_.gap(a, b)) : std::nullopt;
  }
  const HeightField* do_height_field() const override { return sound_.height_field(); }

  bool is_beyond(const Vec3& a, const Vec3& b) const {
    return !sound_.height(a.x(), a.y()) || !sound_.height(b.x(), b.y());
  }

  SoundGround sound_;
};
}  // namespace

ALTIPLAN_PLUGIN(Environment, "sound_ground", SpoiltGround<Flaw::none>, NoParams,
                "nothing is wrong with it")
ALTIPLAN_PLUGIN(Environment, "ground_above", SpoiltGround<Flaw::ground>, NoParams,
                "its ground is 1 mm higher than its height field")
ALTIPLAN_PLUGIN(Environment, "ground_between", SpoiltGround<Flaw::gap>, NoParams,
                "does not look at the ground between the ends of a leg")
ALTIPLAN_PLUGIN(Environment, "ground_at_one_end", SpoiltGround<Flaw::gap_max>, NoParams,
                "says a leg's height at its begin to be the greatest")
ALTIPLAN_PLUGIN(Environment, "ground_enough", SpoiltGround<Flaw::enough>, NoParams,
                "says that a leg is as high as is enough")
ALTIPLAN_PLUGIN(Environment, "ground_flat", SpoiltGround<Flaw::slope>, NoParams,
                "says that large boxes of its ground are flatter than they are")
ALTIPLAN_PLUGIN(Environment, "ground_flat_in_small", SpoiltGround<Flaw::steepest>, NoParams,
                "says that small boxes of its ground are flatter than they are")
ALTIPLAN_PLUGIN(Environment, "ground_straight_below", SpoiltGround<Flaw::distance>, NoParams,
                "says a leg's height to be its distance")
ALTIPLAN_PLUGIN(Environment, "ground_with_holes", SpoiltGround<Flaw::holes>, NoParams,
                "blocks legs beyond its ground")
ALTIPLAN_PLUGIN(Environment, "ground_of_air", SpoiltGround<Flaw::air>, NoParams,
                "blocks no point below its ground")
ALTIPLAN_PLUGIN(Environment, "ground_beyond_its_edge", SpoiltGround<Flaw::edge>, NoParams,
                "says how high legs are beyond its ground")
