// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "altiplan/trace.hpp"
#include "host/base/output_file.hpp"

namespace altiplan::host {

/// Writes a run's search events as lines of JSON: first {"altiplan_trace": 1}, then for each event
/// {"step", "kind", "node", "parent", "at": [x, y, z], "value"}, with "mean" and "alive" for
/// iterations of a population (docs/reference/result.md). Of a search that goes on beyond the limit
/// only iterations are written, which are few. The file is moved to its place on close. Throws
/// Error if it cannot be written.
class TraceFile final : public Trace {
 public:
  TraceFile(std::filesystem::path file, std::uintmax_t max_bytes);
  void begin_step(std::string id) { step_ = std::move(id); }
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
  std::uintmax_t max_bytes_;
  std::uintmax_t bytes_ = 0;
  std::uintmax_t left_out_ = 0;
};
}  // namespace altiplan::host
