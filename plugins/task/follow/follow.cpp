// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "altiplan/environment.hpp"
#include "altiplan/error.hpp"
#include "altiplan/flown_route.hpp"
#include "altiplan/kit/over_ground.hpp"
#include "altiplan/plugin.hpp"
#include "altiplan/request.hpp"
#include "altiplan/task.hpp"
#include "altiplan/world.hpp"
#include "beside.hpp"

namespace altiplan::follow {
namespace {

using Corner = std::array<double, 2>;

struct Params {
  std::vector<Corner> line_m;
  std::vector<Corner> line_lonlat;
  std::vector<double> offsets_m{0};
  std::optional<double> above_ground_m;
  std::optional<double> height_m;
  double tolerance_m = 2;

  void describe(Fields& f) {
    f("line_m", line_m).unit("m").doc("corners [x, y] of the line, in order");
    f("line_lonlat", line_lonlat).unit("deg").doc("corners [longitude, latitude] instead");
    f("offsets_m", offsets_m)
        .unit("m")
        .min_items(1)
        .doc("one pass each, so far to the left of the line; negative: to its right");
    f("above_ground_m", above_ground_m).unit("m").doc("height of the passes above the ground");
    f("height_m", height_m).unit("m").doc("height above sea level instead");
    f("tolerance_m", tolerance_m)
        .unit("m")
        .greater_than(0)
        .doc("with above_ground_m: how far the height may be off it along a pass");
    f.check(line_m.empty() != line_lonlat.empty(), "expected either line_m or line_lonlat");
    f.check(std::max(line_m.size(), line_lonlat.size()) != 1, "expected two corners or more");
    f.check(above_ground_m.has_value() != height_m.has_value(),
            "expected either above_ground_m or height_m");
  }
};

class Follow final : public Task {
 public:
  Follow(const Params& params, const Site& site) : params_(params) {
    const Polyline line = corners(site);
    for (const double offset : params.offsets_m) {
      Polyline pass;
      try {
        pass = beside(line, offset);
      } catch (const Error& error) {
        throw ParameterError("offsets_m", error.what());
      }
      passes_.push_back(params_.height_m ? at_height(pass, *params_.height_m)
                                         : over_ground(pass, *site.before));
    }
    if (params_.above_ground_m) {
      world_ = *site.before;
    }
  }

 private:
  Polyline corners(const Site& site) const {
    const bool is_local = !params_.line_m.empty();
    Polyline line;
    for (const Corner& corner : is_local ? params_.line_m : params_.line_lonlat) {
      Point point;
      point.form = is_local ? Point::Form::metres : Point::Form::lonlat;
      point.at = {corner[0], corner[1], 0};
      point.has_height = true;
      const Vec3 p = site.resolve(point);
      if (line.empty() || (p - line.back()).head<2>().norm() > kLengthTolerance) {
        line.emplace_back(p.x(), p.y(), 0);
      }
    }
    if (line.size() < 2) {
      throw ParameterError(is_local ? "line_m" : "line_lonlat", "the line has no length");
    }
    return line;
  }

  static Polyline at_height(Polyline pass, double height) {
    for (Vec3& p : pass) {
      p.z() = height;
    }
    return pass;
  }

  Polyline over_ground(const Polyline& pass, const World& world) const {
    try {
      return kit::over_ground(pass, world, *params_.above_ground_m, params_.tolerance_m);
    } catch (const Error& error) {
      throw ParameterError("above_ground_m", error.what());
    }
  }

  Box do_bounds() const override {
    Box box = Box::empty();
    for (const Polyline& pass : passes_) {
      for (const Vec3& p : pass) {
        box = box.with(p);
      }
    }
    return box;
  }

  /// Waypoints between two points that keep the height above the ground.
  Polyline between(const Vec3& from, const Vec3& to) const {
    if (!params_.above_ground_m || (to - from).head<2>().norm() < kLengthTolerance) {
      return {};
    }
    const Polyline line = over_ground({from, to}, world_);
    return {line.begin() + 1, line.end() - 1};
  }

  /// Passes in their order, each from the end that is nearer; the first from the start's side.
  TaskOrder do_order(const Request& request, const TaskEnds& ends) const override {
    TaskOrder order;
    std::optional<Vec3> here = ends.start;
    for (Polyline pass : passes_) {
      if (here && (pass.back() - *here).norm() < (pass.front() - *here).norm()) {
        std::reverse(pass.begin(), pass.end());
      }
      Pass& next = order.passes.emplace_back();
      if (here) {
        next.join = between(*here, pass.front());
      }
      here = pass.back();
      next.points = std::move(pass);
    }
    if (ends.goal) {
      order.last_join = between(*here, *ends.goal);
    }
    order.status = PlanStatus::solved;
    order.time_s = flown_time(order.route(ends, request), request);
    return order;  // nothing is known of other orders: the bound stays 0
  }

  Params params_;
  std::vector<Polyline> passes_;
  World world_;  ///< with above_ground_m
};
}  // namespace
}  // namespace altiplan::follow

ALTIPLAN_PLUGIN(Task, "follow", altiplan::follow::Follow, altiplan::follow::Params,
                "flies along a line, beside it and at a height above the ground")
