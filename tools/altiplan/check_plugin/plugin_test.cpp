// SPDX-License-Identifier: Apache-2.0
#include "plugin_test.hpp"

#include <algorithm>
#include <cstring>
#include <memory>

#include "altiplan/error.hpp"
#include "host/plugins/elf_file.hpp"
#include "host/scripts/script.hpp"

namespace altiplan::cli {
namespace {

using conformance::Case;
using conformance::Cases;

constexpr const char* kManifest = "Library: a manifest that matches this altiplan";
constexpr const char* kNamedAlike = "Library: named after its only plugin";
constexpr const char* kLoads = "Library: loads, with all symbols and all listed plugins";
constexpr const char* kSymbols = "Library: exports altiplan_plugins and nothing else";

/// The name that altiplan_add_plugin or `altiplan new --python` gives to a file of this plugin.
std::string file_of(const Manifest& plugin, bool is_script) {
  return is_script ? std::string(plugin.name) + ".py"
                   : std::string("libaltiplan_") + plugin.kind + "_" + plugin.name + ".so";
}

Outcome manifest_fits(const host::Library& library) {
  if (!library.refused.empty()) {
    return {{{kManifest, library.refused}}, "", false, ""};
  }
  const std::string file = library.file.filename().string();
  const bool is_script = host::is_script(library.file);
  if ((is_script || file.starts_with("libaltiplan_")) && library.plugins.size() == 1 &&
      file != file_of(library.plugins.front(), is_script)) {
    return {{{kNamedAlike, "expected " + file_of(library.plugins.front(), is_script) +
                               (is_script ? ", after the plugin's name"
                                          : ", after the kind and the name in ALTIPLAN_PLUGIN: "
                                            "name both alike in altiplan_add_plugin")}},
            "",
            false,
            ""};
  }
  return {};
}

Outcome exports_one_symbol(const host::Library& library) {
  Outcome outcome;
  try {
    for (const std::string& symbol : host::ElfFile(library.file).exported_symbols()) {
      if (symbol != kPluginListSymbol && outcome.findings.size() < 3) {
        outcome.findings.push_back({kSymbols, "it exports " + symbol});
      }
    }
  } catch (const host::ElfError& error) {
    outcome.findings.push_back({kSymbols, error.what()});
  }
  return outcome;
}

Outcome loads(const host::Library& library) {
  try {
    host::load_library(library);
  } catch (const PluginError& error) {
    return {{{kLoads, error.what()}}, "", false, ""};
  }
  return {};
}

/// An entry of the kind that creates nothing: the list of cases depends only on the kind.
PluginEntry stub_of(const Manifest& plugin) {
  PluginEntry entry{};
  const std::string_view kind = plugin.kind;
  if (kind == "environment") {
    entry.environment = [](const Value*, const Site&) { return std::unique_ptr<Environment>(); };
  } else if (kind == "constraint") {
    entry.constraint = [](const Value*, const Site&) { return std::unique_ptr<Constraint>(); };
  } else if (kind == "planner") {
    entry.planner = [](const Value*) { return std::unique_ptr<Planner>(); };
  } else if (kind == "local_planner") {
    entry.local_planner = [](const Value*) { return std::unique_ptr<LocalPlanner>(); };
  } else if (kind == "smoother") {
    entry.smoother = [](const Value*) { return std::unique_ptr<Smoother>(); };
  } else if (kind == "objective") {
    entry.objective = [](const Value*, const Site&) { return std::unique_ptr<Objective>(); };
  } else if (kind == "task") {
    entry.task = [](const Value*, const Site&) { return std::unique_ptr<Task>(); };
  } else {
    entry.tuner = [](const Value*) { return std::unique_ptr<Tuner>(); };
  }
  return entry;
}

/// Creates the cases of a plugin in the process that runs one of them.
class PluginUnderTest {
 public:
  PluginUnderTest(std::shared_ptr<const PluginToCheck> what, const host::Library& library,
                  const Manifest& plugin, const ParameterSet& set)
      : what_(std::move(what)), library_(library), plugin_(plugin), set_(set) {}

  const PluginEntry& load() const {
    static std::vector<const PluginEntry*> entries;
    entries = host::load_library(library_);
    return **std::find_if(entries.begin(), entries.end(), [&](const PluginEntry* entry) {
      return std::strcmp(entry->kind, plugin_.kind) == 0 &&
             std::strcmp(entry->name, plugin_.name) == 0;
    });
  }
  /// Why the plugin cannot be set up here; "" if it can.
  std::string obstacle() const {
    const std::string layer = set_.missing_layer(registry());
    return layer.empty() ? ""
                         : "no library provides the layer '" + layer + "' of the parameter set";
  }
  /// Why the set's parameters do not fit the plugin, or its layers cannot be created; "" if
  /// they fit.
  std::string misfit() const {
    try {
      const conformance::Setup given = setup();
      std::vector<Problem> problems = load().describe(given.with, "").problems;
      if (problems.empty() && given.tighter != nullptr) {
        problems = load().describe(given.tighter, "").problems;
      }
      const char* const hint = what_->sets.empty() ? " (set parameters with --sets FILE)" : "";
      return problems.empty() ? "" : problems.front().text() + hint;
    } catch (const ConfigError& error) {
      return error.problems().front().text();
    } catch (const Error& error) {
      return error.what();
    }
  }
  conformance::Setup setup() const { return with_options(set_.setup(registry())); }
  /// The part of the setup that the names of cases depend on.
  conformance::Setup named_setup() const { return with_options({}); }
  const Manifest& plugin() const { return plugin_; }

