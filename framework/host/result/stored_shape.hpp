// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/result/result_json.hpp"

namespace altiplan::host {

/// Throws Error naming the file and the key if the value of a key of result.json is not of the type
/// that docs/reference/result.md specifies. Missing keys are reported by their readers.
void expect_shape(const Json& result, const std::string& file);
/// The found value, for messages: "a list of 2", "'null'".
std::string found_text(const Json& value);
}  // namespace altiplan::host
