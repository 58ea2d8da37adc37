// SPDX-License-Identifier: Apache-2.0
#include "study/model/progress.hpp"

#include <algorithm>
#include <limits>
#include <set>

#include "altiplan/limits.hpp"
#include "host/base/json.hpp"

namespace altiplan::study {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

double number_or(const host::Json& json, const char* key, double otherwise) {
  return json.contains(key) && json.at(key).is_number() ? json.at(key).get<double>() : otherwise;
}
}  // namespace

std::vector<Progress> progress_of(std::string_view trace) {
  // Few lines of a trace are iterations: only those are parsed.
  constexpr std::string_view kWord = "iteration\"";
  std::vector<Progress> all;
  std::set<std::string> over;  // steps whose first search has ended
  for (std::size_t at = 0; (at = trace.find(kWord, at)) != std::string_view::npos;) {
    const std::size_t begin = trace.rfind('\n', at) + 1;
    const std::size_t end = std::min(trace.find('\n', at), trace.size());
    at = end;
    const host::Json line = host::json_or_discarded(trace.substr(begin, end - begin));
    if (!line.is_object() || line.value("kind", host::Json()) != "iteration" ||
        !line.value("step", host::Json()).is_string()) {
      continue;
    }
    const auto step = line.at("step").get<std::string>();
    const Iteration iteration{number_or(line, "node", 0),       number_or(line, "value", kInfinity),
                              number_or(line, "mean", kNone),   number_or(line, "alive", -1),
                              number_or(line, "time_s", kNone), number_or(line, "expanded", kNone)};
    auto found = std::find_if(all.begin(), all.end(),
                              [&](const Progress& progress) { return progress.step == step; });
    found = found == all.end() ? all.insert(found, {step, {}}) : found;
    if (!found->iterations.empty() && iteration.number <= found->iterations.back().number) {
      over.insert(step);
    }
    if (over.count(step) == 0) {
      found->iterations.push_back(iteration);
    }
  }
  return all;
}
}  // namespace altiplan::study
