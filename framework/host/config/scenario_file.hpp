// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "altiplan/params.hpp"
#include "host/energy/flight_power.hpp"

namespace altiplan::host {

// A scenario file as written, field by field; nothing is resolved yet.

/// `- terrain: {…}` with the host's keys beside it.
struct LayerEntry {
  std::string plugin;
  Value parameters;
  std::string id;
  bool known = true;
  void describe(Fields& f);
};

struct ConstraintEntry {
  std::string plugin;
  Value parameters;
  void describe(Fields& f);
};

/// `objective: {exposure: {…}}`.
struct ObjectiveEntry {
  std::string plugin;
  Value parameters;
  void describe(Fields& f);
};

/// `- exposure: {…}` under `metrics`: an objective by which every route is measured.
struct MetricEntry {
  std::string plugin;
  Value parameters;
  std::string id;  ///< name of the value in results
  void describe(Fields& f);
};

/// `task: {cover: {…}}`: what is to be done besides reaching the goal.
struct TaskEntry {
  std::string plugin;
  Value parameters;
  void describe(Fields& f);
};

struct PointEntry {
  Point point;
  void describe(Fields& f);
};

struct LoiterEntry {
  double radius_m = 0;
  bool left = false;
  void describe(Fields& f);
};

/// A take-off of an aeroplane: straight from the start to a height. A VTOL's begins where it is in
/// hover, level.
struct TakeOffEntry {
  double course_deg = 0;
  double height_m = 0;
  double climb_deg = 4;
  double level_m = 0;
  void describe(Fields& f);
};

/// Of the start: a pose, if it has a heading.
struct StartEntry {
  Point point;
  std::optional<double> heading_deg;
  std::optional<LoiterEntry> loiter;
  std::optional<TakeOffEntry> takeoff;
  void describe(Fields& f);
};

/// Its landing: a level approach, then straight down to the goal; a VTOL's ends in hover.
struct LandingEntry {
  double course_deg = 0;
  double height_m = 0;
  double glide_deg = 5;
  double level_m = 300;
  void describe(Fields& f);
};

struct GoalEntry {
  Point point;
  double tolerance_m = 0;
  std::optional<double> heading_deg;
  std::optional<LoiterEntry> loiter;
  std::optional<LandingEntry> landing;
  void describe(Fields& f);
};

struct VolumeEntry {
  std::optional<Vec3> min_m;
  std::optional<Vec3> max_m;
  std::optional<double> floor_m;
  std::optional<double> ceiling_m;
  std::optional<double> corridor_m;
  void describe(Fields& f);
};

struct SpeedNearEntry {
  double within_m = 0;
  double speed_mps = 0;
  void describe(Fields& f);
};

struct WingEntry {
  double airspeed_mps = 0;
  double bank_deg = 30;
  double climb_deg = 10;
  double sink_deg = 10;
  double roll_rate_dps = 60;
  void describe(Fields& f);
};

/// One wind, or one by the cells of a grid.
struct WindKindEntry {
  std::optional<double> from_deg;
  std::optional<double> speed_mps;
  Path grid;
  std::vector<int> bands;  ///< east, north
  void describe(Fields& f);
};

/// Wind within a layer of height.
struct WindLayerEntry : WindKindEntry {
  double above_m = 0;
  void describe(Fields& f);
};

/// At every height, or `{layers: […]}`.
struct WindLayersEntry : WindKindEntry {
  std::vector<WindLayerEntry> layers;
  bool blows() const { return speed_mps.value_or(0) > 0 || !layers.empty() || !grid.text.empty(); }
  bool is_given() const { return from_deg || !layers.empty() || !grid.text.empty(); }
  void describe(Fields& f);
};

/// From a time on.
struct WindHourEntry : WindLayersEntry {
  std::string from_time;
  void describe(Fields& f);
};

/// At all times, or `{hours: […]}`.
struct WindEntry : WindLayersEntry {
  std::vector<WindHourEntry> hours;
  bool blows() const { return WindLayersEntry::blows() || !hours.empty(); }
  void describe(Fields& f);
};

struct CylinderEntry {
  double radius_m = 0;
  double height_m = 0;
  void describe(Fields& f);
};

struct CapsuleEntry {
  double radius_m = 0;
  double length_m = 0;
  void describe(Fields& f);
};

/// One of four kinds of part.
struct BodyPartEntry {
  std::optional<Vec3> box_m;
  std::optional<CylinderEntry> cylinder;
  std::optional<CapsuleEntry> capsule;
  std::optional<Path> mesh;
  double scale = 1;
  Vec3 offset_m{0, 0, 0};
  void describe(Fields& f);
  /// The number of kinds that are given.
  int kinds() const;
};

/// A part, or several, with its attitude.
struct BodyEntry {
  enum class Yaw { along_route, fixed };
  enum class Pitch { level, along_route };
  BodyPartEntry part;
  std::vector<BodyPartEntry> parts;
  Yaw yaw = Yaw::along_route;
  std::optional<double> fixed_deg;
  Pitch pitch = Pitch::level;
  void describe(Fields& f);
};

// The models of power that a file may name, with what it may say of them.

struct LiuEntry : LiuPower {
  void describe(Fields& f);
};

struct RotorsEntry : MomentumPower {
  RotorsEntry() {  // of small rotors
    induced = 1.15;
    efficiency = 0.6;
  }
  void describe(Fields& f);
};

/// As measured in hover, and perhaps at a speed.
struct HoverEntry {
  double power_w = 0;
  std::optional<double> cruise_w;
  std::optional<double> cruise_mps;
  double mass_kg = 0;
  double efficiency = 0.5;
  void describe(Fields& f);
};

struct AeroplaneEntry : PolarPower {
  AeroplaneEntry() {
    efficiency = 0.5;
    cl_max = 1.2;
  }
  void describe(Fields& f);
};

struct LevelPowerEntry {
  double airspeed_mps = 0;
  double power_w = 0;
  void describe(Fields& f);
};

/// Power measured in level flight.
struct MeasuredEntry {
  std::vector<LevelPowerEntry> level;
  double mass_kg = 0;
  double efficiency = 0.5;
  void describe(Fields& f);
};

/// The battery, and one of six models of power.
struct EnergyEntry {
  std::optional<double> capacity_wh;
  double usable = 1;
  double reserve = 0.2;
  std::optional<LiuEntry> multirotor;
  std::optional<RotorsEntry> rotors;
  std::optional<HoverEntry> hover;
  std::optional<AeroplaneEntry> aeroplane;
  std::optional<MeasuredEntry> measured;
  std::optional<double> power_w;
  void describe(Fields& f);
};

/// An autopilot whose defaults a vehicle has.
enum class Performance { none, arducopter, arduplane, px4_mc, px4_fw };

/// What an autopilot flies, which says how it takes off and lands.
enum class VehicleType { by_wing, copter, plane, vtol };

struct VehicleEntry {
  VehicleType type = VehicleType::by_wing;
  double radius_m = 0;
  Performance performance = Performance::none;
  std::optional<double> speed_mps;
  std::optional<double> climb_mps;
  std::optional<double> sink_mps;
  std::optional<double> acceleration_mps2;
  std::optional<double> jerk_mps3;
  std::optional<double> jerk_time_s;
  std::optional<double> corner_radius_m;
  std::optional<EnergyEntry> energy;
  std::optional<double> sensing_m;
  std::vector<SpeedNearEntry> speed_near;
  bool turns_on_the_spot = false;
  std::optional<WingEntry> wing;
  std::optional<BodyEntry> body;
  void describe(Fields& f);
  /// True with a wing, given or of the performance.
  bool has_wing() const;
  /// The given type; else plane with a wing, copter without.
  VehicleType flown_as() const;
};

struct FrameEntry {
  std::string crs;
  std::optional<std::array<double, 2>> origin_lonlat;
  void describe(Fields& f);
};

/// `- sphere: {…, velocity_mps}` or `- random: {count, …}`.
struct MovingEntry {
  std::string shape;
  Value parameters;
  std::string id;
  std::optional<bool> known;
  void describe(Fields& f);
};

struct NearEntry {
  Point point;
  double within_m = 0;
  void describe(Fields& f);
};

/// The added layer, as under `environment`.
struct AddEntry {
  std::string plugin;
  Value parameters;
  void describe(Fields& f);
};

/// Cells that become blocked or free; only for a layer with cells.
struct SetCellsEntry {
  std::string layer;
  std::vector<Vec3> cells;
  bool blocked = true;
  void describe(Fields& f);
};

struct MoveEntry {
  std::string layer;
  Vec3 by_m{0, 0, 0};
  void describe(Fields& f);
};

struct EventEntry {
  std::optional<double> at_s;
  std::optional<NearEntry> when_near;
  std::optional<AddEntry> add;
  std::string id;
  bool known = false;
  std::optional<std::string> remove;
  std::optional<MoveEntry> move;
  std::optional<SetCellsEntry> set_cells;
  std::optional<PointEntry> move_goal;
  std::optional<NearEntry> visit;
  void describe(Fields& f);
};

struct ScenarioFile {
  int altiplan = 0;
  std::string name;
  std::vector<Path> plugins;
  FrameEntry frame;
  std::vector<LayerEntry> environment;
  VolumeEntry volume;
  VehicleEntry vehicle;
  std::optional<double> level_flight_at_m;
  std::optional<std::string> start_time;
  std::optional<Path> mission;
  WindEntry wind;
  StartEntry start;
  std::vector<GoalEntry> via;
  GoalEntry goal;
  std::optional<TaskEntry> task;
  std::vector<MovingEntry> moving;
  std::vector<EventEntry> events;
  std::vector<ConstraintEntry> constraints;
  std::optional<ObjectiveEntry> objective;
  std::vector<MetricEntry> metrics;
  std::optional<double> reference;
  void describe(Fields& f);
};

/// The format number that every file begins with.
inline constexpr int kFileFormat = 1;
}  // namespace altiplan::host
