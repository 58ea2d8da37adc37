// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "altiplan/request.hpp"

namespace altiplan::bench {

/// OMPL's motion check: its own samples, at most a cell edge apart, or our exact legs.
enum class OmplCheck { samples, legs };

struct OmplResult {
  bool solved = false;
  double seconds = 0;  ///< time of solve alone
  double length = 0;
  std::size_t nodes = 0;
};

/// A planner of OMPL by name, among the cells of a request's only layer.
class OmplPlanner {
 public:
  /// The request must outlive it. A range of 0 keeps the planner's default.
  OmplPlanner(const std::string& planner, const Request& request, OmplCheck check, double range);
  ~OmplPlanner();
  OmplPlanner(OmplPlanner&&) noexcept;
  /// Plans from start to goal of a request in the same world. Reads nodes and length only if
  /// `measure`.
  OmplResult solve(const Request& request, double seconds, bool measure);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};
}  // namespace altiplan::bench
