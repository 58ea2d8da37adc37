// SPDX-License-Identifier: Apache-2.0
#include "host/autopilot/parameters.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "altiplan/error.hpp"
#include "altiplan/formats/input_file.hpp"
#include "host/base/words.hpp"

namespace altiplan::host {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// A parameter with its default in ArduPilot's copter and plane (the quadplane's is the plane's),
/// and in PX4's copter and plane (the VTOL's is the plane's); none: it has no such parameter.
struct Row {
  const char* name;
  std::array<double, 4> defaults;
  const char* old_name = "";  ///< up to ArduPilot 4.6
  double old_unit = 1;        ///< in units of the new one
  double px4_vtol = kNone;    ///< of PX4's VTOL, where it is not its plane's
};

constexpr double kCm = 0.01;

const Row kRows[] = {
    {"WP_RADIUS_M", {2, kNone, kNone, kNone}, "WPNAV_RADIUS", kCm},
    {"WP_SPD", {10, kNone, kNone, kNone}, "WPNAV_SPEED", kCm},
    {"WP_SPD_UP", {2.5, kNone, kNone, kNone}, "WPNAV_SPEED_UP", kCm},
    {"WP_SPD_DN", {1.5, kNone, kNone, kNone}, "WPNAV_SPEED_DN", kCm},
    {"WP_ACC", {2.5, kNone, kNone, kNone}, "WPNAV_ACCEL", kCm},
    {"WP_ACC_Z", {1, kNone, kNone, kNone}, "WPNAV_ACCEL_Z", kCm},
    {"WP_TER_MARGIN", {10, kNone, kNone, kNone}, "WPNAV_TER_MARGIN", 1},
    {"WP_JERK", {1, kNone, kNone, kNone}, "WPNAV_JERK", 1},
    {"ATC_INPUT_TC", {0.15, kNone, kNone, kNone}},
    {"RTL_ALT_M", {15, kNone, kNone, kNone}, "RTL_ALT", kCm},
    {"FS_THR_ENABLE", {1, kNone, kNone, kNone}},
    {"FS_GCS_ENABLE", {0, kNone, kNone, kNone}},
    {"FS_LONG_ACTN", {kNone, 0, kNone, kNone}},
    {"FS_SHORT_ACTN", {kNone, 0, kNone, kNone}},
    {"RTL_CLIMB_MIN_M", {0, kNone, kNone, kNone}, "RTL_CLIMB_MIN", kCm},
    {"RTL_CONE_SLOPE", {3, kNone, kNone, kNone}},
    {"RTL_ALT_TYPE", {0, kNone, kNone, kNone}},
    {"LAND_SPD_MS", {0.5, kNone, kNone, kNone}, "LAND_SPEED", kCm},
    {"LAND_SPD_HIGH_MS", {0, kNone, kNone, kNone}, "LAND_SPEED_HIGH", kCm},
    {"MIS_OPTIONS", {0, kNone, kNone, kNone}},
    {"DISARM_DELAY", {10, kNone, kNone, kNone}},
    {"RALLY_LIMIT_KM", {0.3, 5, kNone, kNone}},
    {"RALLY_INCL_HOME", {1, 0, kNone, kNone}},
    {"FENCE_ENABLE", {0, 0, kNone, kNone}},
    {"FENCE_AUTOENABLE", {0, 0, kNone, kNone}},
    {"FENCE_TYPE", {7, 4, kNone, kNone}},
    {"FENCE_ALT_MAX", {100, 100, kNone, kNone}},
    {"FENCE_MARGIN", {2, 2, kNone, kNone}},
    {"FENCE_ALT_MIN", {-10, -10, kNone, kNone}},
    {"FENCE_RADIUS", {300, 300, kNone, kNone}},
    {"GF_MAX_VER_DIST", {kNone, kNone, 0, 0}},
    {"GF_MAX_HOR_DIST", {kNone, kNone, 0, 0}},
    {"WP_RADIUS", {kNone, 90, kNone, kNone}},
    {"WP_LOITER_RAD", {kNone, 60, kNone, kNone}},
    {"NAVL1_PERIOD", {kNone, 17, kNone, kNone}},
    {"NAVL1_DAMPING", {kNone, 0.75, kNone, kNone}},
    {"AIRSPEED_CRUISE", {kNone, 12, kNone, kNone}, "TRIM_ARSPD_CM", kCm},
    {"AIRSPEED_MIN", {kNone, 9, kNone, kNone}, "ARSPD_FBW_MIN", 1},
    {"AIRSPEED_MAX", {kNone, 22, kNone, kNone}, "ARSPD_FBW_MAX", 1},
    {"TECS_CLMB_MAX", {kNone, 5, kNone, kNone}},
    {"TECS_SINK_MAX", {kNone, 5, kNone, kNone}},
    {"TECS_HDEM_TCONST", {kNone, 3, kNone, kNone}},
    {"ALT_SLOPE_MIN", {kNone, 15, kNone, kNone}, "GLIDE_SLOPE_MIN", 1},
    {"LAND_FLARE_ALT", {kNone, 3, kNone, kNone}},
    {"LAND_FLARE_SEC", {kNone, 2, kNone, kNone}},
    {"TECS_LAND_SINK", {kNone, 0.25, kNone, kNone}},
    {"ROLL_LIMIT_DEG", {kNone, 45, kNone, kNone}, "LIM_ROLL_CD", 0.01},
    {"PTCH_LIM_MAX_DEG", {kNone, 20, kNone, kNone}, "LIM_PITCH_MAX", kCm},
    {"RTL_ALTITUDE", {kNone, 100, kNone, kNone}, "ALT_HOLD_RTL", kCm},
    {"RTL_RADIUS", {kNone, 0, kNone, kNone}},
    {"RTL_AUTOLAND", {kNone, 0, kNone, kNone}},
    {"TERRAIN_LOOKAHD", {kNone, 2000, kNone, kNone}},
    {"TERRAIN_SPACING", {100, 100, kNone, kNone}},
    {"TERRAIN_OFS_MAX", {30, 30, kNone, kNone}},
    {"Q_OPTIONS", {kNone, 0, kNone, kNone}},
    {"Q_RTL_MODE", {kNone, 0, kNone, kNone}},
    {"Q_WP_SPD_UP", {kNone, 2.5, kNone, kNone}, "Q_WP_SPEED_UP", kCm},
    {"Q_WP_SPD_DN", {kNone, 1.5, kNone, kNone}, "Q_WP_SPEED_DN", kCm},
    {"Q_LAND_FINAL_SPD", {kNone, 0.5, kNone, kNone}},
    {"MIS_TKO_LAND_REQ", {kNone, kNone, 0, 2}},
    {"NAV_ACC_RAD", {kNone, kNone, 10, 10}},
    {"NAV_LOITER_RAD", {kNone, kNone, kNone, 80}},
    {"MPC_XY_CRUISE", {kNone, kNone, 5, 5}},
    {"MPC_XY_VEL_MAX", {kNone, kNone, 12, 8}},
    {"MPC_Z_V_AUTO_UP", {kNone, kNone, 3, 3}},
    {"MPC_Z_V_AUTO_DN", {kNone, kNone, 1.5, 1.5}},
    {"MPC_ACC_HOR", {kNone, kNone, 3, 3}},
    {"MPC_JERK_AUTO", {kNone, kNone, 4, 4}},
    {"MPC_XY_TRAJ_P", {kNone, kNone, 0.5, 0.5}},
    {"MPC_TKO_SPEED", {kNone, kNone, 1.5, 1.5}},
    {"MPC_LAND_SPEED", {kNone, kNone, 0.7, 0.7}},
    {"MPC_LAND_CRWL", {kNone, kNone, 0.3, 0.3}},
    {"RTL_RETURN_ALT", {kNone, kNone, 30, 100}, "", 1, 60},
    {"RTL_DESCEND_ALT", {kNone, kNone, 30, 100}, "", 1, 30},
    {"RTL_CONE_ANG", {kNone, kNone, 45, kNone}},
    {"RTL_MIN_DIST", {kNone, kNone, 10, kNone}},
    {"RTL_TYPE", {kNone, kNone, 0, 1}},
    {"FW_AIRSPD_TRIM", {kNone, kNone, kNone, 15}},
    {"FW_AIRSPD_MIN", {kNone, kNone, kNone, 10}},
    {"FW_AIRSPD_MAX", {kNone, kNone, kNone, 20}},
    {"FW_T_CLMB_R_SP", {kNone, kNone, kNone, 3}},
    {"FW_T_SINK_R_SP", {kNone, kNone, kNone, 2}},
    {"FW_T_CLMB_MAX", {kNone, kNone, kNone, 5}},
    {"FW_R_LIM", {kNone, kNone, kNone, 50}},
};

/// Those that may be 0 or less; flight with such a value of the others is none.
constexpr std::string_view kMayBeZero[] = {
    "FS_SHORT_ACTN",   "FS_THR_ENABLE",    "FS_GCS_ENABLE",   "FS_LONG_ACTN",    "RTL_ALT_M",
    "RTL_CLIMB_MIN_M", "RTL_CONE_SLOPE",   "RTL_ALT_TYPE",    "RALLY_LIMIT_KM",  "RALLY_INCL_HOME",
    "FENCE_ENABLE",    "FENCE_AUTOENABLE", "FENCE_TYPE",      "FENCE_ALT_MAX",   "FENCE_ALT_MIN",
    "FENCE_RADIUS",    "GF_MAX_VER_DIST",  "GF_MAX_HOR_DIST", "WP_LOITER_RAD",   "ALT_SLOPE_MIN",
    "RTL_ALTITUDE",    "RTL_RADIUS",       "RTL_AUTOLAND",    "TERRAIN_LOOKAHD", "TERRAIN_OFS_MAX",
    "Q_OPTIONS",       "Q_RTL_MODE",       "NAV_LOITER_RAD",  "RTL_RETURN_ALT",  "RTL_DESCEND_ALT",
    "RTL_TYPE",        "RTL_CONE_ANG",     "RTL_MIN_DIST",    "FENCE_MARGIN",    "MIS_OPTIONS",
    "DISARM_DELAY",    "LAND_FLARE_ALT",   "LAND_FLARE_SEC",  "WP_TER_MARGIN",   "LAND_SPD_HIGH_MS",
    "MIS_TKO_LAND_REQ"};

/// Those that ArduPilot stores as whole numbers.
constexpr std::string_view kWhole[] = {
    "FS_SHORT_ACTN", "FS_THR_ENABLE",   "FS_GCS_ENABLE", "FS_LONG_ACTN",
    "RTL_ALT_TYPE",  "RALLY_INCL_HOME", "FENCE_ENABLE",  "FENCE_AUTOENABLE",
    "FENCE_TYPE",    "WP_LOITER_RAD",   "RTL_RADIUS",    "RTL_AUTOLAND",
    "Q_OPTIONS",     "Q_RTL_MODE",      "MIS_OPTIONS",   "MIS_TKO_LAND_REQ"};

void expect_possible(const Row& row, const ParameterValue& given) {
  const double value = given.value;
  const std::string_view name = row.name;
  const bool is_angle =
      name == "ROLL_LIMIT_DEG" || name == "PTCH_LIM_MAX_DEG" || name == "FW_R_LIM";
  const double maximum = is_angle ? 85 : 1e5;
  const bool may_be_zero =
      std::find(std::begin(kMayBeZero), std::end(kMayBeZero), name) != std::end(kMayBeZero);
  if (!(std::abs(value) <= maximum) || (!may_be_zero && !(value > 0))) {
    throw Error(given.place + "parameter " + std::string(name) + ": expected " +
                (may_be_zero ? "at most " : "more than 0, at most ") +
                std::to_string(std::llround(maximum)) + ", found " + readable(value));
  }
}

const Row& row_of(std::string_view name) {
  for (const Row& row : kRows) {
    if (row.name == name) {
      return row;
    }
  }
  throw std::logic_error("no such parameter: " + std::string(name));
}

std::optional<ParameterValue> value_in(const ParameterFile& file, const Row& row) {
  if (file.contains(row.name) && file.contains(row.old_name)) {
    throw Error(file.at(row.old_name).place + "parameter " + std::string(row.name) +
                ": expected it or its older name " + row.old_name + ", found both");
  }
  if (const auto found = file.find(row.name); found != file.end()) {
    return found->second;
  }
  if (const auto found = file.find(row.old_name); found != file.end()) {
    return ParameterValue(found->second.value * row.old_unit, found->second.place);
  }
  return std::nullopt;
}

std::vector<std::string> words_of(const std::string& line) {
  std::vector<std::string> words;
  constexpr const char* kBetween = " \t\r,=";  // as ArduPilot reads them
  for (std::size_t at = 0; (at = line.find_first_not_of(kBetween, at)) != std::string::npos;) {
    const std::size_t end = std::min(line.find_first_of(kBetween, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = end;
  }
  return words;
}
}  // namespace

ParameterFile read_parameters(const std::string& file) {
  std::string text = formats::read_file(file);
  if (text.starts_with("\xEF\xBB\xBF")) {
    text.erase(0, 3);
  }
  ParameterFile values;
  std::size_t number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string line = text.substr(at, end - at);
    at = end + 1;
    ++number;
    const std::string place = file + ":" + std::to_string(number) + ": ";
    std::vector<std::string> words = words_of(line);
    words.erase(std::find_if(words.begin(), words.end(),
                             [](const std::string& word) { return word.front() == '#'; }),
                words.end());
    if (words.empty()) {
      continue;
    }
    const bool is_of_qgc = words.size() >= 5;
    const std::size_t name = is_of_qgc ? 2 : 0;
    double value = 0;
    if (is_of_qgc || words.size() == 2) {
      const std::string& word = words[name + 1];
      const auto [rest, error] = std::from_chars(word.data(), word.data() + word.size(), value);
      if (error == std::errc() && rest == word.data() + word.size() && std::isfinite(value)) {
        std::string key = words[name];
        std::transform(key.begin(), key.end(), key.begin(),
                       [](unsigned char c) { return char(std::toupper(c)); });
        // Other components of the vehicle have parameters of the same names.
        if (is_of_qgc && words[1] != "1") {
          values.emplace(key, ParameterValue(value, place));
        } else {
          values[key] = {value, place};
        }
        continue;
      }
    }
    const bool is_pair = is_of_qgc || words.size() == 2;
    throw Error(place +
                (is_pair ? words[name] + ": expected a number, found " + excerpt(words[name + 1])
                         : "expected a parameter's name and its value, found " + excerpt(line)));
  }
  if (values.empty()) {
    throw Error(file + ": contains no parameters");
  }
  return values;
}

double Parameters::operator()(std::string_view name) const {
  if (const auto known = used_.find(name); known != used_.end()) {
    return known->second.value;
  }
  const Row& row = row_of(name);
  const std::size_t column = (autopilot_.is_px4() ? 2 : 0) + (autopilot_.is_copter() ? 0 : 1);
  const std::optional<ParameterValue> given = value_in(file_, row);
  const bool is_other = autopilot_.is_px4() && autopilot_.airframe == formats::Airframe::vtol &&
                        std::isfinite(row.px4_vtol);
  double value = given ? given->value : is_other ? row.px4_vtol : row.defaults[column];
  if (!autopilot_.is_px4() &&
      std::find(std::begin(kWhole), std::end(kWhole), name) != std::end(kWhole)) {
    value = std::round(value);
  }
  if (given) {
    expect_possible(row, *given);
  }
  used_.emplace(name, Used{std::string(name), value, given.has_value()});
  return value;
}

bool Parameters::is_given(std::string_view name) const {
  return value_in(file_, row_of(name)).has_value();
}

std::string Parameters::of_another() const {
  // PX4 has one set for all vehicles.
  constexpr std::array<std::array<std::size_t, 2>, 3> kColumns{{{0, 0}, {1, 1}, {2, 3}}};
  constexpr std::array kNames{"ArduPilot copter", "ArduPilot plane", "PX4"};
  // Names of vehicles that fly no mission of ours, which begin so.
  constexpr std::array<std::array<std::string_view, 2>, 3> kOthers{
      {{"ATC_STR_", "an ArduPilot rover"},
       {"CRUISE_SPEED", "an ArduPilot rover"},
       {"JS_GAIN_", "an ArduPilot submarine"}}};
  for (const auto& [begin, vehicle] : kOthers) {
    const auto found = file_.lower_bound(std::string(begin));
    if (found != file_.end() && found->first.starts_with(begin)) {
      return std::string(vehicle);
    }
  }
  // Of names that one alone knows today another may have had some: most decide.
  std::array<int, 3> has{};
  for (const Row& row : kRows) {
    std::array<bool, 3> knows{};
    for (std::size_t n = 0; n < knows.size(); ++n) {
      knows[n] = std::isfinite(row.defaults[kColumns[n][0]]) ||
                 std::isfinite(row.defaults[kColumns[n][1]]);
    }
    const bool is_one_s = std::count(knows.begin(), knows.end(), true) == 1;
    if (is_one_s && (file_.contains(row.name) || file_.contains(row.old_name))) {
      ++has[std::size_t(std::find(knows.begin(), knows.end(), true) - knows.begin())];
    }
  }
  const std::size_t own = autopilot_.is_px4() ? 2 : autopilot_.is_copter() ? 0 : 1;
  const auto most = std::max_element(has.begin(), has.end());
  return *most > has[own] ? kNames[std::size_t(most - has.begin())] : "";
}

bool is_battery_failsafe(std::string_view name) {
  return name.starts_with("BATT") &&
         (name.ends_with("_FS_LOW_ACT") || name.ends_with("_FS_CRT_ACT"));
}

bool decide_a_flight(const ParameterFile& file) {
  const bool decides_returns = std::any_of(
      file.begin(), file.end(), [](const auto& given) { return is_battery_failsafe(given.first); });
  if (decides_returns) {
    return true;
  }
  return std::any_of(std::begin(kRows), std::end(kRows), [&](const Row& row) {
    return file.contains(row.name) || file.contains(row.old_name);
  });
}

std::vector<Parameters::Used> Parameters::used() const {
  std::vector<Used> all;
  for (const auto& [name, use] : used_) {
    all.push_back(use);
  }
  return all;
}
}  // namespace altiplan::host
