// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "altiplan/route.hpp"
#include "host/import_export/mission_text.hpp"

namespace altiplan::host {

/// A route in metres of the world's frame.
struct LocalRoute {
  Polyline points;
  /// Its columns were x, y and z: the waypoints between the ends of a scenario, as papers number
  /// them, with heights above ground. Else they were x_m, y_m and z_m: the route in the world.
  bool is_inner = false;
};

/// Reads these columns of a table whose first line names its columns; ignores others. Throws Error
/// with file and line.
LocalRoute read_route_csv(const std::string& file, const std::string& text);

struct CsvRow {
  double time_s = 0;
  std::optional<double> latest_s;  ///< of a mission; infinite where nothing ends its wait
  Vec3 local{0, 0, 0};
  formats::MissionPoint at;  ///< its degrees count in a world with a georeference
};

/// The table of these columns and others; with degrees if `has_position`, and a column `latest_s`
/// if the first row has such a time.
std::string route_csv_text(const std::vector<CsvRow>& rows, bool has_position,
                           const Decimals& decimals);
}  // namespace altiplan::host
