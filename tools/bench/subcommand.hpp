// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/plugins/registry.hpp"

namespace altiplan::bench {

using Json = nlohmann::ordered_json;

/// What a subcommand is given beside its own options.
struct Given {
  std::shared_ptr<host::Registry> registry;
  bool as_json = false;
  std::vector<std::string> others;  ///< arguments that are for Google Benchmark
};

/// Measures, and returns an object of figures; a list in it is a table, its rows objects with the
/// same keys. Null where all has been printed. What is infinite or NaN has no value in either form.
using Measure = std::function<Json(const Given&)>;

/// The subcommands of altiplan-bench, each with --plugin-path and --json.
class Subcommands {
 public:
  explicit Subcommands(CLI::App& app) : app_(app) { app.require_subcommand(1); }

  /// Options are to be added to what it returns.
  CLI::App& add(const std::string& name, const std::string& sentence, Measure measure);
  /// One that this build has not: `needs` what is missing.
  void leave_out(const std::string& name, const std::string& needs);
  /// The one that was asked for; prints its figures. Throws what it throws.
  void run() const;

 private:
  CLI::App& app_;
  std::map<CLI::App*, Measure> all_;
  std::vector<std::filesystem::path> plugin_path_;
  bool as_json_ = false;
};

// Each adds its subcommand.
void add_ants(Subcommands& all);
void add_any_angle(Subcommands& all);
void add_field(Subcommands& all);
void add_grid(Subcommands& all);
void add_pilot(Subcommands& all);
void add_queries(Subcommands& all);
void add_replan(Subcommands& all);
void add_sampling(Subcommands& all);
void add_search(Subcommands& all);
}  // namespace altiplan::bench
