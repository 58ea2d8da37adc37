// SPDX-License-Identifier: Apache-2.0
// The judge's time for a turn, compared with a straight leg of the same length, over an elevation
// model with a radar.
#include <iostream>
#include <memory>

#include "altiplan/check.hpp"
#include "host/config/config.hpp"
#include "host/mission/mission.hpp"
#include "rows.hpp"

namespace altiplan::bench {
namespace {

struct Pair {
  altiplan::Leg turn;
  altiplan::Leg straight;
};

/// Turns of up to a circle, and straight legs of their length from the same pose, both valid.
std::vector<Pair> valid_pairs(const Request& request) {
  RandomStream random(3);
  std::vector<Pair> pairs;
  while (pairs.size() < kQueries) {
    Pose pose{random.in(request.volume), random.uniform(-kPi, kPi)};
    const auto ground = request.world->ground(pose.position.x(), pose.position.y());
    if (!ground) {
      continue;
    }
    pose.position.z() = *ground + random.uniform(100, 250);
    const double turn = random.uniform(-2 * kPi, 2 * kPi);
    const double radius = request.limits.min_turn_radius * random.uniform(1, 2);
    const double length = radius * std::abs(turn);
    const double climb = length * random.uniform(-0.1, 0.1);
    const Pair pair{
        Leg::turning(pose, turn, radius, climb),
        Leg::straight(pose.position,
                      pose.position + length * unit_heading(pose.heading) + Vec3(0, 0, climb))};
    if (leg_ok(std::nullopt, pair.turn, request) && leg_ok(std::nullopt, pair.straight, request)) {
      pairs.push_back(pair);
    }
  }
  return pairs;
}
}  // namespace

void add_turn_rows() {
  const std::filesystem::path file =
      std::filesystem::path(ALTIPLAN_CONFIGS) / "scenarios/jacksboro_wing.yaml";
  const auto mission =
      std::make_shared<host::Mission>(host::build_mission(host::load_scenario(file, {}), 1));
  mission->request.wind = {};
  const auto pairs = std::make_shared<const std::vector<Pair>>(valid_pairs(mission->request));
  add_row("judge/turn",
          [=](std::size_t n) { return leg_ok(std::nullopt, (*pairs)[n].turn, mission->request); });
  add_row("judge/straight", [=](std::size_t n) {
    return leg_ok(std::nullopt, (*pairs)[n].straight, mission->request);
  });
}
}  // namespace altiplan::bench
