// SPDX-License-Identifier: Apache-2.0
#include <altiplan/constraint.hpp>
#include <altiplan/plugin.hpp>
#include <altiplan/shape.hpp>

namespace {
using namespace altiplan;

struct Params {
  std::array<double, 2> at_m{0, 0};
  double radius_m = 1000;
  double min_m = 300;

  void describe(Fields& f) {
    f("at_m", at_m).unit("m").required().doc("centre of the village, east and north");
    f("radius_m", radius_m).unit("m").at_least(1).doc("radius of the quiet area");
    f("min_m", min_m).unit("m").doc("minimum height above sea level over the village");
  }
};

class QuietVillage final : public Constraint {
 public:
  explicit QuietVillage(const Params& params) : params_(params) {}

 private:
  // Called leg by leg by planners, pilots, smoothers and the judge.
  bool do_admits(const Motion& leg) const override {
    const Cylinder quiet{params_.at_m[0], params_.at_m[1], params_.radius_m - kLengthTolerance,
                         -kInfinity, params_.min_m - kLengthTolerance};
    return leg_distance(quiet, leg.from, leg.to) > 0;  // touching the limit is allowed
  }

  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Constraint, "quiet_village", QuietVillage, Params,
                "Keeps a minimum height over a village")