 private:
  host::Registry& registry() const {
    static host::Registry all(host::Registry::search_path(what_->plugin_path));
    return all;
  }
  conformance::Setup with_options(conformance::Setup setup) const {
    setup.options.seed = what_->seed;
    setup.options.rounds = what_->rounds;
#ifndef ALTIPLAN_SANITIZED
    setup.options.allocations = allocations_of_this_thread;
#endif
    return setup;
  }

  std::shared_ptr<const PluginToCheck> what_;
  host::Library library_;
  Manifest plugin_;
  ParameterSet set_;
};

using CasesOf = Cases (*)(const PluginEntry&, const conformance::Setup&);

Cases entry_cases(const PluginEntry& entry, const conformance::Setup&) {
  return conformance::plugin_cases(entry);
}

/// A test for each case; it creates the case again, with the plugin itself.
std::vector<PluginTest> tests_of_cases(const std::shared_ptr<const PluginUnderTest>& subject,
                                       const std::string& prefix, CasesOf cases_of) {
  std::vector<PluginTest> tests;
  for (const Case& named : cases_of(stub_of(subject->plugin()), subject->named_setup())) {
    tests.push_back({prefix + named.name, [subject, cases_of, name = named.name] {
                       const conformance::Setup setup =
                           cases_of == entry_cases ? subject->named_setup() : subject->setup();
                       for (const Case& one : cases_of(subject->load(), setup)) {
                         if (one.name == name) {
                           return Outcome{one.run(), "", false, ""};
                         }
                       }
                       throw Error("there is no case " + name);
                     }});
  }
  return tests;
}

void add(std::vector<PluginTest>& all, std::vector<PluginTest> more) {
  std::move(more.begin(), more.end(), std::back_inserter(all));
}

/// The test's outcome, or skipped if it fails and the parameters do not fit the plugin. (They are
/// checked afterwards: a test must observe the effects of loading itself.)
Outcome excused(const PluginUnderTest& subject, const std::function<Outcome()>& run) {
  Outcome outcome;
  try {
    outcome = run();
  } catch (...) {
    const std::string misfit = subject.misfit();
    if (misfit.empty()) {
      throw;
    }
    return {{}, misfit, true, ""};
  }
  const std::string misfit = outcome.findings.empty() ? "" : subject.misfit();
  return misfit.empty() ? outcome : Outcome{{}, misfit, true, ""};
}

std::vector<PluginTest> tests_of_set(const std::shared_ptr<const PluginUnderTest>& subject,
                                     const std::string& prefix) {
  const std::string obstacle = subject->obstacle();
  std::vector<PluginTest> all = tests_of_cases(subject, prefix, conformance::cases_of);
  add(all, process_tests(
               prefix, [subject]() -> const PluginEntry& { return subject->load(); },
               [subject] { return subject->setup(); }));
  std::vector<PluginTest> timed = tests_of_cases(subject, prefix, conformance::clock_cases_of);
  for (PluginTest& test : timed) {
    test.alone = true;
  }
  add(all, std::move(timed));
  for (PluginTest& test : all) {
    if (!obstacle.empty()) {
      test.run = [obstacle] { return Outcome{{}, obstacle, false, ""}; };
    } else {
      test.run = [subject, run = std::move(test.run)] { return excused(*subject, run); };
    }
  }
  return all;
}

void expect_known_plugins(const PluginToCheck& what, const host::Library& library) {
  for (const ParameterSet& set : what.sets) {
    const bool known = !set.plugin || std::any_of(library.plugins.begin(), library.plugins.end(),
                                                  [&](const Manifest& plugin) {
                                                    return *set.plugin == plugin.name;
                                                  });
    if (!known) {
      throw Error("a parameter set is for '" + *set.plugin + "', which " + library.file.string() +
                  " does not contain");
    }
  }
}
}  // namespace

std::vector<PluginTest> tests_of(const PluginToCheck& what) {
  const host::Library library = host::examine_library(what.library);
  expect_known_plugins(what, library);
  std::vector<PluginTest> all{{"library/manifest", [library] { return manifest_fits(library); }}};
  if (!host::is_script(library.file)) {
    all.push_back(
        {"library/exports_one_symbol", [library] { return exports_one_symbol(library); }});
  }
  if (!library.refused.empty()) {
    return all;  // none of its code may run
  }
  all.push_back({"library/loads", [library] { return loads(library); }});
  const auto shared = std::make_shared<const PluginToCheck>(what);
  for (const Manifest& plugin : library.plugins) {
    const std::string prefix = std::string(plugin.kind) + "/" + plugin.name + "/";
    std::vector<ParameterSet> sets;
    std::copy_if(
        what.sets.begin(), what.sets.end(), std::back_inserter(sets),
        [&](const ParameterSet& set) { return set.plugin.value_or(plugin.name) == plugin.name; });
    if (sets.empty()) {
      sets.emplace_back();
    }
    for (std::size_t i = 0; i < sets.size(); ++i) {
      const auto subject =
          std::make_shared<const PluginUnderTest>(shared, library, plugin, sets[i]);
      if (i == 0) {
        add(all, tests_of_cases(subject, prefix, entry_cases));
      }
      add(all, tests_of_set(subject, sets.size() > 1 ? prefix + std::to_string(i) + "/" : prefix));
    }
  }
  return all;
}
}  // namespace altiplan::cli
