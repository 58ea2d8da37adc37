// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "altiplan/error.hpp"
#include "altiplan/planner.hpp"
#include "host/plugins/registry.hpp"

namespace altiplan::bench {

/// Exit code where answers differ that must not.
inline constexpr int kWrong = 1;
/// Answers differ that must not, or the judge refuses a route.
struct WrongAnswer : Error {
  using Error::Error;
};

// ---- Clocks, in seconds

double wall_s();
double thread_s();   ///< processor time of this thread: what other programs do is not counted
double process_s();  ///< and of all threads

/// Bytes that the program holds from the C library.
std::size_t allocated();

/// The value below which that share of the values lies, itself one of them; 0 of nothing.
double quantile(std::vector<double> values, double share);
inline double median(std::vector<double> values) { return quantile(std::move(values), 0.5); }

// ---- Plugins

/// A plugin and the parameters that it is to have.
struct Chosen {
  const PluginEntry& entry;
  Value parameters;
};
/// `text`: the plugin's name and, after a space, its parameters in YAML: "astar {corner: any}".
Chosen chosen(host::Registry& registry, const std::string& kind, const std::string& text);
std::shared_ptr<const Planner> planner(host::Registry& registry, const std::string& text);
/// A layer above nothing.
std::unique_ptr<Environment> environment(host::Registry& registry, const std::string& text,
                                         Site site = {});

// ---- Plans

/// 0 where the result has no counter of that name.
double counter(const PlanResult& result, std::string_view name);
/// Length of the route in metres, infinite where there is none. Throws WrongAnswer naming `who`
/// where the judge refuses it.
double judged_length(const PlanResult& result, const Request& request, const std::string& who);
/// The same, where there must be a route.
double solved_length(const PlanResult& result, const Request& request, const std::string& who);
}  // namespace altiplan::bench
