// SPDX-License-Identifier: Apache-2.0
// Layers of shapes broken on purpose, one thing each.
#include <functional>
#include <limits>

#include "altiplan/field.hpp"
#include "altiplan/kit/layers/obstacle_set.hpp"
#include "altiplan/swept_volume.hpp"
#include "bad_entries.hpp"

namespace {
using namespace altiplan;
using namespace altiplan::bad;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::vector<Shape> shapes() {
  return {Sphere{{200, 300, 100}, 80}, BoxShape{{{500, 100, 0}, {700, 400, 150}}},
          BoxShape{{{350, 600, 0}, {352, 900, 300}}}};
}
const kit::ObstacleSet& sound() {
  static const kit::ObstacleSet kSet(shapes());
  return kSet;
}

/// What stands in place of the sound answers; unset ones are sound.
struct Spoils {
  std::function<double(double sound, const Vec3&)> clearance;
  std::function<bool(bool sound, const Vec3&, const Vec3&, double)> blocked;
  std::function<bool(Nearby&)> near;  ///< whether to report it
  bool near_twice_as_far = false;
  std::function<void(VoxelGrid&)> rasterize;
  std::optional<Box> bounds;
  std::optional<double> slack;
  std::function<bool(const SweptVolume&)> meets;
  std::function<std::optional<double>(const Vec3&)> field;
  LayerInfo info;
};

template <void (*kSpoil)(Spoils&)>
class Spoilt final : public Environment, public Field {
 public:
  template <class Params>
  Spoilt(const Params&, const Site&) {
    kSpoil(spoils_);
  }

 private:
  Box do_bounds() const override { return spoils_.bounds.value_or(sound().bounds()); }
  double do_clearance(const Vec3& p) const override {
    const double clear = sound().clearance(p);
    return spoils_.clearance ? spoils_.clearance(clear, p) : clear;
  }
  bool do_blocked(const Vec3& a, const Vec3& b, double r) const override {
    const bool blocked = sound().blocked(a, b, r);
    return spoils_.blocked ? spoils_.blocked(blocked, a, b, r) : blocked;
  }
  void do_near(const Vec3& p, double reach, const NearSink& sink) const override {
    sound().near(p, spoils_.near_twice_as_far ? 2 * reach : reach, [&](const Nearby& nearby) {
      Nearby told = nearby;
      if (!spoils_.near || spoils_.near(told)) {
        sink(told);
      }
    });
  }
  void do_rasterize(VoxelGrid& grid) const override {
    spoils_.rasterize ? spoils_.rasterize(grid) : sound().rasterize(grid);
  }
  double do_over_approximation() const override { return spoils_.slack.value_or(0); }
  const LayerInfo& do_info() const override { return spoils_.info; }
  const Field* do_field() const override { return spoils_.field ? this : nullptr; }
  std::optional<double> do_value(const Vec3& p) const override { return spoils_.field(p); }
  bool do_meets(const SweptVolume& volume) const override {
    return spoils_.meets ? spoils_.meets(volume) : sound().meets(volume);
  }

