// SPDX-License-Identifier: Apache-2.0
// How sharply a route bends, in space.
//
// Citation: E. Heiden, L. Palmieri, L. Bruns, K. O. Arras, G. S. Sukhatme, S. Koenig: Bench-MR: a
//   motion planning benchmark for wheeled mobile robots. IEEE Robotics and Automation Letters 6(3),
//   2021, doi:10.1109/LRA.2021.3068913 (maximum and normalized curvature); J. W. Milnor: On the
//   total curvature of knots. Annals of Mathematics 52(2), 1950 (of polygons: the sum of their
//   exterior angles).
// Guarantees: maximum is 1 / min_radius_m of the metrics; mean is exact for corners, and turns in
//   still air.
// Deviations: the papers take the circle through three points of a path, which sees no bend where
//   it returns on itself. Here a corner has the curvature of the largest circle that touches both
//   legs within half of each.
#include <cmath>

#include "altiplan/kit/penalty/penalty_terms.hpp"
#include "altiplan/objective.hpp"
#include "altiplan/plugin.hpp"
#include "altiplan/request.hpp"

namespace {
using namespace altiplan;

struct Params {
  std::string of = "maximum";

  void describe(Fields& f) {
    f("of", of)
        .one_of({"maximum", "mean"})
        .doc("the greatest curvature, or the sum of all turns over the length");
  }
};

class Curvature final : public Objective {
 public:
  Curvature(const Params& params, const Site&) : is_mean_(params.of == "mean") {}

 private:
  std::vector<double> do_costs(const Route& route, const Request& request) const override {
    const bool on_the_spot = request.vehicle.turns_on_the_spot;
    const Route legs = without_repeats(route);
    double greatest = 0;
    double turned = 0;  // radians
    std::optional<Approach> before;
    Vec3 direction = Vec3::Zero();
    for (std::size_t i = 0; i < legs.leg_count(); ++i) {
      const Leg leg = legs.leg(i);
      if (leg.waits()) {
        continue;
      }
      if (before) {
        turned += kit::angle_between(direction, leg.track(0));
        if (!leg.turns() && !before->turning) {
          greatest = std::max(greatest, 1 / corner_radius(*before, leg.from, leg.to, on_the_spot));
        }
      }
      if (leg.turns()) {
        greatest = std::max(greatest, 1 / leg.radius);
        turned += std::abs(leg.turn) * leg.air_length() / leg.length();  // of a helix
      }
      before = onward(before, leg);
      direction = leg.track(1);
    }
    return {is_mean_ ? (turned > 0 ? turned / length(legs) : 0) : greatest};
  }

  /// A leg alone has no corner.
  double do_cost(const Leg&, double, const Request&) const override { return 0; }
  double do_bound(const Vec3&, const Vec3&, const Request&) const override { return 0; }
  std::string do_unit() const override { return "1/m"; }
  Traits do_traits() const override { return {.waypoints = true}; }

  bool is_mean_;
};
}  // namespace

ALTIPLAN_PLUGIN(Objective, "curvature", Curvature, Params, "Maximum or mean curvature of a route")
