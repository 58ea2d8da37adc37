// SPDX-License-Identifier: Apache-2.0
#include "sets.hpp"

#include "altiplan/error.hpp"
#include "altiplan/world.hpp"
#include "host/config/yaml.hpp"

namespace altiplan::cli {
namespace {

std::shared_ptr<const World> world_of(const std::vector<Value>& layers, host::Registry& registry) {
  World world;
  for (const Value& layer : layers) {
    const std::string& plugin = layer.entries.at(0).key;
    Site site;
    site.before = &world;
    site.frame = world.frame();
    const std::shared_ptr<const Environment> environment =
        registry.get("environment", plugin).environment(&layer.entries[0].value, site);
    world = world.with({plugin, plugin, environment, true});
    if (const auto& frame = environment->info().frame) {
      world = world.with_frame(*frame);
    }
  }
  return std::make_shared<const World>(std::move(world));
}
}  // namespace

void VolumeParams::describe(Fields& f) {
  f("min_m", min_m).required().doc("lower corner");
  f("max_m", max_m).required().doc("upper corner");
  f.check((min_m.array() < max_m.array()).all(), "min_m must be below max_m");
}

void ParameterSet::describe(Fields& f) {
  f("plugin", plugin).doc("plugin that the set is for, in a library of several");
  f("with", with).doc("the plugin's parameters");
  f("tighter", tighter).doc("stricter parameters of a constraint; default: those of with");
  f("unit_m", unit_m).greater_than(0).doc("length that a planner or smoother resolves well");
  f("iterations", iterations).at_least(1).doc("maximum number of iterations of one plan");
  f("volume", volume).doc("volume in which an environment, or legs of a constraint, are sampled");
  f("before", before).doc("layers before an environment, as in a scenario");
}

void ParameterSet::inherit() {
  if (!tighter || tighter->kind != Value::Kind::map) {
    return;
  }
  for (const Value::Entry& entry : with.entries) {
    if (tighter->find(entry.key) == nullptr) {
      tighter->entries.push_back(entry);
    }
  }
}

std::string ParameterSet::missing_layer(host::Registry& registry) const {
  for (const Value& layer : before) {
    if (registry.offering("environment", layer.entries.at(0).key) == nullptr) {
      return layer.entries[0].key;
    }
  }
  return "";
}

conformance::Setup ParameterSet::setup(host::Registry& registry) const {
  conformance::Setup setup;
  setup.with = &with;
  setup.tighter = tighter ? &*tighter : nullptr;
  setup.before = world_of(before, registry);
  setup.options.unit_m = unit_m;
  setup.options.iterations = std::uint64_t(iterations);
  if (volume) {
    setup.options.volume = Box{volume->min_m, volume->max_m};
  }
  return setup;
}

std::vector<ParameterSet> parameter_sets(const std::filesystem::path& file) {
  const Value list = host::load_yaml(file);
  std::vector<Problem> problems;
  if (list.kind != Value::Kind::list || list.items.empty()) {
    problems.push_back({list.where, "",
                        "expected a list of parameter sets, found " +
                            (list.kind == Value::Kind::list ? "none" : list.what())});
  }
  std::vector<ParameterSet> sets(list.items.size());
  for (std::size_t i = 0; i < sets.size(); ++i) {
    const ParamReport report = bind(sets[i], &list.items[i], std::to_string(i));
    problems.insert(problems.end(), report.problems.begin(), report.problems.end());
    sets[i].inherit();
    for (const Value& layer : sets[i].before) {
      if (layer.kind != Value::Kind::map || layer.entries.size() != 1) {
        problems.push_back({layer.where, std::to_string(i) + ".before",
                            "expected a layer as in a scenario, found " + layer.what()});
      }
    }
  }
  if (!problems.empty()) {
    throw ConfigError(std::move(problems));
  }
  return sets;
}
}  // namespace altiplan::cli
