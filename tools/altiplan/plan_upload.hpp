// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/import_export/export.hpp"
#include "host/import_export/plan.hpp"
#include "link_options.hpp"

namespace altiplan::cli {

/// The plan of a route as written; warns where MAVLink carries fewer decimals than it needs.
host::Plan plan_to_upload(const host::Exported& written);
/// Uploads the mission, the fence and the rally points, reads them back and prints what the vehicle
/// changed. True if it holds what was sent.
bool upload_plan(Connection& connection, const host::Plan& plan, bool with_fence);
/// Adds --no-fence.
void add_no_fence(App& command, bool& no_fence);
}  // namespace altiplan::cli
