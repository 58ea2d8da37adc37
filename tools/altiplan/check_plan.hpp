// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/config/config.hpp"
#include "host/gate/plan_report.hpp"
#include "host/view/scene.hpp"

namespace altiplan::cli {

/// A mission to judge, the world that options describe in place of a scenario, and what to write.
struct PlanCheck {
  std::string plan;
  std::optional<std::string> scenario;
  std::vector<std::string> terrain;  ///< models, or folders of them
  std::string crs;                   ///< of a model that names none
  std::vector<std::string> airspace;
  bool fills_voids = false;            ///< from their neighbours, else they are closed
  std::vector<std::string> permitted;  ///< zones that a permission opens, as in host::ZoneUse
  double buffer_m = 0;                 ///< kept from zones
  double radius_m = 0;
  host::GateOptions gate;                 ///< who may fly it
  std::optional<std::string> parameters;  ///< a file with the autopilot's
  std::optional<double> above_ground_m;   ///< of a line without heights
  std::optional<double> min_above_ground_m;
  std::optional<double> max_above_ground_m;
  std::optional<double> max_ground_distance_m;
  std::optional<std::string> start_time;
  std::optional<double> flown_s;  ///< for zones with hours; none: as long as the mission takes
  bool returns = false;           ///< failsafe returns are judged, too
  std::optional<double> battery_wh;
  host::Battery battery;        ///< without the capacity
  std::optional<double> glide;  ///< ratio of an aeroplane without its engine
  std::optional<std::string> ditch;
  bool json = false;
  std::optional<std::string> certificate;
  std::optional<std::string> junit;
  std::optional<std::string> fixed;
  std::optional<std::string> fixed_returns;  ///< for a parameter
};

/// An item of a mission that has a place.
struct PlacedItem {
  std::string place;  ///< in the file, as formats::MissionItem has it
  std::string name;   ///< "item 3 (waypoint)"
  int number = 0;     ///< as ground stations show it; 0: none
  Vec3 at{0, 0, 0};   ///< where its line leads, of a landing the item's own place, not below ground
};

/// A mission, the world in which it is flown, and the verdict.
struct JudgedPlan {
  formats::MissionFile mission;
  host::Mission world;
  host::PlanReport report;
  host::GateOptions gate{};  ///< by which it was judged

  /// What is wrong with it, a line each.
  std::vector<std::string> findings() const;
  /// "pass: mission.plan, 16 waypoints, 10.713 km, at least 53.1 m above ground, 17.9 to 21.7 min"
  std::string verdict() const;
  /// Its items in the page's frame, in order.
  std::vector<PlacedItem> items(const Frame& page) const;
  /// The line as it is flown, with that verdict, for a page of that frame: that of another world
  /// about the mission, or its own.
  host::JudgedLine line(const Frame& page) const;
  /// A point of the report in the page's frame.
  Vec3 in_frame(const Vec3& p, const Frame& page) const;
};

/// Judges a ground station's mission, or another text in the place of its file's; prints and writes
/// nothing.
JudgedPlan judged_plan(const PlanCheck& plan, const host::Overrides& overrides,
                       const std::optional<std::string>& text = std::nullopt);

/// Judges a ground station's mission; prints each violation with its items, its place and, where
/// one item's change cures it, that change. Writes a certificate, JUnit XML and the cured mission
/// where asked to. Returns the exit code.
int check_plan(const PlanCheck& plan, const host::Overrides& overrides);
}  // namespace altiplan::cli
