// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gate/plan_report.hpp"
#include "host/import_export/export.hpp"
#include "host/import_export/plan.hpp"
#include "link_options.hpp"

namespace altiplan::cli {

/// The plan of a route as written; warns where MAVLink carries fewer decimals than it needs.
host::Plan plan_to_upload(const host::Exported& written);
/// What becomes of the vehicle's fence and rally points.
struct FenceOptions {
  bool leave = false;
  bool clear = false;        ///< where the plan has no zones
  bool clear_rally = false;  ///< where the plan has no rally points
};

/// Prints what the vehicle's autopilot refuses of the mission, before it is uploaded.
void tell_refusals(const link::Vehicle& vehicle, const formats::MissionFile& mission);
/// False, and said, where the vehicle is none of those that the mission was judged for.
bool is_judged_for(const link::Vehicle& vehicle, const formats::MissionFile& mission,
                   const host::GateOptions& gate);

/// Uploads the mission, the fence and the rally points, reads them back and prints what the vehicle
/// changed, and a fence or rally points that it keeps. True if it holds what was sent.
bool upload_plan(Connection& connection, const host::Plan& plan, const FenceOptions& fence);
/// Adds --no-fence, --clear-fence and --clear-rally.
void add_fence_options(App& command, FenceOptions& fence);
}  // namespace altiplan::cli
