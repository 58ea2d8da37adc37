// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "host/result/result_json.hpp"

namespace altiplan::host {

/// A place at which two results are not the same.
struct Difference {
  std::string path;    ///< "steps.0.metrics.length_m"
  std::string first;   ///< the value as JSON, shortened; "nothing" where there is none
  std::string second;  ///< likewise
};

/// The first difference in the order of the first result, to the last bit of every number. What
/// may differ between two runs of one seed is left out: keys that end in time_s, and `trace`, which
/// names a file of the call.
std::optional<Difference> first_difference(const Json& first, const Json& second);

/// As above, of the texts of two result.json; two that are no JSON are compared as they are.
std::optional<Difference> first_difference(const std::string& first, const std::string& second);
}  // namespace altiplan::host
