// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "altiplan/constraint.hpp"
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

/// A leg and a fraction of its time.
using LegPlace = std::pair<std::size_t, double>;

/// The route as chords, with the begin of each as a place on it.
struct Chords {
  Polyline points;
  std::vector<LegPlace> places;  ///< one per point

  explicit Chords(const Route& route) : points{route.front()}, places{{0, 0}} {
    for (std::size_t i = 0; i < route.leg_count(); ++i) {
      const Polyline part = route.leg(i).chords(kChordTolerance);
      places.back() = {i, 0};
      for (std::size_t k = 1; k < part.size(); ++k) {
        points.push_back(part[k]);
        places.emplace_back(i, double(k) / double(part.size() - 1));
      }
    }
  }
  /// The place at a fraction of a chord.
  LegPlace at(std::size_t chord, double share) const {
    const auto [leg, from] = places[chord];
    const double to = places[chord + 1].first == leg ? places[chord + 1].second : 1;
    return {leg, from + share * (to - from)};
  }
};

/// The places of the route's minimum clearances and height.
std::vector<LegPlace> nearest_places(const Route& route, const World& world) {
  struct Nearest {
    NearestLeg leg;
    const Environment* layer;
  };
  const Chords chords(route);
  const Polyline& points = chords.points;
  std::map<std::string, Nearest> nearest;  // by kind
  for (const Layer& layer : world.layers()) {
    const auto before = nearest.find(layer.plugin);
    const double enough = before == nearest.end() ? kInfinity : before->second.leg.distance;
    if (const auto leg = nearest_leg(*layer.environment, points, enough)) {
      nearest.insert_or_assign(layer.plugin, Nearest{*leg, layer.environment.get()});
    }
  }
  std::vector<LegPlace> places;
  for (const auto& [kind, its] : nearest) {
    const std::size_t i = its.leg.leg;
    places.push_back(
        chords.at(i, nearest_share(*its.layer, points[i], points[i + 1], its.leg.distance)));
  }
  if (const auto lowest = lowest_leg(world, points)) {
    const std::size_t i = lowest->leg;
    places.push_back(chords.at(i, lowest_share(world, points[i], points[i + 1], lowest->distance)));
  }
  std::sort(places.begin(), places.end());
  return places;
}

/// The turn angle at each waypoint between two legs; of legs that join tangentially 0.
std::vector<std::optional<double>> turns_of(const Route& route, bool turns_on_the_spot) {
  std::vector<std::optional<double>> turns(route.size());
  std::optional<Approach> before;
  for (std::size_t i = 1; i + 1 < route.size(); ++i) {
    before = onward(before, route.leg(i - 1));
    const Vec3 next = route[i] + route.leg(i).track(0);
    turns[i] = before ? degrees(horizontal_turn(*before, route[i], next, turns_on_the_spot)) : 0;
  }
  return turns;
}

/// The waypoints, those places, and evenly spaced others up to the sample limit.
std::vector<Sample> samples_of(const Route& route, const std::vector<LegPlace>& places,
                               std::size_t max_samples, bool turns_on_the_spot) {
  const double total = length(route);
  const std::size_t spare = max_samples - std::min(max_samples, route.size() + places.size());
  const double step = spare > 0 ? total / double(spare) : kInfinity;
  const auto turns = turns_of(route, turns_on_the_spot);
  std::vector<Sample> samples;
  auto place = places.begin();
  double s = 0;
  for (std::size_t i = 0; i < route.size(); ++i) {
    samples.push_back({s, route[i], turns[i]});
    if (i + 1 == route.size()) {
      break;
    }
    const Leg leg = route.leg(i);
    const double run = leg.length();
    const int parts = std::isfinite(step) ? 1 + int(run / step) : 1;
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
    const bool is_even = leg.kind() != Leg::Kind::trochoid;
    for (const double share : shares) {
      const double from_here = is_even ? share * run : leg.piece(0, share).length();
      samples.push_back({s + from_here, leg.at(share), std::nullopt});
    }
    s += run;
  }
  return samples;
}
}  // namespace

std::map<std::string, double> clearances(const World& world, const Vec3& p) {
  std::map<std::string, double> each;
  for (const Layer& layer : world.layers()) {
    double& min_clearance = each.try_emplace(layer.plugin, kInfinity).first->second;
    if (layer.environment->clearance(p) < min_clearance) {
      min_clearance = std::min(min_clearance, place_clearance(*layer.environment, p));
    }
  }
  return each;
}

void ClearanceProfile::add(const std::map<std::string, double>& each) {
  double min_clearance = kInfinity;
  for (const auto& [kind, clearance] : each) {
    Json& values = to_[kind];
    while (values.size() < count_) {
      values.push_back(nullptr);
    }
    values.push_back(rounded(clearance));
    min_clearance = std::min(min_clearance, clearance);
  }
  clearance_.push_back(rounded(min_clearance));
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

Json route_profile(const Route& whole, const Request& request, const SceneDetail& detail) {
  const World& world = *request.world;
  const Route route = without_repeats(whole);
  Json profile;
  for (const char* key : {"s", "at", "altitude", "ground", "speed", "turn"}) {
    profile[key] = Json::array();
  }
  ClearanceProfile clearance;
  const std::vector<LegPlace> places =
      detail.heights ? nearest_places(route, world) : std::vector<LegPlace>();
  const std::vector<Sample> samples =
      samples_of(route, places, detail.samples, request.vehicle.turns_on_the_spot);
  const std::size_t every = detail.heights ? 1 : 1 + samples.size() / (detail.samples + 1);
  for (std::size_t n = 0; n < samples.size(); ++n) {
    const Sample& sample = samples[n];
    if (n % every != 0 && n + 1 < samples.size()) {
      continue;
    }
    clearance.add(clearances(world, sample.at));
    profile["s"].push_back(rounded(sample.s));
    profile["at"].push_back(rounded(sample.at));
    profile["altitude"].push_back(rounded(sample.at.z()));
    profile["ground"].push_back(rounded(world.ground(sample.at.x(), sample.at.y())));
    // At constant speed nobody asks how near the world is.
    const double nearest = request.vehicle.speed_near.empty() ? 0 : world.clearance(sample.at);
    profile["speed"].push_back(rounded(request.vehicle.speed_at(nearest)));
    profile["turn"].push_back(rounded(sample.turn_deg));
  }
  clearance.write(profile);
  if (detail.heights) {
    add_heights(profile, request);
  }
  return profile;
}
}  // namespace altiplan::host
