// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/base/json.hpp"
#include "host/config/config.hpp"
#include "host/run/run_result.hpp"

namespace altiplan::host {

/// result.json, format 1 (docs/reference/result.md). Wall times appear only in keys that end in
/// time_s.
Json result_json(const Config& config, const RunResult& result);

/// The assignments of `--set` in a result's overrides, in order.
std::vector<std::string> set_texts(const Json& overrides);

/// [{"kind", "name", "build", "checksum"}] of the plugins that the files name.
Json plugins_json(const Config& config);

/// Points of the route; of turns, ends of chords within kChordTolerance.
Json to_json(const Route& route);
Json to_json(const CheckResult& check);
Json to_json(const Measures& measures);
/// The same with metrics of one's own.
Json to_json(const Measures& measures, const MetricValues& own);
/// {"cost": …, "bound": …}
Json to_json(const std::optional<Cost>& cost);
/// One of `steps`.
Json to_json(const StepResult& step);

/// The text for files and stdout, indented, with a final line end. Texts of plugins, above all
/// damaged ones, may be invalid UTF-8: U+FFFD replaces invalid bytes.
std::string file_text(const Json& json);
}  // namespace altiplan::host
