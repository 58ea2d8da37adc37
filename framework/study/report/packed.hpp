// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace altiplan::study::report {

/// zlib, then base64, unpacked by the page's script. Throws Error if out of memory.
std::string packed(std::string_view text);
}  // namespace altiplan::study::report
