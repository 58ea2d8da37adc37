// SPDX-License-Identifier: Apache-2.0
// Makes the maps on which searches are compared where they are hard.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>

#include "altiplan/error.hpp"
#include "detours/detour_maps.hpp"
#include "host/base/output_file.hpp"
#include "subcommand.hpp"

namespace altiplan::bench {
namespace {

struct Arguments {
  DetourKind kind = DetourKind::walls;
  std::string out;
  std::vector<int> cells = {80, 80, 100};
  std::uint64_t seed = 1;
  std::size_t queries = 20;
};

Json make(const Arguments& arguments) {
  const VoxelGrid map = detour_map(
      arguments.kind, {arguments.cells[0], arguments.cells[1], arguments.cells[2]}, arguments.seed);
  const std::vector<DetourQuery> queries =
      detour_queries(arguments.kind, map, arguments.queries, arguments.seed);
  const std::filesystem::path map_file = arguments.out + ".3dmap";
  const std::filesystem::path scenarios = arguments.out + ".3dmap.3dscen";
  host::write_file(map_file, voxel_map_text(map));
  host::write_file(scenarios, voxel_scenarios_text(map_file.filename().string(), queries));
  double sum = 0;
  double min_detour = kInfinity;
  for (const DetourQuery& query : queries) {
    sum += std::log(query.length / query.straight);
    min_detour = std::min(min_detour, query.length / query.straight);
  }
  return {{"map", map_file.string()},
          {"scenarios", scenarios.string()},
          {"blocked", double(map.blocked_count()) / double(map.spec().cell_count())},
          {"detour", std::exp(sum / double(queries.size()))},
          {"least_detour", min_detour}};
}
}  // namespace

void add_detours(Subcommands& all) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App& command =
      all.add("detours", "Writes a voxel map that forces detours, and ways through it with lengths",
              [arguments](const Given&) { return make(*arguments); });
  const std::map<std::string, DetourKind> kinds = {{"walls", DetourKind::walls},
                                                   {"canyons", DetourKind::canyons},
                                                   {"towers", DetourKind::towers}};
  command.add_option("kind", arguments->kind, "walls with gaps, canyons, or towers with low ends")
      ->required()
      ->transform(CLI::CheckedTransformer(kinds));
  command.add_option("-o,--out", arguments->out, "writes NAME.3dmap and NAME.3dmap.3dscen")
      ->type_name("NAME")
      ->required();
  command.add_option("--cells", arguments->cells, "cells along x, y and z")
      ->delimiter(',')
      ->expected(3)
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  command.add_option("--seed", arguments->seed, "of the map and the ways")->capture_default_str();
  command.add_option("--queries", arguments->queries, "ways, each with its shortest length")
      ->check(CLI::Range(1, 100'000))
      ->capture_default_str();
}
}  // namespace altiplan::bench
