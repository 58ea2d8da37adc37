// SPDX-License-Identifier: Apache-2.0
#include "host/import_export/plan.hpp"

#include <algorithm>
#include <cmath>

#include "altiplan/error.hpp"
#include "altiplan/geometry.hpp"

namespace altiplan::host {
namespace {

using formats::MissionItem;

int command_of(const MissionItem& item, VehicleType vehicle) {
  using Until = formats::MissionCircle::Until;
  const bool is_vtol = vehicle == VehicleType::vtol;
  switch (item.kind) {
    case MissionItem::Kind::takeoff:
      return is_vtol ? Command::kVtolTakeoff : Command::kTakeoff;
    case MissionItem::Kind::land:
      return is_vtol ? Command::kVtolLand : Command::kLand;
    case MissionItem::Kind::loiter:
      return !item.circle || item.circle->until == Until::forever ? Command::kLoiterForever
             : item.circle->until == Until::turns                 ? Command::kLoiterTurns
                                                                  : Command::kLoiterToAltitude;
    case MissionItem::Kind::waypoint:
      break;
  }
  return Command::kWaypoint;
}

int frame_of(formats::AltitudeFrame frame) {
  return frame == formats::AltitudeFrame::sea ? 0 : frame == formats::AltitudeFrame::home ? 3 : 10;
}

/// The radius that MAVLink gives, positive clockwise, rounded up: a smaller one would be too tight.
double radius_of(const formats::MissionCircle& circle, int decimals) {
  const double nearest = rounded(circle.radius_m, decimals);
  const bool is_tighter = nearest < circle.radius_m - kLengthTolerance / 10;
  const double radius = is_tighter ? nearest + std::pow(10, -decimals) : nearest;
  return -circle.sense * rounded(radius, decimals);
}

/// The first four parameters. Circles are left when heading for the next item, toward it from that
/// place ("xtrack" 1).
std::array<double, 4> params_of(const MissionItem& item, const MissionText& text) {
  using Until = formats::MissionCircle::Until;
  const double unset = std::nan("");
  if (item.kind == MissionItem::Kind::takeoff && text.vehicle == VehicleType::plane) {
    return {text.climb_deg, 0, 0, unset};  // pitch
  }
  constexpr double kAcceptance = 2;  // metres: PX4's copter cuts corners by 10, ArduPilot's by 2
  const bool cuts = text.firmware == formats::Firmware::px4 &&
                    text.vehicle == VehicleType::copter && item.kind == MissionItem::Kind::waypoint;
  if (!item.circle) {
    // Hold time, acceptance radius, pass-by distance, heading. ArduPilot refuses loiters with a
    // parameter that is not a number.
    return {0, cuts ? kAcceptance : 0, 0, item.kind == MissionItem::Kind::loiter ? 0 : unset};
  }
  const double radius = radius_of(*item.circle, text.decimals.metres);
  switch (item.circle->until) {
    case Until::turns:
      return {item.circle->turns, 1, radius, 1};
    case Until::altitude:
      return {1, radius, 0, 1};
    case Until::forever:
      break;
  }
  return {0, 0, radius, 0};
}

constexpr int kMissionFrame = 2;  // MAV_FRAME_MISSION: without a place

/// Over the ground; an aeroplane's is through the air: ArduPilot's takes the other for a minimum.
PlanItem speed_item(double speed_mps, const MissionText& text) {
  const double over_ground = text.vehicle == VehicleType::copter ? 1 : 0;
  constexpr double kSameThrottle = -1;
  return {Command::kChangeSpeed,
          kMissionFrame,
          {over_ground, rounded(speed_mps, text.decimals.metres), kSameThrottle}};
}

PlanItem item_of(const MissionItem& item, const MissionText& text) {
  const Decimals& decimals = text.decimals;
  PlanItem result{command_of(item, text.vehicle), frame_of(item.at.frame)};
  const std::array<double, 4> params = params_of(item, text);
  for (std::size_t n = 0; n < params.size(); ++n) {
    result.params[n] = std::isnan(params[n]) ? params[n] : rounded(params[n], decimals.metres);
  }
  result.params[4] = rounded(item.at.lat, decimals.degrees);
  result.params[5] = rounded(item.at.lon, decimals.degrees);
  result.params[6] = rounded(item.at.altitude_m, decimals.metres);
  return result;
}

/// What is done at the place of the last item. ArduPilot's copter takes a landing for the end,
/// unless a take-off follows, behind delays at most.
void add_stop(const ItemStop& at, std::vector<PlanItem>& items) {
  const Stop& stop = at.stop;
  const double hold_s = std::ceil(stop.hold_s);
  const PlanItem place = items.back();
  if (stop.lands) {
    items.push_back(place);
    items.back().command = Command::kLand;
    items.back().params[6] = at.ground_m;
    if (hold_s > 0) {
      items.push_back({Command::kDelay, kMissionFrame, {hold_s}});
    }
  } else {
    items.back().params[0] = hold_s;
  }
  if (stop.drops) {
    constexpr double kFirst = 1;
    constexpr double kRelease = 0;
    items.push_back({Command::kGripper, kMissionFrame, {kFirst, kRelease}});
  }
  if (stop.lands) {
    items.push_back(place);
    items.back().command = Command::kTakeoff;
  }
}

/// Holes of a keep-in zone become keep-out zones; those of a keep-out zone cannot be expressed.
std::vector<PlanItem> fence_of(const std::vector<formats::Zone>& zones, const Decimals& decimals) {
  std::vector<PlanItem> fence;
  const auto add = [&](int command, double param, const formats::Point2& lonlat) {
    PlanItem item{command};
    item.params[0] = param;
    item.params[4] = rounded(lonlat[1], decimals.degrees);
    item.params[5] = rounded(lonlat[0], decimals.degrees);
    fence.push_back(item);
  };
  const auto add_ring = [&](const formats::Ring& ring, bool keep_in) {
    const int command = keep_in ? Command::kFencePolygonIn : Command::kFencePolygonOut;
    for (const formats::Point2& corner : ring) {
      add(command, double(ring.size()), corner);
    }
  };
  for (const formats::Zone& zone : zones) {
    const formats::ZoneVolume& volume = zone.volumes.front();
    const std::size_t first = fence.size();
    if (volume.polygon.outline.empty()) {
      add(zone.keeps_in() ? Command::kFenceCircleIn : Command::kFenceCircleOut,
          rounded(volume.radius_m, decimals.metres), volume.centre);
    } else {
      add_ring(volume.polygon.outline, zone.keeps_in());
      for (const formats::Ring& hole : volume.polygon.holes) {
        if (zone.keeps_in()) {
          add_ring(hole, false);
        }
      }
    }
    fence[first].name = zone.name;
  }
  return fence;
}
}  // namespace

Plan plan_of(const MissionText& text) {
  constexpr std::size_t kLandingItems = 3;
  constexpr int kFixedWing = 1;
  constexpr int kQuadrotor = 2;
  constexpr int kVtol = 20;  // as QGroundControl calls any of them
  Plan plan;
  plan.vehicle = text.vehicle == VehicleType::plane  ? kFixedWing
                 : text.vehicle == VehicleType::vtol ? kVtol
                                                     : kQuadrotor;
  plan.autopilot = text.firmware == formats::Firmware::px4 ? Plan::kPx4 : Plan::kArduPilot;
  plan.speed_mps = text.speed_mps;
  plan.decimals = text.decimals;
  plan.home = text.mission.home;
  double speed_mps = text.speed_mps;
  for (std::size_t n = 0; n < text.mission.items.size(); ++n) {
    const MissionItem& item = text.mission.items[n];
    if (text.landing_start && n + kLandingItems == text.mission.items.size()) {
      plan.items.push_back({Command::kLandingStart, kMissionFrame});
    }
    if (item.speed_mps > 0 && item.speed_mps != speed_mps) {
      speed_mps = item.speed_mps;
      plan.items.push_back(speed_item(speed_mps, text));
    }
    plan.items.push_back(item_of(item, text));
    if (const auto stop = text.stops.find(n); stop != text.stops.end()) {
      add_stop(stop->second, plan.items);
    } else if (n < text.holds_s.size() && text.holds_s[n] > 0) {
      plan.items.back().params[0] = text.holds_s[n];
    }
    if (n == 0 && text.commanded_mps > 0) {
      plan.items.push_back(speed_item(text.commanded_mps, text));
    }
  }
  plan.fence = fence_of(text.mission.zones, text.decimals);
  return plan;
}

Plan plan_of(const MissionText& text, const CameraLines& camera) {
  Plan plan = plan_of(text);
  std::vector<PlanItem> items;
  std::size_t line = 0;
  bool is_on = false;
  std::size_t n = 0;  // of the places
  for (std::size_t i = 0; i < plan.items.size(); ++i) {
    items.push_back(plan.items[i]);
    if (i + 1 < plan.items.size() && plan.items[i + 1].command == Command::kChangeSpeed) {
      items.push_back(plan.items[++i]);
    }
    const auto is_at = [&](const Vec3& p) {
      const double away = (text.local[n] - p).norm();
      return away < camera.within_m &&
             (n + 1 == text.local.size() || away <= (text.local[n + 1] - p).norm());
    };
    const auto trigger = [&](double metres) {
      items.push_back(
          {Command::kCameraTrigger, kMissionFrame, {rounded(metres, text.decimals.metres), 0, 1}});
      is_on = metres > 0;
    };
    if (is_on && is_at(camera.lines[line].back())) {
      trigger(0);
      ++line;
    }
    if (!is_on && line < camera.lines.size() && is_at(camera.lines[line].front())) {
      trigger(camera.trigger_m);
    }
    n = std::min(n + 1, text.local.size() - 1);  // a landing is below the last one
  }
  if (line < camera.lines.size()) {
    throw Error("line " + std::to_string(line) + " of the photos is not among the items");
  }
  plan.items = std::move(items);
  return plan;
}

Plan plan_of(const formats::MissionFile& mission) {
  if (mission.commands.empty()) {
    throw Error("expected a mission with commands (.plan, .waypoints)");
  }
  Plan plan;
  plan.autopilot = mission.firmware > 0 ? mission.firmware : plan.autopilot;
  plan.vehicle = mission.vehicle_type > 0 ? mission.vehicle_type : plan.vehicle;
  plan.speed_mps = mission.cruise_mps > 0 ? mission.cruise_mps : plan.speed_mps;
  plan.home = mission.home;
  for (const formats::MissionCommand& command : mission.commands) {
    if (command.number == 0) {
      throw Error(command.place + ": a complex item that contains no commands");
    }
    PlanItem item{command.number, command.frame};
    std::copy(command.params.begin(), command.params.end(), item.params.begin());
    item.params[4] = command.lat;
    item.params[5] = command.lon;
    item.params[6] = command.altitude_m;
    item.continues = command.auto_continue;
    plan.items.push_back(item);
  }
  plan.fence = fence_of(mission.zones, plan.decimals);
  for (const formats::MissionPoint& point : mission.rally) {
    PlanItem item{Command::kRallyPoint, frame_of(point.frame)};
    item.params[4] = point.lat;
    item.params[5] = point.lon;
    item.params[6] = point.altitude_m;
    plan.rally.push_back(item);
  }
  return plan;
}
}  // namespace altiplan::host
