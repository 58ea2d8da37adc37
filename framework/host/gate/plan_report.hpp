// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "altiplan/measures.hpp"
#include "host/autopilot/flown_mission.hpp"
#include "host/gate/cure.hpp"
#include "host/import_export/imported_route.hpp"

namespace altiplan::host {

enum class Verdict { pass, fail, not_judged };

/// What is wrong with a mission, as its author sees it.
struct Finding {
  Violation violation;             ///< its constraint is the rule
  std::vector<std::string> items;  ///< as ground stations name them: one, or the two of a way
  std::string what{};              ///< of the part of the flight, "" for a way between two items
  int item = 0;                    ///< the number of the last of them; 0: the format has none
  std::optional<Vec3> at{};        ///< where it is worst, within a metre, if anywhere
  std::string cure{};              ///< "raise item 3 (waypoint) by 12.4 m"; "": none is found
  std::string zone{};              ///< name of the violated layer's part, "" if it has none
  bool is_over_void = false;       ///< there the elevation model has no height
  bool is_unjudged = false;        ///< nothing is known to be wrong
  bool is_own_way = false;         ///< of home or the mission's way, whatever its returns are
};

/// A part of a flight, for tables.
struct ReportedPart {
  std::vector<std::string> items;  ///< one, or the two of a way
  std::string what;                ///< "its circle"; "" for the way between two items
  Vec3 end{0, 0, 0};
  double length_m = 0;
  LegHeights heights;
  TimeSpan time;  ///< of its end, from the beginning of the flight
  bool fails = false;
};

/// A stretch of the flight from which a failsafe return is not valid. Times are those in the middle
/// between the fastest and the slowest flight.
struct RefusedReturn {
  double from_s = 0;
  double to_s = 0;
  std::size_t first = 0;  ///< commands that are carried out at its beginning and at its end
  std::size_t last = 0;
  double worst_s = 0;
  std::size_t worst = 0;        ///< command
  Finding finding;              ///< of the return at the worst time
  std::vector<Finding> others;  ///< by other rules, each of a return of the stretch
  std::vector<Vec3> places;     ///< up to nine along it, at their greatest heights, local metres
};

/// A stretch of the flight from which an aeroplane without its engine glides to the same site.
struct GlideStretch {
  double from_s = 0;
  double to_s = 0;
  std::size_t first = 0;  ///< commands
  std::size_t last = 0;
  std::string site;
  double margin_m = kInfinity;  ///< minimum height above the site
};

/// The verdict on glides from every second of the flight.
struct GlideReport {
  Verdict verdict = Verdict::pass;
  double ratio = 0;                    ///< in still air
  double wind_mps = 0;                 ///< the strongest that is judged
  std::vector<GlideStretch> reached;   ///< by autopilot, and in the order of time
  std::vector<RefusedReturn> refused;  ///< whence no site is reached
  std::vector<std::string> unjudged;   ///< why there is no verdict
  std::vector<Parameters::Used> parameters;

  std::optional<double> margin_m() const;  ///< minimum of all that reach a site
  /// "a site is reached from every second, at least 41.2 m above it", what is refused, or why it is
  /// not judged.
  std::string in_words() const;
};

/// The verdict on the failsafe returns of a mission.
struct ReturnsReport {
  Verdict verdict = Verdict::pass;
  std::optional<GlideReport> glide{};  ///< where they are judged
  std::vector<RefusedReturn> refused;  ///< by autopilot, and in the order of time
  std::vector<std::string> unjudged;   ///< why there is no verdict
  std::vector<Parameters::Used> parameters;
  /// The last second from which, on the slowest flight, the battery lasts for the way home, its
  /// reserve apart; none: no battery is known.
  std::optional<double> point_of_no_return_s{};
  std::optional<Vec3> point_of_no_return{};  ///< none: the end of the flight
  /// "62 s after take-off"; "" where no battery is known.
  std::string no_return_in_words() const;
  /// Of the returns and the glides.
  Verdict overall() const;
  /// The worst of the refused; none: nothing is refused.
  const RefusedReturn* worst() const;
  /// "from every second, of ArduPilot copter", what is refused, or why it is not judged.
  std::string in_words() const;
};

/// What a vehicle has to fly on, and the power that it takes on the whole.
struct Battery {
  double capacity_wh = 0;
  double reserve = 0.2;  ///< share that is kept
  double power_w = 0;    ///< the greatest
  double least_w = 0;

  double usable_wh() const { return capacity_wh * (1 - reserve); }
};

/// What a mission takes of a battery, from the fastest flight at the least power to the slowest at
/// the greatest.
struct EnergyUse {
  double min_wh = 0;
  double max_wh = 0;
  Battery battery;
  double farthest_m = 0;         ///< from home, or from where it begins
  bool circles_at_home = false;  ///< as its end, which is not counted

  /// "31.0 to 44.2 Wh of 72.0 Wh that may be used (battery 90.0 Wh, reserve 20 %), up to 3.912 km
  /// from home"
  std::string in_words() const;
};

/// The verdict on a mission of a ground station.
struct PlanReport {
  std::string file;
  ImportedRoute imported;  ///< as drawn, for maps and profiles
  std::vector<formats::MissionCommand> commands;
  std::vector<formats::Autopilot> autopilots;  ///< those that may fly it; none: judged as drawn
  std::vector<Parameters::Used> parameters;    ///< that mattered
  std::vector<Finding> findings;               ///< none: passed
  std::vector<ReportedPart> parts;             ///< flown by the first of the autopilots
  Polyline line;                               ///< one that it may fly, for pictures
  TimeSpan time;                               ///< by any of them: the only time of the mission
  std::vector<TimeSpan> times;                 ///< when each point of the drawn route is left first
  std::vector<double> speeds_mps;              ///< the greatest on the way to each; 0: none
  double lowest_m = kInfinity;                 ///< above ground, but where it takes off and lands
  Measures measures;
  std::optional<EnergyUse> energy{};       ///< where a battery is known
  std::vector<std::string> notes;          ///< how the file and the world were read
  std::optional<ReturnsReport> returns{};  ///< where they are judged

