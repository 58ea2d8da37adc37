// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "host/result/result_json.hpp"

namespace altiplan::study {

/// Numbers by the names that claims and tables use, sorted by name.
using RunValues = std::vector<std::pair<std::string, double>>;

/// The numbers of a result.json, by the names that claims and tables use: "length_m",
/// "flight.collisions", "steps.ID.counters.expanded". Sorted by name, without nulls. Throws
/// nlohmann's exceptions if the JSON is not a result.
RunValues values_of(const host::Json& result);

/// The error message for a name that no run can have a value of, with the nearest valid name; ""
/// if a run may have it. `metrics`: names of objectives that routes are measured by.
std::string why_no_value(const std::string& name, const std::vector<std::string>& metrics = {});
/// The parts of a pipeline that values of its runs are named by.
struct PipelineParts {
  std::string name;
  std::vector<std::string> steps;  ///< ids
  bool flies = false;
  bool is_known = false;  ///< false: its file cannot be read
};
/// The error message for a value of a step, or of a flight, that none of these pipelines has, with
/// the nearest step; "" if one may have it.
std::string why_no_part(const std::string& name, const std::vector<PipelineParts>& pipelines);
/// True if it is none that runs have without such metrics.
bool is_own_metric(const std::string& name);
}  // namespace altiplan::study
