// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "host/base/json.hpp"
#include "host/plugins/registry.hpp"

namespace altiplan::bench {

using Json = nlohmann::ordered_json;

/// The arguments of a subcommand besides its own options.
struct Given {
  std::shared_ptr<host::Registry> registry;
  bool as_json = false;
  std::vector<std::string> others;  ///< arguments for Google Benchmark
};

/// Measures and returns an object of figures; a list in it is a table whose rows are objects with
/// the same keys. Null if everything has been printed. Infinite and NaN figures have no value.
using Measure = std::function<Json(const Given&)>;

/// The subcommands of altiplan-bench, each with --plugin-path and --json.
class Subcommands {
 public:
  explicit Subcommands(CLI::App& app) : app_(app) { app.require_subcommand(1); }

  /// Add options to the returned command.
  CLI::App& add(const std::string& name, const std::string& sentence, Measure measure);
  /// Adds a subcommand that is not in this build; `needs` names what is missing.
  void leave_out(const std::string& name, const std::string& needs);
  /// Runs the selected subcommand and prints its figures. Does not catch its exceptions.
  void run() const;

 private:
  CLI::App& app_;
  std::map<CLI::App*, Measure> all_;
  std::vector<std::filesystem::path> plugin_path_;
  bool as_json_ = false;
};

// Each adds its subcommand.
void add_airspace(Subcommands& all);
void add_ants(Subcommands& all);
void add_any_angle(Subcommands& all);
void add_detours(Subcommands& all);
void add_dubins(Subcommands& all);
void add_field(Subcommands& all);
void add_grid(Subcommands& all);
void add_hybrid_astar(Subcommands& all);
void add_legs(Subcommands& all);
void add_pilot(Subcommands& all);
void add_plan(Subcommands& all);
void add_queries(Subcommands& all);
void add_reach(Subcommands& all);
void add_replan(Subcommands& all);
void add_sampling(Subcommands& all);
void add_search(Subcommands& all);
void add_terrain(Subcommands& all);
void add_watch(Subcommands& all);
}  // namespace altiplan::bench
