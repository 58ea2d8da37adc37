// SPDX-License-Identifier: Apache-2.0
// Sessions of dstar_lite while layers appear, move and disappear.
#include <gtest/gtest.h>

#include <string>

#include "altiplan/kit/layers/obstacle_set.hpp"
#include "dstar_worlds_test.hpp"

namespace altiplan::dstar_layers_test {
namespace {

using testing::make_planner;
using testing::request_in;

/// A session that is notified of solids that appear, move and disappear, compared with new plans.
/// The start is fixed: a new plan would otherwise place its cells around another one.
class Beside {
 public:
  Beside(Request request, const std::string& with, const std::string& afresh)
      : dstar_(make_planner("dstar_lite", with)),
        astar_(make_planner("astar", afresh)),
        request_(std::move(request)),
        session_(dstar_->begin(request_)) {}

  const PlanResult& result() const { return session_->result(); }
  int solved() const { return solved_; }

  void change(SplitMix64& random, double size) {
    Change change;
    World world = *request_.world;
    std::vector<Layer> solids;
    for (const Layer& layer : world.layers()) {
      if (layer.id.starts_with("solid")) {
        solids.push_back(layer);
      }
    }
    const double what = solids.empty() ? 0 : random.uniform();
    if (what < 0.5) {
      change.kind = Change::Kind::add;
      change.layer = "solid" + std::to_string(next_++);
      const Layer layer = solid(change.layer, random, size);
      change.box = layer.environment->bounds();
      world = world.with(layer);
    } else {
      const Layer& old = solids[std::size_t(random.integer(0, int(solids.size()) - 1))];
      change.layer = old.id;
      change.box = old.environment->bounds();
      if (what < 0.75) {
        change.kind = Change::Kind::remove;
        world = world.without(old.id);
      } else {
        change.kind = Change::Kind::move;
        const Layer layer = solid(old.id, random, size);
        change.box = change.box.united(layer.environment->bounds());
        world = world.with_replaced(layer);
      }
    }
    changes_.push_back(change);
    request_.world = std::make_shared<const World>(std::move(world));
  }

  void compare(const std::string& what) {
    session_->update(request_.start, request_.goal, request_.world, changes_, request_.budget);
    changes_.clear();
    const PlanResult fresh = astar_->plan(request_);
    ASSERT_EQ(result().status, fresh.status)
        << what << ": " << result().message << "; afresh: " << fresh.message;
    if (fresh.status == PlanStatus::solved) {
      ++solved_;
      ASSERT_NEAR(length(result().route), length(fresh.route), 1e-6 * length(fresh.route)) << what;
      ASSERT_TRUE(check(result().route, request_).ok()) << what;
    }
  }

 private:
  Layer solid(const std::string& id, SplitMix64& random, double size) const {
    const Vec3 span = request_.volume.max - request_.volume.min;
    Vec3 at = request_.volume.min;
    for (int axis = 0; axis < 3; ++axis) {
      at[axis] += span[axis] * random.uniform();
    }
    std::vector<Shape> shapes;
    if (random.uniform() < 0.5) {
      shapes.emplace_back(Sphere{at, size * (0.5 + random.uniform())});
    } else {
      Cylinder cylinder{at.x(), at.y(), size * (0.5 + random.uniform())};
      cylinder.ceiling = at.z();
      shapes.emplace_back(cylinder);
    }
    return {id, "solid", std::make_shared<kit::ShapeLayer>(std::move(shapes)), true};
  }

