// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "pilot_bench.hpp"

namespace altiplan::conformance {
namespace {

using namespace pilots;

constexpr int kMaxSteps = 3000;  // more than three times the straight path

void open_world(const Bench& bench, Report& report) {
  const double reach = bench.reach();
  Request plain = bench.flight(nullptr, reach);
  Request far = plain;  // at coordinates of a projected map
  const Vec3 by(500'000, 4'649'776, 0);
  far.start.position += by;
  far.goal.position += by;
  far.volume = {far.volume.min + by, far.volume.max + by};
  const Request level = in_level_flight(plain);
  Request slow = plain;
  slow.vehicle.speed_near = {{reach / 10, reach / 400}, {reach / 2, reach / 200}};
  std::vector<Request> requests{far, slow};
  const Traits traits = bench.make()->traits();
  if (traits.spatial) {
    requests.push_back(plain);
  }
  if (traits.planar) {
    requests.push_back(level);
  }
  for (const Request& request : requests) {
    const Flown flight = fly(bench, request, report, kMaxSteps);
    report.expect(flight.last.outcome == PilotStep::Outcome::arrived ||
                      request.goal.reached_at(flight.last.next.position),
                  kOpen, [&] {
                    return "from " + text(request.start.position) + " to " +
                           text(request.goal.position) + ": after " + std::to_string(flight.steps) +
                           " steps the pilot is at " + text(flight.last.next.position) +
                           " and reports " + std::string(flight.last.why);
                  });
  }
  Request there = plain;
  there.goal.position = there.start.position;
  fly(bench, there, report, 3);
}

void among_balls(const Bench& bench, Report& report) {
  const double reach = bench.reach();
  for (int n = 0; n < bench.options.rounds; ++n) {
    Request request = bench.flight(nullptr, reach);
    request.world = balls(drawn(bench.options.seed * 100 + std::uint64_t(n), request, reach));
    fly(bench, request, report, kMaxSteps);
  }
}

void goal_out_of_reach(const Bench& bench, Report& report) {
  const double reach = bench.reach();
  Request request = bench.flight(nullptr, reach);
  request.world = balls({{request.goal.position, reach}});
  const Flown flight = fly(bench, request, report, kMaxSteps);
  const bool may_arrive = !bench.make()->traits().avoids_obstacles;
  report.expect(may_arrive || flight.last.outcome != PilotStep::Outcome::arrived, kArrived,
                [&] { return "the goal lies inside a ball, and the pilot reports arrived"; });
}

void put_elsewhere(const Bench& bench, Report& report) {
  const double reach = bench.reach();
  for (int n = 0; n < bench.options.rounds; ++n) {
    Request request = bench.flight(nullptr, reach);
    request.world = balls(drawn(bench.options.seed * 100 + std::uint64_t(n), request, reach));
    RandomStream random = RandomStream(bench.options.seed).sub("gusts", std::uint64_t(n));
    fly(bench, request, report, 300, [&](Observation& seen, int step) {
      if (step % 7 != 6) {
        return;
      }
      const Vec3 gust = 0.2 * reach * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), 0);
      if (seen.world->clearance(seen.state.position + gust) > 0.01 * reach) {
        seen.state.position += gust;
        seen.state.time_s += 3;
        seen.max_dt_s = random.uniform(0.1, 1);
      }
    });
  }
}

void world_changes(const Bench& bench, Report& report) {
  const double reach = bench.reach();
  const Request request = bench.flight(nullptr, reach);
  std::vector<std::shared_ptr<const World>> alive;
  std::vector<Change> changes;
  std::vector<SensedObstacle> moving;
  fly(bench, request, report, kMaxSteps, [&](Observation& seen, int step) {
    if (step % 100 == 50) {
      const Vec3 ahead = (seen.goal.position - seen.state.position).normalized();
      const Sphere ball{seen.state.position + 0.6 * reach * ahead, 0.2 * reach};
      if ((ball.centre - seen.goal.position).norm() > reach) {
        alive.push_back(balls({ball}));
        changes = {{Change::Kind::add, "balls", bounds(Shape(ball))}};
        seen.world = alive.back().get();
        seen.changes = changes;
      }
    } else if (step % 100 == 0) {
      seen.world = request.world.get();
    }
    moving = {{"m", seen.state.position + Vec3(0.5 * reach, 0.1 * reach, 0), 0.02 * reach,
               Vec3(-0.01 * reach, 0, 0)},
              {"unknown velocity", seen.state.position - Vec3(0, 0.3 * reach, 0), 0.01 * reach,
               std::nullopt}};
    seen.moving = moving;
  });
}

void reach_holds(const Bench& bench, Report& report) {
  const Request near = bench.flight(nullptr, bench.reach());
  const double reach = bench.make()->begin(near)->reach_m();
  report.expect(reach > 0, kReach, [&] { return "reach_m is " + text(reach); });
  if (!std::isfinite(reach)) {
    return;
  }
  for (int n = 0; n < 8; ++n) {
    RandomStream random = RandomStream(bench.options.seed).sub("reach", std::uint64_t(n));
    Vec3 off(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    if (near.level_m) {
      off.z() = 0;  // a 2-D pilot may treat the ball as a disc
    }
    const double radius = random.uniform(0.1, 3) * reach;
    Request request = near;
    request.world =
        balls({{request.start.position + off.normalized() * (radius + 1.001 * reach), radius}});
    if (request.world->clearance(request.goal.position) < reach / 100) {
      continue;
    }
    const auto planner = bench.make();
    const PilotStep with = planner->begin(request)->step(first_observation(request));
    const PilotStep without = planner->begin(near)->step(first_observation(near));
    report.expect(with.next.position == without.next.position, kReach, [&] {
      return "a ball whose surface is " + text(1.001 * reach) + " m away, the reach being " +
             text(reach) + " m, moves the step from " + text(without.next.position) + " to " +
             text(with.next.position);
    });
  }
}

bool equal_steps(const PilotStep& a, const PilotStep& b) {
  return a.outcome == b.outcome && a.why == b.why && a.next.time_s == b.next.time_s &&
         a.next.position == b.next.position && a.next.velocity == b.next.velocity;
}

void equal_flights(const Bench& bench, Report& report) {
  const double reach = bench.reach();
  Request request = bench.flight(nullptr, reach);
  request.world = balls(drawn(bench.options.seed, request, reach));
  const auto planner = bench.make();
  const auto run = [&](std::vector<PilotStep>& steps, std::vector<std::string>& why) {
    const auto pilot = planner->begin(request);
    Observation seen = first_observation(request);
    for (int i = 0; i < 300; ++i) {
      const PilotStep step = pilot->step(seen);
      why.emplace_back(step.why);
      steps.push_back(step);
      steps.back().why = {};
      if (step.outcome != PilotStep::Outcome::flying) {
        break;
      }
      seen.state = step.next;
    }
  };
  std::vector<PilotStep> steps[3];
  std::vector<std::string> why[3];
  run(steps[0], why[0]);
  in_two_threads([&] { run(steps[1], why[1]); }, [&] { run(steps[2], why[2]); });
  for (int i = 1; i < 3; ++i) {
    report.expect(
        why[i] == why[0] && std::equal(steps[0].begin(), steps[0].end(), steps[i].begin(),
                                       steps[i].end(), equal_steps),
        kEqualSteps,
        [&] { return "two pilots with equal observations diverge, with a second thread running"; });
  }
  // Two pilots of one planner, interleaved.
  const auto one = planner->begin(request);
  const auto other = planner->begin(request);
  Observation seen = first_observation(request);
  for (int i = 0; i < 100; ++i) {
    const PilotStep a = one->step(seen);
    const PilotStep b = other->step(seen);
    if (!report.expect(equal_steps(a, b), kEqualSteps,
                       [&] {
                         return text(seen) + ": one pilot goes to " + text(a.next.position) +
                                ", its twin to " + text(b.next.position);
                       }) ||
        a.outcome != PilotStep::Outcome::flying) {
      return;
    }
    seen.state = a.next;
  }
}

void no_allocation(const Bench& bench, Report& report) {
  const double reach = bench.reach();
  Request request = bench.flight(nullptr, reach);
  request.world = balls(drawn(bench.options.seed, request, reach));
  const auto planner = bench.make();
  const auto pilot = planner->begin(request);
  Observation seen = first_observation(request);
  const SensedObstacle moving{"m", {2 * reach, 0, reach}, 0.05 * reach, Vec3(-0.002 * reach, 0, 0)};
  seen.moving = std::span(&moving, 1);
  for (int i = 0; i < 500; ++i) {
    const std::uint64_t before = bench.options.allocations();
    const PilotStep step = pilot->step(seen);
    const std::uint64_t made = bench.options.allocations() - before;
    if (!report.expect(made == 0, kNoAllocation,
                       [&] {
                         return text(seen) + ": the pilot allocates " + std::to_string(made) +
                                " times in step " + std::to_string(i);
                       }) ||
        step.outcome != PilotStep::Outcome::flying) {
      return;
    }
    seen.state = step.next;
  }
}
}  // namespace

Cases local_planner_cases(const Factory<LocalPlanner>& make, const Options& options) {
  const Bench bench{make, options};
  Cases all = cases_on(bench, kNoThrow,
                       {{"arrives_in_an_open_world", open_world},
                        {"flies_among_balls", among_balls},
                        {"a_goal_out_of_reach_is_not_reached", goal_out_of_reach},
                        {"continues_where_it_is_put", put_elsewhere},
                        {"takes_a_world_that_changes", world_changes},
                        {"reach_holds", reach_holds},
                        {"equal_observations_give_equal_steps", equal_flights}});
  if (options.allocations) {
    all.push_back(make_case("no_allocation_in_a_step", kNoThrow,
                            [bench](Report& report) { no_allocation(bench, report); }));
  }
  return all;
}
}  // namespace altiplan::conformance
