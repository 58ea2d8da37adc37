// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "host/import_export/mission_text.hpp"
#include "host/import_export/route_csv.hpp"

/// \file The writers and readers in the table of formats, each of which has a file of its own.
namespace altiplan::host {

std::string qgc_plan_text(const MissionText& mission);
std::string waypoints_text(const MissionText& mission);
std::string kml_text(const MissionText& mission);
std::string gpx_text(const MissionText& mission);
std::string geojson_text(const MissionText& mission);
std::string csv_text(const MissionText& route);

/// KML in an archive, with a mark for each waypoint and its time.
std::string kmz_text(const MissionText& mission);
/// Reads both kinds of archives: of DJI's the waylines, else the KML.
formats::MissionFile read_kmz(const std::string& file, const std::string& text);

std::string wpml_text(const MissionText& mission);
std::vector<std::string> wpml_notes(const MissionText& mission);

std::string litchi_text(const MissionText& mission);
formats::MissionFile read_litchi(const std::string& file, const std::string& text);
bool is_litchi(std::string_view text);
std::vector<std::string> litchi_notes(const MissionText& mission);

std::string czml_text(const MissionText& mission);
formats::MissionFile read_czml(const std::string& file, const std::string& text);
bool is_czml(std::string_view text);

std::string mcap_text(const MissionText& route);
LocalRoute read_mcap(const std::string& file, const std::string& text);
bool is_mcap(std::string_view text);
}  // namespace altiplan::host
