// SPDX-License-Identifier: Apache-2.0
#include "host/import_export/scenario_set.hpp"

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>

#include "altiplan/error.hpp"
#include "altiplan/formats/input_file.hpp"
#include "altiplan/formats/mat_file.hpp"
#include "host/base/json.hpp"
#include "host/import_export/grid_scenarios.hpp"

namespace altiplan::host {
namespace fs = std::filesystem;
namespace {

using Point2 = std::array<double, 2>;

constexpr Point2 kBarnStart{-2.25, 3};  // m
constexpr Point2 kBarnGoal{-2.25, 13};

std::string cell_text(const std::array<double, 3>& cell, bool is_3d) {
  Json json{std::int64_t(cell[0]), std::int64_t(cell[1])};
  if (is_3d) {
    json.push_back(std::int64_t(cell[2]));
  }
  return exact_json_text(json);
}

std::vector<SetScenario> read_grid_set(const fs::path& file) {
  fs::path map = file;
  map.replace_extension();  // arena.map.scen: arena.map
  const bool is_3d = file.extension() == ".3dscen";
  if (map.extension() != (is_3d ? ".3dmap" : ".map")) {
    throw Error(file.string() + ": expected a name such as " +
                (is_3d ? "A1.3dmap.3dscen" : "arena.map.scen") + ", beside its map");
  }
  const GridScenarios all = read_grid_scenarios(file, grid_counts(map), std::size_t(-1));
  const std::string layer = is_3d ? "voxel_map" : "grid_map";
  std::vector<SetScenario> set;
  for (const GridScenario& scenario : all.list) {
    set.push_back({"line=" + std::to_string(scenario.line),
                   {{"environment.0." + layer + ".file", exact_json_text(map.string())},
                    {"start.at_cell", cell_text(scenario.start, is_3d)},
                    {"goal.at_cell", cell_text(scenario.goal, is_3d)},
                    {"reference", exact_json_text(scenario.length)}}});
  }
  return set;
}

[[noreturn]] void refuse(const fs::path& file, const std::string& why) {
  throw Error(file.string() + ": " + why);
}

/// The cells of a path, rows of two whole numbers in NumPy's format.
std::vector<std::array<std::int64_t, 2>> read_cells(const fs::path& file) {
  const std::string text = formats::read_file(file.string());
  static_assert(std::endian::native == std::endian::little);
  constexpr std::string_view kMagic = "\x93NUMPY\x01";
  if (!text.starts_with(kMagic) || text.size() < 10) {
    refuse(file, "expected an array of NumPy's, format 1");
  }
  const std::size_t length = std::uint8_t(text[8]) + 256 * std::size_t(std::uint8_t(text[9]));
  const std::string header = text.substr(10, length);
  const std::size_t at = header.find("'shape': (");
  std::size_t rows = 0;
  const char* from = header.data() + (at == header.npos ? header.size() : at + 10);
  const auto [end, error] = std::from_chars(from, header.data() + header.size(), rows);
  if (error != std::errc() || !std::string_view(end).starts_with(", 2)") ||
      header.find("'descr': '<i8'") == header.npos ||
      header.find("'fortran_order': False") == header.npos) {
    refuse(file, "expected rows of two 64-bit integers, found " + excerpt(header));
  }
  if (rows == 0 || rows > text.size() || text.size() != 10 + length + 16 * rows) {
    refuse(file, "expected " + std::to_string(rows) + " rows, and at least one, found " +
                     std::to_string(text.size()) + " bytes");
  }
  std::vector<std::array<std::int64_t, 2>> cells(rows);
  std::memcpy(cells.data(), text.data() + 10 + length, 16 * rows);
  return cells;
}

/// The length of the path as the challenge measures it: from its start over the cells to its goal.
double barn_length(const fs::path& file) {
  constexpr double kCell = 0.15;
  double sum = 0;
  Point2 last = kBarnStart;
  const auto go_to = [&](const Point2& next) {
    sum += std::hypot(next[0] - last[0], next[1] - last[1]);
    last = next;
  };
  for (const auto& cell : read_cells(file)) {
    go_to({double(cell[0]) * kCell - 4.575, double(cell[1]) * kCell + 5.075});
  }
  go_to(kBarnGoal);
  return sum;
}

std::vector<SetScenario> read_barn(const fs::path& folder) {
  std::map<int, fs::path> worlds;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string stem = entry.path().stem().string();
    int number = 0;
    if (entry.path().extension() == ".world" && stem.starts_with("world_") &&
        std::from_chars(stem.data() + 6, stem.data() + stem.size(), number).ptr ==
            stem.data() + stem.size()) {
      worlds[number] = entry.path();
    }
  }
  if (worlds.empty()) {
    throw Error(folder.string() +
                ": expected worlds of BARN (world_0.world …) or terrainStruct_….mat, found none");
  }
  std::vector<SetScenario> set;
  for (const auto& [number, world] : worlds) {
    const std::string name = std::to_string(number);
    set.push_back({"world=" + name,
                   {{"environment.0.gazebo.file", exact_json_text(world.string())},
                    {"start.at_m", exact_json_text(kBarnStart)},
                    {"goal.at_m", exact_json_text(kBarnGoal)}}});
    if (const fs::path paths = folder / "path_files"; fs::is_directory(paths)) {
      const double length = barn_length(paths / ("path_" + name + ".npy"));
      set.back().set.emplace_back("reference", exact_json_text(length));
    }
  }
  return set;
}

constexpr std::string_view kMatPrefix = "terrainStruct_";

/// A scenario of the MOEA benchmark. Its program puts the start on the ground, and an end below the
/// ground cannot be reached.
SetScenario read_mat(const fs::path& file) {
  const auto fields = formats::read_mat_structure(file.string(), "terrainStruct");
  const auto numbers = [&](const char* name, std::size_t count) -> const std::vector<double>& {
    const auto found = fields.find(name);
    if (found == fields.end() || found->second.values.size() < count) {
      refuse(file, std::string("expected numbers '") + name + "' in terrainStruct");
    }
    return found->second.values;
  };
  const std::vector<double>& x = numbers("X", 2);
  const std::vector<double>& y = numbers("Y", 2);
  const std::vector<double>& heights = numbers("H", x.size() * y.size());
  const auto end = [&](const char* name) {
    std::vector<double> at = numbers(name, 3);
    const double column = (at[0] - x[0]) / (x[1] - x[0]);
    const double row = (at[1] - y[0]) / (y[1] - y[0]);
    if (!(column >= 0 && column < double(x.size()) && row >= 0 && row < double(y.size())) ||
        column != std::floor(column) || row != std::floor(row)) {
      refuse(file, std::string("'") + name + "' is not over a post");
    }
    const float ground = float(heights[std::size_t(column) * y.size() + std::size_t(row)]);
    at[2] = std::max(at[2], double(ground));
    return exact_json_text(Json{at[0], at[1], at[2]});
  };
  const std::string stem = file.stem().string();
  return {"map=" + (stem.starts_with(kMatPrefix) ? stem.substr(kMatPrefix.size()) : stem),
          {{"environment.0.mat_terrain.file", exact_json_text(file.string())},
           {"start.at_m", end("start")},
           {"goal.at_m", end("end")}}};
}

/// By name; none if the folder has no such files.
std::vector<SetScenario> read_mats(const fs::path& folder) {
  std::map<std::string, SetScenario> set;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(kMatPrefix) && name.ends_with(".mat")) {
      set.emplace(name, read_mat(entry.path()));
    }
  }
  std::vector<SetScenario> all;
  for (auto& [name, scenario] : set) {
    all.push_back(std::move(scenario));
  }
  return all;
}
}  // namespace

std::vector<SetScenario> read_scenario_set(const fs::path& set) {
  if (fs::is_directory(set)) {
    std::vector<SetScenario> mats = read_mats(set);
    return mats.empty() ? read_barn(set) : mats;
  }
  if (set.extension() == ".mat") {
    return {read_mat(set)};
  }
  if (set.extension() == ".scen" || set.extension() == ".3dscen") {
    return read_grid_set(set);
  }
  throw Error(set.string() +
              ": expected a .scen, .3dscen or .mat file, or the folder of BARN's worlds or of "
              "terrainStruct_….mat");
}
}  // namespace altiplan::host
