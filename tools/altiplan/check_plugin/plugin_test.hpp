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

/// The library to check and its settings, from the command line of `altiplan check-plugin`.
struct PluginToCheck {
  std::filesystem::path library;  ///< absolute
  std::vector<ParameterSet> sets;
  std::vector<std::filesystem::path> plugin_path;  ///< for the layers before an environment
  std::uint64_t seed = 1;
  int rounds = 30;
};

/// The result of one test.
struct Outcome {
  std::vector<conformance::Finding> findings;
  std::string skipped;  ///< why the test was skipped; "" if it ran
  bool misfit = false;  ///< skipped because the parameters do not fit the plugin
  std::string answers;  ///< of a test that runs in two processes, equal in both
};

/// One test of a library, to be run in its own process: it loads everything it needs.
struct PluginTest {
  std::string name;  ///< "library/loads", "planner/astar/2/limits_are_honoured"
  std::function<Outcome()> run;
  bool alone = false;  ///< measures time: nothing else may run
  bool in_two_processes = false;
};

/// All tests of the library, listed from its manifest without running its code. Throws Error if the
/// file does not exist, or if a set names a plugin that the library does not contain.
std::vector<PluginTest> tests_of(const PluginToCheck& what);

// Tests of a library's effects on its process. `load` returns its entry; the parameters are those
// of the setup. Each test changes the process, so no other test may follow in it.
using LoadPlugin = std::function<const PluginEntry&()>;
using MakeSetup = std::function<conformance::Setup()>;
std::vector<PluginTest> process_tests(const std::string& prefix, const LoadPlugin& load,
                                      const MakeSetup& setup);

/// Number of allocations of this thread so far.
std::uint64_t allocations_of_this_thread();
}  // namespace altiplan::cli
