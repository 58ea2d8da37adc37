// SPDX-License-Identifier: Apache-2.0
#include "host/gate/task_verdict.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "host/base/words.hpp"

namespace altiplan::host {
namespace {

using formats::MissionCommand;
using formats::MissionItem;
using formats::Task;

/// Files round positions and heights; autopilots come no nearer.
constexpr double kPlace = 1;  // metres
constexpr int kGripper = 211;

double seconds(double parameter) { return parameter > 0 ? parameter : 0; }

/// How far beside a place a copter may pass that comes to it: PX4's acceptance radius by default.
constexpr double kBeside = 10;

/// The commands that each flight carries out, and those that one may pass farther off.
struct Flown {
  std::set<std::size_t> commands;
  std::set<std::size_t> aside;
};
Flown flown_commands(const std::vector<FlownMission>& flights) {
  std::map<std::size_t, std::size_t> count;
  Flown flown;
  for (const FlownMission& flight : flights) {
    std::set<std::size_t> own;
    for (const FlownPart& part : flight.parts) {
      own.insert(part.command);
      own.insert(part.before);
      if (!part.strips.empty() && part.strips.back().reach_m > kBeside) {
        flown.aside.insert(part.command);
      }
    }
    for (const std::size_t n : own) {
      ++count[n];
    }
  }
  for (const auto& [n, times] : count) {
    if (times == flights.size()) {
      flown.commands.insert(n);
    }
  }
  return flown;
}

bool is_same(const Vec3& a, const Vec3& b) { return (a - b).norm() <= kPlace; }

/// True if the places from the first on are the points, forwards or backwards.
bool flies(const std::vector<PlaceFlown>& places, std::size_t first, const Polyline& points) {
  if (first + points.size() > places.size()) {
    return false;
  }
  const auto follows = [&](auto point) {
    return std::all_of(places.begin() + std::ptrdiff_t(first),
                       places.begin() + std::ptrdiff_t(first + points.size()),
                       [&](const PlaceFlown& place) {
                         const bool is_straight = &place == &places[first] || !place.is_on_curve;
                         return is_straight && is_same(place.at, *point++);
                       });
  };
  return follows(points.begin()) || follows(points.rbegin());
}

constexpr const char* kNoLanding = "does not land";

/// What of the stop is not done there; "" if all is.
std::string undone(const Stop& stop, const PlaceFlown& there) {
  constexpr double kSecond = 0.05;  // of times in files
  if (stop.lands && !there.lands) {
    return kNoLanding;
  }
  if (there.hold_s < stop.hold_s - kSecond) {
    return "waits " + with_digits(there.hold_s, 6) + " s of " + with_digits(stop.hold_s, 6);
  }
  if (stop.drops && !there.drops_after_s) {
    return "drops nothing";
  }
  if (stop.drops && *there.drops_after_s < stop.hold_s - kSecond) {
    return "drops its cargo before it has waited";
  }
  return "";
}

Finding finding_of(std::string message, bool is_unjudged) {
  Finding finding;
  finding.violation.constraint = "task";
  finding.violation.message = std::move(message);
  finding.items = {"the mission"};
  finding.is_unjudged = is_unjudged;
  return finding;
}

/// Walks through the commands of a mission without jumps.
class Places {
 public:
  Places(const formats::MissionFile& plan, const World& world,
         const std::vector<FlownMission>& flights)
      : plan_(plan), world_(world), flown_(flown_commands(flights)) {
    for (const MissionItem& item : plan.items) {
      items_[item.place] = &item;
    }
    if (plan.home) {
      const auto [x, y] = world.frame().to_local(plan.home->lon, plan.home->lat);
      home_ = Vec3(x, y, plan.home->altitude_m);
    }
  }

  std::vector<PlaceFlown> all() {
    bool goes_on = true;
    for (std::size_t n = 0; n < plan_.commands.size() && goes_on; ++n) {
      goes_on = take(n);
    }
    return std::move(places_);
  }

