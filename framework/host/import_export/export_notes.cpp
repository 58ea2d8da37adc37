// SPDX-License-Identifier: Apache-2.0
#include "host/import_export/export_notes.hpp"

#include "altiplan/body.hpp"

#include <algorithm>
#include <cmath>

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
                                  double tolerance, bool beside_turns, const Vehicle& vehicle) {
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
  const double lowest_m = lowest_of(vehicle);
  if (lowest_m < 0 && (options.takeoff || options.land)) {
    notes.push_back("warning: parts of the body are up to " + rounded_text(-lowest_m, 2) +
                    " m below the point that follows the route, which take-off and landing put on "
                    "the ground");
  }
  note_autopilots(written, notes);
  return notes;
}
}  // namespace altiplan::host
