// SPDX-License-Identifier: Apache-2.0
#include "host/import_export/placing.hpp"

#include "altiplan/error.hpp"

namespace altiplan::host {

using formats::AltitudeFrame;
using formats::MissionPoint;

namespace {

double ground_at(const World& world, const Vec3& p) {
  const std::optional<double> ground = world.ground(p.x(), p.y());
  if (!ground) {
    throw Error("the world has no ground below the route");
  }
  return *ground;
}
}  // namespace

std::optional<double> home_altitude(const Mission& mission, const ExportOptions& options,
                                    const Vec3& start) {
  return options.home_altitude_m ? options.home_altitude_m
                                 : mission.truth.ground(start.x(), start.y());
}

void expect_possible(const Mission& mission, const ExportOptions& options, const Vec3& start) {
  if (!options.format->is_local() && !mission.truth.frame().has_position()) {
    throw Error(
        "the scenario's world is not georeferenced: add a georeferenced layer, or "
        "frame: {origin_lonlat: …}; csv and mcap need neither");
  }
  if (options.altitude == AltitudeFrame::ground && !mission.truth.has_ground()) {
    throw Error("--altitude ground needs a world with ground");
  }
  const std::optional<double> home = home_altitude(mission, options, start);
  if (!home && (options.altitude == AltitudeFrame::home || options.takeoff || options.land)) {
    throw Error(
        "--altitude home, --takeoff and --land need the altitude of home, and the world has no "
        "ground below the start: give --home-altitude M, in metres above sea level");
  }
  if (options.land && mission.vehicle_type == VehicleType::plane && !mission.runways.glides_from) {
    throw Error(
        "--land: an aeroplane cannot descend vertically below its last point: leave its landing to "
        "the ground station, or give vehicle: {type: vtol}");
  }
  if (options.takeoff && *home >= start.z() && !mission.runways.climbs_to) {
    throw Error("--takeoff: the start, " + rounded_text(start.z(), 3) +
                " m above sea level, is not above home, " + rounded_text(*home, 3) + " m");
  }
}

Placing::Placing(const Mission& mission, const ExportOptions& options, const Vec3& start)
    : world_(mission.truth), frame_(options.altitude) {
  const auto at = lonlat(start);
  home_ = {at[0], at[1], home_altitude(mission, options, start).value_or(start.z()),
           AltitudeFrame::sea};
}

MissionPoint Placing::operator()(const Vec3& p) const {
  const double reference = frame_ == AltitudeFrame::sea      ? 0
                           : frame_ == AltitudeFrame::ground ? ground_at(world_, p)
                                                             : home_.altitude_m;
  const auto at = lonlat(p);
  return {at[0], at[1], p.z() - reference, frame_};
}

std::string Placing::in_words() const {
  switch (frame_) {
    case AltitudeFrame::sea:
      return "altitudes above sea level";
    case AltitudeFrame::ground:
      return "altitudes above the ground below each point";
    case AltitudeFrame::home:
      break;
  }
  return "altitudes relative to home, which is " + rounded_text(home_.altitude_m, 3) +
         " m above sea level";
}

std::array<double, 2> Placing::lonlat(const Vec3& p) const {
  const Frame& frame = world_.frame();
  return frame.has_position() ? frame.to_lonlat(p.x(), p.y()) : std::array<double, 2>{0, 0};
}
}  // namespace altiplan::host
