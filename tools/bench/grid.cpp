// SPDX-License-Identifier: Apache-2.0
#include "grid.hpp"

#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "altiplan/check.hpp"
#include "altiplan/route.hpp"
#include "host/config/config.hpp"
#include "scenarios.hpp"

namespace altiplan::bench {
namespace {

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

/// The planner under the rule by which the printed lengths were made, where it has such a rule.
std::unique_ptr<Planner> make_planner(host::Registry& registry, const GridArguments& arguments) {
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

/// Bytes that the program holds from the C library.
std::size_t allocated() {
  const struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

/// What the scenarios came to.
struct Tally {
  std::size_t matched = 0;
  std::size_t unsolved = 0;
  std::size_t unsound = 0;
  std::string first_unsolved;  ///< what the planner said
  double worst_error = 0;
  std::vector<double> times_us;
  double expanded = 0;
  std::size_t bytes = 0;

  double quantile_us(double q) {
    std::sort(times_us.begin(), times_us.end());
    return times_us[std::size_t(std::ceil(q * double(times_us.size() - 1)))];
  }
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

PlanResult timed_plan(const Planner& planner, const Request& request, int repeat, double& median) {
  PlanResult result;
  std::vector<double> times_us;
  for (int n = 0; n < repeat; ++n) {
    const auto began = std::chrono::steady_clock::now();
    result = planner.plan(request);
    const auto took = std::chrono::steady_clock::now() - began;
    times_us.push_back(std::chrono::duration<double, std::micro>(took).count());
  }
  std::nth_element(times_us.begin(), times_us.begin() + repeat / 2, times_us.end());
  median = times_us[std::size_t(repeat / 2)];
  return result;
}

void run_scenario(const Planner& planner, Request& request, const GridScenario& scenario,
                  const GridArguments& arguments, Tally& tally) {
  const Environment& map = *request.world->layers().front().environment;
  request.start.position = *map.cell_centre(scenario.start);
  request.goal = {*map.cell_centre(scenario.goal), 0};
  double time_us = 0;
  const PlanResult result = timed_plan(planner, request, arguments.repeat, time_us);
  double expanded = 0;
  for (const Counter& counter : result.counters) {
    expanded += counter.name == "expanded" ? double(counter.value) : 0;
  }
  const bool solved = result.status == Status::solved;
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
}  // namespace

nlohmann::ordered_json run_grid(const GridArguments& arguments) {
  host::Registry registry(host::Registry::search_path(arguments.plugin_path));
  const std::unique_ptr<Planner> planner = make_planner(registry, arguments);
  const auto world = std::make_shared<const World>(load_map(registry, arguments.map));
  const GridSpec spec = world->native_grid().value();
  const GridScenarios scenarios = read_scenarios(arguments.scenarios, spec.counts, arguments.limit);
  if (scenarios.is_3d != (spec.counts[2] > 1)) {
    throw Error(arguments.scenarios + ": a .scen file goes with a .map, a .3dscen with a .3dmap");
  }
  Request request = request_for(world, spec, scenarios.is_3d);
  Tally tally;
  const std::size_t before = allocated();
  for (const GridScenario& scenario : scenarios.list) {
    run_scenario(*planner, request, scenario, arguments, tally);
    // The planner's pool keeps its buffers: after a plan they are as large as they were within.
    tally.bytes = std::max(tally.bytes, allocated() - std::min(before, allocated()));
  }
  const double total_us = std::accumulate(tally.times_us.begin(), tally.times_us.end(), 0.0);
  nlohmann::ordered_json json;
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
  json["median_us"] = tally.quantile_us(0.5);
  json["p99_us"] = tally.quantile_us(0.99);
  json["expansions_per_s"] = tally.expanded / (total_us * 1e-6);
  json["bytes_per_cell"] = double(tally.bytes) / double(spec.cell_count());
  return json;
}
}  // namespace altiplan::bench
