// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "altiplan/trace.hpp"
#include "host/base/output_file.hpp"

namespace altiplan::host {

/// Writes a run's search events as lines of JSON: first {"altiplan_trace": 1}, then for each event
/// {"step", "kind", "node", "parent", "at": [x, y, z], "value"}, with "mean" and "alive" for
/// iterations of a population (docs/reference/result.md). The file is moved to its place on close.
/// Throws Error if it cannot be written.
class TraceFile final : public Trace {
 public:
  explicit TraceFile(std::filesystem::path file);
  void begin_step(std::string id) { step_ = std::move(id); }
  void add(const TraceEvent& event) override;
  /// Throws Error if something could not be written.
  void close();
  /// The file, for keeping an incomplete trace if the process ends prematurely.
  const OutputFile& file() const { return file_; }

 private:
  void flush();

  OutputFile file_;
  std::string lines_;  ///< not yet written; whole lines, so that an incomplete file ends with one
  std::string error_;  ///< why writing stopped; "" if it has not
  std::string step_;
};
}  // namespace altiplan::host
