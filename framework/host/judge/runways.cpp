// SPDX-License-Identifier: Apache-2.0
#include "host/judge/runways.hpp"

#include <algorithm>
#include <cmath>

#include "host/base/words.hpp"
#include "host/judge/slanted_end.hpp"

namespace altiplan::host {
namespace {

constexpr double kSamePlace = 1;  // metres: files of missions round points

/// The world of the layers with ground, or of the others.
std::shared_ptr<const World> part_of(const World& world, bool with_ground) {
  World part = world;
  for (const Layer& layer : world.layers()) {
    if ((layer.environment->ground() != nullptr) != with_ground) {
      part = part.without(layer.id);
    }
  }
  return std::make_shared<const World>(std::move(part));
}

/// Of one leg, which is on the ground at one of its ends.
void judge_slope(const Leg& leg, double foot_m, std::size_t at, const Request& request,
                 std::vector<Violation>& found) {
  const SlantedEnd end{foot_m, request.limits.min_ground_clearance.value_or(0)};
  const double margin = end.margin(*request.world, leg.from, leg.to);
  if (request.world->has_ground() && !(margin >= -SlantedEnd::kTouch)) {
    const Vec3 worst = end.worst(*request.world, leg.from, leg.to);
    found.push_back({"ground_clearance", at, margin, 0,
                     "the slope keeps off the ground by less than half of its height above the "
                     "runway: " +
                         with_decimals(-margin, 1) + " m too low at " + request.place_text(worst),
                     "", "m"});
  }
  for (Violation& violation : leg_violations(std::nullopt, leg, request, at)) {
    if (violation.constraint == "altitude" && violation.value > violation.limit) {
      found.push_back(std::move(violation));
    }
  }
}
}  // namespace

Request above_no_ground(Request request) {
  request.world = part_of(*request.world, false);
  request.limits.min_ground_clearance.reset();
  std::erase_if(request.limits.altitude,
                [](const AltitudeBand& band) { return band.datum == AltitudeBand::Datum::ground; });
  return request;
}

SlantedLegs slanted_legs(const Route& route, const Runways& runways) {
  const auto is_slope = [](const std::optional<Vec3>& end, double z) {
    return end && std::abs(end->z() - z) > kLengthTolerance;
  };
  if (route.size() < 2) {
    return {};
  }
  return {is_slope(runways.climbs_to, route.front().z()) ? std::size_t(1) : 0,
          route.size() - (is_slope(runways.glides_from, route.back().z()) ? 2 : 1)};
}

std::vector<Violation> ground_violations(const Route& route, const Request& request,
                                         const Runways& runways) {
  const auto [first, last] = slanted_legs(route, runways);
  const auto is_at = [&](std::size_t n, const std::optional<Vec3>& place) {
    return !place || (n < route.size() && (route[n] - *place).norm() <= kSamePlace);
  };
  if (first >= last || !is_at(1, runways.climbs_to) || !is_at(last, runways.glides_from)) {
    return {{"runway", 0, 0, 0, "the route does not take off and land along its runways"}};
  }
  Request ground = request;
  ground.world = part_of(*request.world, true);
  Request between = ground;
  between.start = {0, route[first], Vec3::Zero(), std::nullopt};
  between.goal = {route[last]};
  std::vector<Violation> found = check(route.part(first, last), between).violations;
  for (Violation& violation : found) {
    violation.at += first;
  }
  if (first > 0) {
    judge_slope(route.leg(0), route[0].z(), 0, ground, found);
  }
  if (last + 1 < route.size()) {
    judge_slope(route.leg(last), route[last + 1].z(), last, ground, found);
  }
  return found;
}
}  // namespace altiplan::host
