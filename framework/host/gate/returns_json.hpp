// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/base/json.hpp"
#include "host/gate/plan_report.hpp"

namespace altiplan::host {

/// "pass", "fail", "not_judged"
const char* key_of(Verdict verdict);
Json to_json(const std::vector<Parameters::Used>& used);
/// The verdict on the report's returns, as `altiplan check --returns --json` prints it.
Json returns_json(const PlanReport& report, const Mission& world);
}  // namespace altiplan::host
