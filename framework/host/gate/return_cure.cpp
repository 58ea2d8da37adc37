// SPDX-License-Identifier: Apache-2.0
#include "host/gate/return_cure.hpp"

#include <algorithm>
#include <cmath>

#include "host/gate/returns.hpp"
#include "host/import_export/imported_route.hpp"

namespace altiplan::host {

namespace {

/// True if no return is refused, and all are judged that were before.
bool is_cured(const ReturnsReport& report, const ReturnsReport& before) {
  const auto& known = before.unjudged;
  return report.refused.empty() &&
         std::all_of(report.unjudged.begin(), report.unjudged.end(), [&](const std::string& why) {
           return std::find(known.begin(), known.end(), why) != known.end();
         });
}
}  // namespace

std::optional<ReturnCure> cure_of_returns(const std::string& file, const formats::MissionFile& plan,
                                          const Mission& world, const GateOptions& options) {
  const auto autopilots =
      possible_autopilots(plan, options.firmware, options.airframe, options.flight.parameters);
  if (plan.commands.empty() || autopilots.size() != 1) {
    return std::nullopt;
  }
  const ReturnsReport before = judge_returns(plan, world, options);
  if (is_cured(before, before) && judge_plan(file, plan, world, options).passed()) {
    return std::nullopt;  // what is not judged no height cures
  }
  GateOptions with = options;
  return min_return_height(autopilots.front(), options.flight.parameters,
                           [&](const ParameterFile& parameters) {
                             with.flight.parameters = parameters;
                             return is_cured(judge_returns(plan, world, with), before) &&
                                    judge_plan(file, plan, world, with).passed();
                           });
}

namespace {

using formats::MissionFile;
using formats::MissionPoint;

/// Seconds of the flight without a way home, and one for each stretch of them.
double refused_time(const ReturnsReport& report) {
  double time = 0;
  for (const RefusedReturn& stretch : report.refused) {
    time += stretch.to_s - stretch.from_s + 1;
  }
  return time;
}

/// Puts rally points where they leave the least of the flight without a way home, one by one.
class RallyCure {
 public:
  RallyCure(MissionFile plan, const Mission& world, const GateOptions& options,
            formats::Autopilot autopilot)
      : plan_(std::move(plan)), world_(world), options_(options), autopilot_(autopilot) {
    home_z_ = to_local(*plan_.home, std::nullopt, world.truth).z();
  }

  /// False if no points cure the returns.
  bool find() {
    const std::size_t own = plan_.rally.size();
    before_ = judge_returns(plan_, world_, options_);
    if (before_.refused.empty()) {
      return false;  // what is not judged no point cures
    }
    for (ReturnsReport report = before_; !is_cured(report, before_);) {
      if (report.refused.empty() || plan_.rally.size() >= maximum() || tried_ > kMaxTries ||
          !add_one(report)) {
        return false;
      }
    }
    while (remove_one(own)) {
    }
    return true;
  }
  const MissionFile& plan() const { return plan_; }

 private:
  /// As many as an autopilot stores (AP_Rally by board: ArduCopter 46, ArduPlane 50; PX4 32).
  std::size_t maximum() const {
    return autopilot_.is_px4() ? 32 : autopilot_.is_copter() ? 46 : 50;
  }

  /// Removes one that is needless, behind the mission's own; false if there is none.
  bool remove_one(std::size_t own) {
    for (std::size_t n = plan_.rally.size(); n-- > own;) {
      MissionFile fewer = plan_;
      fewer.rally.erase(fewer.rally.begin() + std::ptrdiff_t(n));
      if (is_cured(judge_returns(fewer, world_, options_), before_)) {
        plan_ = std::move(fewer);
        return true;
      }
    }
    return false;
  }

  /// Adds the best point for the longest stretch: the first that clears it, else the one that
  /// leaves least.
  bool add_one(ReturnsReport& report) {
    const double before = refused_time(report);
    const RefusedReturn& stretch = *std::max_element(
        report.refused.begin(), report.refused.end(),
        [](const auto& a, const auto& b) { return a.to_s - a.from_s < b.to_s - b.from_s; });
    const double clears = before - (stretch.to_s - stretch.from_s + 1);
    double minimum = before;
    ReturnsReport best;
    std::optional<MissionPoint> point;
    for (const MissionPoint& candidate : candidates(stretch.places)) {
      ++tried_;
      plan_.rally.push_back(candidate);
      ReturnsReport with = judge_returns(plan_, world_, options_);
      plan_.rally.pop_back();
      if (const double left = refused_time(with); left < minimum) {
        minimum = left;
        best = std::move(with);
        point = candidate;
      }
      if (minimum <= clears) {
        break;
      }
    }
    if (point) {
      plan_.rally.push_back(*point);
      report = std::move(best);
    }
    return point.has_value();
  }

