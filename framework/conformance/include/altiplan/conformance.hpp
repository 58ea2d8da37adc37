// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "altiplan/constraint.hpp"
#include "altiplan/environment.hpp"
#include "altiplan/local_planner.hpp"
#include "altiplan/planner.hpp"
#include "altiplan/plugin_abi.hpp"
#include "altiplan/smoother.hpp"
#include "altiplan/tuner.hpp"

/// What every plugin of a kind owes, as cases for any test framework: the laws numbered in the
/// interfaces' class comments, held against small seeded worlds. Fixed seeds and, but for
/// clock_cases_of, no clock: a finding comes again at every run.
namespace altiplan::conformance {

/// A law that was broken: which ("Planner contract 1: …"), and the input that broke it.
struct Finding {
  std::string law;
  std::string message;
};

/// A case stands on its own: it can run alone, in any order, in a process of its own. An exception
/// that escapes the plugin becomes a finding; run itself throws nothing.
struct Case {
  std::string name;  ///< snake_case
  std::function<std::vector<Finding>()> run;
};
using Cases = std::vector<Case>;

struct Options {
  std::uint64_t seed = 1;
  /// Seeded worlds, routes or hundreds of samples of a case.
  int rounds = 6;
  /// Calls of the case that holds the hundredth answer against the first.
  int calls = 100;
  /// Metres of what a planner or smoother resolves well: worlds are 20 x 16 x 6 of them.
  double unit_m = 50;
  /// What one plan may use: enough for a planner to solve a world of 10,000 cells.
  std::uint64_t iterations = 50'000;
  /// Where an environment is looked at; unset: its bounds, a kilometre around the origin where
  /// those are infinite.
  std::optional<Box> volume;
  /// How many allocations this thread has made so far; unset: the law that asks is left out.
  std::function<std::uint64_t()> allocations;
};

template <class Interface>
using Factory = std::function<std::unique_ptr<Interface>()>;
using EnvironmentFactory = std::function<std::unique_ptr<Environment>(const Site&)>;

// Each calls its factory more than once, and expects equal objects of it.
Cases planner_cases(const Factory<Planner>& make, const Options& options = {});
Cases local_planner_cases(const Factory<LocalPlanner>& make, const Options& options = {});
Cases smoother_cases(const Factory<Smoother>& make, const Options& options = {});
/// `tighter` makes the same constraint with a stricter parameter; may be null.
Cases constraint_cases(const Factory<Constraint>& make, const Factory<Constraint>& tighter = {},
                       const Options& options = {});
/// In a world of the layers `before` it; null: none.
Cases environment_cases(const EnvironmentFactory& make, const Options& options = {},
                        const std::shared_ptr<const World>& before = nullptr);
Cases tuner_cases(const Factory<Tuner>& make, const Options& options = {});

/// What a plugin of any kind owes: its entry, and the declaration of its parameters.
Cases plugin_cases(const PluginEntry& entry);

/// One set of parameters under which a plugin is to conform; null parameters are the defaults.
struct Setup {
  const Value* with = nullptr;
  const Value* tighter = nullptr;  ///< of a constraint
  std::shared_ptr<const World> before;
  Options options;
};
/// The cases of the entry's kind.
Cases cases_of(const PluginEntry& entry, const Setup& setup = {});

/// Those that look at the clock, unlike all others: deadlines and stops, kept within 50 ms. To be
/// run while nothing else does.
Cases clock_cases_of(const PluginEntry& entry, const Setup& setup = {});

/// What the plugin answers to a list of questions of its kind, every number in digits enough to
/// make it again: equal parameters and seeds give equal text, in any process.
std::string answers_of(const PluginEntry& entry, const Setup& setup = {});
}  // namespace altiplan::conformance