 private:
  /// False if the flight goes no farther.
  bool take(std::size_t n) {
    const MissionCommand& command = plan_.commands[n];
    const Task task = formats::command_task(command.number).task;
    const auto item = items_.find(command.place);
    if (item != items_.end()) {
      if (!flown_.commands.contains(n)) {
        return true;
      }
      come_to(n, *item->second, task);
      if (task == Task::waypoint || task == Task::loiter_time) {
        places_.back().hold_s += std::trunc(seconds(command.params[0]));  // as it is stored
      }
      return task != Task::loiter_forever;
    }
    // After a landing the flight may end; then nothing more is done.
    const bool ends = !places_.empty() && places_.back().lands && !flown_.commands.empty() &&
                      n > *flown_.commands.rbegin();
    if (places_.empty() || ends) {
      return true;
    }
    if (task == Task::return_home) {
      const Vec3 above = plan_.rally.empty() && home_ ? *home_ : Vec3::Constant(kNowhere);
      places_.push_back({Vec3(above.x(), above.y(), kNowhere)});
      return true;
    }
    PlaceFlown& here = places_.back();
    if (task == Task::delay) {
      here.hold_s += seconds(command.params[0]);
    } else if (command.number == kGripper && command.params[1] == 0) {
      here.drops_after_s = here.hold_s;
    }
    return true;
  }

  void come_to(std::size_t n, const MissionItem& item, Task task) {
    Vec3 at = to_local(item.at, plan_.home, world_);
    const bool lands = item.kind == MissionItem::Kind::land;
    if (item.kind == MissionItem::Kind::takeoff) {  // straight up, whatever its position
      const Vec3 from = !places_.empty() ? places_.back().at : home_.value_or(at);
      at = {from.x(), from.y(), at.z()};
    } else if (lands && !places_.empty()) {
      at.z() = places_.back().at.z();
    } else if (task == Task::loiter_turns || flown_.aside.contains(n)) {  // not at its middle
      at = Vec3::Constant(kNowhere);
    }
    const bool is_there =
        !places_.empty() && !lands && !places_.back().lands && is_same(places_.back().at, at);
    if (!is_there) {
      places_.push_back({at});
    }
    places_.back().lands = lands;
    places_.back().is_on_curve |= task == Task::spline || task == Task::arc;
  }

  static constexpr double kNowhere = 1e9;  // metres

