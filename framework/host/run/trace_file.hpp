// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "altiplan/budget.hpp"
#include "altiplan/trace.hpp"
#include "host/base/output_file.hpp"

namespace altiplan::host {

/// Writes a run's search events as lines of JSON: first {"altiplan_trace": 1}, then for each event
/// {"step", "kind", "node", "parent", "at": [x, y, z], "value"}, with "time_s" and "expanded" for
/// iterations, and "mean" and "alive" for those of a population (docs/reference/result.md). Of a
/// search that goes on beyond the limit only iterations are written, which are few. The file is
/// moved to its place on close. Throws Error if it cannot be written.
class TraceFile final : public Trace {
 public:
  TraceFile(std::filesystem::path file, std::uintmax_t max_bytes);
  void begin_step(std::string id) { step_ = std::move(id); }
  /// Iterations have their time from now on, and what `progress` shows then.
  void begin_search(const SearchProgress& progress);
  /// Seconds from there to the first iteration with a route; nothing if there was none.
  std::optional<double> first_route_s() const { return first_route_s_; }
  void add(const TraceEvent& event) override;
  /// Throws Error if something could not be written.
  void close();
  /// Events beyond the limit.
  std::uintmax_t left_out() const { return left_out_; }
  /// The file, for keeping an incomplete trace if the process ends prematurely.
  const OutputFile& file() const { return file_; }

 private:
  void flush();

  OutputFile file_;
  std::string lines_;  ///< not yet written; whole lines, so that an incomplete file ends with one
  std::string error_;  ///< why writing stopped; "" if it has not
  std::string step_;
  Budget::Clock::time_point began_;
  const SearchProgress* progress_ = nullptr;
  std::optional<double> first_route_s_;
  std::uintmax_t max_bytes_;
  std::uintmax_t bytes_ = 0;
  std::uintmax_t left_out_ = 0;
};
}  // namespace altiplan::host
