// SPDX-License-Identifier: Apache-2.0
// Environments broken on purpose, a law each.
#include <atomic>
#include <limits>
#include <stdexcept>

#include "altiplan/height_field.hpp"
#include "altiplan/kit/obstacle_set.hpp"
#include "catches.hpp"

namespace altiplan::conformance {
namespace {

const double kNan = std::numeric_limits<double>::quiet_NaN();

std::vector<Shape> shapes() {
  return {Sphere{{200, 300, 100}, 80}, BoxShape{{{500, 100, 0}, {700, 400, 150}}},
          BoxShape{{{350, 600, 0}, {352, 900, 300}}}};
}

/// What a test puts in place of the sound answers; unset ones are sound.
struct Spoils {
  std::function<double(double sound, const Vec3&)> clearance;
  std::function<bool(bool sound, const Vec3&, const Vec3&, double)> blocked;
  std::function<bool(Nearby&)> near;  ///< whether to report it
  bool near_twice_as_far = false;
  std::function<void(VoxelGrid&)> rasterize;
  std::optional<Box> bounds;
  std::optional<double> slack;
  std::vector<Threat> threats;
  std::optional<GridSpec> native;
  std::optional<Frame> frame;
};

class Spoiled final : public Environment {
 public:
  explicit Spoiled(Spoils spoils) : spoils_(std::move(spoils)), sound_(shapes()) {}

 private:
  Box do_bounds() const override { return spoils_.bounds.value_or(sound_.bounds()); }
  double do_clearance(const Vec3& p) const override {
    const double sound = sound_.clearance(p);
    return spoils_.clearance ? spoils_.clearance(sound, p) : sound;
  }
  bool do_blocked(const Vec3& a, const Vec3& b, double r) const override {
    const bool sound = sound_.blocked(a, b, r);
    return spoils_.blocked ? spoils_.blocked(sound, a, b, r) : sound;
  }
  void do_near(const Vec3& p, double reach, const NearSink& sink) const override {
    sound_.near(p, spoils_.near_twice_as_far ? 2 * reach : reach, [&](const Nearby& nearby) {
      Nearby told = nearby;
      if (!spoils_.near || spoils_.near(told)) {
        sink(told);
      }
    });
  }
  void do_rasterize(VoxelGrid& grid) const override {
    spoils_.rasterize ? spoils_.rasterize(grid) : sound_.rasterize(grid);
  }
  double do_slack() const override { return spoils_.slack.value_or(0); }
  std::vector<Threat> do_threats() const override { return spoils_.threats; }
  std::optional<GridSpec> do_native_grid() const override { return spoils_.native; }
  std::optional<Frame> do_frame() const override { return spoils_.frame; }

