// SPDX-License-Identifier: Apache-2.0
#include "altiplan/energy.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "altiplan/flown_route.hpp"
#include "altiplan/kit/stated_power.hpp"
#include "altiplan/objective.hpp"
#include "altiplan/plugin.hpp"
#include "altiplan/request.hpp"

namespace {
using namespace altiplan;

using Params = kit::StatedPower;

/// Wh of flight; a whole route takes what stops and accelerations do as well.
class FlightEnergy final : public Objective {
 public:
  FlightEnergy(const Params& params, const Site& site) : power_(params.of(site.vehicle)) {
    least_w_ = params.power_w ? *params.power_w : least_watts(site.vehicle, *power_);
  }

 private:
  /// Of a copter in wind, times its fastest speed over the ground.
  static constexpr double kAirspeeds = 3;

  double do_cost(const Leg& leg, double time_s, const Request& request) const override {
    return leg_energy(leg, request.start.time_s + time_s, request, *power_);
  }

  std::vector<double> do_costs(const Route& route, const Request& request) const override {
    // No less than its legs alone, which bounds of searches count: what is slow may take less.
    return {std::max(legs_cost(route, request), flown_energy(route, request, *power_))};
  }

  /// The least power for the least time.
  double do_bound(const Vec3& from, const Vec3& to, const Request& request) const override {
    constexpr double kSecondsPerHour = 3600;
    return least_w_ * least_seconds(to - from, request) / kSecondsPerHour;
  }

  std::string do_unit() const override { return "Wh"; }
  /// The power depends on the density of the air, the time on obstacles and layers of wind.
  Traits do_traits() const override { return {.place = true, .heading = true}; }

  static double least_seconds(const Vec3& way, const Request& request) {
    const double climbs_s = request.vehicle.climb_time(way.z());
    const double wind = request.wind.max_speed();
    if (!request.vehicle.wing) {
      const double fast = request.vehicle.max_speed();
      const double length = request.vehicle.counted_m(way);
      return wind > (kAirspeeds - 1) * fast ? 0 : std::max(length / fast, climbs_s);
    }
    return std::max(way.head<2>().norm() / (request.air_speed() + wind), climbs_s);
  }

  /// Of flights at any airspeed that climb and sink as fast as they may: the least of a fine grid
  /// of them, less what lies between. 0 where a rate is not limited.
  static double least_watts(const Vehicle& vehicle, const Power& power) {
    constexpr int kSteps = 64;
    const int fastest_air = vehicle.wing ? kSteps : int(kAirspeeds * kSteps);
    constexpr double kBetween = 0.98;
    const double fast = vehicle.max_speed();
    const double up = vehicle.wing ? fast * std::tan(vehicle.wing->climb) : vehicle.climb_mps;
    const double down = vehicle.wing ? fast * std::tan(vehicle.wing->sink) : vehicle.sink_mps;
    if (!std::isfinite(up) || !std::isfinite(down)) {
      return 0;
    }
    double minimum = kInfinity;
    for (int i = vehicle.wing ? kSteps : 0; i <= fastest_air; ++i) {
      for (int k = 0; k <= kSteps; ++k) {
        for (const double height_m : {0.0, 9000.0}) {
          const double climb = -down + (up + down) * k / kSteps;
          minimum = std::min(minimum, power.watts({fast * i / kSteps, climb, 0, height_m}));
        }
      }
    }
    return std::isfinite(minimum) ? kBetween * minimum : 0;
  }

  std::shared_ptr<const Power> power_;
  double least_w_ = 0;
};
}  // namespace

ALTIPLAN_PLUGIN(Objective, "energy", FlightEnergy, Params,
                "Energy of the flight, by the vehicle's power, in Wh")
