// SPDX-License-Identifier: Apache-2.0
// Flights of velocity_field, for its tests.
#pragma once

#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "altiplan/kit/layers/obstacle_set.hpp"
#include "support/support.hpp"

namespace velocity_field {
using namespace altiplan;

/// Table 1 of paper 001 (x, y, r), the scan repaired.
inline const std::vector<Cylinder> kTable1{
    {25592, 35739, 1013}, {7665, 17002, 4399},  {7694, 52501, 4599},  {11904, 42995, 8801},
    {29989, 2801, 2150},  {29182, 23941, 2398}, {19889, 13092, 8925}, {17900, 25944, 6700},
    {30996, 9401, 5197},  {7093, 32608, 1376},  {38581, 7291, 4932},  {12690, 31697, 4901}};

inline World world_of(const std::vector<Cylinder>& threats) {
  return altiplan::testing::world_of(std::vector<Shape>(threats.begin(), threats.end()));
}

/// From (0, 0) at 30 m/s and at 1000 m.
inline Request problem(World world, const Vec3& goal) {
  const Vec3 start(0, 0, 1000);
  Request request = altiplan::testing::request_in(std::move(world), start, goal,
                                                  {{-1e5, -1e5, 1000}, {2e5, 2e5, 1000}});
  request.level_m = 1000;
  request.vehicle.speed_mps = 30;
  request.goal.tolerance_m = 15;
  return request;
}
inline Request table1() { return problem(world_of(kTable1), {50000, 50000, 1000}); }

/// The page's random maps: kind A, B or C, number of the map.
inline std::vector<Cylinder> random_map(char kind, std::uint64_t number, std::size_t count = 80) {
  std::mt19937_64 next(number);
  const auto u = [&] { return double(next() >> 11) * 0x1p-53; };
  std::vector<Cylinder> threats(count);
  for (Cylinder& threat : threats) {
    threat.x = 90000 * u();
    threat.y = 90000 * u();
    const double r = u();
    threat.radius = kind == 'A'   ? kTable1[std::size_t(12 * r)].radius
                    : kind == 'B' ? 1000 + 8000 * r
                                  : 1000 + 4000 * r;
  }
  return threats;
}

struct Flown {
  Route route;
  PilotStep::Outcome outcome = PilotStep::Outcome::flying;
  std::vector<std::string> why;  ///< as it changes
  Counters counters;

  std::int64_t counter(std::string_view name) const {
    for (const Counter& counter : counters) {
      if (counter.name == name) {
        return counter.value;
      }
    }
    return -1;
  }
};

inline Observation first_observation(const Request& request) {
  Observation seen;
  seen.state = request.start;
  seen.local_target = request.goal.position;
  seen.goal = request.goal;
  seen.rest = std::span(&request.goal.position, 1);
  seen.world = request.world.get();
  return seen;
}

/// Flies until the pilot arrives or is stuck; `between` may change what it sees before a step.
inline Flown flight(const Request& request, std::string_view yaml = "{}", int max_steps = 41000,
                    const std::function<void(Observation&, int)>& between = {}) {
  const auto planner = altiplan::testing::make_local_planner("velocity_field", yaml);
  const auto pilot = planner->begin(request);
  Flown flown;
  flown.route = {request.start.position};
  Observation seen = first_observation(request);
  for (int n = 0; n < max_steps && flown.outcome == PilotStep::Outcome::flying; ++n) {
    if (between) {
      between(seen, n);
    }
    const PilotStep step = pilot->step(seen);
    seen.changes = {};
    flown.outcome = step.outcome;
    if (flown.why.empty() || flown.why.back() != step.why) {
      flown.why.emplace_back(step.why);
    }
    if (step.outcome != PilotStep::Outcome::stuck) {
      flown.route.push_back(step.next.position);
      seen.state = step.next;
    }
  }
  flown.counters = pilot->counters();
  return flown;
}

/// Least radius of the circle through three points in a row.
inline double min_radius(const Route& route) {
  double least = kInfinity;
  for (std::size_t i = 2; i < route.size(); ++i) {
    least = std::min(least, radius_through(route[i - 2], route[i - 1], route[i]));
  }
  return least;
}

/// Greatest difference of a step's length from `length`.
inline double uneven(const Route& route, double length) {
  double most = 0;
  for (std::size_t i = 1; i < route.size(); ++i) {
    most = std::max(most, std::abs((route[i] - route[i - 1]).norm() - length));
  }
  return most;
}
}  // namespace velocity_field
