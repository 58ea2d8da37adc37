// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace altiplan::host {

/// In the place of a zone's name: all that take a permission.
inline constexpr const char* kEveryZone = "all";

/// How the zones of files count.
struct ZoneUse {
  bool has_start_time = false;  ///< their hours count
  double buffer_m = 0;          ///< is kept from them
  std::vector<std::string>
      permitted;  ///< identifiers or names, or kEveryZone: open by a permission
};

/// Parameters of the `zones` plugin for a file, but the file: properties of GeoJSON that name
/// limits (`floor_m`, `ceiling_m`) and, where hours count, times (`from`, `until`, `timeBegin`,
/// `timeEnd`); of the permissions those that open zones of this file. "" if there are none. Throws
/// Error naming the file.
std::string zone_parameters(const std::filesystem::path& file, const ZoneUse& use);

/// Why one of the permissions opens no zone of the files; "" if each opens one.
std::string permission_problem(const std::vector<std::string>& permitted,
                               const std::vector<std::filesystem::path>& files);
}  // namespace altiplan::host
