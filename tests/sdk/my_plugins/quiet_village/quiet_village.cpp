// SPDX-License-Identifier: Apache-2.0
#include <altiplan/constraint.hpp>
#include <altiplan/plugin.hpp>

namespace {
using namespace altiplan;

struct Params {
  std::array<double, 2> at_m{0, 0};
  double radius_m = 1000;
  double min_m = 300;

  void describe(Fields& f) {
    f("at_m", at_m).unit("m").required().doc("centre of the village, east and north");
    f("radius_m", radius_m).unit("m").greater_than(0).doc("radius of the quiet area");
    f("min_m", min_m).unit("m").doc("minimum height above sea level over the village");
  }
};

class QuietVillage final : public Constraint {
 public:
  explicit QuietVillage(const Params& params) : params_(params) {}

 private:
  /// Minimum height of the leg over the village: at an end of the part inside the circle, since the
  /// leg is straight. Infinite if no part is inside.
  double lowest_over(const Vec3& from, const Vec3& to) const {
    const Vec3 flat(to.x() - from.x(), to.y() - from.y(), 0);
    const Vec3 away(from.x() - params_.at_m[0], from.y() - params_.at_m[1], 0);
    const double radius = params_.radius_m - kLengthTolerance;  // touching is free
    // |away + t flat|² < radius²
    const double a = flat.squaredNorm();
    const double b = away.dot(flat);
    const double c = away.squaredNorm() - radius * radius;
    double t0 = 0;
    double t1 = 1;
    if (a > 0) {
      const double root = std::sqrt(std::max(0.0, b * b - a * c));
      t0 = std::max(t0, (-b - root) / a);
      t1 = std::min(t1, (-b + root) / a);
    }
    if ((a == 0 && c >= 0) || t0 >= t1) {
      return kInfinity;
    }
    const double climb = to.z() - from.z();
    return from.z() + climb * (climb > 0 ? t0 : t1);
  }

  // Called leg by leg by planners, pilots, smoothers and the judge.
  bool do_admits(const Motion& leg) const override {
    return lowest_over(leg.from, leg.to) >= params_.min_m - kLengthTolerance;
  }

  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Constraint, "quiet_village", QuietVillage, Params,
                "Keeps a minimum height over a village")
