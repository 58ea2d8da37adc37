// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cells.hpp"
#include "subcommand.hpp"

namespace altiplan::bench {

/// One planner and the results of its plans.
class Row {
 public:
  /// `text`: the plugin's name and, after a space, its parameters in YAML.
  Row(host::Registry& registry, const std::string& text);

  struct Plan {
    double ms;
    double length;  ///< cells; infinite without a route
    double expanded;
  };
  /// Throws WrongAnswer if the judge rejects the route.
  Plan plan(const Cells& cells, const Way& way);
  /// Adds the plans of one query, one per pass.
  void add(const std::vector<Plan>& passes);

  const std::string& name() const { return name_; }
  /// Lengths relative to those of `first`; memory per cell for that many cells.
  Json figures(const Row& first, std::size_t cells) const;

 private:
  std::string name_;
  std::shared_ptr<const Planner> planner_;
  std::vector<double> first_ms_;  ///< one entry per query, as below
  std::vector<double> ms_;
  std::vector<double> lengths_;
  double expanded_ = 0;
  double resident_ = 0;  ///< growth of resident memory while planning, bytes
};

/// Plans every query by every row, interleaved, so that machine load affects all of them alike.
void plan_all(std::vector<Row>& rows, const Cells& cells, const std::vector<Way>& ways, int passes);
/// Adds a table of the rows, and the program's peak memory, to the figures of a world.
void add(Json& figures, const std::vector<Row>& rows, std::size_t cells);
}  // namespace altiplan::bench
