// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace altiplan::study::report {

/// zlib, then base64: what the page's script takes apart again. Throws Error for lack of memory.
std::string packed(std::string_view text);
}  // namespace altiplan::study::report
