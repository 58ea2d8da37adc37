// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gate/plan_report.hpp"
#include "host/import_export/export.hpp"
#include "host/import_export/plan.hpp"

namespace altiplan::host {

/// A route as few items of a plan.
struct FewestItems {
  Plan plan;
  PlanReport report;       ///< the verdict on the plan as it is flown
  std::size_t judged = 0;  ///< plans until then
  bool passed() const { return report.passed(); }
};

/// The fewest waypoints along the route that pass as the autopilot flies them: those of its
/// straight legs, and the corners of its turns, which are flown by. Dynamic programming finds the
/// fewest that are joined by valid straight legs; the gate judges that plan, and legs that meet at
/// an item with a finding are not taken again. `written` is the route as export_route wrote it,
/// with home, zones and settings. Does not pass if not even all of the waypoints do.
FewestItems fewest_items(const Mission& mission, const ExportSource& source,
                         const ExportOptions& options, const MissionText& written,
                         const GateOptions& gate);
}  // namespace altiplan::host
