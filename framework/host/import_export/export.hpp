// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/flight/track_judge.hpp"
#include "host/import_export/mission_text.hpp"
#include "host/mission/mission.hpp"

namespace altiplan::host {

struct ExportOptions {
  /// None: CSV, which needs no position.
  std::optional<kit::MissionFile::Format> format;
  kit::AltitudeFrame altitude = kit::AltitudeFrame::sea;
  bool takeoff = false;
  bool land = false;
  /// Of home, above sea level; left out: the ground below the start.
  std::optional<double> home_altitude_m;
  std::optional<std::size_t> max_items;

  /// Which of them do not go together, "" where they do.
  std::string problem() const;
};

/// What is to be written: a route, or a flight with its times.
struct ExportSource {
  std::string name;
  Route route;
  std::vector<double> times;        ///< of a flight, one a point
  std::vector<FlightEvent> events;  ///< that the flight met
};

struct Exported {
  std::optional<std::string> text;    ///< none where what would be written is not sound
  std::vector<std::string> messages;  ///< the verdict first
};

/// Writes the route, reads back what was written and judges that: with more decimals where fewer
/// are not enough. Throws Error for what the format or the world cannot say.
Exported export_route(const Mission& mission, const ExportSource& source,
                      const ExportOptions& options);
}  // namespace altiplan::host
