// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <iostream>

#include "altiplan/formats/input_file.hpp"
#include "commands.hpp"
#include "host/base/utf8.hpp"
#include "host/first_route/file_info.hpp"
#include "host/gate/plan_report.hpp"
#include "host/import_export/route_format.hpp"
#include "host/mission/mission.hpp"
#include "host/result/result_json.hpp"
#include "plan_world.hpp"

namespace altiplan::cli {
namespace {

struct InfoArguments {
  std::vector<std::string> files;
  PlanCheck mission;  ///< the terrain over which missions are flown
  bool json = false;
  host::Overrides overrides;
};

/// What the file holds and, of a mission, how it is flown.
host::FileInfo facts_of(const std::string& file, const InfoArguments& arguments,
                        host::Registry& registry) {
  host::FileInfo info = host::info_of(file, arguments.mission.crs, registry);
  if (info.kind == "mission") {
    const formats::MissionFile mission = host::read_mission_file(file, formats::read_file(file));
    std::optional<host::Mission> world;
    if (!arguments.mission.terrain.empty() && !mission.items.empty()) {
      PlanCheck plan = arguments.mission;
      plan.plan = file;
      world = host::build_mission(world_of(plan, mission, arguments.overrides), 1);
    }
    const std::vector<std::string> flown =
        host::flight_facts(mission, world ? &*world : nullptr, {});
    info.facts.insert(info.facts.end(), flown.begin(), flown.end());
  }
  return info;
}

void print(const std::string& file, const host::FileInfo& info) {
  std::printf("%s: %s\n", host::printable(file).c_str(), info.kind.c_str());
  for (const std::string& fact : info.facts) {
    std::printf("  %s\n", fact.c_str());
  }
  if (!info.scenario.empty()) {
    std::printf("  in a scenario:\n");
  }
  for (const std::string& line : info.scenario) {
    std::printf("    %s\n", line.c_str());
  }
}

int info_of(const InfoArguments& arguments) {
  host::Registry registry(host::Registry::search_path(arguments.overrides.plugin_path));
  int code = kDone;
  host::Json all = host::Json::array();
  for (const std::string& file : arguments.files) {
    try {
      const host::FileInfo info = facts_of(file, arguments, registry);
      if (arguments.json) {
        all.push_back({{"file", host::printable(file)},
                       {"kind", info.kind},
                       {"facts", info.facts},
                       {"scenario", info.scenario}});
      } else {
        print(file, info);
      }
    } catch (const PluginError&) {
      throw;
    } catch (const Error& error) {  // the files that follow may be good
      std::cerr << "altiplan: " << host::printable(error.what(), true) << '\n';
      code = kBadFile;
    }
  }
  if (arguments.json) {
    std::cout << host::file_text(all);
  }
  return code;
}
}  // namespace

void add_info(App& app, Action& action) {
  auto [command, arguments] = add_command<InfoArguments>(
      app, action, "info", "what a file holds: elevation model, zones, map, mission", info_of);
  command.add_option("files", arguments.files, "files")->required();
  command
      .add_option("--terrain FILE", arguments.mission.terrain,
                  "elevation model over which missions are flown, or a folder of tiles; repeatable")
      ->take_all()
      ->one_at_a_time();
  command.add_option("--crs EPSG:CODE", arguments.mission.crs,
                     "coordinate system of a model that names none");
  command.add_flag("--json", arguments.json, "print as JSON");
  add_plugin_path(command, arguments.overrides);
  set_example(command, "altiplan info configs/data/jacksboro_fault.tif");
}
}  // namespace altiplan::cli
