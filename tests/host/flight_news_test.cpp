// SPDX-License-Identifier: Apache-2.0
// What changes in flight, when it becomes known, and what is kept of a flight that fails.
#include <algorithm>
#include <stdexcept>

#include "flight_scene.hpp"

namespace altiplan::host::flight_news_test {
namespace {

using testing::make_smoother;

/// Answers every update with a detour over points, and notes what it was told.
class Detour final : public Session {
 public:
  explicit Detour(Polyline over) : over_(std::move(over)) {}
  std::vector<Change> changes;
  Vec3 asked_at{0, 0, 0};

 private:
  const PlanResult& do_result() const override { return result_; }
  const PlanResult& do_update(const State& state, const Goal& goal, std::shared_ptr<const World>,
                              std::span<const Change> news, const Budget&) override {
    asked_at = state.position;
    changes.assign(news.begin(), news.end());
    result_.status = PlanStatus::solved;
    result_.route = {state.position};
    result_.route.edit().insert(result_.route.end(), over_.begin(), over_.end());
    result_.route.push_back(goal.position);
    return result_;
  }
  Polyline over_;
  PlanResult result_;
};

/// Flies straight to the goal, and fails at its n-th step.
class FailingPlanner final : public LocalPlanner {
 public:
  explicit FailingPlanner(int at_step) : at_step_(at_step) {}