  Verdict verdict() const;
  /// The mission, and its returns where they are judged.
  bool passed() const {
    return findings.empty() && (!returns || returns->overall() == Verdict::pass);
  }
  /// Of a command.
  std::string name_of(std::size_t command) const;
  /// Of an item at that place of the file; "" of none.
  std::string name_of_item(const std::string& place) const;
  /// Of a point of the drawn route: "item 3 (waypoint)", "point 3" where the file numbers nothing,
  /// "waypoint 3" where the route has other points than the file.
  std::string name_of_point(std::size_t waypoint) const;
  /// "at least 52.4 m above ground", of the flight.
  std::string height_in_words() const;
};

/// One of the lines that the flight may follow: in each part the longest, in the middle between its
/// minimum and maximum heights.
Polyline flown_line(const FlownMission& flown);

/// "from 3 min 12 s (item 4 (waypoint)) to 3 min 40 s (item 5 (waypoint)): 'field', at least 41.2 m
/// above it"
std::string in_words(const GlideStretch& stretch, const PlanReport& report);
/// "…, worst at 3 min 20 s: the glide to 'field': flies into the ground, …"
std::string in_glide_words(const RefusedReturn& refused, const PlanReport& report);
/// "from 3 min 12 s (item 4 (waypoint)) to 3 min 40 s (item 5 (waypoint)), worst at …: a return's
/// …"
std::string in_words(const RefusedReturn& refused, const PlanReport& report);

/// Findings whose sentences differ in figures alone, as one: the worst of them with all the items.
std::vector<Finding> joined_findings(const std::vector<Finding>& findings);

/// "items 1 to 3, 5"; their names where the file numbers nothing.
std::string items_in_words(const std::vector<std::string>& names, const std::vector<int>& numbers);

/// "pass", "fail", "not judged"
const char* word_of(Verdict verdict);

/// "7 to 8 min"; "8 min or more" where nothing ends it.
std::string time_in_words(const TimeSpan& time);

inline constexpr double kHomeTolerance = 10;  ///< metres
/// A ground at least as high stands for a void of the elevation model, which is closed.
inline constexpr double kUnknownGround = 9'000;

/// Throws Error, beginning with `file`, naming what a mission without a route holds instead.
void expect_route(const std::string& file, const formats::MissionFile& plan);
/// Puts each point of a drawn line without heights at this height above the ground. Throws Error,
/// naming the file, for any other.
void put_above_ground(const std::string& file, formats::MissionFile& plan, double height_m);

/// The world as it is from one time of the flight to another, in seconds.
using WorldDuring = std::function<Mission(double, double)>;

/// Ground on which an aeroplane may come down without its engine: a point, or points all over an
/// area.
struct GlideSite {
  std::string name;
  std::vector<formats::Point2> points;  ///< longitude, latitude
};

/// A glide without engine.
struct GlideOptions {
  double ratio = 0;              ///< metres on per metre of height, in still air
  std::vector<GlideSite> sites;  ///< none: home, and where the mission lands
};

/// Of flights that last longer than GateOptions::zones_known_s.
inline constexpr const char* kZonesUnknown = "zones with hours, after the horizon_s of zones";

/// Who may fly it, as far as the user says.
struct GateOptions {
  std::optional<formats::Firmware> firmware{};
  std::optional<formats::Airframe> airframe{};
  FlightOptions flight{};
  std::optional<double> drawn_mps{};  ///< speed along drawn lines; none: 5
  WorldDuring world_during{};         ///< none: it is the same all the time
  std::optional<GlideOptions> glide{};
  std::optional<Battery> battery{};
  bool has_events = false;  ///< of the scenario, which change the world in flight
  /// How long after the start the world knows which zones with hours are open.
  double zones_known_s = kInfinity;
  std::string battery_problem{};  ///< why that of a declared vehicle is not judged; "" if it is
  /// The route need not begin and end where the world's scenario says, nor do its task.
  bool own_ends = true;
};

/// From the fastest to the slowest of the flights.
TimeSpan time_of(const std::vector<FlownMission>& flights);

/// The flights by each autopilot that may fly it. Without a world heights above ground count from
/// home, and the vehicle takes off and lands at its height.
std::vector<FlownMission> flights_of(const formats::MissionFile& plan, const Mission* world,
                                     const GateOptions& options);

/// What can be said of a mission without a verdict: its drawn length, and for each autopilot that
/// may fly it time, heights, and what it refuses or what is not modelled; a line each.
std::vector<std::string> flight_facts(const formats::MissionFile& plan, const Mission* world,
                                      const GateOptions& options);

/// Judges a mission as the autopilots that may fly it do: every part of the flight, the whole band
/// that its parameters allow. A file without commands (KML, GPX, GeoJSON) is judged as drawn,
/// unless the options name an autopilot. What autopilots refuse, heights relative to a home that is
/// more than kHomeTolerance off the ground, and what is not modelled are findings. Throws Error for
/// a mission wholly beside the ground; messages begin with `file`.
PlanReport judge_plan(const std::string& file, const formats::MissionFile& plan,
                      const Mission& world, const GateOptions& options);

/// The mission changed until it passes; none where that fails.
std::optional<formats::MissionFile> cured_plan(const formats::MissionFile& plan,
                                               const Mission& world, const GateOptions& options);
}  // namespace altiplan::host
