// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace altiplan::host {

/// A scenario of a published set, as keys of a scenario file over the texts of their values.
struct SetScenario {
  std::string label;  ///< "line=17", "world=12": where it is in the set
  std::vector<std::pair<std::string, std::string>> set;
};

/// The scenarios of a set as published, each with its ends and, as `reference`, the length of its
/// best route. Of MovingAI a .scen, of Warframe a .3dscen file, beside the map that its name begins
/// with (arena.map.scen: arena.map), whose layer is the scenario's first; N. Sturtevant,
/// doi:10.1109/TCIAIG.2012.2197681. Of BARN the folder of world_0.world and the following, with the
/// lengths of path_files/path_0.npy as its challenge measures them, from (-2.25, 3) to (-2.25, 13)
/// (m); doi:10.1109/SSRR50563.2020.9292572. Of the MOEA benchmark (D. Darlan et al., 2025) a
/// MAT-file, or the folder of terrainStruct_….mat, whose ends are raised to the ground. Throws
/// Error with the file.
std::vector<SetScenario> read_scenario_set(const std::filesystem::path& set);
}  // namespace altiplan::host