  std::unique_ptr<Planner> dstar_;
  std::unique_ptr<Planner> astar_;
  Request request_;
  std::unique_ptr<Session> session_;
  std::vector<Change> changes_;
  int next_ = 0;
  int solved_ = 0;
};

/// Number of plans that found a route.
int run(const Request& request, const std::string& with, const std::string& afresh, double size,
        std::uint64_t seed) {
  Beside beside(request, with, afresh);
  SplitMix64 random(seed);
  for (int round = 0; round < 12; ++round) {
    for (int n = random.integer(0, 4); n > 0; --n) {
      beside.change(random, size);
    }
    beside.compare(with + ", seed " + std::to_string(seed) + ", round " + std::to_string(round));
    if (::testing::Test::HasFatalFailure()) {
      break;
    }
  }
  return beside.solved();
}

TEST(DStarLiteLayers, EqualPlansMadeAfreshInSpaceAndOnALevel) {
  for (const char* with :
       {"{moves: exact, cell_m: [10, 10, 5]}", "{moves: cells, cell_m: [8, 8, 8]}",
        "{moves: cells, corner: free_box, cell_m: [10, 10, 5]}"}) {
    for (const bool level : {false, true}) {
      Request request =
          request_in(World(), {12, 15, 22}, {107, 93, 31}, {{0, 0, 0}, {120, 110, 50}});
      request.vehicle.radius_m = request.limits.min_clearance = 1.5;
      if (level) {
        request.goal.position.z() = 22;
        request.level_m = 22;
      }
      int solved = 0;
      for (std::uint64_t seed = 0; seed < 15; ++seed) {
        solved += run(request, with, with, 15, seed);
        if (HasFatalFailure()) {
          return;
        }
      }
      EXPECT_GT(solved, 60) << with;
    }
  }
}

TEST(DStarLiteLayers, EqualPlansMadeAfreshOverTerrain) {
  Site site;
  static const World kEmpty;
  site.before = &kEmpty;
  const std::shared_ptr<const Environment> hills =
      testing::make_environment("hills", "{seed: 5, count: 20}", site);
  Request request = request_in(testing::world_of(hills, "hills"), {4000, 6000, 900},
                               {92000, 88000, 1200}, {{0, 0, 0}, {100000, 100000, 3000}});
  request.limits.min_ground_clearance = 100;
  request.limits.max_climb = 0.3;
  int solved = 0;
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    const char* with = "{cell_m: [4000, 4000, 200]}";
    solved += run(request, with, with, 9000, seed);
    if (HasFatalFailure()) {
      return;
    }
  }
  EXPECT_GT(solved, 20);
}

TEST(DStarLiteLayers, AGroundComesAndGoes) {
  Site site;
  static const World kEmpty;
  site.before = &kEmpty;
  const Layer hills{"hills", "hills", testing::make_environment("hills", "{seed: 5}", site), true};
  Request request = request_in(World(), {4000, 6000, 1200}, {92000, 88000, 1500},
                               {{0, 0, 0}, {100000, 100000, 3000}});
  request.limits.min_ground_clearance = 100;
  for (const char* with :
       {"{cell_m: [4000, 4000, 200]}", "{cell_m: [4000, 4000, 200], moves: cells}"}) {
    const auto dstar = make_planner("dstar_lite", with);
    const auto astar = make_planner("astar", with);
    const auto session = dstar->begin(request);
    World world = *request.world;
    for (const auto kind : {Change::Kind::add, Change::Kind::remove}) {
      world = kind == Change::Kind::add ? world.with(hills) : world.without("hills");
      Request now = request;
      now.world = std::make_shared<const World>(world);
      const Change change{kind, "hills", hills.environment->bounds()};
      const PlanResult result = session->update(now.start, now.goal, now.world, {&change, 1}, {});
      const PlanResult fresh = astar->plan(now);
      ASSERT_EQ(result.status, fresh.status) << with << ": " << result.message;
      EXPECT_NEAR(length(result.route), length(fresh.route), 1e-6 * length(fresh.route)) << with;
    }
  }
}

/// No eastward legs in the north, and no left turns in the south.
class OneWay final : public Constraint {
  bool do_admits(const Motion& leg) const override {
    const Vec3 way = leg.to - leg.from;
    if (leg.from.y() > 55) {
      return way.x() <= 0;
    }
    const Vec3 before = leg.before ? Vec3(leg.from - *leg.before) : way;
    return before.x() * way.y() - before.y() * way.x() <= 1e-6;
  }
};

TEST(DStarLiteLayers, EqualPlansMadeAfreshWhereDirectionsMatter) {
  int solved = 0;
  for (const char* moves : {"exact", "cells"}) {
    Request request = request_in(World(), {105, 95, 22}, {12, 18, 28}, {{0, 0, 0}, {120, 110, 50}});
    apply_constraints(request, {{"one_way", std::make_shared<OneWay>()}}, AppliesTo::route);
    const std::string with = std::string("{cell_m: [12, 12, 10], moves: ") + moves;
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
      solved += run(request, with + "}", with + ", state: cell_and_heading}", 18, seed);
      if (HasFatalFailure()) {
        return;
      }
    }
  }
  EXPECT_GT(solved, 60);
}

TEST(DStarLiteLayers, EqualPlansMadeAfreshUnderLimitsOnTurnsAndClimb) {
  Request request = request_in(World(), {12, 15, 22}, {107, 93, 31}, {{0, 0, 0}, {120, 110, 50}});
  apply_constraints(request,
                    {{"turn", testing::make_constraint("turn_angle", "{max_deg: 50}")},
                     {"climb", testing::make_constraint("climb_angle", "{max_deg: 30}")}},
                    AppliesTo::route);
  int solved = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    solved += run(request, "{cell_m: [12, 12, 6]}",
                  "{cell_m: [12, 12, 6], state: cell_and_heading}", 18, seed);
    if (HasFatalFailure()) {
      return;
    }
  }
  EXPECT_GT(solved, 30);
}
}  // namespace
}  // namespace altiplan::dstar_layers_test
