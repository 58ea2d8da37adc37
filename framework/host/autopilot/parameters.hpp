// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "altiplan/formats/mission_commands.hpp"

namespace altiplan::host {

struct ParameterValue {
  double value = 0;
  std::string place{};  ///< for messages: "vehicle.param:12: ", "" of no file

  ParameterValue() = default;
  ParameterValue(double v, std::string where = "") : value(v), place(std::move(where)) {}
};
/// Parameters of an autopilot as a file has them, by name.
using ParameterFile = std::map<std::string, ParameterValue>;

/// Reads Mission Planner's `.param` ("NAME,VALUE") or QGroundControl's `.params` (five columns, the
/// third and fourth name and value). Throws Error naming the file and the line.
ParameterFile read_parameters(const std::string& file);
/// True of what a battery that is low has the vehicle do, by its number: BATT_FS_LOW_ACT, BATT2_….
bool is_battery_failsafe(std::string_view name);
/// False if an autopilot flies every mission with these as it does without.
bool decide_a_flight(const ParameterFile& file);

/// The parameters that decide how an autopilot flies a mission: those of a file, else its defaults.
/// Remembers which were asked for.
class Parameters {
 public:
  Parameters(formats::Autopilot autopilot, const ParameterFile& file)
      : autopilot_(autopilot), file_(file) {}

  /// By its newest name, in metres, seconds and degrees; a file may have an older name and unit.
  double operator()(std::string_view name) const;
  bool is_given(std::string_view name) const;

  struct Used {
    std::string name;
    double value;
    bool is_given;  ///< by the file
  };
  /// The autopilot whose parameters the file has, "" unless it is another: it has more names that
  /// are that one's alone than names that are this one's alone.
  std::string of_another() const;
  /// Sorted by name.
  std::vector<Used> used() const;
  formats::Autopilot autopilot() const { return autopilot_; }

 private:
  formats::Autopilot autopilot_;
  const ParameterFile& file_;
  mutable std::map<std::string, Used, std::less<>> used_;
};
}  // namespace altiplan::host
