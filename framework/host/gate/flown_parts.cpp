// SPDX-License-Identifier: Apache-2.0
#include "host/gate/flown_parts.hpp"

#include <algorithm>
#include <cmath>

#include "altiplan/error.hpp"
#include "host/import_export/imported_route.hpp"

namespace altiplan::host {
namespace {

using formats::MissionItem;
using formats::MissionPoint;
using Kind = MissionItem::Kind;

/// Height of the ground there, else of home, else of the point.
double foot_of(const Vec3& top, const std::optional<MissionPoint>& home, const World& world) {
  const std::optional<double> ground = world.ground(top.x(), top.y());
  return std::min(top.z(), ground ? *ground : home ? home->altitude_m : top.z());
}

std::string type_of(const MissionItem& item) {
  return item.kind == Kind::takeoff  ? "take-off"
         : item.returns              ? "return to launch"
         : item.kind == Kind::land   ? "landing"
         : item.kind == Kind::loiter ? "loiter"
                                     : "waypoint";
}

/// A return at the end as a landing at home.
void end_at_home(formats::MissionFile& plan) {
  if (plan.moves.empty() || !plan.home || plan.items.empty()) {
    return;
  }
  const formats::MissionMove& last = plan.moves.back();
  if (last.command == formats::MissionMove::kReturn && last.after == plan.items.size() &&
      plan.items.back().kind != Kind::land) {
    MissionItem landing{Kind::land, *plan.home, 0, last.place};
    landing.number = last.number;
    landing.returns = true;
    plan.items.push_back(std::move(landing));
    plan.moves.pop_back();
  }
}

/// Splits a mission into its route and what is no leg of it.
class Splitter {
 public:
  Splitter(formats::MissionFile plan, const World& world) : plan_(std::move(plan)), world_(world) {}

  FlownParts parts() {
    end_at_home(plan_);
    begin_at_home();
    add_circles();
    if (plan_.items.size() > 1 && plan_.items.back().kind == Kind::land) {
      keep_one_landing();
      end_above_landing();
    }
    if (plan_.items.size() == 1) {
      const Vec3 p = place(plan_.items.front());
      parts_.ways.push_back(
          {name_of_item(plan_.items.front()), "the only position", Leg::straight(p, p)});
    }
    parts_.route = std::move(plan_);
    return std::move(parts_);
  }

 private:
  Vec3 place(const MissionItem& item) const {
    try {
      return to_local(item.at, plan_.home, world_);
    } catch (const Error& error) {
      throw Error(name_of_item(item) + ": " + error.what());
    }
  }

  void add(const MissionItem& item, bool is_climb, const Vec3& foot, const Vec3& top) {
    const double z = foot_of({foot.x(), foot.y(), top.z()}, plan_.home, world_);
    const bool is_vertical = foot.x() == top.x() && foot.y() == top.y();
    parts_.passages.push_back(
        {name_of_item(item), is_climb, is_vertical, {foot.x(), foot.y(), z}, top});
  }

  /// An aeroplane climbs from home to the first item; others do above home, to its height.
  void begin_at_home() {
    const MissionItem& first = plan_.items.front();
    if (first.kind != Kind::takeoff) {
      return;
    }
    const Vec3 top = place(first);
    Vec3 above = top;
    if (plan_.home) {
      const auto [x, y] = world_.frame().to_local(plan_.home->lon, plan_.home->lat);
      const bool is_elsewhere = std::hypot(x - top.x(), y - top.y()) > kRoundingReach;
      above = is_elsewhere ? Vec3(x, y, top.z()) : top;
    }
    add(first, true, above, plan_.is_wing ? top : above);
    if (above != top && !plan_.is_wing) {
      parts_.ways.push_back({name_of_item(first), "the way from home", Leg::straight(above, top)});
    }
  }

  void add_circles() {
    for (const MissionItem& item : plan_.items) {
      if (item.loiter_m > 0) {
        const Vec3 centre = place(item);
        parts_.ways.push_back(
            {name_of_item(item), "its circle", Loiter{item.loiter_m, 1}.circle(centre)});
      }
    }
  }

  /// Of landings at one place: the descent begins above the first.
  void keep_one_landing() {
    auto& items = plan_.items;
    const auto xy = [&](const MissionItem& item) {
      return world_.frame().to_local(item.at.lon, item.at.lat);
    };
    while (items.size() > 2 && items[items.size() - 2].kind == Kind::land) {
      const auto [x, y] = xy(items.back());
      const auto [before_x, before_y] = xy(items[items.size() - 2]);
      if (std::hypot(x - before_x, y - before_y) > kRoundingReach) {
        break;
      }
      items.erase(items.end() - 2);
    }
  }

  void end_above_landing() {
    MissionItem& landing = plan_.items.back();
    const Vec3 before = place(plan_.items[plan_.items.size() - 2]);
    const auto [x, y] = world_.frame().to_local(landing.at.lon, landing.at.lat);
    const bool is_elsewhere = std::hypot(x - before.x(), y - before.y()) > kRoundingReach;
    const bool is_flown_to = is_elsewhere && !plan_.is_wing;
    add(landing, false, {x, y, 0}, is_flown_to ? Vec3(x, y, before.z()) : before);
    if (is_flown_to) {
      landing.at = {landing.at.lon, landing.at.lat, before.z(), formats::AltitudeFrame::sea};
    } else {
      plan_.items.pop_back();
    }
  }

  formats::MissionFile plan_;
  const World& world_;
  FlownParts parts_;
};
}  // namespace

std::string name_of_item(const MissionItem& item) {
  return item.number > 0 ? "item " + std::to_string(item.number) + " (" + type_of(item) + ")"
                         : item.place;
}

std::string name_of_move(const formats::MissionMove& move) {
  const std::string what = move.command == formats::MissionMove::kReturn ? "return to launch"
                           : move.command == 82                          ? "spline"
                           : move.command == 177                         ? "jump"
                           : move.command == 0                           ? "complex item"
                                               : "command " + std::to_string(move.command);
  return (move.number > 0 ? "item " + std::to_string(move.number) : move.place) + " (" + what + ")";
}

FlownParts flown_parts(const formats::MissionFile& plan, const World& world) {
  return plan.items.empty() ? FlownParts{plan, {}, {}} : Splitter(plan, world).parts();
}
}  // namespace altiplan::host
