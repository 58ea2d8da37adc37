// SPDX-License-Identifier: Apache-2.0
#include "altiplan/world.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <random>
#include <thread>

#include "altiplan/formats/iso_time.hpp"
#include "altiplan/frame.hpp"
#include "altiplan/kit/layers/obstacle_set.hpp"
#include "altiplan/planner.hpp"
#include "support/support.hpp"

namespace altiplan::world_test {
namespace {

Layer shapes(std::string id, std::vector<Shape> list) {
  return {std::move(id), "shapes", std::make_shared<kit::ShapeLayer>(std::move(list)), true};
}

/// Level ground over a rectangle: a tile of a larger terrain.
class FlatTile final : public Environment, public Ground {
 public:
  FlatTile(const Box& box, double height) : box_(box), height_(height) {}

 private:
  Box do_bounds() const override { return box_; }
  double do_clearance(const Vec3& p) const override { return p.z() - height_; }
  const Ground* do_ground() const override { return this; }
  std::optional<double> do_height(double x, double y) const override {
    return box_.contains({x, y, box_.min.z()}) ? std::optional(height_) : std::nullopt;
  }
  double do_gap(const Vec3& a, const Vec3& b, double) const override {
    return std::min(a.z(), b.z()) - height_;
  }
  Box box_;
  double height_;
};

/// Many posts, over which a grid is filled for a while.
World posts() {
  std::vector<Shape> list;
  for (int n = 0; n < 100; ++n) {
    list.push_back(Cylinder{100.0 * n, 5000, 30});
  }
  return World().with(shapes("posts", std::move(list)));
}

Budget used_up(bool by_stop, std::stop_source& stop) {
  Budget budget;
  if (by_stop) {
    stop.request_stop();
    budget.stop = stop.get_token();
  } else {
    budget.deadline = Budget::Clock::now();
  }
  return budget;
}

TEST(World, FillingAGridEndsWithTheBudget) {
  GridSpec spec;
  spec.cell = {10, 10, 10};
  spec.counts = {1000, 1000, 10};
  for (const bool by_stop : {false, true}) {
    SCOPED_TRACE(by_stop);
    const World world = posts();
    std::stop_source stop;
    try {
      world.voxels(spec, used_up(by_stop, stop));
      FAIL() << "was filled";
    } catch (const BudgetSpent& spent) {
      EXPECT_EQ(spent.cancelled(), by_stop);
    }
    // What was begun is not kept.
    const auto whole = world.voxels(spec);
    EXPECT_TRUE(VoxelGrid::diff(*whole, *posts().voxels(spec)).empty());
    EXPECT_EQ(world.voxels(spec, used_up(by_stop, stop)), whole) << "there: no time is needed";
  }
}

TEST(World, PlannersAnswerWhereTheGridTakesTheirTime) {
  for (const char* name : {"theta_star", "lazy_theta_star", "stratified_theta", "spatial_slicing",
                           "astar", "dstar_lite"}) {
    SCOPED_TRACE(name);
    Request request = testing::request_in(posts(), {500, 500, 50}, {9000, 9500, 50},
                                          {{0, 0, 0}, {10e3, 10e3, 100}});
    std::stop_source stop;
    request.budget = used_up(false, stop);
    const auto planner = testing::make_planner(name, "{cell_m: [10, 10, 10]}");
    const PlanResult result = planner->plan(request);
    EXPECT_EQ(result.status, PlanStatus::timed_out) << result.message;
    EXPECT_TRUE(result.budget_hit);
    const auto session = planner->begin(request);
    EXPECT_EQ(session->result().status, PlanStatus::timed_out) << session->result().message;
  }
}

TEST(World, ASessionBegunWithoutTimeGoesOnWithTheNext) {
  const auto planner = testing::make_planner("dstar_lite", "{moves: cells, cell_m: [50, 50, 50]}");
  Request request = testing::request_in(posts(), {500, 500, 50}, {9000, 9500, 50},
                                        {{0, 0, 0}, {10e3, 10e3, 100}});
  std::stop_source stop;
  for (const bool by_stop : {false, true}) {
    request.budget = used_up(by_stop, stop);
    const auto session = planner->begin(request);
    ASSERT_NE(session, nullptr);
    EXPECT_EQ(session->result().status, by_stop ? PlanStatus::cancelled : PlanStatus::timed_out);
    EXPECT_EQ(session->result().reason, by_stop ? Reason::none : Reason::deadline);
    EXPECT_TRUE(session->result().budget_hit);
    EXPECT_EQ(
        session->update(request.start, request.goal, request.world, {}, request.budget).status,
        session->result().status);
    EXPECT_EQ(session->update(request.start, request.goal, request.world, {}, Budget()).status,
              PlanStatus::solved);
  }
}

TEST(World, ASessionGoesOnAfterAnUpdateWithoutTime) {
  const auto planner = testing::make_planner("dstar_lite", "{cell_m: [50, 50, 50]}");
  Request request = testing::request_in(posts(), {500, 500, 50}, {9000, 9500, 50},
                                        {{0, 0, 0}, {10e3, 10e3, 100}});
  const auto session = planner->begin(request);
  ASSERT_EQ(session->result().status, PlanStatus::solved) << session->result().message;
  const auto changed = std::make_shared<const World>(
      request.world->with(shapes("more", {Cylinder{5000, 7000, 2000}})));
  const Change change{Change::Kind::add, "more", changed->layers().back().environment->bounds()};
  std::stop_source stop;
  EXPECT_EQ(
      session->update(request.start, request.goal, changed, {&change, 1}, used_up(false, stop))
          .status,
      PlanStatus::timed_out);
  const PlanResult again = session->update(request.start, request.goal, changed, {}, Budget());
  ASSERT_EQ(again.status, PlanStatus::solved) << again.message;
  request.world = changed;
  EXPECT_NEAR(length(again.route), length(planner->plan(request).route), 1e-6);
}

/// A solid that fills its grids as a test wants it.
class Filled final : public Environment {
 public:
  explicit Filled(std::function<void()> fill, std::function<void()> bound = nullptr)
      : fill_(std::move(fill)), bound_(std::move(bound)) {}

