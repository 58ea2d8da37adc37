// SPDX-License-Identifier: Apache-2.0
#include <altiplan/constraint.hpp>
#include <altiplan/plugin.hpp>
#include <altiplan/shape.hpp>

namespace {
using namespace altiplan;

struct Params {
  std::array<double, 2> at_m{0, 0};
  double min_m = 300;

  void describe(Fields& f) {  // the only place that lists them
    f("at_m", at_m).unit("m").doc("centre of the quiet area, east and north");
    f("min_m", min_m).unit("m").greater_than(0).doc("minimum horizontal distance from the centre");
  }
};

class QuietPlace final : public Constraint {
 public:
  explicit QuietPlace(const Params& params) : params_(params) {}

 private:
  // Called leg by leg by planners, pilots, smoothers and the judge.
  bool do_admits(const Motion& leg) const override {
    // At all altitudes; a line between two points would be Prism{{from_m, to_m}}.
    const Cylinder place{params_.at_m[0], params_.at_m[1]};
    const double distance = leg_distance(place, leg.from, leg.to);
    return distance >= params_.min_m - kLengthTolerance;  // touching is allowed
  }

  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Constraint, "@name@", QuietPlace, Params,
                "Keeps a minimum distance from a quiet area")