  Spoils spoils_;
  kit::ObstacleSet sound_;
};

Cases with(const Spoils& spoils) {
  return environment_cases([spoils](const Site&) { return std::make_unique<Spoiled>(spoils); });
}

template <class Part, class Value>
Cases with(Part part, Value value) {
  Spoils spoils;
  spoils.*part = std::move(value);
  return with(spoils);
}

TEST(CatchesEnvironment, NothingInASoundOne) { expect_clean("sound", with(Spoils{})); }

TEST(CatchesEnvironment, Impure) {
  static std::atomic<int> made = 0;
  static std::atomic<int> asked = 0;
  expect_caught(
      "answers drift",
      with(&Spoils::clearance, [](double sound, const Vec3&) { return sound - 1e-9 * ++asked; }),
      "Environment law 1");
  expect_caught("objects differ", environment_cases([](const Site&) {
                  Spoils spoils;
                  spoils.clearance = [id = ++made](double sound, const Vec3&) {
                    return sound - 1e-7 * id;
                  };
                  return std::make_unique<Spoiled>(spoils);
                }),
                "Environment law 1");
  expect_caught("throws",
                with(&Spoils::clearance,
                     [](double sound, const Vec3& p) {
                       return p.x() > 300 ? throw std::runtime_error("lost") : sound;
                     }),
                "Environment law 1");
}

TEST(CatchesEnvironment, Clearance) {
  expect_caught("too steep",
                with(&Spoils::clearance, [](double sound, const Vec3&) { return 1.01 * sound; }),
                "Environment law 2");
  expect_caught("a step",
                with(&Spoils::clearance,
                     [](double sound, const Vec3& p) { return p.x() > 400 ? sound - 0.5 : sound; }),
                "Environment law 2");
  expect_caught("not a number",
                with(&Spoils::clearance,
                     [](double sound, const Vec3& p) { return p.z() > 150 ? kNan : sound; }),
                "Environment law 2");
  expect_caught("more than the distance",
                with(&Spoils::clearance, [](double sound, const Vec3&) { return sound + 0.01; }),
                "Environment");
}

TEST(CatchesEnvironment, Blocked) {
  const kit::ObstacleSet set(shapes());
  expect_caught("sampled",
                with(&Spoils::blocked,
                     [&](bool, const Vec3& a, const Vec3& b, double r) {
                       for (int k = 0; k <= 8; ++k) {
                         if (set.clearance(a + (b - a) * k / 8) < r) {
                           return true;
                         }
                       }
                       return false;
                     }),
                "Environment law 3");
  expect_caught("more than the slack",
                with(&Spoils::blocked, [&](bool, const Vec3& a, const Vec3& b,
                                           double r) { return set.blocked(a, b, r + 0.5); }),
                "Environment law 3");
  expect_caught("less than the radius",
                with(&Spoils::blocked, [&](bool, const Vec3& a, const Vec3& b,
                                           double r) { return set.blocked(a, b, 0.9 * r); }),
                "Environment law 3");
  expect_caught("not monotone",
                with(&Spoils::blocked, [](bool sound, const Vec3&, const Vec3&,
                                          double r) { return sound && !(r > 20 && r < 30); }),
                "Environment law 4");
}

TEST(CatchesEnvironment, Near) {
  expect_caught("leaves one out",
                with(&Spoils::near, [](Nearby& nearby) { return nearby.id != 1; }),
                "Environment::near");
  expect_caught("too near",
                with(&Spoils::near,
                     [](Nearby& nearby) {
                       nearby.distance -= 0.1;
                       return true;
                     }),
                "Environment::near");
  expect_caught("normals of any length",
                with(&Spoils::near,
                     [](Nearby& nearby) {
                       nearby.normal *= 2;
                       return true;
                     }),
                "Environment::near");
  expect_caught("the wrong point",
                with(&Spoils::near,
                     [](Nearby& nearby) {
                       nearby.point += 0.1 * nearby.distance * nearby.normal;
                       return true;
                     }),
                "Environment::near");
  expect_caught("beyond the reach", with(&Spoils::near_twice_as_far, true), "Environment::near");
}

TEST(CatchesEnvironment, RasterAndBounds) {
  const kit::ObstacleSet set(shapes());
  expect_caught("by centres only",
                with(&Spoils::rasterize,
                     [&](VoxelGrid& grid) {
                       GridSpec spec = grid.spec();
                       spec.rule = GridSpec::Rule::centre;
                       VoxelGrid centres(spec);
                       set.rasterize(centres);
                       for (std::size_t n = 0; n < spec.cell_count(); ++n) {
                         const int i = int(n) % spec.counts[0];
                         const int row = int(n) / spec.counts[0];
                         const Cell cell{i, row % spec.counts[1], row / spec.counts[1]};
                         if (centres.blocked(cell)) {
                           grid.set(cell, true);
                         }
                       }
                     }),
                "Environment law 6");
  expect_caught("without inflation",
                with(&Spoils::rasterize,
                     [&](VoxelGrid& grid) {
                       GridSpec spec = grid.spec();
                       spec.inflation = 0;
                       VoxelGrid bare(spec);
                       set.rasterize(bare);
                       for (const Cell& c : VoxelGrid::diff(bare, VoxelGrid(spec))) {
                         grid.set(c, true);
                       }
                     }),
                "Environment law 6");
  expect_caught("wipes the grid",
                with(&Spoils::rasterize,
                     [&](VoxelGrid& grid) {
                       grid = VoxelGrid(grid.spec());
                       set.rasterize(grid);
                     }),
                "Environment law 6");
  expect_caught("bounds too small", with(&Spoils::bounds, Box{{130, 100, 0}, {700, 900, 300}}),
                "Environment::bounds");
}

TEST(CatchesEnvironment, Kin) {
  expect_caught("slack", with(&Spoils::slack, -1.0), "Environment: slack");
  expect_caught("threat", with(&Spoils::threats, std::vector<Threat>{{{0, 0, 0}, kNan, "", ""}}),
                "Environment: slack");
  GridSpec cells;
  cells.cell = {1, 0, 1};
  expect_caught("cells", with(&Spoils::native, cells), "Environment: slack");
  class Bent final : public Projection {
    std::array<double, 2> to_local(double lon, double lat) const override { return {lon, lat}; }
    std::array<double, 2> to_lonlat(double x, double y) const override { return {x + 1e-5, y}; }
  };
  expect_caught("frame", with(&Spoils::frame, Frame::projected(std::make_shared<Bent>(), "bent")),
                "Environment: slack");
  expect_caught("nothing there", environment_cases([](const Site&) {
                  return std::make_unique<kit::ShapeLayer>(std::vector<Shape>{});
                }),
                "Suite");
}

/// Which answer about the ground is wrong.
enum class Flaw { none, ground, gap, gap_max, enough, slope, holes, air, has_none, edge };

/// A small model of posts; clearance and blocked as a terrain has them.
class Ground final : public Environment {
 public:
  explicit Ground(Flaw flaw) : flaw_(flaw), field_({0, 0}, {50, 50}, 9, 8, heights()) {}