  const formats::MissionFile& plan_;
  const World& world_;
  Flown flown_;
  std::map<std::string, const MissionItem*> items_;
  std::optional<Vec3> home_;
  std::vector<PlaceFlown> places_;
};

/// Why the places that a mission comes to are not known; "" if they are.
std::string why_unknown(const formats::MissionFile& plan,
                        const std::vector<FlownMission>& flights) {
  for (const MissionCommand& command : plan.commands) {
    const Task task = formats::command_task(command.number).task;
    if (task == Task::jump || task == Task::jump_to_tag || task == Task::condition ||
        task == Task::set_home) {
      return "jumps, conditions and new homes";
    }
  }
  for (const FlownMission& flown : flights) {
    const bool is_wide = std::any_of(
        flown.parameters.begin(), flown.parameters.end(), [](const Parameters::Used& used) {
          return (used.name == "NAV_ACC_RAD" || used.name == "WP_RADIUS_M") && used.value > kBeside;
        });
    const bool has_wide =
        flown.autopilot.is_px4() &&
        std::any_of(plan.commands.begin(), plan.commands.end(), [](const MissionCommand& command) {
          return command.number == 16 && command.params[1] > kBeside;
        });
    if (is_wide || has_wide) {
      return "acceptance radii above " + with_digits(kBeside, 3) + " m";
    }
  }
  const bool is_all_copters =
      std::all_of(flights.begin(), flights.end(),
                  [](const FlownMission& flown) { return flown.autopilot.is_copter(); });
  return plan.commands.empty() || is_all_copters ? "" : "aeroplanes";
}

Finding no_order(const TaskOrder& order) {
  return finding_of(
      "whether it does the scenario's task is not judged: it has no order: " + order.message, true);
}

std::optional<Finding> undone(const Mission& world, const TaskOrder& order,
                              const std::vector<PlaceFlown>& places) {
  std::vector<bool> used(places.size());  // by a place of the task: another is another visit
  const std::string of_all = " of the task's " + std::to_string(order.passes.size());
  for (std::size_t k = 0; k < order.passes.size(); ++k) {
    const Pass& pass = order.passes[k];
    const std::string name = std::to_string(k + 1) + of_all;
    bool is_flown = false;
    std::string why;
    for (std::size_t first = 0; first < places.size() && (!is_flown || !why.empty()); ++first) {
      const std::size_t last = first + pass.points.size() - 1;
      if (flies(places, first, pass.points) && !(pass.points.size() == 1 && used[first])) {
        const std::string left = undone(pass.stop, places[last]);
        // Of several visits the one that does the most of it is told of.
        why = !is_flown || left.empty() || why == kNoLanding ? left : why;
        is_flown = true;
        used[last] = used[last] || left.empty();
      }
    }
    if (!is_flown && pass.points.size() > 1) {
      return finding_of("does not fly pass " + name +
                            ", and whether other lines of its own do the task is not judged",
                        true);
    }
    if (!is_flown || !why.empty()) {
      Finding finding =
          finding_of((is_flown ? why + " at" : "does not come to") + " place " + name, false);
      finding.at = pass.points.back();
      return finding;
    }
  }
  const bool ends_elsewhere =
      places.empty() || (places.back().at - places.front().at).head<2>().norm() > kPlace;
  if (order.closes && !world.ends.goal && ends_elsewhere) {
    return finding_of("does not end where it begins, as its task is closed", false);
  }
  return std::nullopt;
}
}  // namespace

std::vector<PlaceFlown> places_flown(const Route& route) {
  std::vector<PlaceFlown> places;
  for (std::size_t n = 0; n < route.size(); ++n) {
    if (places.empty() || !is_same(places.back().at, route[n])) {
      places.push_back({route[n]});
    }
    places.back().hold_s += n < route.leg_count() ? route.leg(n).hold_s : 0;
    places.back().is_on_curve |= n > 0 && route.leg(n - 1).turns();
  }
  return places;
}

std::optional<Finding> undone(const Mission& world, const formats::MissionFile& plan,
                              const std::vector<FlownMission>& flights) {
  if (const std::string why = why_unknown(plan, flights); !why.empty()) {
    return finding_of("whether it does the scenario's task is not judged of " + why, true);
  }
  const TaskOrder order = order_of_task(world, {});
  if (order.status != PlanStatus::solved) {
    return no_order(order);
  }
  if (auto found = undone(world, order, Places(plan, world.truth, flights).all())) {
    return found;
  }
  // What is let go of elsewhere is not there any more.
  const auto drops = std::count_if(order.passes.begin(), order.passes.end(),
                                   [](const Pass& pass) { return pass.stop.drops; });
  const auto releases =
      std::count_if(plan.commands.begin(), plan.commands.end(),
                    [](const MissionCommand& command) { return command.number == kGripper; });
  if (releases != drops) {
    return finding_of("commands its gripper " + std::to_string(releases) +
                          " times, where the task drops cargo " + std::to_string(drops) +
                          " times: which cargo is let go of is not judged",
                      true);
  }
  return std::nullopt;
}

std::optional<Finding> undone(const Mission& world, const std::vector<PlaceFlown>& places) {
  const TaskOrder order = order_of_task(world, {});
  return order.status == PlanStatus::solved ? undone(world, order, places) : no_order(order);
}
}  // namespace altiplan::host
