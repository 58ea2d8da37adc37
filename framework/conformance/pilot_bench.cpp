// SPDX-License-Identifier: Apache-2.0
#include "pilot_bench.hpp"

#include <algorithm>

#include "altiplan/error.hpp"

namespace altiplan::conformance::pilots {

std::shared_ptr<const World> balls(std::vector<Sphere> all) {
  return std::make_shared<const World>(
      World().with({"balls", "conformance", std::make_shared<Balls>(std::move(all)), true}));
}

std::vector<Sphere> drawn(std::uint64_t seed, const Request& request, double reach) {
  RandomStream random = RandomStream(seed).sub("balls");
  std::vector<Sphere> all;
  while (all.size() < 8) {
    const Sphere ball{{random.uniform(0, 8) * reach, random.uniform(-1.5, 1.5) * reach,
                       random.uniform(0, 2) * reach},
                      random.uniform(0.05, 0.5) * reach};
    const auto far = [&](const Vec3& p) {
      return (p - ball.centre).norm() > ball.radius + reach / 2;
    };
    if (far(request.start.position) && far(request.goal.position)) {
      all.push_back(ball);
    }
  }
  return all;
}

Request in_level_flight(Request request) {
  request.goal.position.z() = request.start.position.z();
  request.level_m = request.start.position.z();
  return request;
}

Observation first_observation(const Request& request) {
  Observation seen;
  seen.state = request.start;
  seen.local_target = request.goal.position;
  seen.goal = request.goal;
  seen.rest = std::span(&request.goal.position, 1);
  seen.world = request.world.get();
  return seen;
}

std::string text(const Observation& seen) {
  return "observed at " + text(seen.state.position) + ", velocity " + text(seen.state.velocity) +
         ", after " + text(seen.state.time_s) + " s";
}

namespace {

/// Checks a step against contracts 1 and 2, and against its own outcome.
void judge(Report& report, const PilotStep& step, const Observation& seen, const Request& request) {
  const double dt = step.next.time_s - seen.state.time_s;
  if (step.outcome == PilotStep::Outcome::stuck) {
    return;
  }
  report.expect(dt > 0 && dt <= seen.max_dt_s * (1 + 1e-9), kTimeAndSpeed, [&] {
    return text(seen) + ": the pilot's step takes " + text(dt) + " s of at most " +
           text(seen.max_dt_s) + " s";
  });
  const double way = (step.next.position - seen.state.position).norm();
  const double max_way = request.vehicle.max_speed() * dt;
  // A pilot that continues from its own last answer appears to leap from its new position.
  const bool leaps = way > 3 * max_way + kLengthTolerance;
  report.expect(
      way <= max_way * (1 + 1e-9) + kLengthTolerance, leaps ? kContinues : kTimeAndSpeed, [&] {
        return text(seen) + ": the pilot moves " + text(way) + " m in " + text(dt) + " s to " +
               text(step.next.position) + ", the vehicle's speed allows " + text(max_way) + " m";
      });
  report.expect(step.next.velocity.norm() <= request.vehicle.max_speed() * (1 + 1e-9) + 1e-9,
                kTimeAndSpeed, [&] {
                  return text(seen) + ": the pilot's velocity is " + text(step.next.velocity) +
                         ", the vehicle flies " + text(request.vehicle.max_speed()) + " m/s";
                });
  report.expect(
      step.outcome != PilotStep::Outcome::arrived || seen.goal.reached_at(step.next.position),
      kArrived, [&] {
        return text(seen) + ": the pilot reports arrived at " + text(step.next.position) + ", " +
               text((step.next.position - seen.goal.position).norm()) + " m from the goal";
      });
  if (request.level_m) {
    report.expect(std::abs(step.next.position.z() - *request.level_m) <= kLengthTolerance, kLevel,
                  [&] { return text(seen) + ": the pilot goes to " + text(step.next.position); });
  }
}
}  // namespace

PilotStep step_of(Pilot& pilot, const Observation& seen, Report& report) {
  try {
    return pilot.step(seen);
  } catch (const PluginError& error) {
    report.add(kTimeAndSpeed, text(seen) + ": " + error.what());
    return {seen.state, PilotStep::Outcome::stuck, "violated the contract"};
  }
}

namespace {

/// The step's leg, by dense samples: it must not pass through an obstacle, whatever clearance is
/// required.
void judge_way(Report& report, const PilotStep& step, const Observation& seen) {
  if (step.outcome == PilotStep::Outcome::stuck || seen.world->clearance(seen.state.position) < 0) {
    return;
  }
  for (int i = 1; i <= 40; ++i) {
    const Vec3 p = seen.state.position + (step.next.position - seen.state.position) * (i / 40.0);
    if (!report.expect(seen.world->clearance(p) > -kLengthTolerance, kNotThrough, [&] {
          return text(seen) + ": the pilot's step to " + text(step.next.position) + " is " +
                 text(-seen.world->clearance(p)) + " m inside an obstacle at " + text(p);
        })) {
      return;
    }
  }
}
}  // namespace

Flown fly(const Bench& bench, const Request& request, Report& report, int max_steps,
          const std::function<void(Observation&, int)>& between) {
  const auto planner = bench.make();
  const bool avoids_obstacles = planner->traits().avoids_obstacles;
  const auto pilot = planner->begin(request);
  Observation seen = first_observation(request);
  Flown flight;
  while (flight.steps < max_steps) {
    if (between) {
      between(seen, flight.steps);
    }
    flight.last = step_of(*pilot, seen, report);
    ++flight.steps;
    judge(report, flight.last, seen, request);
    if (avoids_obstacles) {
      judge_way(report, flight.last, seen);
    }
    if (flight.last.outcome != PilotStep::Outcome::flying) {
      break;
    }
    seen.state = flight.last.next;
    seen.changes = {};
  }
  (void)pilot->counters();
  return flight;
}
}  // namespace altiplan::conformance::pilots
