// SPDX-License-Identifier: Apache-2.0
#include "host/mission/vehicle.hpp"

#include <algorithm>

#include "altiplan/body.hpp"
#include "altiplan/energy.hpp"
#include "altiplan/environment.hpp"
#include "host/autopilot/parameters.hpp"
#include "host/config/config_check.hpp"
#include "host/energy/flight_power.hpp"

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

std::shared_ptr<const Power> power_of(const EnergyEntry& entry) {
  if (entry.multirotor) {
    return std::make_shared<LiuPower>(*entry.multirotor);
  }
  if (entry.rotors) {
    return std::make_shared<MomentumPower>(*entry.rotors);
  }
  if (entry.aeroplane) {
    return std::make_shared<PolarPower>(*entry.aeroplane);
  }
  if (entry.power_w) {
    MeanPower power;
    power.mean_w = *entry.power_w;
    return std::make_shared<MeanPower>(power);
  }
  MeasuredPower power;
  if (const auto& hover = entry.hover) {
    constexpr double kAnySpeed = 1e9;
    power.level = {
        {0, hover->power_w},
        {hover->cruise_mps.value_or(kAnySpeed), hover->cruise_w.value_or(hover->power_w)}};
    power.mass_kg = hover->mass_kg;
    power.efficiency = hover->efficiency;
  } else {
    for (const LevelPowerEntry& level : entry.measured->level) {
      power.level.push_back({level.airspeed_mps, level.power_w});
    }
    power.mass_kg = entry.measured->mass_kg;
    power.efficiency = entry.measured->efficiency;
  }
  return std::make_shared<MeasuredPower>(power);
}

/// What a performance says, where nothing else is given.
void take_defaults(Performance performance, Vehicle& vehicle) {
  using formats::Airframe;
  using formats::Firmware;
  const bool is_px4 = performance == Performance::px4_mc || performance == Performance::px4_fw;
  const bool is_copter =
      performance == Performance::px4_mc || performance == Performance::arducopter;
  const ParameterFile none;
  const Parameters value({is_px4 ? Firmware::px4 : Firmware::ardupilot,
                          is_copter ? Airframe::copter : Airframe::plane},
                         none);
  const auto of = [&](const char* px4, const char* ardupilot) {
    return value(is_px4 ? px4 : ardupilot);
  };
  if (!is_copter) {
    vehicle.speed_mps = of("FW_AIRSPD_TRIM", "AIRSPEED_CRUISE");
    vehicle.climb_mps = of("FW_T_CLMB_R_SP", "TECS_CLMB_MAX");
    vehicle.sink_mps = of("FW_T_SINK_R_SP", "TECS_SINK_MAX");
    vehicle.wing = {vehicle.speed_mps, radians(of("FW_R_LIM", "ROLL_LIMIT_DEG")), kPi / 2, kPi / 2};
    return;
  }
  vehicle.speed_mps = of("MPC_XY_CRUISE", "WP_SPD");
  vehicle.climb_mps = of("MPC_Z_V_AUTO_UP", "WP_SPD_UP");
  vehicle.sink_mps = of("MPC_Z_V_AUTO_DN", "WP_SPD_DN");
  vehicle.acceleration.mps2 = of("MPC_ACC_HOR", "WP_ACC");
  vehicle.acceleration.jerk_mps3 = of("MPC_JERK_AUTO", "WP_JERK");
  // ArduPilot's jerk follows the attitude, whose time constant it takes for 0.1 s at least; PX4
  // passes corners at the speed of half of its radius.
  vehicle.acceleration.jerk_time_s = is_px4 ? 0 : 2 * std::max(value("ATC_INPUT_TC"), 0.1);
  vehicle.acceleration.corner_radius_m =
      is_px4 ? value("MPC_XY_TRAJ_P") * value("NAV_ACC_RAD") : value("WP_RADIUS_M");
}
}  // namespace

Vehicle vehicle_of(const VehicleEntry& entry, const Value* where, Registry& registry) {
  Vehicle vehicle;
  if (entry.body) {
    vehicle.body = body_of(*entry.body, *where->find("body"), registry);
  }
  vehicle.radius_m = vehicle.body != nullptr ? vehicle.body->inner_m() : entry.radius_m;
  vehicle.speed_mps = 15;
  if (entry.performance != Performance::none) {
    take_defaults(entry.performance, vehicle);
  }
  const auto take = [](double& value, const std::optional<double>& given) {
    value = given.value_or(value);
  };
  take(vehicle.speed_mps, entry.speed_mps);
  take(vehicle.climb_mps, entry.climb_mps);
  take(vehicle.sink_mps, entry.sink_mps);
  take(vehicle.acceleration.mps2, entry.acceleration_mps2);
  take(vehicle.acceleration.jerk_mps3, entry.jerk_mps3);
  take(vehicle.acceleration.jerk_time_s, entry.jerk_time_s);
  if (entry.corner_radius_m) {
    vehicle.acceleration.corner_radius_m = entry.corner_radius_m;
  }
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
  if (vehicle.wing) {  // which does not slow down to climb
    Wing& wing = *vehicle.wing;
    wing.airspeed_mps = vehicle.speed_mps;
    wing.climb = std::min(wing.climb, std::atan(vehicle.climb_mps / wing.airspeed_mps));
    wing.sink = std::min(wing.sink, std::atan(vehicle.sink_mps / wing.airspeed_mps));
  }
  if (const auto& energy = entry.energy) {
    vehicle.energy =
        std::make_shared<Energy>(Energy{power_of(*energy), energy->capacity_wh.value_or(kInfinity),
                                        energy->usable, energy->reserve});
  }
  return vehicle;
}
}  // namespace altiplan::host
