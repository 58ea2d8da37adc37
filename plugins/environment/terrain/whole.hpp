// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace terrain {

/// What is missing of a file that GDAL reads as if it were whole, or "": numbers of an ESRI ASCII
/// grid that are none (it takes them as 0), heights beyond the end of an ENVI file (likewise).
std::string missing_from(const std::string& file, void* dataset);
}  // namespace terrain
