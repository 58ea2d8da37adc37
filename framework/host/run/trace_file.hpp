// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <filesystem>
#include <string>

#include "altiplan/trace.hpp"

namespace altiplan::host {

/// Writes a run's search events as lines of JSON: first {"altiplan_trace": 1}, then for each event
/// {"step", "kind", "node", "parent", "at": [x, y, z], "value"}, of an iteration of a population
/// with "mean" and "alive" (docs/result.md). Throws Error when the file cannot be written.
class TraceFile final : public Trace {
 public:
  explicit TraceFile(std::filesystem::path file);
  ~TraceFile() override;
  TraceFile(const TraceFile&) = delete;
  TraceFile& operator=(const TraceFile&) = delete;

  void begin_step(std::string id) { step_ = std::move(id); }
  void add(const TraceEvent& event) override;
  /// Throws Error when something could not be written.
  void close();

 private:
  std::filesystem::path path_;
  std::FILE* file_;
  std::string step_;
};
}  // namespace altiplan::host
