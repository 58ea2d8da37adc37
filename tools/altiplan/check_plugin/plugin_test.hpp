// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "altiplan/conformance.hpp"
#include "sets.hpp"

namespace altiplan::cli {

/// What `altiplan check-plugin` is asked to look at.
struct PluginToCheck {
  std::filesystem::path library;  ///< absolute
  std::vector<ParameterSet> sets;
  std::vector<std::filesystem::path> plugin_path;  ///< of the layers before an environment
  std::uint64_t seed = 1;
  int rounds = 30;
};

/// What a test said.
struct Outcome {
  std::vector<conformance::Finding> findings;
  std::string skipped;  ///< why there was nothing to do; "" where there was
  bool misfit = false;  ///< skipped, as the parameters do not fit the plugin
  std::string answers;  ///< of a test of two processes: what must be equal in both
};

/// One test of a library, to be run in a process of its own: it loads what it needs by itself.
struct PluginTest {
  std::string name;  ///< "library/loads", "planner/astar/2/limits_are_honoured"
  std::function<Outcome()> run;
  bool alone = false;  ///< it looks at the clock: nothing else may run
  bool in_two_processes = false;
};

/// All tests of the library, by its manifest: none of its code has run. Throws Error where there is
/// no such file, or no plugin of it has the name that a set asks for.
std::vector<PluginTest> tests_of(const PluginToCheck& what);

// What a library does to the process that it is in. `load` brings its entry; the parameters are
// those of the setup. Each leaves the process changed: no other test may follow.
using LoadPlugin = std::function<const PluginEntry&()>;
using MakeSetup = std::function<conformance::Setup()>;
std::vector<PluginTest> process_tests(const std::string& prefix, const LoadPlugin& load,
                                      const MakeSetup& setup);

/// How often this thread has allocated so far.
std::uint64_t allocations_of_this_thread();
}  // namespace altiplan::cli
