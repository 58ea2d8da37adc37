// SPDX-License-Identifier: Apache-2.0
#include "colony.hpp"

#include <algorithm>
#include <thread>
#include <vector>

#include "host/config/config.hpp"
#include "host/config/yaml.hpp"
#include "host/mission/mission.hpp"

namespace altiplan::bench {
namespace {

void set(Value& map, const std::string& key, const std::string& yaml) {
  const Value value = host::parse_override(yaml, key);
  if (Value* old = map.find(key)) {
    *old = value;
  } else {
    map.entries.push_back({key, {}, value});
  }
}

std::shared_ptr<const Planner> make(host::Registry& registry, const Setting& setting,
                                    int iterations) {
  Chosen colony = chosen(registry, "planner", setting.planner);
  set(colony.parameters, "iterations", std::to_string(iterations));
  if (setting.cell_m > 0) {
    const std::string edge = std::to_string(setting.cell_m);
    set(colony.parameters, "cell_m", "[" + edge + ", " + edge + ", " + edge + "]");
  }
  return colony.entry.planner(&colony.parameters);
}

double counted(const PlanResult& result, const std::string& what, const std::string& planner) {
  if (std::none_of(result.counters.begin(), result.counters.end(),
                   [&](const Counter& counter) { return counter.name == what; })) {
    throw Error(planner + ": has no counter '" + what + "'");
  }
  return counter(result, what);
}
}  // namespace

Request problem_of(const std::filesystem::path& scenario) {
  return host::build_mission(host::load_scenario(scenario, {}), 1).request;
}

Colony::Colony(host::Registry& registry, const Setting& setting)
    : name_(setting.planner),
      all_(make(registry, setting, setting.iterations)),
      single_(make(registry, setting, 1)) {}

Run Colony::run(const Planner& planner, const Request& request) const {
  const Time began = Time::now();
  const PlanResult result = planner.plan(request);
  Run run;
  run.time = Time::now().since(began);
  run.steps = counted(result, "expanded", name_);
  run.alive = counted(result, "alive", name_);
  run.length = judged_length(result, request, name_);
  return run;
}

Time Colony::at_once(const Request& request, int plans) const {
  const Time began = Time::now();
  {
    std::vector<std::jthread> threads;
    for (int n = 0; n < plans; ++n) {
      threads.emplace_back([&] { all_->plan(request); });
    }
  }
  return Time::now().since(began);
}

Pass plan_once(host::Registry& registry, const Setting& setting, Request request, int seed) {
  const Colony colony(registry, setting);
  request.random = RandomStream(std::uint64_t(seed));
  Pass pass;
  pass.first = colony.all(request);
  pass.again = colony.all(request);
  colony.single(request);  // allocates its own memory before timing
  pass.single = colony.single(request);
  return pass;
}
}  // namespace altiplan::bench