  /// From the middle of the stretch outward, at one height after another.
  std::vector<MissionPoint> candidates(const std::vector<Vec3>& places) const {
    std::vector<MissionPoint> points;
    for (const double rise : {0.0, 40.0, 100.0}) {
      for (std::size_t k = 0; k < places.size(); ++k) {
        const std::size_t middle = places.size() / 2;
        const std::size_t at = k % 2 == 0 ? middle + k / 2 : middle - (k + 1) / 2;
        if (const auto place = at < places.size() ? place_near(places[at]) : std::nullopt) {
          points.push_back(point_at(*place, rise));
        }
      }
    }
    return points;
  }

  MissionPoint point_at(const Vec3& place, double rise) const {
    constexpr double kUnits = 1e7;  // of a degree, as autopilots store it
    const auto [lon, lat] = world_.truth.frame().to_lonlat(place.x(), place.y());
    return {std::round(lon * kUnits) / kUnits, std::round(lat * kUnits) / kUnits,
            std::ceil(place.z() - home_z_ + rise), formats::AltitudeFrame::home};
  }

  /// An aeroplane circles where it flies; a copter lands on the nearest flat ground. Its height is
  /// where it then begins to come down (ArduPilot), or the ground itself (PX4).
  std::optional<Vec3> place_near(const Vec3& place) const {
    constexpr double kAbove = 15;  // metres: ArduCopter's own return height
    if (!autopilot_.is_copter()) {
      return place;
    }
    for (const double aside : {0.0, 30.0, 60.0, 120.0, 240.0}) {
      for (int eighth = 0; eighth < (aside > 0 ? 8 : 1); ++eighth) {
        const double angle = eighth * kPi / 4;
        const double x = place.x() + aside * std::cos(angle);
        const double y = place.y() + aside * std::sin(angle);
        if (const std::optional<double> ground = flat_ground(x, y)) {
          return Vec3(x, y, *ground + (autopilot_.is_px4() ? 0 : kAbove));
        }
      }
    }
    return std::nullopt;
  }

  /// Its height, where no ground within 10 m differs by more than a tenth of that.
  std::optional<double> flat_ground(double x, double y) const {
    constexpr double kAside = 10;  // metres
    const std::optional<double> middle = world_.truth.ground(x, y);
    for (int eighth = 0; middle && eighth < 8; ++eighth) {
      const double angle = eighth * kPi / 4;
      const auto beside =
          world_.truth.ground(x + kAside * std::cos(angle), y + kAside * std::sin(angle));
      if (!beside || std::abs(*beside - *middle) > kAside / 10) {
        return std::nullopt;
      }
    }
    return middle;
  }

  static constexpr int kMaxTries = 200;  ///< each takes up to a second