 private:
  struct FailingPilot final : Pilot {
    explicit FailingPilot(int at_step) : steps_left(at_step) {}
    int steps_left;
    PilotStep do_step(const Observation& seen) override {
      if (--steps_left <= 0) {
        throw std::runtime_error("its engine stopped");
      }
      const Vec3 velocity = 30 * (seen.goal.position - seen.state.position).normalized();
      return {{seen.state.time_s + 1, seen.state.position + velocity, velocity},
              PilotStep::Outcome::flying,
              "on"};
    }
    double do_reach_m() const override { return 3000; }
    Counters do_counters() const override { return {{"steps_left", steps_left}}; }
  };
  std::unique_ptr<Pilot> do_begin(const Request&) const override {
    return std::make_unique<FailingPilot>(at_step_);
  }
  int at_step_;
};

/// A row of blocks north of the way from x = 5 to 25 km, and the same with a tower on the way.
Layer blocks(bool closed) {
  std::vector<Shape> shapes;
  for (double x = 5000; x <= 25000; x += 2000) {
    shapes.push_back(BoxShape{{{x, 17000, 0}, {x + 500, 17500, 1000}}});
  }
  if (closed) {
    shapes.push_back(Cylinder{20250, 15050, 250, 0, 1000});
  }
  return {"blocks", "shape", std::make_shared<kit::ShapeLayer>(std::move(shapes))};
}

FlightEvent closing() {
  FlightEvent event;
  event.kind = FlightEvent::Kind::set_cells;
  event.at_s = 50;
  event.id = "blocks";
  event.layer = blocks(true);
  event.box = {{20000, 14800, 0}, {20500, 15300, 1000}};
  return event;
}

void make_known(FlightScene& scene, Layer known) {
  scene.setup.truth = scene.setup.truth.with(known);
  scene.setup.request.world =
      std::make_shared<const World>(scene.setup.request.world->with(std::move(known)));
}

TEST(FlightNews, ChangedCellsAreKnownWithinSensingOfTheirBox) {
  FlightScene scene;
  make_known(scene, blocks(false));
  scene.setup.events = {closing()};
  Detour detour({{20000, 14000, 500}});
  scene.setup.replanner = &detour;
  scene.follow_alone();
  const FlightResult result = fly(scene.setup);
  EXPECT_EQ(result.status, RunStatus::solved) << result.message;
  ASSERT_EQ(result.replans.size(), 1u);
  ASSERT_EQ(detour.changes.size(), 1u);
  EXPECT_EQ(detour.changes[0].kind, Change::Kind::set_cells);
  EXPECT_EQ(detour.changes[0].layer, "blocks");
  EXPECT_EQ(detour.changes[0].box.min, closing().box.min);
  EXPECT_EQ(detour.changes[0].box.max, closing().box.max);
  EXPECT_NEAR(detour.asked_at.x(), 20000 - 4000 + 30, 61);
}

TEST(FlightNews, ThePilotFliesAroundChangedCells) {
  FlightScene scene;
  make_known(scene, blocks(false));
  scene.setup.events = {closing()};
  expect_flown(fly(scene.setup), 2);
  scene.follow_alone();
  EXPECT_EQ(fly(scene.setup).status, RunStatus::collided);
}

TEST(FlightNews, CellsChangedTwiceAreToldInOneBox) {
  FlightScene scene;
  make_known(scene, blocks(false));
  FlightEvent more = closing();
  more.at_s = 60;
  more.box = {{24000, 14800, 0}, {24500, 15300, 1000}};
  scene.setup.events = {closing(), more};
  Detour detour({{20000, 14000, 500}});
  scene.setup.replanner = &detour;
  scene.follow_alone();
  fly(scene.setup);
  ASSERT_EQ(detour.changes.size(), 1u);
  EXPECT_EQ(detour.changes[0].box.min, closing().box.min);
  EXPECT_EQ(detour.changes[0].box.max, more.box.max);
}

/// Hovers on the way; known from the start, gone after 100 s, when the vehicle is 10 km away.
FlightScene with_hoverer(bool told) {
  FlightScene scene;
  MovingObstacle hoverer{"hoverer", Sphere{{15000, 15000, 500}, 300}, {0, 0, 0}, 0, true};
  scene.setup.truth = scene.setup.truth.with_moving({hoverer});
  scene.setup.request.world =
      std::make_shared<const World>(scene.setup.request.world->with_moving({hoverer}));
  FlightEvent gone;
  gone.kind = FlightEvent::Kind::remove;
  gone.id = "hoverer";
  gone.at_s = 100;
  gone.known = told;
  scene.setup.events = {gone};
  return scene;
}

TEST(FlightNews, AMovingObstacleIsGoneOnlyWhenThatIsSensed) {
  FlightScene scene = with_hoverer(false);
  scene.setup.request.vehicle.sensing_m = 1000;  // less than the pilot's reach: it takes over first
  const FlightResult result = fly(scene.setup);
  expect_flown(result, 2);
  EXPECT_NE(result.handovers[0].why.find("'hoverer'"), std::string::npos);
  // Then the place is seen to be empty, 300 + 1000 m before its centre, and the route is clear.
  EXPECT_NEAR(result.handovers[1].at_s, (15000 - 1300 - 2000) / 30.0, 15);
}

TEST(FlightNews, AMovingObstacleToldToBeGoneIsNotFlownAround) {
  FlightScene told = with_hoverer(true);
  told.setup.request.vehicle.sensing_m = 1000;
  EXPECT_TRUE(fly(told.setup).handovers.empty());
  FlightScene stays = with_hoverer(true);
  stays.setup.events.clear();
  expect_flown(fly(stays.setup), 2);
}

TEST(FlightNews, TheMoveOfAMovingObstacleIsKnownWhenSensed) {
  for (const bool told : {false, true}) {
    FlightScene scene = with_hoverer(told);
    scene.setup.request.vehicle.sensing_m = 1000;
    scene.setup.events[0].kind = FlightEvent::Kind::move;
    scene.setup.events[0].vector = {0, 8000, 0};
    const FlightResult result = fly(scene.setup);
    expect_flown(result, told ? 0 : 2);
    EXPECT_EQ(result.handovers.empty(), told);
  }
}

TEST(FlightNews, ReplannedRoutesAreSmoothed) {
  FlightScene scene;
  scene.hide(layer("unknown", post(17000, 15050, 800)));
  scene.follow_alone();
  Detour detour({{15000, 13000, 500}, {16000, 12990, 500}, {17000, 13000, 500}});
  scene.setup.replanner = &detour;
  const FlightResult raw = fly(scene.setup);
  const auto prune = make_smoother("prune");
  scene.setup.smoothers = {prune.get()};
  const FlightResult smooth = fly(scene.setup);
  EXPECT_EQ(raw.status, RunStatus::solved) << raw.message;
  EXPECT_EQ(smooth.status, RunStatus::solved) << smooth.message;
  const auto passes = [](const FlightResult& result, const Vec3& p) {
    return std::any_of(result.track.begin(), result.track.end(),
                       [&](const auto& at) { return at.second == p; });
  };
  EXPECT_TRUE(passes(raw, {16000, 12990, 500}));
  EXPECT_FALSE(passes(smooth, {16000, 12990, 500}));
  EXPECT_LT(smooth.measures.length_m, raw.measures.length_m);
}

TEST(FlightNews, AFailingPilotKeepsTheTrack) {
  FlightScene scene;
  const FailingPlanner failing(5);
  scene.setup.pilot = &failing;
  scene.setup.pilot_name = "failing";
  scene.setup.always = true;
  const FlightResult result = fly(scene.setup);
  EXPECT_EQ(result.status, RunStatus::failed);
  EXPECT_NE(result.message.find("its engine stopped"), std::string::npos) << result.message;
  ASSERT_EQ(result.track.size(), 5u);  // the start and four steps
  EXPECT_EQ(result.track.back().second, Vec3(2120, 15000, 500));
  EXPECT_EQ(result.handovers.size(), 1u);
  EXPECT_NEAR(result.measures.length_m, 120, 1e-9);
  EXPECT_FALSE(result.reached);
  EXPECT_FALSE(result.check.ok());
  EXPECT_TRUE(std::any_of(result.counters.begin(), result.counters.end(),
                          [](const Counter& c) { return c.name == "steps_left" && c.value == 0; }));
}

TEST(FlightNews, AnEventThatFailsKeepsTheTrack) {
  FlightScene scene;
  FlightEvent gone;
  gone.kind = FlightEvent::Kind::remove;
  gone.id = "nobody";
  gone.at_s = 5;
  scene.setup.events = {gone};
  const FlightResult result = fly(scene.setup);
  EXPECT_EQ(result.status, RunStatus::failed);
  ASSERT_EQ(result.track.size(), 6u);
  EXPECT_NEAR(result.track.back().second.x(), 2000 + 5 * 30, 1e-6);
  ASSERT_TRUE(result.min_separation_m);
}
}  // namespace
}  // namespace altiplan::host::flight_news_test