  Spoils spoils_;
};

void nothing(Spoils&) {}
void with_field(Spoils& s) {
  s.field = [](const Vec3& p) { return std::optional(sound().clearance(p) > 0 ? 1.0 : 2.0); };
}
void negative_field(Spoils& s) {
  s.field = [](const Vec3& p) { return std::optional(sound().clearance(p)); };
}
void field_without_values(Spoils& s) {
  s.field = [](const Vec3&) { return std::optional<double>(); };
}
void field_that_counts(Spoils& s) {
  static std::atomic<int> asked = 0;
  s.field = [](const Vec3&) { return std::optional<double>(++asked); };
}
using Sound = Spoilt<nothing>;

void drifts(Spoils& s) {
  static std::atomic<int> asked = 0;
  s.clearance = [](double clear, const Vec3&) { return clear - 1e-9 * ++asked; };
}
void differs(Spoils& s) {
  static std::atomic<int> made = 0;
  s.clearance = [id = ++made](double clear, const Vec3&) { return clear - 1e-7 * id; };
}
void throws_eastward(Spoils& s) {
  s.clearance = [](double clear, const Vec3& p) {
    return p.x() > 300 ? throw std::runtime_error("lost") : clear;
  };
}
void too_steep(Spoils& s) {
  s.clearance = [](double clear, const Vec3&) { return 1.01 * clear; };
}
void has_a_step(Spoils& s) {
  s.clearance = [](double clear, const Vec3& p) { return p.x() > 400 ? clear - 0.5 : clear; };
}
void is_no_number(Spoils& s) {
  s.clearance = [](double clear, const Vec3& p) { return p.z() > 150 ? kNan : clear; };
}
void too_great(Spoils& s) {
  s.clearance = [](double clear, const Vec3&) { return clear + 0.01; };
}

void samples(Spoils& s) {
  s.blocked = [](bool, const Vec3& a, const Vec3& b, double r) {
    for (int k = 0; k <= 8; ++k) {
      if (sound().clearance(a + (b - a) * k / 8) < r) {
        return true;
      }
    }
    return false;
  };
}
void too_wide(Spoils& s) {
  s.blocked = [](bool, const Vec3& a, const Vec3& b, double r) {
    return sound().blocked(a, b, r + 0.5);
  };
}
void too_narrow(Spoils& s) {
  s.blocked = [](bool, const Vec3& a, const Vec3& b, double r) {
    return sound().blocked(a, b, r - 2e-4);
  };
}
// What a great slack allows, but not in this way.
void not_monotone(Spoils& s) {
  s.slack = 100;
  s.blocked = [](bool, const Vec3& a, const Vec3& b, double r) {
    return sound().blocked(a, b, int(r) % 2 == 0 ? r + 80 : r);
  };
}

void leaves_one_out(Spoils& s) {
  s.near = [](Nearby& nearby) { return nearby.id != 1; };
}
void too_near(Spoils& s) {
  s.near = [](Nearby& nearby) {
    nearby.distance -= 0.1;
    return true;
  };
}
void long_normals(Spoils& s) {
  s.near = [](Nearby& nearby) {
    nearby.normal *= 2;
    return true;
  };
}
void wrong_point(Spoils& s) {
  s.near = [](Nearby& nearby) {
    nearby.point += 0.1 * nearby.distance * nearby.normal;
    return true;
  };
}
void beyond_reach(Spoils& s) { s.near_twice_as_far = true; }

void body_as_a_point(Spoils& s) {
  s.meets = [](const SweptVolume& volume) {
    return sound().blocked(volume.from(), volume.to(), 2 * kLengthTolerance);
  };
}

void by_centres(Spoils& s) {
  s.rasterize = [](VoxelGrid& grid) {
    GridSpec spec = grid.spec();
    spec.rule = GridSpec::Rule::centre;
    VoxelGrid centres(spec);
    sound().rasterize(centres);
    for (const Cell& cell : VoxelGrid::diff(centres, VoxelGrid(spec))) {
      grid.set(cell, true);
    }
  };
}
void without_inflation(Spoils& s) {
  s.rasterize = [](VoxelGrid& grid) {
    GridSpec spec = grid.spec();
    spec.inflation = 0;
    VoxelGrid bare(spec);
    sound().rasterize(bare);
    for (const Cell& cell : VoxelGrid::diff(bare, VoxelGrid(spec))) {
      grid.set(cell, true);
    }
  };
}
void wipes_the_grid(Spoils& s) {
  s.rasterize = [](VoxelGrid& grid) {
    grid = VoxelGrid(grid.spec());
    sound().rasterize(grid);
  };
}

void small_bounds(Spoils& s) { s.bounds = Box{{120, 100, 0}, {700, 400, 180}}; }
void slightly_small_bounds(Spoils& s) {
  s.bounds = sound().bounds();
  s.bounds->min.x() += 1;
}
void lost_far_off(Spoils& s) {
  s.clearance = [](double clear, const Vec3& p) {
    return p.cwiseAbs().maxCoeff() > 1e9 ? throw std::out_of_range("off the map") : clear;
  };
}

void negative_slack(Spoils& s) { s.slack = -1; }
void endless_threat(Spoils& s) { s.info.threats = {{{0, 0, 0}, kNan, "", ""}}; }
void flat_cells(Spoils& s) {
  s.info.native_grid = GridSpec{};
  s.info.native_grid->cell = {1, 0, 1};
}
class Bent final : public Projection {
  std::array<double, 2> to_local(double lon, double lat) const override { return {lon, lat}; }
  std::array<double, 2> to_lonlat(double x, double y) const override { return {x + 1e-5, y}; }
};
void bent_frame(Spoils& s) { s.info.frame = Frame::projected(std::make_shared<Bent>(), "bent"); }

class Empty final : public Environment {
 public:
  Empty(const NoParams&, const Site&) {}

 private:
  Box do_bounds() const override { return Box::empty(); }
  double do_clearance(const Vec3&) const override { return kInfinity; }
};

template <Does kDoes>
void does(Spoils&) {
  kDoes();
}
void by_its_address(Spoils& s) {
  s.clearance = [](double clear, const Vec3&) { return clear - 1e-3 * by_address(); };
}
}  // namespace

ALTIPLAN_PLUGIN(Environment, "sound", Sound, NoParams, "nothing is wrong with it")
ALTIPLAN_PLUGIN(Environment, "drifts", Spoilt<drifts>, NoParams,
                "its answers depend on how often it was asked")
ALTIPLAN_PLUGIN(Environment, "differs", Spoilt<differs>, NoParams,
                "two objects of one Site answer differently")
ALTIPLAN_PLUGIN(Environment, "throws_eastward", Spoilt<throws_eastward>, NoParams,
                "throws in half of the volume")
