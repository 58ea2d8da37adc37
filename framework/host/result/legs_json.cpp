// SPDX-License-Identifier: Apache-2.0
#include "host/result/legs_json.hpp"

#include "altiplan/error.hpp"
#include "altiplan/leg_limits.hpp"
#include "host/result/stored_shape.hpp"

namespace altiplan::host {
namespace {

const char* name(Leg::Kind kind) {
  return kind == Leg::Kind::straight ? "straight" : kind == Leg::Kind::arc ? "arc" : "trochoid";
}

/// Clockwise from north, in [0, 360).
double compass(double heading) {
  const double turned = std::fmod(90 - degrees(heading), 360);
  return turned < 0 ? turned + 360 : turned;
}

double number_of(const Json& leg, const char* key, const std::string& place) {
  const auto found = leg.find(key);
  if (found == leg.end() || !found->is_number()) {
    throw Error(place + "." + key + ": expected a number, found " +
                (found == leg.end() ? "nothing" : found_text(*found)));
  }
  return found->get<double>();
}

/// A list of `count` numbers as a vector.
Vec3 vector_of(const Json& leg, const char* key, std::size_t count, const std::string& place) {
  const auto found = leg.find(key);
  const bool is_list =
      found != leg.end() && found->is_array() && found->size() == count &&
      std::all_of(found->begin(), found->end(), [](const Json& each) { return each.is_number(); });
  if (!is_list) {
    throw Error(place + "." + key + ": expected a list of " + std::to_string(count) +
                " numbers in metres, found " +
                (found == leg.end() ? "nothing" : found_text(*found)));
  }
  Vec3 v(0, 0, 0);
  for (std::size_t i = 0; i < count; ++i) {
    v[Eigen::Index(i)] = found->at(i).get<double>();
  }
  return v;
}

bool is_given(const Json& leg, const char* key) {
  const auto found = leg.find(key);
  return found != leg.end() && !found->is_null();
}

Leg leg_of(const Vec3& from, const Json& json, const std::string& place) {
  if (!json.is_object()) {
    throw Error(place + ": expected an object, found " + found_text(json));
  }
  Leg leg = Leg::straight(from, vector_of(json, "end", 3, place));
  const Json kind = json.value("kind", Json());
  if (kind == name(Leg::Kind::straight)) {
    for (const char* key : {"turn_deg", "radius_m", "heading_deg", "drift_m"}) {
      if (is_given(json, key)) {
        throw Error(place + "." + key + ": expected null on a straight leg, found " +
                    found_text(json[key]));
      }
    }
    if (is_given(json, "hold_s")) {
      leg.hold_s = number_of(json, "hold_s", place);
      if (!(leg.hold_s > 0) || leg.to != from) {
        throw Error(place + ".hold_s: expected a time above 0, on a leg that ends where it begins");
      }
    }
    return leg;
  }
  if (is_given(json, "hold_s")) {
    throw Error(place + ".hold_s: expected none on a turn, found " + found_text(json["hold_s"]));
  }
  if (kind != name(Leg::Kind::arc) && kind != name(Leg::Kind::trochoid)) {
    throw Error(place + ".kind: expected one of straight, arc, trochoid, found " +
                found_text(kind));
  }
  leg.turn = radians(number_of(json, "turn_deg", place));
  leg.radius = number_of(json, "radius_m", place);
  if (leg.turn == 0 || std::abs(leg.turn) > kMaxTurn) {
    throw Error(place + ".turn_deg: expected an angle other than 0, at most " +
                std::to_string(std::lround(degrees(kMaxTurn))) + " degrees either way");
  }
  if (!(leg.radius > 0) || leg.radius > kMaxTurnRadius) {
    throw Error(place + ".radius_m: expected a radius above 0, at most 1e8 m");
  }
  if (is_given(json, "drift_m")) {
    leg.drift = vector_of(json, "drift_m", 2, place);
  }
  const bool is_trochoid = kind == name(Leg::Kind::trochoid);
  if (is_trochoid != (leg.kind() == Leg::Kind::trochoid)) {
    throw Error(place + ".drift_m: expected " +
                (is_trochoid ? "the drift of a trochoid, which is not 0" : "no drift of an arc") +
                ", found " + (json.contains("drift_m") ? found_text(json["drift_m"]) : "nothing"));
  }
  if (is_given(json, "heading_deg") || (is_trochoid && json.contains("heading_deg"))) {
    leg.heading = radians(90 - number_of(json, "heading_deg", place));
  } else {  // half a turn before the direction of the chord
    const Vec3 chord = leg.to - leg.from - leg.drift;
    const double backwards = std::sin(std::abs(leg.turn) / 2) < 0 ? kPi : 0;
    leg.heading = std::atan2(chord.y(), chord.x()) - leg.turn / 2 + backwards;
  }
  return leg;
}
}  // namespace

Json legs_json(const Route& route) {
  Json all = Json::array();
  for (std::size_t i = 0; i < route.leg_count(); ++i) {
    const Leg leg = route.leg(i);
    Json json;
    json["kind"] = name(leg.kind());
    json["end"] = {leg.to.x(), leg.to.y(), leg.to.z()};
    json["turn_deg"] = leg.turns() ? Json(degrees(leg.turn)) : Json();
    json["radius_m"] = leg.turns() ? Json(leg.radius) : Json();
    json["heading_deg"] = leg.turns() ? Json(compass(leg.heading)) : Json();
    json["drift_m"] = leg.turns() ? Json{leg.drift.x(), leg.drift.y()} : Json();
    if (leg.waits()) {
      json["hold_s"] = leg.hold_s;
    }
    all.push_back(std::move(json));
  }
  return all;
}

Route route_of_legs(const Vec3& start, const Json& legs, const std::string& place) {
  if (!legs.is_array()) {
    throw Error(place + ": expected a list, found " + found_text(legs));
  }
  Route route{start};
  for (const Json& leg : legs) {
    route.push_back(leg_of(route.back(), leg, place + "." + std::to_string(route.leg_count())));
  }
  return route;
}
}  // namespace altiplan::host
