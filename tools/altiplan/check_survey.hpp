// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "check_plan.hpp"
#include "host/first_route/first_route.hpp"
#include "host/first_route/shown.hpp"

namespace altiplan::cli {

/// A plan's text with what its photos are to show, for check_survey: areas and a camera, which
/// ground stations do not read.
std::string with_survey(const std::string& plan, const host::FirstRoute& first, const Frame& frame);

/// What photos of a survey show of flat ground, by the metre of height, and how far the camera may
/// be off its lines. An aeroplane may need their ends beyond the areas to line up, and to turn
/// away.
host::PhotoLines photo_lines(const host::FirstRoute& first, std::vector<Polyline> along);

/// Makes the surveys of QGroundControl in a plan again and compares them with its items; or, with
/// models, computes what the photos of one that with_survey wrote show of its areas. Returns the
/// exit code.
int check_survey(const std::string& file, const PlanCheck& options,
                 const host::Overrides& overrides);
}  // namespace altiplan::cli
