// SPDX-License-Identifier: Apache-2.0
#include <altiplan/environment.hpp>
#include <altiplan/plugin.hpp>

namespace {
using namespace altiplan;

struct Params {
  std::vector<std::array<double, 2>> towers_m;
  double top_m = 60;
  double half_width_m = 15;

  void describe(Fields& f) {
    f("towers_m", towers_m)
        .unit("m")
        .min_items(2)
        .required()
        .doc("towers in order, east and north");
    f("top_m", top_m).unit("m").doc("height of the highest wire above sea level");
    f("half_width_m", half_width_m).unit("m").at_least(0).doc("half the width of the line");
  }
};

/// A fence from tower to tower, solid below its top.
class PowerLine final : public Environment {
 public:
  PowerLine(const Params& params, const Site&) : params_(params) {}

 private:
  // Distance to the fence (m), negative inside. All other queries (blocked legs, grids, nearby
  // obstacles) have defaults based on this.
  double do_clearance(const Vec3& p) const override {
    double beside = kInfinity;
    for (std::size_t i = 0; i + 1 < params_.towers_m.size(); ++i) {
      const Vec3 a(params_.towers_m[i][0], params_.towers_m[i][1], 0);
      const Vec3 span = Vec3(params_.towers_m[i + 1][0], params_.towers_m[i + 1][1], 0) - a;
      const Vec3 flat = Vec3(p.x(), p.y(), 0) - a;
      const double along =
          span.isZero() ? 0.0 : std::clamp(flat.dot(span) / span.squaredNorm(), 0.0, 1.0);
      beside = std::min(beside, (flat - along * span).norm() - params_.half_width_m);
    }
    const double above = p.z() - params_.top_m;
    return beside > 0 && above > 0 ? std::hypot(beside, above) : std::max(beside, above);
  }

  Box do_bounds() const override {
    Box box{{kInfinity, kInfinity, -kInfinity}, {-kInfinity, -kInfinity, params_.top_m}};
    for (const auto& tower : params_.towers_m) {
      for (const int axis : {0, 1}) {
        box.min[axis] = std::min(box.min[axis], tower[std::size_t(axis)] - params_.half_width_m);
        box.max[axis] = std::max(box.max[axis], tower[std::size_t(axis)] + params_.half_width_m);
      }
    }
    return box;
  }

  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Environment, "power_line", PowerLine, Params, "Power lines between their towers")
