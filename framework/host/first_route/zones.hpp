// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace altiplan::host {

/// Parameters of the `zones` plugin for a file, but the file: properties of GeoJSON that name
/// limits (`floor_m`, `ceiling_m`) and, where hours count, times (`from`, `until`, `timeBegin`,
/// `timeEnd`). "" if there are none. Throws Error naming the file.
std::string zone_parameters(const std::filesystem::path& file, bool has_start_time);
}  // namespace altiplan::host
