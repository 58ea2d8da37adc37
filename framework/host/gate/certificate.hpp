// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "host/gate/plan_report.hpp"

namespace altiplan::host {

/// What the verdict rests on, in words: ("terrain", "dem.tif, SHA-256 …").
using Basis = std::vector<std::pair<std::string, std::string>>;

/// "46.815182 N, 9.824228 E, 1766.0 m above sea level"; local metres in a world without a
/// georeference.
std::string place_in_words(const Vec3& p, const Request& request);

/// The verdict as a page of HTML without scripts: what it rests on, the violations with their
/// cures, a map, the height profile, and the parts of the flight with heights and times.
std::string certificate(const PlanReport& report, const Mission& world, const Basis& basis);

/// The verdict as JUnit XML: one test case a part of the flight, and one for each other finding.
std::string junit(const PlanReport& report);
/// The same where there is no verdict.
std::string junit_of_error(const std::string& file, const std::string& message);
}  // namespace altiplan::host
