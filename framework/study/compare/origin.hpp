// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "host/result/result_json.hpp"
#include "study/compare/compare.hpp"

namespace altiplan::study {

/// A sentence for each file and plugin build that differs between two result.json: "'city.yaml' has
/// changed since". A file that was only moved is the same. Throws Json::exception if either is not
/// a result.
std::vector<std::string> changed_origins(const host::Json& then, const host::Json& now);

/// The text of a run's result.json, "" if it left none.
using ResultOf = std::function<std::string(const RunRow&)>;

/// The different inputs of two studies' runs with different keys: the above, the version of the
/// program, the keys that the studies set, the budget; each once. Reads the results of one pair of
/// runs for each pipeline and scenario file.
std::vector<std::string> changed_origins(const Comparison& comparison, const StudyData& first,
                                         const StudyData& second, const ResultOf& of_first,
                                         const ResultOf& of_second);
}  // namespace altiplan::study
