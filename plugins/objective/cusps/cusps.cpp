// SPDX-License-Identifier: Apache-2.0
// The number of corners of a route that turn sharply, seen from above.
//
// Citation: E. Heiden, L. Palmieri, L. Bruns, K. O. Arras, G. S. Sukhatme, S. Koenig: Bench-MR: a
//   motion planning benchmark for wheeled mobile robots. IEEE Robotics and Automation Letters 6(3),
//   2021, doi:10.1109/LRA.2021.3068913; its program counts changes of heading by more than 60°.
// Deviations: counted at the waypoints of the route, which is not sampled; turns have no corner.
#include "altiplan/objective.hpp"
#include "altiplan/plugin.hpp"
#include "altiplan/request.hpp"

namespace {
using namespace altiplan;

struct Params {
  double above_deg = 60;

  void describe(Fields& f) {
    f("above_deg", above_deg)
        .unit("deg")
        .range(0, 180)
        .doc("corners that turn by more than this, seen from above, are cusps");
  }
};

class Cusps final : public Objective {
 public:
  Cusps(const Params& params, const Site&) : above_deg_(params.above_deg) {}

 private:
  std::vector<double> do_costs(const Route& route, const Request& request) const override {
    const Route legs = without_repeats(route);
    double cusps = 0;
    std::optional<Approach> before;
    for (std::size_t i = 0; i < legs.leg_count(); ++i) {
      const Leg leg = legs.leg(i);
      if (leg.waits()) {
        continue;
      }
      const double turn = before ? horizontal_turn(*before, leg.from, leg.from + leg.track(0),
                                                   request.vehicle.turns_on_the_spot)
                                 : 0;
      cusps += degrees(turn) > above_deg_ + kTolerance ? 1 : 0;
      before = onward(before, leg);
    }
    return {cusps};
  }

  /// A leg alone has no corner.
  double do_cost(const Leg&, double, const Request&) const override { return 0; }
  double do_bound(const Vec3&, const Vec3&, const Request&) const override { return 0; }
  std::string do_unit() const override { return ""; }
  Traits do_traits() const override { return {.waypoints = true}; }

  static constexpr double kTolerance = 1e-6;  // degrees, of rounding
  double above_deg_;
};
}  // namespace

ALTIPLAN_PLUGIN(Objective, "cusps", Cusps, Params,
                "Number of corners of a route that turn sharply, seen from above")
