// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "altiplan/objective.hpp"
#include "altiplan/plugin.hpp"
#include "altiplan/request.hpp"

namespace {
using namespace altiplan;

/// The integral of the height above sea level along a leg; below sea level it counts as 0.
class Altitude final : public Objective {
 public:
  Altitude(const NoParams&, const Site&) {}

 private:
  double do_cost(const Leg& leg, double, const Request&) const override {
    if (!leg.turns()) {
      return leg.length() * mean_height(leg.from.z(), leg.to.z());
    }
    // Speed over the ground varies with the wind along a turn, not the rate of climb: chords.
    const std::vector<Vec3> points = leg.chords(kTolerance);
    double sum = 0;
    for (std::size_t i = 1; i < points.size(); ++i) {
      sum += (points[i] - points[i - 1]).norm() * mean_height(points[i - 1].z(), points[i].z());
    }
    return sum;
  }

  /// No route is lower than the volume, and one that changes its height flies at least as far.
  double do_bound(const Vec3& from, const Vec3& to, const Request& request) const override {
    const double floor = std::min({request.volume.min.z(), from.z(), to.z()});
    const double low = std::max(0.0, from.z());
    const double high = std::max(0.0, to.z());
    return std::max(std::max(0.0, floor) * (to - from).norm(),
                    std::abs(high * high - low * low) / 2);
  }

  std::string do_unit() const override { return "m²"; }
  Traits do_traits() const override { return {}; }

  /// Mean of max(0, z) over a straight line between two heights.
  static double mean_height(double a, double b) {
    const auto [low, high] = std::minmax(a, b);
    if (low >= 0 || high <= 0) {
      return std::max(0.0, (low + high) / 2);
    }
    return high * high / (2 * (high - low));
  }

  static constexpr double kTolerance = 1e-4;  // of chords, metres
};
}  // namespace

ALTIPLAN_PLUGIN(Objective, "altitude", Altitude, NoParams,
                "Height above sea level, integrated along the route")
