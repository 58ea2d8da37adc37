// SPDX-License-Identifier: Apache-2.0
//
// The hills of paper 002, given peak by peak or generated from a seed:
//   alt(x, y) = min(cap, base + Σ h exp(-((x - x0)/sx)²/2 - ((y - y0)/sy)²/2)).
// A smooth surface: every result is certified by bounds of its first and second derivatives, not by
// sampling.
#include <algorithm>
#include <cmath>
#include <optional>

#include "altiplan/environment.hpp"
#include "altiplan/ground.hpp"
#include "altiplan/kit/layers/ground.hpp"
#include "altiplan/kit/layers/ground_body.hpp"
#include "altiplan/kit/layers/ground_within.hpp"
#include "altiplan/plugin.hpp"
#include "altiplan/world.hpp"
#include "surface.hpp"

namespace {
using namespace altiplan;

struct PeakParams {
  std::array<double, 2> at_m{0, 0};
  double height_m = 1000;
  std::array<double, 2> sigma_m{5000, 5000};

  void describe(Fields& f) {
    f("at_m", at_m).unit("m").doc("position of the peak").required();
    f("height_m", height_m)
        .unit("m")
        .at_least(0)
        .doc("height of the peak itself, above base_m")
        .required();
    f("sigma_m", sigma_m)
        .unit("m")
        .at_least(1)
        .doc("standard deviations east and north, where the peak is at 0.61 of its height")
        .required();
  }
};

struct Params {
  double base_m = 500;
  double cap_m = 4000;
  std::vector<PeakParams> peaks;
  std::optional<int> count;
  std::optional<std::int64_t> seed;
  double extent_m = 100000;

  void describe(Fields& f) {
    f("base_m", base_m).unit("m").doc("height of the ground far from all peaks");
    f("cap_m", cap_m).unit("m").doc("maximum height of the ground; higher parts become a plateau");
    f("peaks", peaks).doc("the peaks; if omitted, they are generated");
    f("count", count).range(1, 1000).doc("number of generated peaks (default: 16)");
    f("seed", seed).at_least(0).doc("random seed of the peaks; default: the run's seed");
    f("extent_m", extent_m)
        .unit("m")
        .at_least(100)
        .doc(
            "side of the square, from the origin, in which peaks are generated; their widths "
            "scale with it");
    f.check(peaks.empty() || (!count && !seed), "give either peaks, or count and seed");
    f.check(cap_m > base_m, "cap_m must be greater than base_m");
  }
};

/// The published generator; all peaks are regenerated while the start or goal is not above ground.
/// Zones over them are left to the judge: they do not depend on the peaks, and regenerating does
/// not help.
hills::Surface draw(const Params& params, const Site& site) {
  RandomStream of_run = site.random;
  SplitMix64 random(params.seed ? std::uint64_t(*params.seed) : of_run());
  const double unit = params.extent_m / 100;
  constexpr double kHeightUnit = 100;  // metres
  constexpr int kDraws = 10000;
  for (int n = 0; n < kDraws; ++n) {
    std::vector<hills::Peak> peaks(std::size_t(params.count.value_or(16)));
    for (hills::Peak& peak : peaks) {
      peak.x = random.integer(5, 95) * unit;
      peak.y = random.integer(5, 95) * unit;
      peak.height = random.integer(10, 38) * kHeightUnit;
      peak.sx = random.integer(3, 8) * unit;
      peak.sy = random.integer(3, 8) * unit;
    }
    const auto covers = [&](const std::optional<Vec3>& p) {
      return p &&
             std::min(params.cap_m, params.base_m + hills::bells(peaks, p->x(), p->y())) >= p->z();
    };
    if (!covers(site.start) && !covers(site.goal)) {
      return hills::Surface(params.base_m, params.cap_m, std::move(peaks));
    }
  }
  throw Error("hills: the ground covers the start or the goal in all " + std::to_string(kDraws) +
              " attempts; expected a start and goal above base_m, and not too many peaks");
}

hills::Surface make(const Params& params, const Site& site) {
  if (params.peaks.empty()) {
    return draw(params, site);
  }
  std::vector<hills::Peak> peaks;
  for (const PeakParams& p : params.peaks) {
    peaks.push_back({p.at_m[0], p.at_m[1], p.height_m, p.sigma_m[0], p.sigma_m[1]});
  }
  return hills::Surface(params.base_m, params.cap_m, std::move(peaks));
}

class Hills final : public Environment, public Ground {
 public:
  Hills(const Params& params, const Site& site) : surface_(make(params, site)) {
    const std::size_t count =
        params.peaks.empty() ? std::size_t(params.count.value_or(16)) : params.peaks.size();
    info_.notes = {std::to_string(count) + " peaks, steepest slope " +
                   std::to_string(degrees(std::atan(surface_.max_slope()))) + " degrees"};
  }

 private:
  // The ground is unbounded; a scenario specifies how much of it is flown over (volume).
  Box do_bounds() const override {
    return {{-kInfinity, -kInfinity, -kInfinity}, {kInfinity, kInfinity, surface_.top()}};
  }
  const Ground* do_ground() const override { return this; }
  bool do_is_all() const override { return true; }
  std::optional<double> do_height(double x, double y) const override {
    return surface_.height(x, y);
  }
  double do_gap(const Vec3& a, const Vec3& b, double enough) const override {
    return surface_.gap(a, b, enough);
  }
  double do_slope(const Box& box) const override {
    const Vec3 half = (box.max - box.min) / 2;
    if (box.is_empty() || !(half.head<2>().norm() < kInfinity)) {
      return surface_.max_slope();
    }
    const Vec3 middle = box.min + half;
    return surface_.max_slope(middle.x(), middle.y(), half.head<2>().norm());
  }
  double do_gap_max(const Vec3& a, const Vec3& b) const override { return surface_.gap_max(a, b); }

