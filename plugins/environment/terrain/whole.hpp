// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace terrain {

/// The part missing from a file that GDAL reads as if it were complete, or "": invalid numbers of
/// an ESRI ASCII grid (GDAL reads them as 0), heights beyond the end of an ENVI file (likewise).
std::string missing_from(const std::string& file, void* dataset);
}  // namespace terrain
