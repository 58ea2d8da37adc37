// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "altiplan/nearest_place.hpp"
#include "host/base/run_status.hpp"
#include "host/flight/flight_world.hpp"
#include "host/flight/track_judge.hpp"
#include "host/view/scene_parts.hpp"

namespace altiplan::host {
namespace {

constexpr std::size_t kMaxPoints = 20'000;

/// For each event, the first point of the track at which it is due.
std::vector<std::optional<std::size_t>> points_of_events(const Track& track,
                                                         const std::vector<FlightEvent>& events) {
  std::vector<std::optional<std::size_t>> points(events.size());
  for (std::size_t i = 0; i < events.size(); ++i) {
    for (std::size_t at = 0; at < track.size() && !points[i]; ++at) {
      if (events[i].is_due(track[at].first, track[at].second)) {
        points[i] = at;
      }
    }
  }
  return points;
}

/// The first point at or after that time; the last if there is none.
std::size_t point_at(const Track& track, double time_s) {
  const auto found =
      std::lower_bound(track.begin(), track.end(), time_s,
                       [](const auto& point, double time) { return point.first < time; });
  return std::min(std::size_t(found - track.begin()), track.size() - 1);
}

/// Distance of the point from the vehicle's position at that time on a straight, uniform motion
/// from the point before to the one after.
double bend(const Track& track, std::size_t i) {
  const auto& [t0, a] = track[i - 1];
  const auto& [t, p] = track[i];
  const auto& [t1, b] = track[i + 1];
  const double share = t1 > t0 ? (t - t0) / (t1 - t0) : 0;
  return (p - (a + share * (b - a))).norm();
}

/// The track points to show: all in `must`; of the remainder up to `max_points`, half evenly
/// spaced, half where the track bends most.
std::set<std::size_t> thinned(const Track& track, std::set<std::size_t> must,
                              std::size_t max_points) {
  if (track.size() <= max_points) {
    for (std::size_t i = 0; i < track.size(); ++i) {
      must.insert(must.end(), i);
    }
    return must;
  }
  const std::size_t spare = max_points - std::min(max_points, must.size());
  std::vector<std::size_t> bends;
  for (std::size_t i = 1; i + 1 < track.size(); ++i) {
    bends.push_back(i);
  }
  const auto sharpest = bends.begin() + std::ptrdiff_t(std::min(spare / 2, bends.size()));
  std::nth_element(bends.begin(), sharpest, bends.end(), [&](std::size_t i, std::size_t j) {
    return std::pair(-bend(track, i), i) < std::pair(-bend(track, j), j);
  });
  for (std::size_t n = 0; n < spare / 2; ++n) {
    must.insert(n * track.size() / (spare / 2));
  }
  must.insert(bends.begin(), sharpest);
  return must;
}

/// Points at which something happens.
std::set<std::size_t> happenings(const Json& flight, const Track& track,
                                 const std::vector<std::optional<std::size_t>>& events) {
  std::set<std::size_t> points{0, track.size() - 1};
  for (const char* list : {"handovers", "replans"}) {
    for (const Json& happening : flight.at(list)) {
      points.insert(point_at(track, happening.at("at_s").get<double>()));
    }
  }
  for (const auto& event : events) {
    if (event) {
      points.insert(*event);
    }
  }
  return points;
}

/// The true world along a flight, as it is at each point; to be queried in track order.
class TruthAlong {
 public:
  TruthAlong(const Mission& mission, const std::vector<FlightEvent>& events,
             std::vector<std::optional<std::size_t>> points)
      : events_(events), points_(std::move(points)), world_(setup_of(mission)) {}

  void go_to(std::size_t point) {
    for (; next_ <= point; ++next_) {
      for (std::size_t i = 0; i < events_.size(); ++i) {
        if (points_[i] == next_ && events_[i].changes_world()) {
          world_.apply(events_[i]);
        }
      }
    }
  }
  std::optional<double> ground(const Vec3& p) const { return world_.truth().ground(p.x(), p.y()); }
  std::map<std::string, double> clearance(double time_s, const Vec3& p) const {
    std::map<std::string, double> each = clearances(world_.truth(), p);
    for (const MovingObstacle& moving : world_.truth().moving()) {
      double& min_distance = each.try_emplace("moving", kInfinity).first->second;
      min_distance = std::min(min_distance, signed_distance(moving.at(time_s), p));
    }
    return each;
  }
  double separation_below(double min_distance, const Vec3& a, double t0, const Vec3& b,
                          double t1) const {
    return world_.separation_below(min_distance, a, t0, b, t1);
  }
  void flown(const Vec3& a, double t0, const Vec3& b, double t1) { world_.flown(a, t0, b, t1); }
  NearestLeg separation() { return world_.separation(); }
  const World& truth() const { return world_.truth(); }

