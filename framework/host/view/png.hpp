// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace altiplan::host {

/// A PNG of 8-bit RGBA: four bytes per pixel, rows from the top. Throws Error unless there are 4 ×
/// width × height bytes.
std::string png(int width, int height, const std::vector<std::uint8_t>& rgba);
}  // namespace altiplan::host
