// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "altiplan/request.hpp"

namespace altiplan::bench {

/// What OMPL's motions are checked with: its own samples, a cell edge apart or nearer, or our legs.
enum class OmplCheck { samples, legs };

struct OmplResult {
  bool solved = false;
  double seconds = 0;  ///< of solve alone
  double length = 0;
  std::size_t nodes = 0;
};

/// A planner of OMPL by name, among the cells of a request's only layer.
class OmplPlanner {
 public:
  /// The request must outlive it. A range of 0 leaves the planner's own.
  OmplPlanner(const std::string& planner, const Request& request, OmplCheck check, double range);
  ~OmplPlanner();
  OmplPlanner(OmplPlanner&&) noexcept;
  /// Between the start and the goal of a request in the same world. Nodes and length are asked for
  /// only if `measure`.
  OmplResult solve(const Request& request, double seconds, bool measure);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};
}  // namespace altiplan::bench
