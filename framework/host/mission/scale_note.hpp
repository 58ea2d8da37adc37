// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/mission/mission.hpp"

namespace altiplan::host {

/// The scenario's line that puts the origin of its frame there.
std::string frame_about(const LonLat& origin);

/// Notes the frame's scale error where routes may be, and warns if it is large. Returns it.
double note_scale(Mission& mission, const NoteSink& on_note);
}  // namespace altiplan::host
