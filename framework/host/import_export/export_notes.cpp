// SPDX-License-Identifier: Apache-2.0
#include "host/import_export/export_notes.hpp"

#include <algorithm>
#include <cmath>

#include "altiplan/body.hpp"
#include "altiplan/earth.hpp"

#include "host/base/words.hpp"

namespace altiplan::host {
namespace {

/// How autopilots fly the circles, where they differ from the file.
void note_autopilots(const WrittenRoute& written, std::vector<std::string>& notes) {
  double tighter = 0;
  std::size_t turns = 0;
  for (const MissionPlace& place : written.places) {
    if (place.circle) {
      const bool counts_turns = place.circle->until == formats::MissionCircle::Until::turns;
      const double unit = counts_turns && place.circle->radius_m > 255 ? 10 : 1;
      tighter = std::max(tighter, std::fmod(place.circle->radius_m, unit));
      turns += counts_turns ? 1 : 0;
    }
  }
  if (tighter > 0) {
    notes.push_back("warning: ArduPilot stores radii in whole metres: it flies circles up to " +
                    rounded_text(tighter, 3) + " m tighter");
  }
  if (turns > 0) {
    notes.push_back("warning: PX4 does not accept the full circles (LOITER_TURNS) of " +
                    counted(turns, "loiter"));
  }
}

/// How far autopilots fly beside the legs, which are straight in the frame: PX4 flies the geodesic,
/// ArduPilot even steps of longitude and latitude. Both are farthest from a leg at its middle.
void note_long_legs(const WrittenRoute& written, const Frame& frame,
                    std::vector<std::string>& notes) {
  constexpr double kWorthSaying = 1;  // metre
  double by_px4 = 0;
  double by_ardupilot = 0;
  for (std::size_t n = 0; n + 1 < written.places.size(); ++n) {
    const Vec3& from = written.places[n].at;
    const Vec3& to = written.places[n + 1].at;
    const auto from_middle = [&](double lon, double lat) {
      const auto [x, y] = frame.to_local(lon, lat);
      return std::hypot(x - (from.x() + to.x()) / 2, y - (from.y() + to.y()) / 2);
    };
    const LonLat begin = frame.to_lonlat(from.x(), from.y());
    const LonLat end = frame.to_lonlat(to.x(), to.y());
    const GeodesicCourse course = geodesic_course(begin, end);
    const auto [lon, lat] = geodesic_end(begin, course.bearing_deg, course.metres / 2);
    by_px4 = std::max(by_px4, from_middle(lon, lat));
    by_ardupilot =
        std::max(by_ardupilot, from_middle(begin[0] + std::remainder(end[0] - begin[0], 360.0) / 2,
                                           (begin[1] + end[1]) / 2));
  }
  if (std::max(by_px4, by_ardupilot) > kWorthSaying) {
    notes.push_back("warning: of long legs PX4 flies up to " + with_decimals(by_px4, 1) +
                    " m beside the line that was judged, ArduPilot " +
                    with_decimals(by_ardupilot, 1) +
                    " m: `altiplan check` of the file judges what is flown");
  }
}

/// Height of the lowest part of the body above its reference point.
double lowest_of(const Vehicle& vehicle) {
  double lowest = 0;
  if (vehicle.body != nullptr) {
    for (const BodyPart& part : vehicle.body->parts) {
      for (const Vec3& corner : part.corners) {
        lowest = std::min(lowest, corner.z() - part.rounding);
      }
    }
  }
  return lowest;
}
}  // namespace

std::vector<std::string> notes_on(const WrittenRoute& written, const ExportOptions& options,
                                  double tolerance, bool beside_turns, const Mission& mission) {
  std::vector<std::string> notes;
  if (written.turns > 0) {
    notes.push_back(
        counted(written.turns, "turn") + " written as " + counted(written.points, "point") +
        ", whose legs are within " + rounded_text(tolerance, 3) + " m of " +
        (written.turns == 1 ? "it" : "them") +
        (options.loiters ? ": not a circle over the ground that leads to a straight leg" : ""));
  }
  if (beside_turns) {
    notes.emplace_back(
        "turn radius, climb and headings are judged along the turns: the legs between the points "
        "have corners");
  }
  const double lowest_m = lowest_of(mission.request.vehicle);
  if (lowest_m < 0 && (options.takeoff || options.land)) {
    notes.push_back("warning: parts of the body are up to " + rounded_text(-lowest_m, 2) +
                    " m below the point that follows the route, which take-off and landing put on "
                    "the ground");
  }
  note_autopilots(written, notes);
  if (options.format->has_commands() && mission.truth.frame().has_position()) {
    note_long_legs(written, mission.truth.frame(), notes);
  }
  return notes;
}
}  // namespace altiplan::host
