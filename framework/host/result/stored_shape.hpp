// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/result/result_json.hpp"

namespace altiplan::host {

/// Throws Error naming the file and the key where what stands under a key of result.json is not
/// what docs/reference/result.md says. A key that is left out is for its reader to miss.
void expect_shape(const Json& result, const std::string& file);
/// What a message says was found: "a list of 2", "'null'".
std::string found_text(const Json& value);
}  // namespace altiplan::host
