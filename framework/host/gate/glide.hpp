// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gate/plan_report.hpp"

namespace altiplan::host {

/// The points and areas of a map (GeoJSON, KML) as sites. Throws Error, naming the file, for one
/// that holds anything else.
std::vector<GlideSite> read_glide_sites(const std::string& file);

/// Judges whether an aeroplane whose engine stops reaches a site, from every place of the flight's
/// band: it turns toward it, at any heading, and glides straight, above the ground and clear of all
/// layers, to a circle over it. Limits of height and other constraints do not count, and what it
/// does below its circle is not judged. Throws Error if no site lies in the model.
GlideReport judge_glide(const formats::MissionFile& plan, const Mission& world,
                        const GateOptions& options);
}  // namespace altiplan::host
