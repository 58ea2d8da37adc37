// SPDX-License-Identifier: Apache-2.0
#include "first_run.hpp"

#include "altiplan/drawing.hpp"
#include "commands.hpp"
#include "host/base/output_file.hpp"
#include "host/base/unfinished.hpp"
#include "host/base/words.hpp"
#include "host/mission/mission.hpp"
#include "host/result/result_json.hpp"

namespace altiplan::cli {
namespace {

namespace fs = std::filesystem;

/// Names of the keep-out zones that the route enters, quoted.
std::vector<std::string> zones_entered(const World& world, const Polyline& route) {
  std::vector<std::string> names;
  for (const Layer& layer : world.layers()) {
    const std::optional<Drawing> drawing = layer.environment->drawing();
    if (layer.plugin != "zones" || !drawing) {
      continue;
    }
    for (const Drawn& zone : drawing->shapes) {
      const auto enters = [&](std::size_t n) {
        return leg_depth(zone.shape, route[n], route[std::min(n + 1, route.size() - 1)]) > 0;
      };
      for (std::size_t n = 0; zone.role == Drawn::Role::keep_out && n < route.size(); ++n) {
        if (enters(n)) {
          names.push_back("'" + (zone.name.empty() ? layer.id : zone.name) + "'");
          break;
        }
      }
    }
  }
  return names;
}

/// "'A', 'B' and 3 more"
std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t kMaxNames = 4;
  std::string text;
  for (std::size_t i = 0; i < std::min(kMaxNames, names.size()); ++i) {
    text += (i > 0 ? ", " : "") + names[i];
  }
  return names.size() > kMaxNames
             ? text + " and " + std::to_string(names.size() - kMaxNames) + " more"
             : text;
}

/// A route for a wish that asks for less; empty if there is none either.
Polyline route_of(const FailedTry& failed, const host::RouteWish& wish, Interrupt& interrupt) {
  const fs::path folder = failed.folder / "without";
  fs::create_directory(folder);
  const host::Unfinished removed([folder] {
    std::error_code ignored;
    fs::remove_all(folder, ignored);
  });
  const host::FirstRoute less(wish, failed.overrides.plugin_path);
  const host::RunResult result =
      run_in(folder, less.files(failed.attempt, folder), failed.overrides, interrupt);
  return result.accepted ? result.steps[*result.accepted].route.waypoints() : Polyline{};
}

std::string kilometres(const Polyline& route) {
  return host::with_digits(length(route) / 1000, 4) + " km";
}

/// Of points that lie in zones, which no route can leave.
std::vector<std::string> ends_in_zones(const host::Mission& mission) {
  std::vector<std::string> sentences;
  const auto add = [&](const std::string& what, const Vec3& at) {
    const std::vector<std::string> names = zones_entered(mission.truth, {at, at});
    if (!names.empty()) {
      sentences.push_back(what + " lies in " + listed(names));
    }
  };
  add("the start", mission.request.start.position);
  for (const Goal& via : mission.via) {
    add("a point to pass through", via.position);
  }
  add("the goal", mission.request.goal.position);
  return sentences;
}
}  // namespace

host::RunResult run_in(const fs::path& folder, const host::FirstFiles& files,
                       const host::Overrides& overrides, Interrupt& interrupt) {
  host::write_file(folder / "scenario.yaml", files.scenario);
  host::write_file(folder / "pipeline.yaml", files.pipeline);
  try {
    const host::Config config = host::load_config(folder / "pipeline.yaml", overrides);
    const std::string out = folder / "result.json";
    const HandOut hand_out = [&](std::FILE* to, const host::RunResult& result) {
      host::write_file(out, host::file_text(host::result_json(config, result)));
      std::fprintf(to, "no route: %s\n", result.message.c_str());
      return result.exit_code();
    };
    host::RunResult result = guarded_run(config, {}, {out, false}, interrupt, hand_out);
    host::write_file(out, host::file_text(host::result_json(config, result)));
    return result;
  } catch (const ConfigError& error) {
    throw Error(error.problems().front().message);
  }
}

std::vector<std::string> reasons_of(const FailedTry& failed, Interrupt& interrupt) {
  const host::Mission mission =
      host::build_mission(host::load_config(failed.folder / "pipeline.yaml", failed.overrides), 1);
  std::vector<std::string> reasons = ends_in_zones(mission);
  // The first thing to give up that a route is found without; empty where it is not tried.
  const auto found_without = [&](bool is_given, const auto& give_up) {
    if (!is_given || !reasons.empty() || interrupt.happened()) {
      return Polyline{};
    }
    host::RouteWish wish = failed.wish;
    give_up(wish);
    return route_of(failed, wish, interrupt);
  };
  Polyline route = found_without(failed.wish.planner.has_value(),
                                 [](host::RouteWish& wish) { wish.planner.reset(); });
  if (!route.empty()) {
    reasons.push_back("--planner " + *failed.wish.planner + ": without it a route of " +
                      kilometres(route) + " is found within the same limits");
  }
  route =
      found_without(!failed.wish.avoid.empty(), [](host::RouteWish& wish) { wish.avoid.clear(); });
  if (!route.empty()) {
    const std::vector<std::string> names = zones_entered(mission.truth, route);
    reasons.push_back("the zones close every way: without them a route of " + kilometres(route) +
                      " is found" + (names.empty() ? "" : ", which enters " + listed(names)));
  }
  route = found_without(failed.wish.max_above_ground_m.has_value(), [](host::RouteWish& wish) {
    wish.min_above_ground_m = host::heights_of(wish).min_m;
    wish.max_above_ground_m.reset();
  });
  if (!route.empty()) {
    reasons.push_back("--max-agl: without a limit above a route of " + kilometres(route) +
                      " is found: raise it");
  }
  return reasons;
}
}  // namespace altiplan::cli
