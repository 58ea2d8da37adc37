// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "host/result/result_json.hpp"
#include "study/compare/compare.hpp"

namespace altiplan::study {

/// A sentence for each file and plugin's build of two results, as result.json names them, that are
/// not the same: "'city.yaml' has changed since". A file that was moved alone is the same. Throws
/// Json::exception for what is no result.
std::vector<std::string> changed_origins(const host::Json& then, const host::Json& now);

/// The text of a run's result.json, "" where it left none.
using ResultOf = std::function<std::string(const RunRow&)>;

/// What the runs of two studies with other keys were made from that is not the same: the above, the
/// version of the program, the keys that the studies set, the budget; each once. Results are read
/// of one pair of runs for each pipeline and scenario file.
std::vector<std::string> changed_origins(const Comparison& comparison, const StudyData& first,
                                         const StudyData& second, const ResultOf& of_first,
                                         const ResultOf& of_second);
}  // namespace altiplan::study