ALTIPLAN_PLUGIN(Environment, "too_steep", Spoilt<too_steep>, NoParams,
                "its clearance changes by more than the way")
ALTIPLAN_PLUGIN(Environment, "has_a_step", Spoilt<has_a_step>, NoParams,
                "its clearance has a step of 0.5 m")
ALTIPLAN_PLUGIN(Environment, "is_no_number", Spoilt<is_no_number>, NoParams,
                "its clearance is no number in some places")
ALTIPLAN_PLUGIN(Environment, "too_great", Spoilt<too_great>, NoParams,
                "its clearance is 1 cm more than the distance")
ALTIPLAN_PLUGIN(Environment, "samples", Spoilt<samples>, NoParams,
                "looks at nine points of a leg alone")
ALTIPLAN_PLUGIN(Environment, "too_wide", Spoilt<too_wide>, NoParams,
                "blocks 0.5 m more than its slack")
ALTIPLAN_PLUGIN(Environment, "too_narrow", Spoilt<too_narrow>, NoParams,
                "takes the radius to be 0.2 mm less")
ALTIPLAN_PLUGIN(Environment, "not_monotone", Spoilt<not_monotone>, NoParams,
                "some legs are free for a greater radius")
ALTIPLAN_PLUGIN(Environment, "leaves_one_out", Spoilt<leaves_one_out>, NoParams,
                "does not report one of the obstacles that are near")
ALTIPLAN_PLUGIN(Environment, "too_near", Spoilt<too_near>, NoParams,
                "reports what is near as nearer than it is")
ALTIPLAN_PLUGIN(Environment, "long_normals", Spoilt<long_normals>, NoParams,
                "reports normals of length 2")
ALTIPLAN_PLUGIN(Environment, "wrong_point", Spoilt<wrong_point>, NoParams,
                "reports points that are not on a surface")
ALTIPLAN_PLUGIN(Environment, "beyond_reach", Spoilt<beyond_reach>, NoParams,
                "reports obstacles beyond the reach")
ALTIPLAN_PLUGIN(Environment, "body_as_a_point", Spoilt<body_as_a_point>, NoParams,
                "sees of a body no more than its reference point")
ALTIPLAN_PLUGIN(Environment, "by_centres", Spoilt<by_centres>, NoParams,
                "blocks the cells whose centre is solid, whatever the grid's rule")
ALTIPLAN_PLUGIN(Environment, "without_inflation", Spoilt<without_inflation>, NoParams,
                "does not grow what it draws by the grid's inflation")
ALTIPLAN_PLUGIN(Environment, "wipes_the_grid", Spoilt<wipes_the_grid>, NoParams,
                "frees the cells that another layer has blocked")
ALTIPLAN_PLUGIN(Environment, "small_bounds", Spoilt<small_bounds>, NoParams,
                "its bounds leave out a wall")
ALTIPLAN_PLUGIN(Environment, "slightly_small_bounds", Spoilt<slightly_small_bounds>, NoParams,
                "its bounds leave out 1 m of a ball")
ALTIPLAN_PLUGIN(Environment, "lost_far_off", Spoilt<lost_far_off>, NoParams,
                "throws at places far off")
ALTIPLAN_PLUGIN(Environment, "negative_slack", Spoilt<negative_slack>, NoParams,
                "its over-approximation is negative")
ALTIPLAN_PLUGIN(Environment, "endless_threat", Spoilt<endless_threat>, NoParams,
                "the radius of a threat is no number")
ALTIPLAN_PLUGIN(Environment, "flat_cells", Spoilt<flat_cells>, NoParams,
                "its native cells have no extent")
ALTIPLAN_PLUGIN(Environment, "bent_frame", Spoilt<bent_frame>, NoParams,
                "its frame does not bring a place back")
ALTIPLAN_PLUGIN(Environment, "with_field", Spoilt<with_field>, NoParams,
                "nothing is wrong with it, nor with its field")
ALTIPLAN_PLUGIN(Environment, "negative_field", Spoilt<negative_field>, NoParams,
                "values of its field are negative")
ALTIPLAN_PLUGIN(Environment, "field_without_values", Spoilt<field_without_values>, NoParams,
                "its field has no value anywhere")
ALTIPLAN_PLUGIN(Environment, "field_that_counts", Spoilt<field_that_counts>, NoParams,
                "values of its field depend on how often it was asked")
ALTIPLAN_PLUGIN(Environment, "empty", Empty, NoParams, "there is nothing in it")
ALTIPLAN_BAD_ENTRIES(Environment, Sound, NoParams)
ALTIPLAN_BAD_PROCESSES(Environment, Spoilt<does<changes_locale>>, Spoilt<does<prints>>,
                       Spoilt<does<writes_file>>, Spoilt<does<leaks>>, Spoilt<by_its_address>,
                       NoParams)