  double do_clearance(const Vec3& p) const override {
    const double above = p.z() - surface_.height(p.x(), p.y());
    return std::max(above / std::hypot(1, surface_.max_slope()), p.z() - surface_.top());
  }

  /// The steepest slope within that distance of a leg.
  double slope_near(const Vec3& a, const Vec3& b, double within) const {
    const Vec3 middle = (a + b) / 2;
    const double half = std::hypot(b.x() - a.x(), b.y() - a.y()) / 2;
    return surface_.max_slope(middle.x(), middle.y(), half + within);
  }

  kit::GroundWithin searched(const Vec3& a, const Vec3& b, double distance,
                             kit::GroundWithin::Until until) const {
    const Box box = leg_box(a, b).grown(distance);
    kit::GroundWithin ground(a, b, distance, until);
    ground.search(box.min.x(), box.min.y(), box.max.x(), box.max.y(),
                  [this](double x0, double y0, double x1, double y1) {
                    return surface_.piece(x0, y0, x1, y1);
                  });
    return ground;
  }

  bool do_blocked(const Vec3& a, const Vec3& b, double r) const override {
    if (std::min(a.z(), b.z()) - surface_.top() >= r - kLengthTolerance) {
      return false;
    }
    const auto gap = [&](const Vec3& from, const Vec3& to, double enough) {
      return surface_.gap(from, to, enough, r - kLengthTolerance);
    };
    const auto slope = [&](const Vec3& from, const Vec3& to, double within) {
      return slope_near(from, to, within);
    };
    const auto meets = [&](const Vec3& from, const Vec3& to, double keep) {
      return searched(from, to, keep, kit::GroundWithin::Until::found).found();
    };
    const double enough = kit::height_for(r - kLengthTolerance, surface_.max_slope());
    return kit::too_near_ground(a, b, r, {surface_.top(), enough}, kShortest, gap, slope, meets);
  }

  bool do_meets(const SweptVolume& volume) const override {
    const Box& box = volume.box();
    return box.min.z() <= surface_.top() &&
           kit::meets_ground(volume, box.min.x(), box.min.y(), box.max.x(), box.max.y(),
                             [this](double x0, double y0, double x1, double y1) {
                               return surface_.piece(x0, y0, x1, y1);
                             });
  }

  std::optional<double> do_distance(const Vec3& a, const Vec3& b) const override {
    const auto gap = [&](const Vec3& from, const Vec3& to) {
      return surface_.gap(from, to, kInfinity);
    };
    const auto slope = [&](const Vec3& from, const Vec3& to, double within) {
      return slope_near(from, to, within);
    };
    const auto nearest = [&](const Vec3& from, const Vec3& to, double minimum) {
      return searched(from, to, minimum, kit::GroundWithin::Until::nearest).distance();
    };
    return kit::ground_distance(a, b, kInfinity, surface_.top(), kShortest, gap, slope, nearest);
  }

  void do_near(const Vec3& p, double reach, const NearSink& sink) const override {
    if (p.z() - surface_.top() > reach) {
      return;
    }
    const double gap = p.z() - surface_.height(p.x(), p.y());
    if (gap <= kLengthTolerance) {
      // The way out is up; the depth is a lower bound, as clearance requires.
      sink({{p.x(), p.y(), p.z() - gap}, do_clearance(p), {0, 0, 1}, 0});
      return;
    }
    if (gap > kit::height_for(reach, surface_.max_slope(p.x(), p.y(), reach))) {
      return;  // no slope within reach rises that far
    }
    const auto ground = [&](double x, double y) { return surface_.height(x, y); };
    const auto highest = [&](double x0, double y0, double x1, double y1) {
      return surface_.height_bound(x0, y0, x1, y1);
    };
    const kit::NearestGround nearest(p, Box{}, ground, highest);
    if (nearest.distance() <= reach) {
      sink({nearest.point(), nearest.distance(), (p - nearest.point()) / nearest.distance(), 0});
    }
  }

  void do_rasterize(VoxelGrid& grid) const override {
    const GridSpec& spec = grid.spec();
    const Vec3 first = spec.centre({0, 0, 0});
    const auto half = kit::half_footprint(spec);
    const auto top =
        surface_.highest({first.x(), spec.cell.x(), half[0], spec.counts[0]},
                         {first.y(), spec.cell.y(), half[1], spec.counts[1]}, spec.cell.z() / 50);
    kit::block_below(grid, [&](int i, int j) {
      return top[std::size_t(j) * std::size_t(spec.counts[0]) + std::size_t(i)];
    });
  }

  // The search near the edge of the plateau ends there.
  double do_over_approximation() const override { return 1e-5; }

  std::optional<Drawing> do_drawing() const override { return Drawing{}; }
  const LayerInfo& do_info() const override { return info_; }

  static constexpr double kShortest = 1;  // metres of a leg, below which it is searched undivided

  hills::Surface surface_;
  LayerInfo info_;
};
}  // namespace

ALTIPLAN_PLUGIN(Environment, "hills", Hills, Params,
                "smooth hills, peak by peak or generated from a seed (paper 002)")
