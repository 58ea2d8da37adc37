// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "host/result/result_json.hpp"

namespace altiplan::host {

/// A key at which two results differ.
struct Difference {
  std::string path;    ///< "steps.0.metrics.length_m"
  std::string first;   ///< the value as JSON, shortened; "nothing" if there is none
  std::string second;  ///< likewise
};

/// The first difference in the order of the first result; numbers are compared exactly. Ignores
/// what may differ between two runs of one seed: keys that end in time_s, and `trace` and
/// `folder`, which the call gives.
std::optional<Difference> first_difference(const Json& first, const Json& second);

/// The same for the texts of two result.json; texts that are not JSON are compared verbatim.
std::optional<Difference> first_difference(const std::string& first, const std::string& second);
}  // namespace altiplan::host
