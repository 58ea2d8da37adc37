// SPDX-License-Identifier: Apache-2.0
#include <altiplan/constraint.hpp>
#include <altiplan/plugin.hpp>

namespace {
using namespace altiplan;

struct Params {
  std::array<double, 2> at_m{0, 0};
  double min_m = 300;

  void describe(Fields& f) {  // the only place that lists them
    f("at_m", at_m).unit("m").doc("the quiet place, east and north");
    f("min_m", min_m).unit("m").greater_than(0).doc("least horizontal distance from it");
  }
};

class QuietPlace final : public Constraint {
 public:
  explicit QuietPlace(const Params& params) : params_(params) {}

 private:
  // Asked leg by leg by planners, pilots, smoothers and the judge.
  bool do_admits(const Leg& leg) const override {
    const Vec3 way(leg.to.x() - leg.from.x(), leg.to.y() - leg.from.y(), 0);
    const Vec3 place(params_.at_m[0] - leg.from.x(), params_.at_m[1] - leg.from.y(), 0);
    const double along =
        way.isZero(0) ? 0.0 : std::clamp(place.dot(way) / way.squaredNorm(), 0.0, 1.0);
    return (place - along * way).norm() >= params_.min_m - kLengthTolerance;  // touching is free
  }

  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Constraint, "@name@", QuietPlace, Params, "Keeps away from a quiet place")
