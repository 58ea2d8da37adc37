// SPDX-License-Identifier: Apache-2.0
// Pilots broken on purpose, a law each.
#include <algorithm>
#include <atomic>
#include <stdexcept>

#include "altiplan/world.hpp"
#include "catches.hpp"

namespace altiplan::conformance {
namespace {

enum class Flaw {
  none,
  own_mind,
  fast,
  fast_by_word,
  late,
  no_time,
  allocates,
  counts,
  sees_far,
  short_of_goal,
  hovers,
  through,
  old_world,
  climbs,
  throws
};

std::uint64_t allocations = 0;  ///< as a flawed pilot owns up to them

/// Straight to the goal, stuck where that is not free; with a flaw.
class Straight final : public Pilot {
 public:
  Straight(const Request& request, Flaw flaw)
      : request_(request), flaw_(flaw), mind_(request.start) {}

 private:
  PilotStep do_step(const Observation& seen) override {
    static std::atomic<int> steps = 0;
    ++steps;
    const State from = flaw_ == Flaw::own_mind ? mind_ : seen.state;
    const Vec3 way = seen.goal.position - from.position;
    if (seen.goal.reached_at(from.position)) {
      return {{seen.state.time_s + seen.max_dt_s, from.position, Vec3::Zero()},
              PilotStep::Outcome::arrived,
              "there"};
    }
    if (flaw_ == Flaw::throws && seen.world != request_.world.get()) {
      throw std::runtime_error("another world");
    }
    double speed = request_.vehicle.speed_mps;
    speed *= flaw_ == Flaw::fast ? 1.01 : 1;
    speed *= flaw_ == Flaw::counts && steps % 5 == 0 ? 0.9 : 1;
    speed *= flaw_ == Flaw::sees_far && seen.world->clearance(from.position) < kInfinity ? 0.9 : 1;
    const double run = std::min(way.norm(), speed * seen.max_dt_s);
    Vec3 to = run == way.norm() ? seen.goal.position : Vec3(from.position + run * way.normalized());
    const World& world = flaw_ == Flaw::old_world ? *request_.world : *seen.world;
    if (flaw_ != Flaw::through && world.blocked(from.position, to, request_.vehicle.radius_m)) {
      return {seen.state, PilotStep::Outcome::stuck, "blocked"};
    }
    allocations += flaw_ == Flaw::allocates;
    to.z() += flaw_ == Flaw::climbs ? 1e-3 : 0;
    const double dt = flaw_ == Flaw::no_time ? 0
                      : flaw_ == Flaw::late  ? 1.1 * seen.max_dt_s
                                             : std::max(run / speed, 1e-9);
    PilotStep step{{seen.state.time_s + dt, to, speed * way.normalized()},
                   PilotStep::Outcome::flying,
                   "straight on"};
    step.next.velocity *= flaw_ == Flaw::fast_by_word ? 2 : 1;
    if (flaw_ == Flaw::hovers) {
      step.next.position = from.position;
    }
    if (flaw_ == Flaw::short_of_goal && way.norm() < 0.1 * request_.volume.max.x()) {
      step.outcome = PilotStep::Outcome::arrived;
    }
    mind_ = step.next;
    return step;
  }
  double do_reach_m() const override { return 100; }

  Request request_;
  Flaw flaw_;
  State mind_;
};

class StraightOn final : public LocalPlanner {
 public:
  explicit StraightOn(Flaw flaw, Traits traits = {}) : flaw_(flaw), traits_(traits) {}

 private:
  std::unique_ptr<Pilot> do_begin(const Request& request) const override {
    return std::make_unique<Straight>(request, flaw_);
  }
  Traits do_traits() const override { return traits_; }
  Flaw flaw_;
  Traits traits_;
};

Cases of(Flaw flaw, Traits traits = {}) {
  Options options;
  options.allocations = [] { return allocations; };
  return local_planner_cases([=] { return std::make_unique<StraightOn>(flaw, traits); }, options);
}

TEST(CatchesPilot, Flaws) {
  expect_clean("none", of(Flaw::none));
  expect_caught("own mind", of(Flaw::own_mind), "Pilot law 1");
  expect_caught("fast", of(Flaw::fast), "Pilot law 2");
  expect_caught("fast by its own word", of(Flaw::fast_by_word), "Pilot law 2");
  expect_caught("late", of(Flaw::late), "Pilot law 2");
  expect_caught("no time", of(Flaw::no_time), "Pilot law 2");
  expect_caught("allocates", of(Flaw::allocates), "Pilot law 3");
  expect_caught("counts", of(Flaw::counts), "Pilot law 4");
  expect_caught("sees far", of(Flaw::sees_far), "Pilot::reach_m");
  expect_caught("short of the goal", of(Flaw::short_of_goal), "PilotStep: arrived");
  expect_caught("hovers", of(Flaw::hovers), "Pilot: arrives");
  expect_caught("through", of(Flaw::through), "Pilot: a step that says flying");
  expect_caught("old world", of(Flaw::old_world), "Pilot: a step that says flying");
  expect_caught("climbs", of(Flaw::climbs), "Planner trait `plane`");
  expect_caught("throws", of(Flaw::throws), "Pilot: being stuck");
}

TEST(CatchesPilot, WhatIsNotPromisedIsNotAskedFor) {
  Traits traits;
  traits.avoids_obstacles = false;
  expect_clean("through", of(Flaw::through, traits));
  expect_caught("fast", of(Flaw::fast, traits), "Pilot law 2");
  traits = {};
  traits.space = false;
  expect_clean("level", of(Flaw::none, traits));
  expect_caught("climbs", of(Flaw::climbs, traits), "Planner trait `plane`");
  expect_caught("through, on a level", of(Flaw::through, traits), "Pilot: a step that says flying");
}
}  // namespace
}  // namespace altiplan::conformance
