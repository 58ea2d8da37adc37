// SPDX-License-Identifier: Apache-2.0
#include "host/mission/vehicle.hpp"

#include <algorithm>

#include "altiplan/body.hpp"
#include "altiplan/environment.hpp"
#include "host/config/config_check.hpp"

namespace altiplan::host {
namespace {

constexpr double kFarthest = 1000;  // metres

/// A part, with the location of its keys for messages.
class PartReader {
 public:
  PartReader(const Value& where, std::string key, Registry& registry)
      : where_(where), key_(std::move(key)), registry_(registry) {}

  BodyPart operator()(const BodyPartEntry& entry) const {
    if (entry.box_m) {
      return box_part(*entry.box_m, entry.offset_m);
    }
    if (const auto& cylinder = entry.cylinder) {
      return cylinder_part(cylinder->radius_m, cylinder->height_m, entry.offset_m);
    }
    if (const auto& capsule = entry.capsule) {
      return capsule_part(capsule->radius_m, capsule->length_m, entry.offset_m);
    }
    try {
      return hull_part(corners_of(*entry.mesh, entry.scale, entry.offset_m));
    } catch (const Error& error) {
      throw ConfigError(place_of(where_, "mesh"), key_ + ".mesh", error.what());
    }
  }

 private:
  /// By the environment plugin for meshes, which refuses damaged and open ones.
  std::vector<Vec3> corners_of(const Path& file, double scale, const Vec3& offset) const {
    Value parameters;
    parameters.kind = Value::Kind::map;
    parameters.where = where_.where;
    const auto add = [&](const std::string& key, const std::string& text) {
      Value value;
      value.text = text;
      value.quoted = key == "file";
      value.where = where_.where;
      parameters.entries.push_back({key, where_.where, value});
    };
    add("file", file.text);
    const World nothing;
    Site site;
    site.before = &nothing;
    const auto mesh = plugin(registry_, "environment", "mesh").environment(&parameters, site);
    const Drawing drawing = mesh->drawing().value();
    std::vector<Vec3> corners;
    for (const auto& triangle : drawing.triangles) {
      for (const Vec3& corner : triangle) {
        corners.push_back(offset + scale * corner);
      }
    }
    // Triangles share corners.
    const auto less = [](const Vec3& a, const Vec3& b) {
      return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
    };
    std::sort(corners.begin(), corners.end(), less);
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    Box box = Box::empty();
    for (const Vec3& corner : corners) {
      box = box.with(corner);
    }
    const double farthest = std::max(box.max.maxCoeff(), -box.min.minCoeff());
    if (farthest > kFarthest) {
      throw Error(file.text + ": reaches " + std::to_string(std::llround(farthest)) +
                  " m from the vehicle's reference point, expected at most " +
                  std::to_string(std::llround(kFarthest)) +
                  " m: check `scale`, metres per unit of the file, and its origin");
    }
    return corners;
  }

  const Value& where_;
  std::string key_;
  Registry& registry_;
};

std::shared_ptr<const Body> body_of(const BodyEntry& entry, const Value& where,
                                    Registry& registry) {
  auto body = std::make_shared<Body>();
  if (entry.parts.empty()) {
    body->parts.push_back(PartReader(where, "vehicle.body", registry)(entry.part));
  }
  for (std::size_t i = 0; i < entry.parts.size(); ++i) {
    const std::string key = "vehicle.body.parts." + std::to_string(i);
    const Value& part = where.find("parts")->items[i];
    body->parts.push_back(PartReader(part, key, registry)(entry.parts[i]));
  }
  if (entry.fixed_deg) {
    body->yaw = radians(90 - *entry.fixed_deg);
  }
  body->pitches = entry.pitch == BodyEntry::Pitch::along_route;
  return body;
}
}  // namespace

Vehicle vehicle_of(const VehicleEntry& entry, const Value* where, Registry& registry) {
  Vehicle vehicle;
  if (entry.body) {
    vehicle.body = body_of(*entry.body, *where->find("body"), registry);
  }
  vehicle.radius_m = vehicle.body != nullptr ? vehicle.body->inner_m() : entry.radius_m;
  vehicle.speed_mps = entry.speed_mps;
  vehicle.sensing_m = entry.sensing_m.value_or(kInfinity);
  vehicle.turns_on_the_spot = entry.turns_on_the_spot;
  for (const SpeedNearEntry& near : entry.speed_near) {
    vehicle.speed_near.push_back({near.within_m, near.speed_mps});
  }
  if (const auto& wing = entry.wing) {
    vehicle.speed_mps = wing->airspeed_mps;
    vehicle.wing = {vehicle.speed_mps, radians(wing->bank_deg), radians(wing->climb_deg),
                    radians(wing->sink_deg), radians(wing->roll_rate_dps)};
  }
  return vehicle;
}

Wind wind_of(const WindEntry& entry) {
  const auto velocity = [](double from_deg, double speed_mps) -> Vec3 {
    return -speed_mps * unit_heading(radians(90 - from_deg));
  };
  Wind wind;
  if (entry.from_deg && *entry.speed_mps > 0) {
    wind.layers.push_back({-kInfinity, velocity(*entry.from_deg, *entry.speed_mps)});
  }
  for (const auto& [above_m, from_deg, speed_mps] : entry.layers) {
    wind.layers.push_back({above_m, velocity(from_deg, speed_mps)});
  }
  return wind;
}
}  // namespace altiplan::host
