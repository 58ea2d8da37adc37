// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/import_export/export.hpp"
#include "host/import_export/place_timing.hpp"
#include "host/import_export/placing.hpp"
#include "host/import_export/written_route.hpp"

namespace altiplan::host {

/// The end point of the landing below the last point.
Vec3 landing(const Mission& mission, const Route& route, const Placing& place);

/// The items of a mission at the places, with the take-off and landing that the options ask for.
std::vector<formats::MissionItem> items_of(const std::vector<MissionPlace>& places,
                                           const Mission& mission, const Placing& place,
                                           const ExportOptions& options,
                                           const std::vector<PlaceTiming>& timing);

/// Has an item for each place do what the stop there asks for, instead of its wait. False if a stop
/// is at none of them.
bool tell_stops(const std::vector<MissionPlace>& places, const std::vector<PlacedStop>& stops,
                const Mission& mission, const Placing& place, MissionText& text);

/// The first violation of the route as written and read back; "" if it is valid.
std::string problem_of(const Mission& mission, const ExportSource& source, const Route& route,
                       const Request& request, const std::vector<Goal>& via);

/// The number of items that the route takes, with the commands that set speeds.
std::size_t item_count(const ExportSource& source, const Mission& mission,
                       const ExportOptions& options);

/// Writes the route so that it is valid when read back; returns the text and its messages. `text`
/// has no items yet.
Exported written_soundly(const Mission& mission, const ExportSource& source, const Placing& place,
                         const ExportOptions& options, MissionText text);
}  // namespace altiplan::host
