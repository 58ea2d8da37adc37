// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "altiplan/error.hpp"
#include "altiplan/planner.hpp"
#include "host/plugins/registry.hpp"

namespace altiplan::bench {

/// Exit code if answers differ that must agree.
inline constexpr int kWrong = 1;
/// Answers differ that must agree, or the judge rejects a route.
struct WrongAnswer : Error {
  using Error::Error;
};

// ---- Clocks, in seconds

double wall_s();
double thread_s();   ///< CPU time of this thread, independent of other programs
double process_s();  ///< CPU time of all threads

/// Bytes that the program has allocated from the C library.
std::size_t allocated();

/// The quantile of the values at that share, one of the values; 0 if empty.
double quantile(std::vector<double> values, double share);
inline double median(std::vector<double> values) { return quantile(std::move(values), 0.5); }

// ---- Plugins

/// A plugin and its parameters.
struct Chosen {
  const PluginEntry& entry;
  Value parameters;
};
/// `text`: the plugin's name and, after a space, its parameters in YAML: "astar {corner: any}".
Chosen chosen(host::Registry& registry, const std::string& kind, const std::string& text);
std::shared_ptr<const Planner> planner(host::Registry& registry, const std::string& text);
/// A layer with no layers below it.
std::unique_ptr<Environment> environment(host::Registry& registry, const std::string& text,
                                         Site site = {});

// ---- Plans

/// 0 if the result has no counter of that name.
double counter(const PlanResult& result, std::string_view name);
/// Length of the route in metres, infinite if there is none. Throws WrongAnswer naming `who` if the
/// judge rejects it.
double judged_length(const PlanResult& result, const Request& request, const std::string& who);
/// The same; throws WrongAnswer if there is no route.
double solved_length(const PlanResult& result, const Request& request, const std::string& who);
}  // namespace altiplan::bench
