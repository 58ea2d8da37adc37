// SPDX-License-Identifier: Apache-2.0
// Layers that lie or throw, one with cells of its own, a ball, and constraints of every sort.
#include <stdexcept>

#include "altiplan/constraint.hpp"
#include "altiplan/environment.hpp"
#include "altiplan/plugin.hpp"

namespace {
using namespace altiplan;

struct LayerParams {
  std::string does = "lies";
  void describe(Fields& f) { f("does", does).one_of({"lies", "throws", "refuses"}).doc("what"); }
};

/// Says that all is far away, and that it is solid from x = 500 m to 800 m.
class Liar final : public Environment {
 public:
  Liar(const LayerParams& params, const Site&) : params_(params) {
    if (params.does == "refuses") {
      throw std::runtime_error("the map is blank");
    }
  }

 private:
  Box do_bounds() const override { return {{0, 0, 0}, {1000, 1000, 1000}}; }
  double do_clearance(const Vec3&) const override { return 900; }
  bool do_blocked(const Vec3& a, const Vec3& b, double r) const override {
    if (params_.does == "throws") {
      throw std::runtime_error("the map is torn");
    }
    return r == 0 && a == b && a.x() > 500 && a.x() < 800;
  }
  LayerParams params_;
};

/// Cells of 100 m, all free at first; solid where told, by the default walk along the clearance.
class Cells final : public Environment {
 public:
  Cells(const NoParams&, const Site&) {
    spec_.cell = {100, 100, 100};
    spec_.counts = {10, 10, 10};
    spec_.rule = GridSpec::Rule::native;
    info_.native_grid = spec_;
  }

 private:
  Box do_bounds() const override { return spec_.box(); }
  double do_clearance(const Vec3&) const override { return 1e9; }
  void do_rasterize(VoxelGrid&) const override {}
  const LayerInfo& do_info() const override { return info_; }
  std::optional<Vec3> do_cell_centre(const std::array<double, 3>& cell) const override {
    return spec_.centre({int(cell[0]), int(cell[1]), int(cell[2])});
  }
  GridSpec spec_;
  LayerInfo info_;
};

/// A ball that can only say how far away it is.
class Ball final : public Environment {
 public:
  Ball(const NoParams&, const Site&) {}

 private:
  Box do_bounds() const override { return Box{kCentre, kCentre}.grown(kRadius); }
  double do_clearance(const Vec3& p) const override { return (p - kCentre).norm() - kRadius; }
  inline static const Vec3 kCentre{500, 500, 100};
  static constexpr double kRadius = 80;
};

struct RuleParams {
  std::string does = "admits";
  std::string holds_for = "both";
  double max_y_m = 1e9;
  void describe(Fields& f) {
    f("does", does).one_of({"admits", "violations", "throws"}).doc("how it says no");
    f("holds_for", holds_for).one_of({"route", "track", "both"}).doc("what it applies to");
    f("max_y_m", max_y_m).unit("m").doc("no point lies farther north");
  }
};

/// North of max_y_m is forbidden: leg by leg, or of the route as a whole.
class NotNorth final : public Constraint {
 public:
  explicit NotNorth(const RuleParams& params) : params_(params) {}

 private:
  AppliesTo do_applies_to() const override {
    return params_.holds_for == "route"   ? AppliesTo::route
           : params_.holds_for == "track" ? AppliesTo::track
                                          : AppliesTo::both;
  }
  bool do_admits(const Motion& leg) const override {
    return params_.does != "admits" ||
           (leg.from.y() <= params_.max_y_m && leg.to.y() <= params_.max_y_m);
  }
  std::vector<Violation> do_violations(const Polyline& route, const Request&) const override {
    if (params_.does == "throws") {
      throw std::runtime_error("the rule book is lost");
    }
    std::vector<Violation> found;
    for (std::size_t i = 0; i < route.size() && params_.does == "violations"; ++i) {
      if (route[i].y() > params_.max_y_m) {
        found.push_back({"", i, route[i].y(), params_.max_y_m, "too far north"});
      }
    }
    return found;
  }
  RuleParams params_;
};
/// Forbids what lies north of a place.
struct PlaceParams {
  Point at;
  void describe(Fields& f) { f.point(at).required().doc("no point lies farther north"); }
};

class SouthOf final : public Constraint {
 public:
  SouthOf(const PlaceParams& params, const Site& site) : max_y_(site.resolve(params.at).y()) {}

 private:
  bool do_admits(const Motion& leg) const override {
    return leg.from.y() <= max_y_ && leg.to.y() <= max_y_;
  }
  double max_y_;
};
}  // namespace

ALTIPLAN_PLUGIN(Environment, "liar", Liar, LayerParams, "contradicts itself")
ALTIPLAN_PLUGIN(Environment, "cells", Cells, NoParams, "ten by ten by ten free cells")
ALTIPLAN_PLUGIN(Environment, "ball", Ball, NoParams, "a ball of 80 m at (500, 500, 100)")
ALTIPLAN_PLUGIN(Constraint, "not_north", NotNorth, RuleParams, "forbids the north")
ALTIPLAN_PLUGIN(Constraint, "south_of", SouthOf, PlaceParams, "forbids what is north of a place")
