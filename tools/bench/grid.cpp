// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <optional>

#include "altiplan/check.hpp"
#include "altiplan/route.hpp"
#include "host/config/config.hpp"
#include "host/import_export/grid_scenarios.hpp"
#include "measuring.hpp"
#include "subcommand.hpp"

namespace altiplan::bench {
namespace {

struct Arguments {
  std::string map;
  std::string scenarios;
  std::string planner = "astar";
  std::optional<std::string> corner;
  std::vector<std::string> with;  ///< further parameters of the planner, KEY=VALUE
  std::size_t limit = ~std::size_t{0};
  int repeat = 1;     ///< number of plans per scenario; its time is the median
  bool each = false;  ///< a line for each scenario on stdout
};

Value map_of(const std::vector<std::pair<std::string, std::string>>& texts) {
  Value map;
  map.kind = Value::Kind::map;
  for (const auto& [key, text] : texts) {
    Value value;
    value.text = text;
    map.entries.push_back({key, {}, std::move(value)});
  }
  return map;
}

/// The map as a world of one layer.
World load_map(host::Registry& registry, const std::string& file) {
  const std::filesystem::path path = std::filesystem::absolute(file);
  const bool is_3d = path.extension() == ".3dmap";
  if (!is_3d && path.extension() != ".map") {
    throw Error(file + ": expected a .map or a .3dmap file");
  }
  const World empty;
  Site site;
  site.before = &empty;
  const Value parameters = map_of({{"file", path.string()}});
  const char* plugin_name = is_3d ? "voxel_map" : "grid_map";
  return empty.with(
      {"map", plugin_name,
       host::plugin(registry, "environment", plugin_name).environment(&parameters, site)});
}

/// The planner with the corner rule of the published lengths, if it has such a parameter.
std::unique_ptr<Planner> make_planner(host::Registry& registry, const Arguments& arguments) {
  const PluginEntry& entry = host::plugin(registry, "planner", arguments.planner);
  const std::vector<BoundField> fields = entry.describe(nullptr, "").fields;
  const bool has_corner = std::any_of(fields.begin(), fields.end(), [](const BoundField& field) {
    return field.spec.name == "corner";
  });
  std::vector<std::pair<std::string, std::string>> texts;
  if (has_corner || arguments.corner) {
    texts.emplace_back("corner", arguments.corner.value_or("free_box"));
  }
  for (const std::string& text : arguments.with) {
    const std::size_t equals = text.find('=');
    if (equals == text.npos || equals == 0) {
      throw Error("--with: expected KEY=VALUE, found " + excerpt(text));
    }
    texts.emplace_back(text.substr(0, equals), text.substr(equals + 1));
  }
  const Value parameters = map_of(texts);
  return entry.planner(&parameters);
}

/// The results of the scenarios.
struct Tally {
  std::size_t matched = 0;
  std::size_t unsolved = 0;
  std::size_t unsound = 0;
  std::string first_unsolved;  ///< the planner's message
  double worst_error = 0;
  std::vector<double> times_us;
  double expanded = 0;
  std::size_t bytes = 0;
};

Request request_for(std::shared_ptr<const World> world, const GridSpec& spec, bool is_3d) {
  Request request;
  request.world = std::move(world);
  request.volume = spec.box();
  if (!is_3d) {
    request.level_m = spec.centre({0, 0, 0}).z();
  }
  return request;
}

PlanResult timed_plan(const Planner& planner, const Request& request, int repeat,
                      double& median_us) {
  PlanResult result;
  std::vector<double> times_us;
  for (int n = 0; n < repeat; ++n) {
    const double began = wall_s();
    result = planner.plan(request);
    times_us.push_back(1e6 * (wall_s() - began));
  }
  median_us = median(times_us);
  return result;
}

void run_scenario(const Planner& planner, Request& request, const host::GridScenario& scenario,
                  const Arguments& arguments, Tally& tally) {
  const Environment& map = *request.world->layers().front().environment;
  request.start.position = *map.cell_centre(scenario.start);
  request.goal = {*map.cell_centre(scenario.goal), 0};
  double time_us = 0;
  const PlanResult result = timed_plan(planner, request, arguments.repeat, time_us);
  const double expanded = counter(result, "expanded");
  const bool solved = result.status == PlanStatus::solved;
  if (arguments.each) {
    std::printf("%zu %d %.9g %.0f %.3f\n", tally.times_us.size(), int(solved),
                solved ? length(result.route) : 0.0, expanded, time_us);
  }
  tally.times_us.push_back(time_us);
  tally.expanded += expanded;
  if (!solved) {
    if (++tally.unsolved == 1) {
      tally.first_unsolved = "line " + std::to_string(scenario.line) + ": " + result.message;
    }
    return;
  }
  const double error = std::abs(length(result.route) - scenario.length);
  tally.worst_error = std::max(tally.worst_error, error);
  tally.matched += error <= (scenario.decimals <= 2 ? 0.006 : 1e-3);
  tally.unsound += !check(result.route, request).ok();
}

/// Plans every scenario on the map, loaded once, and compares the lengths with the published ones.
Json plan_scenarios(host::Registry& registry, const Arguments& arguments) {
  const std::unique_ptr<Planner> planner = make_planner(registry, arguments);
  const auto world = std::make_shared<const World>(load_map(registry, arguments.map));
  const GridSpec spec = world->native_grid().value();
  const host::GridScenarios scenarios =
      host::read_grid_scenarios(arguments.scenarios, spec.counts, arguments.limit);
  if (scenarios.is_3d != (spec.counts[2] > 1)) {
    throw Error(arguments.scenarios + ": a .scen file goes with a .map, a .3dscen with a .3dmap");
  }
  Request request = request_for(world, spec, scenarios.is_3d);
  Tally tally;
  const std::size_t before = allocated();
  for (const host::GridScenario& scenario : scenarios.list) {
    run_scenario(*planner, request, scenario, arguments, tally);
    // The planner's pool keeps its buffers at the size that they reached during the plan.
    tally.bytes = std::max(tally.bytes, allocated() - std::min(before, allocated()));
  }
  const double total_us = std::accumulate(tally.times_us.begin(), tally.times_us.end(), 0.0);
  Json json;
  json["map"] = arguments.map;
  json["planner"] = arguments.planner;
  json["scenarios"] = scenarios.list.size();
  json["matched"] = tally.matched;
  json["unsolved"] = tally.unsolved;
  if (tally.unsolved > 0) {
    json["first_unsolved"] = tally.first_unsolved;
  }
  json["unsound"] = tally.unsound;
  json["worst_error"] = tally.worst_error;
  json["median_us"] = median(tally.times_us);
  json["p99_us"] = quantile(tally.times_us, 0.99);
  json["expansions_per_s"] = tally.expanded / (total_us * 1e-6);
  json["bytes_per_cell"] = double(tally.bytes) / double(spec.cell_count());
  return json;
}
}  // namespace

void add_grid(Subcommands& all) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App& command =
      all.add("grid", "plan a grid map's scenarios and compare with the published lengths",
              [=](const Given& given) { return plan_scenarios(*given.registry, *arguments); });
  command.add_option("map", arguments->map, "MovingAI .map or Warframe .3dmap file")->required();
  command.add_option("scenarios", arguments->scenarios, "the map's .scen or .3dscen file")
      ->required();
  command.add_option("--planner", arguments->planner, "planner plugin (default astar)")
      ->type_name("NAME");
  command
      .add_option("--corner", arguments->corner,
                  "the planner's rule for diagonal steps (default free_box, that of the published "
                  "lengths)")
      ->type_name("RULE");
  command
      .add_option("--with", arguments->with,
                  "further parameter of the planner, e.g. heuristic=euclidean; repeatable")
      ->type_name("KEY=VALUE");
  command
      .add_option("--repeat", arguments->repeat,
                  "number of plans per scenario; its time is their median (default 1)")
      ->type_name("N")
      ->check(CLI::Range(1, 1000));
  command.add_flag("--each", arguments->each,
                   "first print a line for each scenario: index from 0, solved (0 or 1), length "
                   "(cells), cells expanded, time (us)");
  command.add_option("--limit", arguments->limit, "plan only the first N scenarios")
      ->type_name("N")
      ->check(CLI::PositiveNumber);
  command.footer("Example:\n  altiplan-bench grid arena.map arena.map.scen --limit 100");
}
}  // namespace altiplan::bench
