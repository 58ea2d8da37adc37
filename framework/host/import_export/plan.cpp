// SPDX-License-Identifier: Apache-2.0
#include "host/import_export/plan.hpp"

#include <cmath>

#include "altiplan/geometry.hpp"

namespace altiplan::host {
namespace {

using kit::MissionItem;
using kit::MissionZone;

int command_of(const MissionItem& item) {
  using Until = kit::MissionCircle::Until;
  switch (item.kind) {
    case MissionItem::Kind::takeoff:
      return Command::kTakeoff;
    case MissionItem::Kind::land:
      return Command::kLand;
    case MissionItem::Kind::loiter:
      return !item.circle || item.circle->until == Until::forever ? Command::kLoiterForever
             : item.circle->until == Until::turns                 ? Command::kLoiterTurns
                                                                  : Command::kLoiterToAltitude;
    case MissionItem::Kind::waypoint:
      break;
  }
  return Command::kWaypoint;
}

int frame_of(kit::AltitudeFrame frame) {
  return frame == kit::AltitudeFrame::sea ? 0 : frame == kit::AltitudeFrame::home ? 3 : 10;
}

/// The radius that MAVLink gives, positive clockwise, rounded up: a smaller one would be too tight.
double radius_of(const kit::MissionCircle& circle, int decimals) {
  const double nearest = rounded(circle.radius_m, decimals);
  const bool is_tighter = nearest < circle.radius_m - kLengthTolerance / 10;
  const double radius = is_tighter ? nearest + std::pow(10, -decimals) : nearest;
  return -circle.sense * rounded(radius, decimals);
}

/// The first four parameters. Circles are left when heading for the next item, toward it from that
/// place ("xtrack" 1).
std::array<double, 4> params_of(const MissionItem& item, int decimals) {
  using Until = kit::MissionCircle::Until;
  const double unset = std::nan("");
  if (!item.circle) {
    return {0, 0, 0, unset};  // hold time, acceptance radius, pass-by distance, heading
  }
  const double radius = radius_of(*item.circle, decimals);
  switch (item.circle->until) {
    case Until::turns:
      return {item.circle->turns, 1, radius, 1};
    case Until::altitude:
      return {1, radius, 0, 1};
    case Until::forever:
      break;
  }
  return {0, 0, radius, unset};
}

PlanItem item_of(const MissionItem& item, const Decimals& decimals) {
  PlanItem result{command_of(item), frame_of(item.at.frame)};
  const std::array<double, 4> params = params_of(item, decimals.metres);
  for (std::size_t n = 0; n < params.size(); ++n) {
    result.params[n] = std::isnan(params[n]) ? params[n] : rounded(params[n], decimals.metres);
  }
  result.params[4] = rounded(item.at.lat, decimals.degrees);
  result.params[5] = rounded(item.at.lon, decimals.degrees);
  result.params[6] = rounded(item.at.altitude_m, decimals.metres);
  return result;
}

/// Holes of a keep-in zone become keep-out zones; those of a keep-out zone cannot be expressed.
std::vector<PlanItem> fence_of(const std::vector<MissionZone>& zones, const Decimals& decimals) {
  std::vector<PlanItem> fence;
  const auto add = [&](int command, double param, double lon, double lat) {
    PlanItem item{command};
    item.params[0] = param;
    item.params[4] = rounded(lat, decimals.degrees);
    item.params[5] = rounded(lon, decimals.degrees);
    fence.push_back(item);
  };
  const auto add_ring = [&](const kit::Ring& ring, bool keep_in) {
    const int command = keep_in ? Command::kFencePolygonIn : Command::kFencePolygonOut;
    for (const auto& [lon, lat] : ring) {
      add(command, double(ring.size()), lon, lat);
    }
  };
  for (const MissionZone& zone : zones) {
    if (zone.polygon.outline.empty()) {
      add(zone.keep_in ? Command::kFenceCircleIn : Command::kFenceCircleOut,
          rounded(zone.radius_m, decimals.metres), zone.centre[0], zone.centre[1]);
      continue;
    }
    add_ring(zone.polygon.outline, zone.keep_in);
    if (zone.keep_in) {
      for (const kit::Ring& hole : zone.polygon.holes) {
        add_ring(hole, false);
      }
    }
  }
  return fence;
}
}  // namespace

Plan plan_of(const MissionText& text) {
  constexpr int kFixedWing = 1;
  constexpr int kQuadrotor = 2;
  Plan plan;
  plan.vehicle = text.is_wing ? kFixedWing : kQuadrotor;
  plan.speed_mps = text.speed_mps;
  plan.decimals = text.decimals;
  plan.home = text.mission.home;
  for (const MissionItem& item : text.mission.items) {
    plan.items.push_back(item_of(item, text.decimals));
  }
  plan.fence = fence_of(text.mission.zones, text.decimals);
  return plan;
}
}  // namespace altiplan::host
