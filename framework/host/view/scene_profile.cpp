// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "altiplan/nearest_place.hpp"
#include "altiplan/route.hpp"
#include "host/view/scene_parts.hpp"

namespace altiplan::host {
namespace {

/// A position along the route; at waypoints with the turn angle.
struct Sample {
  double s = 0;
  Vec3 at{0, 0, 0};
  std::optional<double> turn_deg;
};

/// The positions of the route's minimum clearances and height, as leg and fraction of it.
std::vector<std::pair<std::size_t, double>> nearest_places(const Polyline& route,
                                                           const World& world) {
  struct Nearest {
    NearestLeg leg;
    const Environment* layer;
  };
  std::map<std::string, Nearest> nearest;  // by kind
  for (const Layer& layer : world.layers()) {
    const auto before = nearest.find(layer.plugin);
    const double enough = before == nearest.end() ? kInfinity : before->second.leg.distance;
    if (const auto leg = nearest_leg(*layer.environment, route, enough)) {
      nearest.insert_or_assign(layer.plugin, Nearest{*leg, layer.environment.get()});
    }
  }
  std::vector<std::pair<std::size_t, double>> places;
  for (const auto& [kind, its] : nearest) {
    const std::size_t i = its.leg.leg;
    places.emplace_back(i, nearest_share(*its.layer, route[i], route[i + 1], its.leg.distance));
  }
  if (const auto lowest = lowest_leg(world, route)) {
    const std::size_t i = lowest->leg;
    places.emplace_back(i, lowest_share(world, route[i], route[i + 1], lowest->distance));
  }
  std::sort(places.begin(), places.end());
  return places;
}

/// The waypoints, those positions, and evenly spaced others up to the sample limit.
std::vector<Sample> samples_of(const Polyline& route,
                               const std::vector<std::pair<std::size_t, double>>& places,
                               std::size_t most, bool turns_on_the_spot) {
  const double total = length(route);
  const std::size_t spare = most - std::min(most, route.size() + places.size());
  const double step = spare > 0 ? total / double(spare) : kInfinity;
  std::vector<Sample> samples;
  auto place = places.begin();
  std::optional<Approach> before;
  double s = 0;
  for (std::size_t i = 0; i < route.size(); ++i) {
    std::optional<double> turn;
    if (i > 0 && i + 1 < route.size()) {
      before = onward(before, route[i - 1]);
      turn = degrees(horizontal_turn(*before, route[i], route[i + 1], turns_on_the_spot));
    }
    samples.push_back({s, route[i], turn});
    if (i + 1 < route.size()) {
      const Vec3 leg = route[i + 1] - route[i];
      const int parts = std::isfinite(step) ? 1 + int(leg.norm() / step) : 1;
      std::vector<double> shares;
      for (int part = 1; part < parts; ++part) {
        shares.push_back(double(part) / parts);
      }
      for (; place != places.end() && place->first == i; ++place) {
        if (place->second > 0 && place->second < 1) {
          shares.push_back(place->second);
        }
      }
      std::sort(shares.begin(), shares.end());
      for (const double share : shares) {
        samples.push_back({s + share * leg.norm(), route[i] + share * leg, std::nullopt});
      }
      s += leg.norm();
    }
  }
  return samples;
}
}  // namespace

std::map<std::string, double> clearances(const World& world, const Vec3& p) {
  std::map<std::string, double> each;
  for (const Layer& layer : world.layers()) {
    double& least = each.try_emplace(layer.plugin, kInfinity).first->second;
    if (layer.environment->clearance(p) < least) {
      least = std::min(least, place_clearance(*layer.environment, p));
    }
  }
  return each;
}

void ClearanceProfile::add(const std::map<std::string, double>& each) {
  least_ = kInfinity;
  for (const auto& [kind, clearance] : each) {
    Json& values = to_[kind];
    while (values.size() < count_) {
      values.push_back(nullptr);
    }
    values.push_back(rounded(clearance));
    least_ = std::min(least_, clearance);
  }
  clearance_.push_back(rounded(least_));
  ++count_;
  for (Json& values : to_) {
    if (values.size() < count_) {
      values.push_back(nullptr);
    }
  }
}

void ClearanceProfile::write(Json& profile) const {
  profile["clearance"] = clearance_;
  profile["to"] = to_;
}

Json route_profile(const Polyline& whole, const Request& request, std::size_t samples) {
  const World& world = *request.world;
  const Polyline route = without_repeats(whole);
  Json profile;
  for (const char* key : {"s", "at", "altitude", "ground", "speed", "turn"}) {
    profile[key] = Json::array();
  }
  ClearanceProfile clearance;
  for (const Sample& sample : samples_of(route, nearest_places(route, world), samples,
                                         request.vehicle.turns_on_the_spot)) {
    clearance.add(clearances(world, sample.at));
    profile["s"].push_back(rounded(sample.s));
    profile["at"].push_back(rounded(sample.at));
    profile["altitude"].push_back(rounded(sample.at.z()));
    profile["ground"].push_back(rounded(world.ground(sample.at.x(), sample.at.y())));
    profile["speed"].push_back(rounded(request.vehicle.speed_at(world.clearance(sample.at))));
    profile["turn"].push_back(rounded(sample.turn_deg));
  }
  clearance.write(profile);
  return profile;
}
}  // namespace altiplan::host
