// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <optional>
#include <vector>

#include "altiplan/task.hpp"
#include "host/run/along_via.hpp"

namespace altiplan::host {

/// The sections of a route that flies a task's passes in their order.
class TaskSections {
 public:
  TaskSections(TaskOrder order, const TaskEnds& ends, const Request& request);

  const TaskOrder& order() const { return order_; }
  const Vec3& start() const { return points_.front(); }
  const Vec3& goal() const { return points_.back(); }
  /// The points between, in order; of an aeroplane with the heading of the pass that begins there.
  std::vector<Goal> via(const Request& request) const;
  /// Seconds of each flight, by the passes and joins as ordered.
  std::vector<double> flights(const Request& request) const;
  /// Flies passes and stops as they are, and the order's joins where they are valid; else
  /// `plan_part` joins.
  PlanPart part(PlanPart plan_part) const;
  /// The violation of the first pass or stop that the route does not fly as it is, or of the first
  /// landing that is not clear; none if it flies all.
  std::optional<Violation> violation(const Route& route, const Request& request) const;

 private:
  using Ends = std::array<double, 6>;
  struct Section {
    bool is_pass = false;
    Polyline join;
    double stop_s = 0;  ///< a stop: a section from a place to itself
  };
  static Ends ends_of(const Vec3& from, const Vec3& to);
  void add(const Vec3& to, const Section& section);

  TaskOrder order_;
  std::vector<double> stops_s_;  ///< of each pass
  Polyline points_;
  std::vector<bool> begins_pass_;  ///< of each point: a leg of a pass begins there
  std::map<Ends, Section> sections_;
};
}  // namespace altiplan::host
