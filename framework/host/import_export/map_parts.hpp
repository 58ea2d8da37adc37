// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "host/import_export/mission_text.hpp"

/// \file Common parts of the formats of maps.
namespace altiplan::host {

inline constexpr const char* kXml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";

/// "above mean sea level", …
const char* words_of(formats::AltitudeFrame frame);
/// "keep_in" or "keep_out".
const char* role_of(const formats::Zone& zone);
/// Metres above sea level; none: no limit.
std::optional<double> altitude_of(const formats::ZoneLimit& limit);
/// When the route is at its n-th item, UTC; "" where no start time is given.
std::string iso_time(const MissionText& text, std::size_t n);
}  // namespace altiplan::host
