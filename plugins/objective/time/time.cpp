// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "altiplan/flown_route.hpp"
#include "altiplan/measures.hpp"
#include "altiplan/objective.hpp"
#include "altiplan/plugin.hpp"
#include "altiplan/request.hpp"

namespace {
using namespace altiplan;

struct Params {
  std::optional<double> above_m;

  void describe(Fields& f) {
    f("above_m", above_m)
        .unit("m")
        .doc("only time above this height counts, above sea level; default: all");
  }
};

/// Seconds of flight at the vehicle's speeds in the wind; a whole route takes what its stops and
/// accelerations do as well.
class FlightTime final : public Objective {
 public:
  FlightTime(const Params& params, const Site&) : params_(params) {}

 private:
  double do_cost(const Leg& leg, double after_s, const Request& request) const override {
    const double time_s = request.start.time_s + after_s;
    if (leg.waits()) {
      return leg.hold_s * share_above(leg.from.z(), leg.to.z());
    }
    if (request.vehicle.wing) {
      // Along a turn the rate of climb is constant, along a straight leg in each layer of wind.
      return leg.turns()
                 ? leg_duration(leg, time_s, request) * share_above(leg.from.z(), leg.to.z())
                 : above(leg.from, leg.to, time_s, request);
    }
    const std::vector<Vec3> points =
        leg.turns() ? leg.chords(kTolerance) : std::vector<Vec3>{leg.from, leg.to};
    double sum = 0;
    for (std::size_t i = 1; i < points.size(); ++i) {
      sum += above(points[i - 1], points[i], time_s, request);
    }
    return sum;
  }

  std::vector<double> do_costs(const Route& route, const Request& request) const override {
    if (request.vehicle.wing || !request.vehicle.acceleration.takes_time()) {
      return {legs_cost(route, request)};
    }
    double seconds = 0;
    fly(route, request, [&](const FlownPhase& phase) { seconds += above(phase); });
    return {seconds};
  }

  /// Seconds of a phase above the height.
  double above(const FlownPhase& phase) const {
    const double share = share_above(phase.from.z(), phase.to.z());
    if (share == 0 || share == 1) {
      return share * phase.seconds;
    }
    // The share of the way to the crossing, and that of the time.
    const bool sinks = phase.from.z() > phase.to.z();
    const double way = sinks ? share : 1 - share;
    const double v = phase.from_mps;
    const double change = phase.to_mps - v;
    const double square = v * v + change * way * (v + phase.to_mps);
    const double time = change == 0 ? way : (std::sqrt(square) - v) / change;
    return (sinks ? time : 1 - time) * phase.seconds;
  }

  /// As fast as ever possible: straight, or down to the height where no time counts and up again.
  double do_bound(const Vec3& from, const Vec3& to, const Request& request) const override {
    const Vec3 way = to - from;
    if (request.vehicle.wing) {  // by its airspeed, which is level: going down takes it no time
      const double fastest = request.air_speed() + request.wind.max_speed();
      return params_.above_m
                 ? 0
                 : std::max(way.head<2>().norm() / fastest, request.vehicle.climb_time(way.z()));
    }
    const Vehicle& vehicle = request.vehicle;
    const double fastest = vehicle.max_speed();
    const double straight_s = vehicle.counted_m(way) / fastest;
    if (!params_.above_m) {
      return std::max(straight_s, vehicle.climb_time(way.z()));
    }
    const double down = std::max(0.0, from.z() - *params_.above_m);
    const double up = std::max(0.0, to.z() - *params_.above_m);
    return std::min(straight_s, vehicle.has_rates()
                                    ? vehicle.climb_time(-down) + vehicle.climb_time(up)
                                    : (down + up) / fastest);
  }

  std::string do_unit() const override { return "s"; }
  /// Near obstacles, and in layers of wind, the speed depends on the place.
  Traits do_traits() const override { return {.place = true, .heading = true}; }

  /// Seconds of a straight leg that begins at a time, or of its part above the height.
  double above(const Vec3& a, const Vec3& b, double time_s, const Request& request) const {
    const double share = share_above(a.z(), b.z());
    if (share == 0) {
      return 0;
    }
    if (share == 1) {
      return leg_duration(Leg::straight(a, b), time_s, request);
    }
    if (a.z() > b.z()) {
      return leg_duration(Leg::straight(a, a + share * (b - a)), time_s, request);
    }
    const Vec3 crossing = b + share * (a - b);
    const double below_s = leg_duration(Leg::straight(a, crossing), time_s, request);
    return leg_duration(Leg::straight(crossing, b), time_s + below_s, request);
  }

  /// Of a change of height at a constant rate, the part that counts.
  double share_above(double from, double to) const {
    const auto [low, high] = std::minmax(from, to);
    if (!params_.above_m) {
      return 1;
    }
    if (high <= *params_.above_m) {
      return 0;
    }
    return low >= *params_.above_m ? 1 : (high - *params_.above_m) / (high - low);
  }

  static constexpr double kTolerance = 1e-4;  // of chords, metres
  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Objective, "time", FlightTime, Params,
                "Time of flight at the vehicle's speeds in the wind, or of its part above a height")
