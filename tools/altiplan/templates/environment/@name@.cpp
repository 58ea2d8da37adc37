// SPDX-License-Identifier: Apache-2.0
#include <altiplan/environment.hpp>
#include <altiplan/plugin.hpp>

namespace {
using namespace altiplan;

struct Params {
  std::array<double, 2> from_m{0, 0};
  std::array<double, 2> to_m{500, 200};
  int poles = 6;
  double radius_m = 20;
  double top_m = 150;

  void describe(Fields& f) {  // the only place that lists them
    f("from_m", from_m).unit("m").doc("position of the first pole, east and north");
    f("to_m", to_m).unit("m").doc("position of the last pole");
    f("poles", poles).range(2, 10000).doc("number of poles, at equal distances");
    f("radius_m", radius_m).unit("m").greater_than(0).doc("radius of a pole");
    f("top_m", top_m).unit("m").doc("height of the poles above sea level");
  }
};

class RowOfPoles final : public Environment {
 public:
  RowOfPoles(const Params& params, const Site&) : params_(params) {}

 private:
  Vec3 pole(int i) const {
    const Vec3 first(params_.from_m[0], params_.from_m[1], 0);
    const Vec3 last(params_.to_m[0], params_.to_m[1], 0);
    return first + double(i) / (params_.poles - 1) * (last - first);
  }

  // Distance to the nearest pole (m), negative inside. All other queries (blocked legs, grids,
  // nearby obstacles) have defaults based on this.
  double do_clearance(const Vec3& p) const override {
    double beside = kInfinity;
    for (int i = 0; i < params_.poles; ++i) {
      const Vec3 away = p - pole(i);
      beside = std::min(beside, std::hypot(away.x(), away.y()) - params_.radius_m);
    }
    const double above = p.z() - params_.top_m;
    return beside > 0 && above > 0 ? std::hypot(beside, above) : std::max(beside, above);
  }

  // Poles extend downwards without limit.
  Box do_bounds() const override {
    const Vec3 first = pole(0);
    const Vec3 last = pole(params_.poles - 1);
    const Vec3 beside(params_.radius_m, params_.radius_m, 0);
    Box box{first.cwiseMin(last) - beside, first.cwiseMax(last) + beside};
    box.min.z() = -kInfinity;
    box.max.z() = params_.top_m;
    return box;
  }

  // Without this override `altiplan view` draws the layer as cells, which is slower.
  std::optional<Drawing> do_drawing() const override {
    Drawing drawing;
    for (int i = 0; i < params_.poles; ++i) {
      const Cylinder upright{pole(i).x(), pole(i).y(), params_.radius_m, -kInfinity, params_.top_m};
      drawing.shapes.push_back({upright, Drawn::Role::obstacle, ""});
    }
    return drawing;
  }

  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Environment, "@name@", RowOfPoles, Params, "A row of upright poles")
