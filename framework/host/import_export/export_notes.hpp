// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/import_export/export.hpp"
#include "host/import_export/written_route.hpp"

namespace altiplan::host {

/// How the turns were written and judged, and how autopilots fly turns and long legs where that
/// differs. `beside_turns`: the points do not satisfy what the turns do.
std::vector<std::string> notes_on(const WrittenRoute& written, const ExportOptions& options,
                                  double tolerance, bool beside_turns, const Mission& mission);
}  // namespace altiplan::host
