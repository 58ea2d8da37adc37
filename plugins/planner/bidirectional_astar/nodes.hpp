// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "altiplan/kit/lattice/move_rules.hpp"
#include "altiplan/kit/lattice/open_list.hpp"
#include "altiplan/kit/scratch.hpp"

namespace altiplan::bidirectional {

/// A node of one side: a cell, and the step that leads to it (forward) or away from it (backward)
/// on the path to that side's end.
struct Arrival {
  double g;       ///< cost of the path to that end
  double length;  ///< length of that path
  std::uint32_t cell;
  std::uint32_t from;    ///< the preceding arrival, toward that end
  std::uint32_t beside;  ///< another arrival of this side at the cell
  std::uint8_t along;    ///< that step; kHere: linked to the end
};

/// State of a cell on one side.
struct Reached {
  double g;              ///< of its cheapest arrival
  kit::StepMask taken;   ///< outgoing steps that need no further arrival
  std::uint32_t newest;  ///< of its arrivals
  std::uint8_t along;    ///< of the cheapest
  bool is_open;          ///< `taken` includes steps that no arrival may take
};

struct Node {
  std::array<Reached, 2> by;
  std::uint16_t stamp;
};

struct Memory {
  kit::NodeStore<Node> nodes;
  std::array<kit::OpenList, 2> open;
  std::array<std::vector<Arrival>, 2> arrivals;
};
}  // namespace altiplan::bidirectional