 private:
  Box do_bounds() const override {
    if (bound_) {
      bound_();
    }
    return {{0, 0, 0}, {1, 1, 1}};
  }
  double do_clearance(const Vec3& p) const override { return (p - Vec3(0.5, 0.5, 0.5)).norm() - 2; }
  void do_rasterize(VoxelGrid& grid) const override {
    fill_();
    grid.set({0, 0, 0}, true);
  }

  std::function<void()> fill_;
  std::function<void()> bound_;
};

World filled(std::function<void()> fill, std::function<void()> bound = nullptr) {
  return World().with(
      {"slow", "filled", std::make_shared<Filled>(std::move(fill), std::move(bound)), true});
}

TEST(World, ALayerThatFillsAGridHoldsUpNobodyElse) {
  std::promise<void> begun;
  std::promise<void> changed;
  std::future_status met{};
  const World world = filled([&] {
    begun.set_value();
    met = changed.get_future().wait_for(std::chrono::seconds(5));
  });
  auto grid = std::async(std::launch::async, [&] { return world.voxels(GridSpec()); });
  begun.get_future().wait();
  EXPECT_EQ(world.with(shapes("more", {})).layers().size(), 2U);
  changed.set_value();
  EXPECT_TRUE(grid.get()->blocked(0, 0, 0));
  EXPECT_EQ(met, std::future_status::ready);
}

TEST(World, ThreadsThatWantOneGridGetTheSame) {
  std::atomic<int> fills{0};
  const World world = filled([&] {
    ++fills;
    for (int n = 0; n < 1000 && fills < 2; ++n) {  // so that both fill at once, if they may
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  });
  auto grid = std::async(std::launch::async, [&] { return world.voxels(GridSpec()); });
  const auto mine = world.voxels(GridSpec());
  EXPECT_EQ(grid.get(), mine);
  EXPECT_EQ(world.voxels(GridSpec()), mine);
}

TEST(World, NamesTheLayerThatThrowsWhileAGridIsFilled) {
  const auto told = [](const World& world) {
    try {
      world.voxels(GridSpec());
      return std::string("filled");
    } catch (const PluginError& error) {
      return std::string(error.what());
    } catch (const std::exception& error) {
      return std::string("not the layer's: ") + error.what();
    }
  };
  int calls = 0;
  const auto once = [&calls] {
    if (++calls == 1) {
      throw std::runtime_error("no paint");
    }
  };
  const World world = filled(once);
  EXPECT_EQ(told(world), "the layer 'slow' (filled) threw: no paint");
  EXPECT_EQ(told(world), "filled");
  calls = 0;
  const World unbounded = filled([] {}, once).with(shapes("more", {Sphere{{0, 0, 0}, 1}}));
  EXPECT_EQ(told(unbounded), "filled") << "its bounds are not asked yet";
  EXPECT_EQ(told(unbounded.without("more")), "the layer 'slow' (filled) threw: no paint");
  EXPECT_EQ(told(unbounded.without("more")), "filled");
}

TEST(World, LayersByIdAndRevision) {
  const World empty;
  const World one = empty.with(shapes("a", {Sphere{{0, 0, 0}, 1}}));
  EXPECT_EQ(one.revision(), empty.revision() + 1);
  EXPECT_NE(one.find("a"), nullptr);
  EXPECT_EQ(one.find("b"), nullptr);
  EXPECT_EQ(one.without("a").layers().size(), 0u);
  EXPECT_THROW(one.with(shapes("a", {})), Error);
  EXPECT_EQ(empty.clearance({0, 0, 0}), kInfinity);
}

TEST(World, ChangedGridsEqualFreshOnes) {
  RandomStream random(9);
  const Box space{{0, 0, 0}, {60, 60, 30}};
  GridSpec spec;
  spec.counts = {60, 60, 30};
  spec.inflation = 0.7;
  World world;
  for (int i = 0; i < 8; ++i) {
    world = world.with(shapes(
        "s" + std::to_string(i),
        {Sphere{random.in(space), 5}, BoxShape{leg_box(random.in(space), random.in(space))}}));
  }
  for (int round = 0; round < 12; ++round) {
    world.voxels(spec);  // the grid that the change patches
    const std::string id = "s" + std::to_string(round % 8);
    world = world.find(id) != nullptr ? world.without(id)
                                      : world.with(shapes(id, {Sphere{random.in(space), 8}}));
    World fresh;
    for (const Layer& layer : world.layers()) {
      fresh = fresh.with(layer);
    }
    EXPECT_TRUE(VoxelGrid::diff(*world.voxels(spec), *fresh.voxels(spec)).empty()) << round;
  }
}

TEST(World, DistancesFollowTheGrid) {
  const World world = World().with(shapes("s", {BoxShape{{{4, 4, 4}, {5, 5, 5}}}}));
  GridSpec spec;
  spec.counts = {10, 10, 10};
  const auto field = world.distances(spec);
  EXPECT_EQ(field, world.distances(spec));
  EXPECT_EQ(field->centre_distance({4, 4, 4}), 0);
  EXPECT_NEAR(field->centre_distance({7, 8, 4}), 5, 1e-5);
  EXPECT_EQ(world.without("s").distances(spec)->centre_distance({4, 4, 4}), kInfinity);
}

TEST(World, TilesShareTheGround) {
  World world = World()
                    .with({"west", "flat",
                           std::make_shared<FlatTile>(Box{{0, 0, 0}, {100, 100, 50}}, 50), true})
                    .with({"east", "flat",
                           std::make_shared<FlatTile>(Box{{100, 0, 0}, {200, 100, 60}}, 60), true});
  EXPECT_EQ(world.ground_gap({10, 50, 100}, {190, 50, 100}), 40);
  EXPECT_EQ(world.ground_gap({10, 50, 100}, {90, 50, 100}), 50);
  EXPECT_EQ(world.ground_gap({10, 50, 100}, {210, 50, 100}), -kInfinity);
  EXPECT_EQ(*world.ground(150, 50), 60);
  EXPECT_FALSE(world.ground(250, 50));
}

TEST(World, MovingObstaclesMeetByRelativeMotion) {
  // It crosses the leg's middle when the vehicle is there, at right angles.
  const MovingObstacle crossing{"m", Sphere{{50, -50, 0}, 5}, {0, 10, 0}, 0, true};
  EXPECT_TRUE(hits(crossing, {0, 0, 0}, 0, {100, 0, 0}, 10, 0.1));
  EXPECT_EQ(separation(crossing, {0, 0, 0}, 0, {100, 0, 0}, 10), 0);
  // Ten seconds later it has gone.
  EXPECT_FALSE(hits(crossing, {0, 0, 0}, 10, {100, 0, 0}, 20, 20));
  // A parallel flight keeps its distance exactly: touching is free.
  const MovingObstacle beside{"m", Sphere{{0, 15, 0}, 5}, {10, 0, 0}, 0, true};
  EXPECT_FALSE(hits(beside, {0, 0, 0}, 0, {100, 0, 0}, 10, 10));
  EXPECT_TRUE(hits(beside, {0, 0, 0}, 0, {100, 0, 0}, 10, 10.001));
}

TEST(Environment, SphereTracingKeepsItsLaws) {
  // A third party that gives clearance alone: a ball of radius 10.
  class Ball final : public Environment {
    Box do_bounds() const override { return {{-10, -10, -10}, {10, 10, 10}}; }
    double do_clearance(const Vec3& p) const override { return p.norm() - 10; }
  };
  const Ball ball;
  RandomStream random(3);
  for (int i = 0; i < 20000; ++i) {
    const Vec3 a = random.in({{-40, -40, -40}, {40, 40, 40}});
    const Vec3 b = random.in({{-40, -40, -40}, {40, 40, 40}});
    const double r = random.uniform(0, 10);
    const double distance = point_leg_distance({0, 0, 0}, a, b) - 10;
    const bool blocked = ball.blocked(a, b, r);
    EXPECT_EQ(blocked, ball.blocked(b, a, r));
    if (distance < r - kLengthTolerance) {
      EXPECT_TRUE(blocked);
    } else if (distance > r + ball.over_approximation()) {
      EXPECT_FALSE(blocked);
    }
  }
  int found = 0;
  ball.near({0, 0, 12}, 5, [&](const Nearby& nearby) {
    ++found;
    EXPECT_NEAR(nearby.distance, 2, 1e-9);
    EXPECT_NEAR(nearby.normal.z(), 1, 1e-6);
    EXPECT_NEAR(nearby.point.z(), 10, 1e-5);
  });
  EXPECT_EQ(found, 1);
}

TEST(Frame, GeographicThereAndBack) {
  const Frame frame = Frame::geographic(-84.41, 36.45, 36.6);
  const auto p = frame.to_local(-84.08, 36.73);
  EXPECT_NEAR(p[0], 29500, 200);
  EXPECT_NEAR(p[1], 31060, 200);
  const auto back = frame.to_lonlat(p[0], p[1]);
  EXPECT_NEAR(back[0], -84.08, 1e-12);
  EXPECT_NEAR(back[1], 36.73, 1e-12);
  // Across the antimeridian the short way.
  EXPECT_NEAR(Frame::geographic(179.9, 0, 0).to_local(-179.9, 0)[0], 22264, 1);
  EXPECT_LT(frame.scale_error({{0, 0, 0}, {30000, 31000, 0}}), 0.005);
  EXPECT_THROW(Frame().to_local(0, 0), Error);
}

TEST(RandomStream, NamedStreamsAreIndependentAndStable) {
  RandomStream a = RandomStream(7).sub("sample", 1);
  RandomStream b = RandomStream(7).sub("sample", 2);
  RandomStream again = RandomStream(7).sub("sample", 1);
  double sum = 0;
  for (int i = 0; i < 10000; ++i) {
    const double u = a.uniform();
    EXPECT_EQ(u, again.uniform());
    EXPECT_NE(u, b.uniform());
    sum += u;
  }
  EXPECT_NEAR(sum / 10000, 0.5, 0.02);
  std::array<int, 6> dice{};
  for (int i = 0; i < 60000; ++i) {
    ++dice[std::size_t(a.integer(1, 6) - 1)];
  }
  for (const int n : dice) {
    EXPECT_NEAR(n, 10000, 500);
  }
}

TEST(SplitMix64, KnownSequence) {
  // The published reference values for seed 1234567.
  SplitMix64 random(1234567);
  EXPECT_EQ(random.next(), 6457827717110365317ULL);
  EXPECT_EQ(random.next(), 3203168211198807973ULL);
}

TEST(IsoTime, ReadsAndRefuses) {
  EXPECT_EQ(formats::parse_iso_time("1970-01-02"), 86400);
  EXPECT_EQ(formats::parse_iso_time("2026-05-01T10:00:00Z"), 1777629600);
  EXPECT_EQ(formats::parse_iso_time("2026-05-01T12:00:00+02:00"), 1777629600);
  EXPECT_EQ(formats::parse_iso_time("2026-05-01T10:00Z"), 1777629600);
  for (const char* bad : {"", "2026-02-30", "2026-05-01T25:00Z", "2026-05-01T10:00:00", "today",
                          "2026-05-01T10:00:00Zx"}) {
    EXPECT_FALSE(formats::parse_iso_time(bad)) << bad;
  }
}

TEST(Moving, APointHitsWhatItFliesThrough) {
  const MovingObstacle still{"still", Sphere{{500, 0, 0}, 9}, {0, 0, 0}, 0, true};
  EXPECT_TRUE(hits(still, {0, 0, 0}, 0, {900, 0, 0}, 60, 0));
  EXPECT_TRUE(hits(still, {500, 0, 0}, 0, {500, 0, 0}, 1, 0));
  EXPECT_FALSE(hits(still, {0, 9, 0}, 0, {900, 9, 0}, 60, 0)) << "touching is free";
  EXPECT_FALSE(hits(still, {0, 0, 0}, 0, {480, 0, 0}, 60, 0));
}

/// Answers of a world of very many layers, against those of each layer in turn.
void expect_as_each(const World& world, std::mt19937_64& random) {
  std::uniform_real_distribution<double> place(-300, 1300);
  std::uniform_real_distribution<double> step(-150, 150);
  int blocked = 0;
  for (int n = 0; n < 20'000; ++n) {
    Vec3 a(place(random), place(random), place(random) / 4);
    Vec3 b = n % 3 == 0 ? a : Vec3(a + Vec3(step(random), step(random), step(random) / 4));
    if (n % 5 == 0) {
      b.y() = a.y();
    }
    const double r = n % 4 == 0 ? 0 : std::abs(step(random)) / 10;
    const Layer* first = nullptr;
    double clearance = kInfinity;
    std::vector<std::pair<std::string, double>> near;
    for (const Layer& layer : world.layers()) {
      first = first == nullptr && layer.environment->blocked(a, b, r) ? &layer : first;
      clearance = std::min(clearance, layer.environment->clearance(a));
      layer.environment->near(
          a, r, [&](const Nearby& one) { near.emplace_back(layer.id, one.distance); });
    }
    ASSERT_EQ(world.blocked_by(a, b, r), first) << a.transpose() << " to " << b.transpose();
    ASSERT_EQ(world.clearance(a), clearance) << a.transpose();
    std::vector<std::pair<std::string, double>> found;
    world.near(a, r, [&](const Layer& layer, const Nearby& one) {
      found.emplace_back(layer.id, one.distance);
    });
    ASSERT_EQ(found, near);
    blocked += first != nullptr;
  }
  EXPECT_GT(blocked, 2000);
  EXPECT_LT(blocked, 18'000);
}

TEST(World, OfThousandsOfLayersAnswersAsEachOfThem) {
  for (const int count : {17, 400}) {
    std::mt19937_64 random(static_cast<std::uint64_t>(count));
    std::uniform_real_distribution<double> place(0, 1000);
    std::uniform_real_distribution<double> size(1, count < 100 ? 120 : 30);
    World world;
    for (int n = 0; n < count; ++n) {
      const Vec3 at(place(random), place(random), place(random) / 4);
      const Vec3 half(size(random), size(random), size(random));
      const Shape shape = n % 2 == 0 ? Shape(Sphere{at, half.x()})
                                     : Shape(Cylinder{at.x(), at.y(), half.x(), at.z() - half.z(),
                                                      n % 7 == 0 ? kInfinity : at.z() + half.z()});
      world = std::move(world).with(shapes(std::to_string(n), {shape}));
    }
    world = std::move(world).with(shapes("nothing", {}));
    world = std::move(world).with(
        {"tile", "flat", std::make_shared<FlatTile>(Box{{0, 0, 0}, {500, 1000, 5}}, 5), true});
    expect_as_each(world, random);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const Vec3& nowhere : {Vec3(nan, 0, 0), Vec3(0, kInfinity, 0)}) {
      EXPECT_EQ(world.clearance(nowhere), -kInfinity);
      EXPECT_TRUE(world.blocked({0, 0, 0}, nowhere, 0));
    }
  }
}
}  // namespace
}  // namespace altiplan::world_test
