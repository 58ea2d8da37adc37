// SPDX-License-Identifier: Apache-2.0
// The conformance suites over every plugin of the build, found as the host finds them. A plugin
// whose defaults are not enough, or that deserves several sets of parameters, has a list of them in
// its folder: conformance.yaml (docs/conformance.md).
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <new>

#include "altiplan/conformance_gtest.hpp"
#include "altiplan/error.hpp"
#include "altiplan/world.hpp"
#include "host/config/yaml.hpp"
#include "host/registry/registry.hpp"

namespace {
thread_local std::uint64_t allocations = 0;
}  // namespace

void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) {
    return memory;
  }
  throw std::bad_alloc();
}
// Else a sanitizer's own would meet the delete below.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  return std::malloc(size);
}
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"  // where only one of the two is inlined
#endif
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace altiplan::conformance {
namespace {
namespace fs = std::filesystem;

struct VolumeParams {
  Vec3 min_m{0, 0, 0};
  Vec3 max_m{0, 0, 0};
  void describe(Fields& f) {
    f("min_m", min_m).required().doc("lower corner");
    f("max_m", max_m).required().doc("upper corner");
    f.check((min_m.array() < max_m.array()).all(), "min_m must be below max_m");
  }
};

/// One entry of a conformance.yaml.
struct SetParams {
  Value with;
  std::optional<Value> tighter;
  double unit_m = Options{}.unit_m;
  std::int64_t iterations = std::int64_t(Options{}.iterations);
  std::optional<VolumeParams> volume;
  std::vector<Value> before;

  SetParams() { with.kind = Value::Kind::map; }
  void describe(Fields& f) {
    f("with", with).doc("the plugin's parameters");
    f("tighter", tighter).doc("of a constraint: stricter ones");
    f("unit_m", unit_m).greater_than(0).doc("what a planner or smoother resolves well");
    f("iterations", iterations).at_least(1).doc("what one plan may use");
    f("volume", volume).doc("where an environment is looked at");
    f("before", before).doc("layers before an environment, as in a scenario");
  }
};

host::Registry& registry() {
  static host::Registry all({fs::path(ALTIPLAN_BUILD_DIR) / "lib/altiplan/plugins",
                             fs::path(ALTIPLAN_BUILD_DIR) / "tests/mock_plugins"});
  return all;
}

std::vector<SetParams> sets_of(const std::string& kind, const std::string& name) {
  const fs::path file =
      fs::path(ALTIPLAN_SOURCE_DIR) / "plugins" / kind / name / "conformance.yaml";
  if (!fs::exists(file)) {
    return {SetParams()};
  }
  const Value list = host::load_yaml(file);
  std::vector<SetParams> sets(list.items.size());
  for (std::size_t i = 0; i < sets.size(); ++i) {
    ParamReport report = bind(sets[i], &list.items[i], std::to_string(i));
    if (!report.problems.empty()) {
      throw ConfigError(std::move(report.problems));
    }
  }
  return sets;
}

std::shared_ptr<const World> world_before(const std::vector<Value>& layers) {
  World world;
  for (const Value& layer : layers) {
    const std::string& plugin = layer.entries.at(0).key;
    Site site;
    site.before = &world;
    site.frame = world.frame();
    const std::shared_ptr<const Environment> made =
        registry().get("environment", plugin).environment(&layer.entries[0].value, site);
    world = world.with({plugin, plugin, made, true});
    if (const auto frame = made->frame()) {
      world = world.with_frame(*frame);
    }
  }
  return std::make_shared<const World>(std::move(world));
}

void register_set(const PluginEntry& entry, const SetParams& set, const std::string& suffix) {
  Setup setup;
  setup.with = &set.with;
  setup.tighter = set.tighter ? &*set.tighter : nullptr;
  setup.before = world_before(set.before);
  setup.options.unit_m = set.unit_m;
  setup.options.iterations = std::uint64_t(set.iterations);
  if (set.volume) {
    setup.options.volume = Box{set.volume->min_m, set.volume->max_m};
  }
  setup.options.allocations = [] { return allocations; };
  setup.options.rounds = ALTIPLAN_CONFORMANCE_ROUNDS;
  const std::string suite = std::string(entry.kind) + "/" + entry.name + suffix;
  register_cases(suite, cases_of(entry, setup));
  setup.options.seed = 2;
  setup.options.rounds = 500;
  register_cases("Nightly/" + suite, cases_of(entry, setup));
}

/// Whether this build has the layers that the set builds upon; GDAL, say, may be off.
bool can_be_built(const SetParams& set) {
  const std::vector<std::string> names = registry().names("environment");
  return std::all_of(set.before.begin(), set.before.end(), [&](const Value& layer) {
    return std::find(names.begin(), names.end(), layer.entries.at(0).key) != names.end();
  });
}

/// A library that cannot be loaded fails, as a case of its own.
void register_refusal(const host::Library& library) {
  const Finding finding{"Plugin: loads", library.file.string() + ": " + library.refused};
  register_cases("refused/" + library.file.stem().string(),
                 {{"loads", [finding] { return std::vector<Finding>{finding}; }}});
}

void register_all() {
  for (const host::Library& library : registry().libraries()) {
    if (!library.refused.empty()) {
      register_refusal(library);
      continue;
    }
    for (const Manifest& manifest : library.plugins) {
      const PluginEntry& entry = registry().get(manifest.kind, manifest.name);
      register_cases(std::string(entry.kind) + "/" + entry.name, plugin_cases(entry));
      const std::vector<SetParams> sets = sets_of(entry.kind, entry.name);
      for (std::size_t i = 0; i < sets.size(); ++i) {
        const std::string suffix = sets.size() > 1 ? "/" + std::to_string(i) : "";
        if (can_be_built(sets[i])) {
          register_set(entry, sets[i], suffix);
        } else {
          std::printf("%s/%s%s left out: this build lacks a layer before it\n", entry.kind,
                      entry.name, suffix.c_str());
        }
      }
    }
  }
}
}  // namespace
}  // namespace altiplan::conformance

int main(int argc, char** argv) {
  try {
    altiplan::conformance::register_all();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  ::testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
