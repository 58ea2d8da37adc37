// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/sampling/path_rules.hpp"

#include <algorithm>

namespace altiplan::kit {
namespace {

constexpr int kRuleHeadings = 16;  // tried where none is given
constexpr int kLoiterPoses = 64;   // places where a loiter circle may be left or joined
}  // namespace

PathRules::PathRules(const Request& request, double turn_radius)
    : request_(request),
      rules_(request),
      steering_(request, turn_radius),
      looks_back_(request.limits.max_turn_space < kPi || request.judges_pairs() ||
                  steering_.is_layered()) {}

std::vector<Pose> PathRules::starts() const {
  return request_.start_poses(request_.start.loiter ? kLoiterPoses : kRuleHeadings);
}

std::vector<Pose> PathRules::goals() const {
  return request_.goal_poses(request_.goal.loiter ? kLoiterPoses : kRuleHeadings);
}

std::optional<PathRules::Arrival> PathRules::arrival(std::optional<Approach> before,
                                                     const Pose& from, const Pose& to) {
  const auto path = steering_.path(from, to);
  const auto in_volume = [&](const Leg& leg) {
    return request_.volume.contains(leg.to, kLengthTolerance);
  };
  if (!path || !std::all_of(path->legs.begin(), path->legs.end(), in_volume)) {
    return std::nullopt;
  }
  for (const Leg& leg : path->legs) {
    if (!rules_.ok(before, leg)) {
      return std::nullopt;
    }
    before = onward(before, leg);
  }
  return Arrival{path->length, before};
}

bool PathRules::follows(const std::optional<Approach>& before, const Pose& from, const Pose& to) {
  if (!looks_back_) {
    return true;
  }
  const auto path = steering_.path(from, to);
  return path && (path->legs.empty() || rules_.ok(before, path->legs.front()));
}

Route PathRules::route_through(const std::vector<Pose>& poses) const {
  std::vector<Leg> legs;
  for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
    const auto path = steering_.path(poses[i], poses[i + 1]);
    legs.insert(legs.end(), path->legs.begin(), path->legs.end());
  }
  return route_of(legs, poses.front().position, request_);
}
}  // namespace altiplan::kit
