// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "mission_parts.hpp"

namespace altiplan::formats {
namespace {

constexpr std::size_t kFields = 12;
constexpr std::array<const char*, kFields> kNames{
    "number", "current", "frame",    "command",   "param1",   "param2",
    "param3", "param4",  "latitude", "longitude", "altitude", "autocontinue"};

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  std::size_t at = 0;
  while ((at = line.find_first_not_of(" \t\r", at)) != std::string_view::npos) {
    const std::size_t end = std::min(line.find_first_of(" \t\r", at), line.size());
    words.push_back(line.substr(at, end - at));
    at = end;
  }
  return words;
}

std::optional<double> number_of(std::string_view word) {
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size() ? std::optional(value)
                                                                  : std::nullopt;
}

/// The twelve columns of a line.
struct Row {
  std::array<double, kFields> fields{};

  explicit Row(std::string_view line) {
    const std::vector<std::string_view> words = words_of(line);
    if (words.size() != kFields) {
      const bool has_commas = line.find(',') != std::string_view::npos;
      throw Error("expected 12 columns, found " + std::to_string(words.size()) +
                  (has_commas ? ": they are separated by tabs or spaces, not by commas" : ""));
    }
    for (std::size_t n = 0; n < kFields; ++n) {
      const std::optional<double> value = number_of(words[n]);
      const bool is_parameter = n >= 4 && n <= 7;  // "nan": left to the autopilot
      if (!value || !(std::isfinite(*value) || (is_parameter && std::isnan(*value)))) {
        throw Error(std::string("expected a number as ") + kNames[n] + ", found " +
                    excerpt(words[n]) +
                    (words[n].find(',') != std::string_view::npos
                         ? ", which has a comma for its decimal point"
                         : ""));
      }
      fields[n] = *value;
    }
    whole(1, 1);
    whole(11, 1);
  }

  int whole(std::size_t n, int maximum) const {
    if (!(fields[n] >= 0 && fields[n] <= maximum && fields[n] == std::floor(fields[n]))) {
      throw Error(std::string("expected a whole number from 0 to ") + std::to_string(maximum) +
                  " as " + kNames[n]);
    }
    return int(fields[n]);
  }
  int frame() const { return whole(2, 21); }
  int command() const { return whole(3, 65535); }
  double lat() const { return fields[8]; }
  double lon() const { return fields[9]; }
  double altitude() const { return fields[10]; }
};

/// Fence points; those of one polygon are consecutive.
class FenceReader {
 public:
  explicit FenceReader(MissionFile& mission) : mission_(mission) {}

  static bool is_fence(int command) { return command >= 5000 && command <= 5004; }

  void add(const Row& row, std::size_t line) {
    const int command = row.command();
    const std::string name = "line " + std::to_string(line);
    if (missing_ > 0 && command != command_) {
      finish();
    }
    if (command == 5000) {  // return point after a fence breach
      ++returns_;
    } else if (command == 5003 || command == 5004) {
      start(name, command == 5003);
      add_zone({{}, {}, {}, {row.lon(), row.lat()}, row.fields[4]});
    } else {
      add_corner(row, command, name);
    }
  }

  void finish() const {
    if (missing_ > 0) {
      throw Error("the fence's polygon of " + zone_.name + " ends " + std::to_string(missing_) +
                  " corners early");
    }
    if (returns_ > 0) {
      mission_.notes.push_back(std::to_string(returns_) + " return points of the fence skipped");
    }
  }

 private:
  void start(const std::string& name, bool keep_in) {
    zone_ = Zone{};
    zone_.name = name;
    zone_.restriction = keep_in ? Restriction::keep_in : Restriction::keep_out;
  }
  void add_zone(ZoneVolume volume) {
    check_volume(volume);
    zone_.volumes = {std::move(volume)};
    mission_.zones.push_back(zone_);
  }
  void add_corner(const Row& row, int command, const std::string& name) {
    const double count = row.fields[4];
    if (!(count >= 3 && count <= 1e6 && count == std::floor(count))) {
      throw Error("expected the number of the polygon's corners, 3 or more, as param1");
    }
    if (missing_ == 0) {
      start(name, command == 5001);
      outline_.clear();
      command_ = command;
      corners_ = missing_ = std::size_t(count);
    } else if (std::size_t(count) != corners_) {
      throw Error("the polygon of " + zone_.name + " has " + std::to_string(corners_) +
                  " corners, this one gives " + std::to_string(std::size_t(count)));
    }
    expect_position(row.lon(), row.lat());
    outline_.push_back({row.lon(), row.lat()});
    if (--missing_ == 0) {
      add_zone({{outline_, {}}, {}, {}});
    }
  }

