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

/// The commands that each flight carries out.
std::set<std::size_t> flown_commands(const std::vector<FlownMission>& flights) {
  std::map<std::size_t, std::size_t> count;
  for (const FlownMission& flown : flights) {
    std::set<std::size_t> own;
    for (const FlownPart& part : flown.parts) {
      own.insert(part.command);
    }
    for (const std::size_t n : own) {
      ++count[n];
    }
  }
  std::set<std::size_t> all;
  for (const auto& [n, times] : count) {
    if (times == flights.size()) {
      all.insert(n);
    }
  }
  return all;
}

class Places {
 public:
  void come_to(const Vec3& at) {
    if (all.empty() || (all.back().at - at).norm() > kPlace) {
      all.push_back({at});
    }
  }
  void land_at(const Vec3& foot) {
    come_to({foot.x(), foot.y(), all.empty() ? foot.z() : all.back().at.z()});
    all.back().lands = true;
  }

  std::vector<PlaceFlown> all;
};

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
                         return is_straight && (place.at - *point++).norm() <= kPlace;
                       });
  };
  return follows(points.begin()) || follows(points.rbegin());
}

/// What of the stop is not done there; "" if all is.
std::string undone(const Stop& stop, const PlaceFlown& there) {
  constexpr double kSecond = 0.05;  // of times in files
  if (stop.lands && !there.lands) {
    return "does not land";
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
}  // namespace

std::vector<PlaceFlown> places_flown(const formats::MissionFile& plan, const World& world,
                                     const std::vector<FlownMission>& flights) {
  std::map<std::string, const MissionItem*> items;
  for (const MissionItem& item : plan.items) {
    items[item.place] = &item;
  }
  const std::set<std::size_t> flown = flown_commands(flights);
  Places places;
  bool is_landed = false;
  for (std::size_t n = 0; n < plan.commands.size(); ++n) {
    const MissionCommand& command = plan.commands[n];
    const Task task = formats::command_task(command.number).task;
    const auto item = items.find(command.place);
    if (item != items.end() && !flown.contains(n)) {
      continue;
    }
    // After a landing the flight may end; then nothing more is done.
    const bool goes_on = !is_landed || (!flown.empty() && n < *flown.rbegin());
    if (item != items.end()) {
      const Vec3 at = to_local(item->second->at, plan.home, world);
      is_landed = item->second->kind == MissionItem::Kind::land;
      is_landed ? places.land_at(at) : places.come_to(at);
      places.all.back().is_on_curve |= task == Task::spline || task == Task::arc;
      if (task == Task::waypoint || task == Task::loiter_time) {
        places.all.back().hold_s += std::trunc(seconds(command.params[0]));  // as it is stored
      }
    } else if (!places.all.empty() && goes_on) {
      PlaceFlown& here = places.all.back();
      if (task == Task::return_home && plan.home) {
        const auto [x, y] = world.frame().to_local(plan.home->lon, plan.home->lat);
        places.come_to({x, y, here.at.z()});
      } else if (task == Task::delay) {
        here.hold_s += seconds(command.params[0]);
      } else if (command.number == kGripper && command.params[1] == 0) {
        here.drops_after_s = here.hold_s;
      }
    }
  }
  return places.all;
}

std::vector<PlaceFlown> places_flown(const Route& route) {
  Places places;
  for (std::size_t n = 0; n < route.size(); ++n) {
    places.come_to(route[n]);
    places.all.back().hold_s += n < route.leg_count() ? route.leg(n).hold_s : 0;
    places.all.back().is_on_curve |= n > 0 && route.leg(n - 1).turns();
  }
  return places.all;
}

std::optional<Finding> undone(const Mission& world, const std::vector<PlaceFlown>& places) {
  const TaskOrder order = order_of_task(world, {});
  if (order.status != PlanStatus::solved) {
    return finding_of("whether it does the scenario's task is not judged: it has no order: " +
                          order.message,
                      true);
  }
  const std::string of_all = " of the task's " + std::to_string(order.passes.size());
  for (std::size_t k = 0; k < order.passes.size(); ++k) {
    const Pass& pass = order.passes[k];
    const std::string name = std::to_string(k + 1) + of_all;
    bool is_flown = false;
    std::string why;
    for (std::size_t first = 0; first < places.size() && (!is_flown || !why.empty()); ++first) {
      if (flies(places, first, pass.points)) {
        is_flown = true;
        why = undone(pass.stop, places[first + pass.points.size() - 1]);
      }
    }
    if (!is_flown && pass.points.size() > 1) {
      return finding_of("does not fly pass " + name +
                            ", and whether other lines of its own do the task is not judged",
                        true);
    }
    if (!is_flown || !why.empty()) {
      Finding finding = finding_of((is_flown ? why + " at" : "does not come to") + " place " + name,
                                   false);
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
}  // namespace altiplan::host
