// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "altiplan/trace.hpp"
#include "host/base/output_file.hpp"

namespace altiplan::host {

/// Writes a run's search events as lines of JSON: first {"altiplan_trace": 1}, then for each event
/// {"step", "kind", "node", "parent", "at": [x, y, z], "value"}, of an iteration of a population
/// with "mean" and "alive" (docs/reference/result.md). It takes its place when it is closed. Throws
/// Error when the file cannot be written.
class TraceFile final : public Trace {
 public:
  explicit TraceFile(std::filesystem::path file);
  void begin_step(std::string id) { step_ = std::move(id); }
  void add(const TraceEvent& event) override;
  /// Throws Error when something could not be written.
  void close();
  /// With it, where a process that ends before its time leaves the trace as far as it goes.
  const OutputFile& file() const { return file_; }

 private:
  void flush();

  OutputFile file_;
  std::string lines_;  ///< not yet written; whole lines, so that what is cut off ends with one
  std::string error_;  ///< why nothing more is written; "" while all is well
  std::string step_;
};
}  // namespace altiplan::host
