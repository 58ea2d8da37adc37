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
#include "altiplan/objective.hpp"
#include "altiplan/planner.hpp"
#include "altiplan/plugin_abi.hpp"
#include "altiplan/smoother.hpp"
#include "altiplan/task.hpp"
#include "altiplan/tuner.hpp"

/// The contract of every plugin of a kind as cases for any test framework: the numbered clauses of
/// the interfaces' class comments, checked in small seeded worlds. Seeds are fixed and, except in
/// clock_cases_of, no clock is used: every finding is reproducible.
namespace altiplan::conformance {

/// A violation of a contract: its clause ("Planner contract 1: …"), and the input that caused it.
struct Finding {
  std::string contract;
  std::string message;
};

/// Cases are independent: each can run alone, in any order, in its own process. An exception that
/// escapes the plugin becomes a finding; run itself throws nothing.
struct Case {
  std::string name;  ///< snake_case
  std::function<std::vector<Finding>()> run;
};
using Cases = std::vector<Case>;

struct Options {
  std::uint64_t seed = 1;
  /// Number of seeded worlds, of routes or of hundreds of samples per case.
  int rounds = 6;
  /// Number of calls in the case that compares the last answer with the first.
  int calls = 100;
  /// Resolution of a planner or smoother in metres: worlds are 20 x 16 x 6 units.
  double unit_m = 50;
  /// Budget of one plan: enough for a planner to solve a world of 10,000 cells.
  std::uint64_t iterations = 50'000;
  /// Where an environment is sampled; unset: its bounds, a kilometre around the origin where those
  /// are infinite.
  std::optional<Box> volume;
  /// Number of allocations that this thread has made so far; unset: the check that needs it is
  /// skipped.
  std::function<std::uint64_t()> allocations;
};

template <class Interface>
using Factory = std::function<std::unique_ptr<Interface>()>;
using EnvironmentFactory = std::function<std::unique_ptr<Environment>(const Site&)>;
using ConstraintFactory = std::function<std::unique_ptr<Constraint>(const Site&)>;
using ObjectiveFactory = std::function<std::unique_ptr<Objective>(const Site&)>;
using TaskFactory = std::function<std::unique_ptr<Task>(const Site&)>;

// Each calls its factory more than once, and expects equal objects.
Cases planner_cases(const Factory<Planner>& make, const Options& options = {});
Cases local_planner_cases(const Factory<LocalPlanner>& make, const Options& options = {});
Cases smoother_cases(const Factory<Smoother>& make, const Options& options = {});
/// `tighter` makes the same constraint with a stricter parameter; may be null. The site is in a
/// world with the layers `before`; null: an empty one.
Cases constraint_cases(const ConstraintFactory& make, const ConstraintFactory& tighter = {},
                       const Options& options = {},
                       const std::shared_ptr<const World>& before = nullptr);
/// In a world with the layers `before`; null: none.
Cases environment_cases(const EnvironmentFactory& make, const Options& options = {},
                        const std::shared_ptr<const World>& before = nullptr);
/// Likewise in a world; null: of random solids.
Cases objective_cases(const ObjectiveFactory& make, const Options& options = {},
                      const std::shared_ptr<const World>& before = nullptr);
/// Likewise in a world; null: an empty one.
Cases task_cases(const TaskFactory& make, const Options& options = {},
                 const std::shared_ptr<const World>& before = nullptr);
Cases tuner_cases(const Factory<Tuner>& make, const Options& options = {});

/// The cases for plugins of any kind: their entry, and the declaration of their parameters.
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

/// The only cases that depend on the clock: deadlines and stops, kept within 50 ms. To be run on an
/// otherwise idle machine.
Cases clock_cases_of(const PluginEntry& entry, const Setup& setup = {});

/// Answers of the plugin to a list of queries of its kind, with enough digits to reproduce every
/// number: equal parameters and seeds give equal text, in any process.
std::string answers_of(const PluginEntry& entry, const Setup& setup = {});
}  // namespace altiplan::conformance
