// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/config/config.hpp"
#include "host/mission/mission.hpp"

namespace altiplan::host {

/// The volume as far as the scenario alone tells it, for the layers that are still to be built:
/// infinite where it does not. `points` are start, via points and goal, none if a layer must be
/// built to place them.
Box asked_volume(const ScenarioFile& file, const std::vector<Vec3>& points);

/// The volume; what the scenario leaves out comes from the layers' box, and what lies beyond the
/// ground is cut off, with a note. Throws ConfigError.
Box volume_of(const Config& config, Mission& mission, const std::vector<Vec3>& points,
              const NoteSink& on_note);
}  // namespace altiplan::host