 private:
  static std::vector<float> heights() {
    RandomStream random(3);
    std::vector<float> all(72);
    for (float& height : all) {
      height = float(random.uniform(0, 60));
    }
    return all;
  }
  Box do_bounds() const override { return {{0, 0, -1000}, {400, 350, 60}}; }
  double do_clearance(const Vec3& p) const override {
    const double x = std::clamp(p.x(), 0.0, 400.0);
    const double y = std::clamp(p.y(), 0.0, 350.0);
    const double beside = std::hypot(p.x() - x, p.y() - y);
    const double above = (p.z() - *field_.at(x, y)) / std::hypot(1, field_.max_slope());
    return beside > 0 ? beside : above;
  }
  bool do_blocked(const Vec3& a, const Vec3& b, double r) const override {
    if (!field_.at(a.x(), a.y()) || !field_.at(b.x(), b.y())) {
      return flaw_ == Flaw::holes;
    }
    return flaw_ == Flaw::air
               ? false
               : field_.gap(a, b) < r * std::hypot(1, field_.max_slope()) - kLengthTolerance;
  }
  double do_slack() const override { return 1000; }
  bool do_has_ground() const override { return flaw_ != Flaw::has_none; }
  std::optional<double> do_ground(double x, double y) const override {
    const auto at = field_.at(x, y);
    return at && flaw_ == Flaw::ground ? std::optional(*at + 1e-3) : at;
  }
  double do_ground_gap(const Vec3& a, const Vec3& b, double enough) const override {
    if (flaw_ == Flaw::edge && (!field_.at(a.x(), a.y()) || !field_.at(b.x(), b.y()))) {
      return 0;
    }
    if (flaw_ == Flaw::gap && a != b) {
      return std::min(field_.gap(a, a), field_.gap(b, b));
    }
    if (flaw_ == Flaw::enough && enough < kInfinity) {
      return std::max(enough, field_.gap(a, b));
    }
    return field_.gap(a, b);
  }
  double do_ground_gap_max(const Vec3& a, const Vec3& b) const override {
    return flaw_ == Flaw::gap_max && a != b ? field_.gap_max(a, a) : field_.gap_max(a, b);
  }
  double do_ground_slope(const Box&) const override {
    return field_.max_slope() * (flaw_ == Flaw::slope ? 0.5 : 1);
  }
  const HeightField* do_height_field() const override { return &field_; }

  Flaw flaw_;
  HeightField field_;
};

TEST(CatchesEnvironment, Ground) {
  const auto of = [](Flaw flaw) {
    const EnvironmentFactory make = [flaw](const Site&) { return std::make_unique<Ground>(flaw); };
    Cases cases;
    for (Case& one : environment_cases(make)) {
      if (one.name.starts_with("ground")) {
        cases.push_back(std::move(one));
      }
    }
    return cases;
  };
  expect_clean("sound", of(Flaw::none));
  for (const Flaw flaw : {Flaw::ground, Flaw::gap, Flaw::gap_max, Flaw::enough, Flaw::slope,
                          Flaw::holes, Flaw::air, Flaw::has_none, Flaw::edge}) {
    expect_caught("flaw " + std::to_string(int(flaw)), of(flaw), "Environment law 5");
  }
}
}  // namespace
}  // namespace altiplan::conformance