  MissionFile& mission_;
  Zone zone_;
  Ring outline_;
  int command_ = 0;
  std::size_t corners_ = 0;
  std::size_t missing_ = 0;
  std::size_t returns_ = 0;
};

constexpr int kRallyPoint = 5100;

MissionPoint rally_point(double lat, double lon, double altitude_m, AltitudeFrame frame) {
  expect_position(lon, lat);
  expect_altitude(altitude_m);
  return {lon, lat, altitude_m, frame};
}

bool is_rally_list(const std::vector<std::string_view>& words) {
  return !words.empty() && words[0] == "RALLY";
}

/// A line of MAVProxy's list of rally points. What follows the height above home tells an aeroplane
/// how to land there.
MissionPoint rally_line(const std::vector<std::string_view>& words) {
  constexpr std::size_t kWords = 7;
  if (!is_rally_list(words) || words.size() != kWords) {
    throw Error("expected RALLY and 6 numbers, found " + std::to_string(words.size()) + " words");
  }
  std::array<double, kWords> numbers{};
  for (std::size_t n = 1; n < kWords; ++n) {
    const std::optional<double> number = number_of(words[n]);
    if (!number || !std::isfinite(*number)) {
      throw Error("expected a number, found " + excerpt(words[n]));
    }
    numbers[n] = *number;
  }
  return rally_point(numbers[1], numbers[2], numbers[3], AltitudeFrame::home);
}

/// Throws Error naming what a text with another first line may be.
void expect_header(std::string_view first_line) {
  const std::vector<std::string_view> words = words_of(first_line);
  if (words.size() == 3 && words[0] == "QGC" && words[1] == "WPL") {
    if (words[2] != "110") {
      throw Error("expected QGC WPL 110, found version " + excerpt(words[2]));
    }
    return;
  }
  if (words.size() == 2 && number_of(words[0]) && number_of(words[1])) {
    throw Error(
        "this is an ArduPilot fence in the old format (latitude and longitude only), "
        "expected QGC WPL 110");
  }
  if (first_line.starts_with("PK")) {
    throw Error("this is a ZIP archive (KMZ?), expected the file inside it");
  }
  throw Error("expected QGC WPL 110, JSON or XML, found " + excerpt(first_line.substr(0, 40)));
}

/// Line 0 is the home position if it is a waypoint above sea level: ground stations write it there.
bool is_home(const Row& row) { return row.command() == 16 && row.frame() == 0; }
}  // namespace

MissionFile read_waypoints(const std::string& file, const std::string& text) {
  MissionFile mission;
  mission.format = MissionFile::Format::waypoints;
  CommandList commands(mission);
  FenceReader fence(mission);
  std::size_t line = 0;
  std::size_t number = 0;
  bool begun = false;
  bool is_list = false;  // of rally points
  std::vector<std::pair<std::size_t, Row>>
      rows;  // after their lines: what is no number comes first
  const auto add = [&](const Row& row) {
    if (row.whole(0, 1'000'000) != int(number)) {
      throw Error("expected item " + std::to_string(number) + ", found " +
                  std::to_string(row.whole(0, 1'000'000)) +
                  (number == 0 ? ": the file has no home position, which is item 0" : ""));
    }
    if (FenceReader::is_fence(row.command())) {
      fence.add(row, line);
    } else if (row.command() == kRallyPoint) {
      mission.rally.push_back(
          rally_point(row.lat(), row.lon(), row.altitude(), frame_of(row.frame())));
    } else if (number == 0 && is_home(row)) {
      expect_position(row.lon(), row.lat());
      expect_altitude(row.altitude());
      if (!is_nowhere(row.lon(), row.lat())) {
        mission.home = {row.lon(), row.lat(), row.altitude(), AltitudeFrame::sea};
      }
    } else {
      const auto& of = row.fields;
      commands.add({row.command(),
                    row.frame(),
                    {of[4], of[5], of[6], of[7]},
                    row.lon(),
                    row.lat(),
                    row.altitude(),
                    "line " + std::to_string(line),
                    int(number),
                    row.whole(11, 1) == 1});
    }
    ++number;
  };
  try {
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t end = std::min(text.find('\n', at), text.size());
      const std::string_view content = std::string_view(text).substr(at, end - at);
      at = end + 1;
      ++line;
      const std::vector<std::string_view> words = words_of(content);
      if (words.empty()) {
        continue;
      }
      is_list = is_list || (!begun && is_rally_list(words));
      if (is_list) {
        mission.rally.push_back(rally_line(words));
      } else if (begun) {
        rows.emplace_back(line, Row(content));
      } else {
        expect_header(content);
        begun = true;
      }
    }
    for (const auto& [at, row] : rows) {
      line = at;
      add(row);
    }
    fence.finish();
  } catch (const Error& error) {
    throw Error(file + ":" + std::to_string(line) + ": " + error.what());
  }
  commands.finish();
  if (number == 0 && !is_list) {
    throw Error(file + ": contains no mission items");
  }
  return mission;
}
}  // namespace altiplan::formats