 private:
  static FlightSetup setup_of(const Mission& mission) {
    FlightSetup setup;
    setup.request = mission.track_request;
    setup.truth = mission.truth;
    return setup;
  }
  const std::vector<FlightEvent>& events_;
  std::vector<std::optional<std::size_t>> points_;
  FlightWorld world_;
  std::size_t next_ = 0;
};

/// A position on the track: a point, and the fraction of the leg to the next.
using TrackPlace = std::pair<std::size_t, double>;

std::pair<double, Vec3> at(const Track& track, const TrackPlace& place) {
  const auto& [t, p] = track[place.first];
  if (place.second == 0) {
    return {t, p};
  }
  const auto& [t1, p1] = track[place.first + 1];
  return {t + place.second * (t1 - t), p + place.second * (p1 - p)};
}

/// The position at which the flight came nearest to anything in the true world.
TrackPlace nearest_place(const Track& track, TruthAlong truth) {
  constexpr double kFine = 1e-4;  // metres
  TruthAlong there = truth;
  for (std::size_t i = 0; i + 1 < track.size(); ++i) {
    truth.go_to(i);
    truth.flown(track[i].second, track[i].first, track[i + 1].second, track[i + 1].first);
  }
  const auto [leg, min_distance] = truth.separation();
  if (min_distance == kInfinity) {
    return {0, 0};
  }
  there.go_to(leg);
  double from = 0;
  double to = 1;
  while ((to - from) * (track[leg + 1].second - track[leg].second).norm() > kFine) {
    const double middle = (from + to) / 2;
    const auto [t0, a] = at(track, {leg, from});
    const auto [t1, b] = at(track, {leg, middle});
    const double met = min_distance + kLengthTolerance;
    (there.separation_below(met, a, t0, b, t1) < met ? to : from) = middle;
  }
  return to == 1 ? TrackPlace{leg + 1, 0} : TrackPlace{leg, from};
}

/// Those points, the nearest approach to anything, and the lowest position.
std::set<TrackPlace> places_of(const Track& track, const std::set<std::size_t>& points,
                               TruthAlong truth) {
  std::set<TrackPlace> places{nearest_place(track, truth)};
  for (const std::size_t i : points) {
    places.emplace(i, 0);
  }
  Polyline route;
  for (const auto& [t, p] : track) {
    route.push_back(p);
  }
  truth.go_to(track.size() - 1);
  if (const auto lowest = lowest_leg(truth.truth(), route)) {
    const Vec3& a = route[lowest->leg];
    const double share = lowest_share(truth.truth(), a, route[lowest->leg + 1], lowest->distance);
    places.insert(share == 1 ? TrackPlace{lowest->leg + 1, 0} : TrackPlace{lowest->leg, share});
  }
  return places;
}

/// Adds the heights that the true world's layers fill, as they are when the vehicle is there.
void add_solids_along(Json& profile, const Track& track, const std::set<TrackPlace>& places,
                      TruthAlong truth, const Box& volume) {
  SolidProfile solids = solid_profile(profile, volume);
  for (const TrackPlace& place : places) {
    const std::size_t next = std::min(place.first + 1, track.size() - 1);
    const std::size_t last = next > 0 ? next - 1 : 0;
    truth.go_to(place.first);
    solids.add(truth.truth(), at(track, place).second, track[next].second - track[last].second);
  }
  solids.write(profile);
}

/// The flight's profile at those positions: height, clearance in the true world, and the speed and
/// turn flown.
Json profile_of(const Track& track, const std::set<std::size_t>& points, TruthAlong truth,
                const Box& volume) {
  const TruthAlong at_start = truth;
  Json profile;
  for (const char* key : {"t", "s", "altitude", "ground", "speed", "turn"}) {
    profile[key] = Json::array();
  }
  ClearanceProfile clearance;
  double s = 0;
  std::size_t reached = 0;
  const std::set<TrackPlace> places = places_of(track, points, truth);
  for (const TrackPlace& place : places) {
    const auto [i, share] = place;
    for (; reached < i; ++reached) {
      s += (track[reached + 1].second - track[reached].second).norm();
    }
    const auto [t, p] = at(track, place);
    const bool is_last = i + 1 == track.size();
    const Vec3 before = i > 0 ? Vec3(track[i].second - track[i - 1].second) : Vec3::Zero();
    const Vec3 after = is_last ? Vec3::Zero() : Vec3(track[i + 1].second - track[i].second);
    const std::size_t from = is_last && i > 0 ? i - 1 : i;  // of the leg whose speed is shown
    const double takes = from + 1 < track.size() ? track[from + 1].first - track[from].first : 0;
    truth.go_to(i);
    clearance.add(truth.clearance(t, p));
    profile["t"].push_back(rounded(t));
    profile["s"].push_back(rounded(s + share * after.norm()));
    profile["altitude"].push_back(rounded(p.z()));
    profile["ground"].push_back(rounded(truth.ground(p)));
    profile["speed"].push_back(takes > 0 ? rounded((is_last ? before : after).norm() / takes)
                                         : Json(nullptr));
    profile["turn"].push_back(i > 0 && !is_last && share == 0
                                  ? rounded(degrees(turn_angle_horizontal(before, after)))
                                  : Json(nullptr));
  }
  clearance.write(profile);
  add_solids_along(profile, track, places, at_start, volume);
  return profile;
}

Json happenings_json(const Json& list, std::initializer_list<const char*> texts) {
  Json happenings = Json::array();
  for (const Json& stored : list) {
    Json happening{{"at_s", stored.at("at_s")}};
    copy_texts(happening, stored, texts);
    happenings.push_back(std::move(happening));
  }
  return happenings;
}

/// The judge's present verdict on the track.
TrackVerdict judged(const Track& track, bool telemetry, const Mission& mission,
                    const std::vector<FlightEvent>& events) {
  FlightSetup setup;
  setup.request = mission.track_request;
  setup.truth = mission.truth;
  setup.events = events;
  setup.telemetry = telemetry;
  return judge_track(track, setup);
}

TrackVerdict verdict_of(const FlightResult& flight) {
  return {flight.check, flight.collisions, flight.reached, flight.measures,
          flight.min_separation_m};
}

/// The status of a flight with that verdict.
std::string status_of_track(const TrackVerdict& verdict) {
  return name(verdict.collisions > 0 ? RunStatus::collided
              : !verdict.reached     ? RunStatus::not_reached
              : !verdict.check.ok()  ? RunStatus::rejected
                                     : RunStatus::solved);
}

std::string first_found_on(const TrackVerdict& verdict, const Track& track) {
  if (verdict.check.ok()) {
    return "";
  }
  const Violation& first = verdict.check.violations.front();
  char when[32];
  std::snprintf(when, sizeof when,
                "at %.1f s: ", track[std::min(first.at, track.size() - 1)].first);
  return when + first.message;
}

/// The verdict, with indices into the thinned track.
Json recounted(Json check, const std::set<std::size_t>& shown) {
  const std::vector<std::size_t> points(shown.begin(), shown.end());
  for (Json& violation : check.at("violations")) {
    const auto at = violation.at("at").get<std::size_t>();
    const auto found = std::lower_bound(points.begin(), points.end(), at);
    violation["at"] = std::min(std::size_t(found - points.begin()), points.size() - 1);
  }
  return check;
}
}  // namespace

Json flight_scene(const StoredResult& stored, const Mission& mission,
                  const std::vector<FlightEvent>& events, const SceneDetail& detail,
                  SceneNotes& notes) {
  if (!stored.track) {
    return nullptr;
  }
  const Track& track = *stored.track;
  const Json& flight = stored.json.at("flight");
  const auto points = points_of_events(track, events);
  const std::set<std::size_t> must = happenings(flight, track, points);
  const std::set<std::size_t> shown = thinned(track, must, kMaxPoints);
  if (shown.size() < track.size()) {
    notes.add(stored.file + ": the flight is shown with " + std::to_string(shown.size()) +
              " of its " + std::to_string(track.size()) + " points");
  }
  Json json;
  copy_texts(json, flight, {"status", "message"});
  const TrackVerdict now = detail.judged != nullptr
                               ? verdict_of(detail.judged->flight.value())
                               : judged(track, stored.telemetry, mission, events);
  const std::string whose = stored.file + ": the flight";
  set_status(json, stored.file, status_of_track(now), first_found_on(now, track));
  json["metrics"] = metrics_now(flight.at("metrics"), to_json(now.measures));
  for (const char* name : {"cross_track_max_m", "cross_track_p999_m", "height_error_max_m"}) {
    if (const auto error = flight.find(name); error != flight.end() && !error->is_null()) {
      json["metrics"][name] = *error;  // of an aeroplane
    }
  }
  json["collisions"] = now.collisions;
  json["min_separation_m"] = now.min_separation_m ? Json(*now.min_separation_m) : Json(nullptr);
  json["reached"] = now.reached;
  json["check"] = check_scene(recounted(to_json(now.check), shown), whose, notes);
  json["handovers"] = happenings_json(flight.at("handovers"), {"to", "why"});
  json["replans"] = happenings_json(flight.at("replans"), {"step", "status", "message"});
  json["track"] = Json::array();
  for (const std::size_t i : shown) {
    const auto& [t, p] = track[i];
    json["track"].push_back({rounded(t), rounded(p.x()), rounded(p.y()), rounded(p.z())});
  }
  json["event_times"] = Json::array();
  for (const auto& point : points) {
    json["event_times"].push_back(point ? rounded(track[*point].first) : Json(nullptr));
  }
  json["profile"] =
      detail.heights ? profile_of(track, thinned(track, must, detail.samples),
                                  TruthAlong(mission, events, points), mission.track_request.volume)
                     : Json(nullptr);
  return json;
}
}  // namespace altiplan::host
