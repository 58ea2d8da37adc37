// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "altiplan/formats/mission_file.hpp"
#include "altiplan/leg.hpp"
#include "altiplan/world.hpp"

namespace altiplan::host {

/// A motion that is no leg of the route: a climb after take-off, or a descent to land.
struct Passage {
  std::string item;  ///< as ground stations name it
  bool is_climb = true;
  bool is_vertical = true;  ///< else that of an aeroplane, which may not go through the ground
  Vec3 foot{0, 0, 0};
  Vec3 top{0, 0, 0};
};

/// A motion that is judged as legs are, and has no waypoints of its own: from home to the first
/// item, and around a loiter.
struct Way {
  std::string item;
  std::string what;  ///< "the way from home"
  Leg leg;
};

/// A mission as it is flown.
struct FlownParts {
  formats::MissionFile route;  ///< without what is no leg between two items
  std::vector<Passage> passages;
  std::vector<Way> ways;
};

/// Throws Error naming the item whose place in the world is unknown.
FlownParts flown_parts(const formats::MissionFile& plan, const World& world);

/// "item 3 (waypoint)" as ground stations number it, "point 3" where the file numbers nothing.
std::string name_of_item(const formats::MissionItem& item);
std::string name_of_move(const formats::MissionMove& move);
}  // namespace altiplan::host