  MissionFile plan_;
  const Mission& world_;
  const GateOptions& options_;
  formats::Autopilot autopilot_;
  ReturnsReport before_;
  double home_z_ = 0;
  int tried_ = 0;
};
}  // namespace

namespace {

constexpr int kReturnPathStart = 188;
constexpr int kLandingStart = 189;

/// The markers that ArduPilot looks for when a failsafe has it return; none without such a
/// failsafe.
std::vector<int> markers_of_returns(formats::Autopilot autopilot, const ParameterFile& given) {
  constexpr double kAlongMission = 6;  // of a failsafe's actions
  if (autopilot.is_px4() || autopilot.airframe == formats::Airframe::vtol) {
    return {};
  }
  const Parameters value(autopilot, given);
  if (!autopilot.is_copter()) {
    const double autoland = value("RTL_AUTOLAND");
    return autoland == 4                    ? std::vector{kReturnPathStart}
           : autoland == 1 || autoland == 2 ? std::vector{kLandingStart}
                                            : std::vector<int>{};
  }
  const bool joins = std::any_of(given.begin(), given.end(), [&](const auto& parameter) {
    const std::string& name = parameter.first;
    return parameter.second.value == kAlongMission &&
           (name == "FS_THR_ENABLE" || name == "FS_GCS_ENABLE" || is_battery_failsafe(name));
  });
  return joins ? std::vector{kReturnPathStart, kLandingStart} : std::vector<int>{};
}

MissionFile with_markers(MissionFile plan, const std::vector<AddedMarker>& markers) {
  for (const AddedMarker& marker : markers) {  // from the last
    const auto before = std::find_if(plan.commands.begin(), plan.commands.end(),
                                     [&](const auto& one) { return one.place == marker.before; });
    formats::MissionCommand added;
    added.number = marker.command;
    added.frame = 2;
    added.item = before->item;
    std::for_each(before, plan.commands.end(), [](auto& one) { one.item += 1; });
    plan.commands.insert(before, added);
  }
  return plan;
}
}  // namespace

std::optional<std::vector<AddedMarker>> markers_that_cure(const std::string& file,
                                                          const MissionFile& plan,
                                                          const Mission& world,
                                                          const GateOptions& options) {
  using formats::Task;
  const auto autopilots =
      possible_autopilots(plan, options.firmware, options.airframe, options.flight.parameters);
  const auto task_of = [](const auto& one) { return formats::command_task(one.number).task; };
  const auto is = [&](Task task) {
    return [&, task](const auto& one) { return task_of(one) == task; };
  };
  const auto& commands = plan.commands;
  if (autopilots.size() != 1 || std::any_of(commands.begin(), commands.end(), is(Task::jump)) ||
      std::any_of(commands.begin(), commands.end(), is(Task::jump_to_tag))) {
    return std::nullopt;
  }
  std::vector<std::size_t> items;  // with places of their own, and in the file
  for (std::size_t n = 1; n < commands.size(); ++n) {
    const bool is_alone = std::count_if(commands.begin(), commands.end(), [&](const auto& one) {
                            return one.place == commands[n].place;
                          }) == 1;
    const bool is_simple =
        commands[n].place.starts_with("mission.items.") &&
        commands[n].place.find_first_not_of("0123456789", 14) == std::string::npos;
    if (is_alone && is_simple && commands[n].has_position() && task_of(commands[n]) != Task::land &&
        formats::flies_to_position(task_of(commands[n]))) {
      items.push_back(n);
    }
  }
  const ReturnsReport before = judge_returns(plan, world, options);
  const auto cure = [&](const std::vector<AddedMarker>& markers) {
    const MissionFile with = with_markers(plan, markers);
    return is_cured(judge_returns(with, world, options), before) &&
           judge_plan(file, with, world, options).passed();
  };
  // An aeroplane does not land from wherever it is: its path ends where the last approach begins.
  const auto land = std::find_if(commands.begin(), commands.end(), is(Task::land));
  const auto approach = std::find_if(items.rbegin(), items.rend(), [&](std::size_t n) {
    return n < std::size_t(land - commands.begin());
  });
  const bool has_start = std::any_of(commands.begin(), commands.end(), is(Task::landing_start));
  for (const int command : markers_of_returns(autopilots.front(), options.flight.parameters)) {
    const bool needs_start =
        command == kReturnPathStart && !autopilots.front().is_copter() && !has_start;
    if (needs_start && approach == items.rend()) {
      return std::nullopt;
    }
    for (std::size_t k = items.size(); k-- > 0;) {
      std::vector<AddedMarker> markers{{commands[items[k]].place, command}};
      if (needs_start && items[k] >= *approach) {
        continue;
      }
      if (needs_start) {
        markers.insert(markers.begin(), {commands[*approach].place, kLandingStart});
      }
      if (cure(markers)) {
        return markers;
      }
    }
  }
  return std::nullopt;
}

std::optional<MissionFile> with_rally_cure(const std::string& file, const MissionFile& plan,
                                           const Mission& world, const GateOptions& options) {
  const auto autopilots =
      possible_autopilots(plan, options.firmware, options.airframe, options.flight.parameters);
  if (plan.commands.empty() || autopilots.size() != 1 || !plan.home) {
    return std::nullopt;
  }
  RallyCure cure(plan, world, options, autopilots.front());
  if (!cure.find() || !judge_plan(file, cure.plan(), world, options).passed()) {
    return std::nullopt;
  }
  return cure.plan();
}
}  // namespace altiplan::host
