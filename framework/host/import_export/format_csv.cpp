// SPDX-License-Identifier: Apache-2.0
#include "host/import_export/route_csv.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>
#include <vector>

#include "altiplan/error.hpp"
#include "host/import_export/format_functions.hpp"

namespace altiplan::host {
namespace {

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  for (std::size_t at = 0; at <= line.size();) {
    const std::size_t end = std::min(line.find(',', at), line.size());
    cells.push_back(line.substr(at, end - at));
    at = end + 1;
  }
  return cells;
}

using Names = std::array<std::string_view, 3>;
constexpr Names kOfWorld{"x_m", "y_m", "z_m"};
constexpr Names kOfPapers{"x", "y", "z"};

bool has(const std::vector<std::string_view>& head, const Names& names) {
  return std::all_of(names.begin(), names.end(), [&](std::string_view name) {
    return std::find(head.begin(), head.end(), name) != head.end();
  });
}

std::array<std::size_t, 3> columns_of(const std::vector<std::string_view>& head,
                                      const Names& names) {
  std::array<std::size_t, 3> columns{};
  for (std::size_t n = 0; n < 3; ++n) {
    const auto found = std::find(head.begin(), head.end(), names[n]);
    if (found == head.end()) {
      throw Error(
          "expected a first line that names the columns x_m, y_m and z_m (or x, y and z, of the "
          "waypoints between start and goal, with heights above ground), found no '" +
          std::string(names[n]) + "'");
    }
    columns[n] = std::size_t(found - head.begin());
  }
  return columns;
}

double metres_of(std::string_view cell) {
  double value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc() || end != cell.data() + cell.size() || !std::isfinite(value)) {
    throw Error("expected a number of metres, found " + excerpt(cell));
  }
  return value;
}
/// Checks the column that `export` writes, if present.
void expect_frame(const std::vector<std::string_view>& head,
                  const std::vector<std::string_view>& cells) {
  const auto found = std::find(head.begin(), head.end(), "altitude_frame");
  if (found == head.end()) {
    return;
  }
  const std::string_view frame = cells[std::size_t(found - head.begin())];
  if (frame != "sea" && frame != "ground" && frame != "home") {
    throw Error("expected sea, ground or home as altitude_frame, found " + excerpt(frame));
  }
}
}  // namespace

LocalRoute read_route_csv(const std::string& file, const std::string& text) {
  LocalRoute route;
  std::vector<std::string_view> head;
  std::array<std::size_t, 3> columns{};
  std::size_t line = 0;
  try {
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t end = std::min(text.find('\n', at), text.size());
      std::string_view content = std::string_view(text).substr(at, end - at);
      at = end + 1;
      ++line;
      if (content.ends_with('\r')) {
        content.remove_suffix(1);
      }
      if (content.empty()) {
        continue;
      }
      const std::vector<std::string_view> cells = cells_of(content);
      if (head.empty()) {
        route.is_inner = !has(cells, kOfWorld) && has(cells, kOfPapers);
        columns = columns_of(cells, route.is_inner ? kOfPapers : kOfWorld);
        head = cells;
        continue;
      }
      if (cells.size() != head.size()) {
        throw Error("expected " + std::to_string(head.size()) + " columns, found " +
                    std::to_string(cells.size()));
      }
      expect_frame(head, cells);
      route.points.emplace_back(metres_of(cells[columns[0]]), metres_of(cells[columns[1]]),
                                metres_of(cells[columns[2]]));
    }
  } catch (const Error& error) {
    throw Error(file + ":" + std::to_string(line) + ": " + error.what());
  }
  if (route.points.empty()) {
    throw Error(file + ": it contains no route");
  }
  return route;
}

std::string route_csv_text(const std::vector<CsvRow>& rows, bool has_position,
                           const Decimals& decimals) {
  constexpr int kMilliseconds = 3;
  const bool has_latest = !rows.empty() && rows.front().latest_s;
  std::string out = std::string("time_s") + (has_latest ? ",latest_s" : "") + ",x_m,y_m,z_m" +
                    (has_position ? ",longitude_deg,latitude_deg" : "") +
                    ",altitude_m,altitude_frame\n";
  for (const auto& [time_s, latest_s, local, at] : rows) {
    out += rounded_text(time_s, kMilliseconds);
    if (has_latest) {
      out += "," + (std::isfinite(*latest_s) ? rounded_text(*latest_s, kMilliseconds) : "");
    }
    for (const double metres : local) {
      out += "," + rounded_text(metres, decimals.metres);
    }
    if (has_position) {
      out += "," + rounded_text(at.lon, decimals.degrees) + "," +
             rounded_text(at.lat, decimals.degrees);
    }
    out += "," + rounded_text(at.altitude_m, decimals.metres) + "," + name(at.frame) + "\n";
  }
  return out;
}

std::string csv_text(const MissionText& text) {
  std::vector<CsvRow> rows;
  for (std::size_t n = 0; n < text.local.size(); ++n) {
    rows.push_back({text.times_s.at(n), {}, text.local[n], text.mission.items.at(n).at});
  }
  return route_csv_text(rows, text.has_position, text.decimals);
}
}  // namespace altiplan::host
