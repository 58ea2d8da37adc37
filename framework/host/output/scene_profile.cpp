// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "altiplan/route.hpp"
#include "host/output/scene_parts.hpp"

namespace altiplan::host {
namespace {

/// Samples of a profile, unless there are more waypoints than that.
constexpr std::size_t kMostSamples = 2000;

/// A place along the route; at waypoints the angle by which it turns there.
struct Sample {
  double s = 0;
  Vec3 at{0, 0, 0};
  std::optional<double> turn_deg;
};

/// The waypoints, and places evenly between them as far as there is room for more.
std::vector<Sample> samples_of(const Route& route) {
  const double total = length(route);
  const std::size_t spare = kMostSamples - std::min(kMostSamples, route.size());
  const double step = spare > 0 ? total / double(spare) : kInfinity;
  std::vector<Sample> samples;
  double s = 0;
  for (std::size_t i = 0; i < route.size(); ++i) {
    std::optional<double> turn;
    if (i > 0 && i + 1 < route.size()) {
      turn = degrees(turn_angle_horizontal(route[i] - route[i - 1], route[i + 1] - route[i]));
    }
    samples.push_back({s, route[i], turn});
    if (i + 1 < route.size()) {
      const Vec3 leg = route[i + 1] - route[i];
      const int parts = std::isfinite(step) ? 1 + int(leg.norm() / step) : 1;
      for (int part = 1; part < parts; ++part) {
        const double share = double(part) / parts;
        samples.push_back({s + share * leg.norm(), route[i] + share * leg, std::nullopt});
      }
      s += leg.norm();
    }
  }
  return samples;
}
}  // namespace

Json route_profile(const Route& route, const Request& request) {
  Json profile;
  for (const char* key : {"s", "at", "altitude", "ground", "clearance", "speed", "turn"}) {
    profile[key] = Json::array();
  }
  for (const Sample& sample : samples_of(without_repeats(route))) {
    const double clearance = request.world->clearance(sample.at);
    profile["s"].push_back(rounded(sample.s));
    profile["at"].push_back(rounded(sample.at));
    profile["altitude"].push_back(rounded(sample.at.z()));
    profile["ground"].push_back(rounded(request.world->ground(sample.at.x(), sample.at.y())));
    profile["clearance"].push_back(rounded(clearance));
    profile["speed"].push_back(rounded(request.vehicle.speed_at(clearance)));
    profile["turn"].push_back(rounded(sample.turn_deg));
  }
  return profile;
}
}  // namespace altiplan::host
