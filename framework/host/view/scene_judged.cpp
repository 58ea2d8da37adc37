// SPDX-License-Identifier: Apache-2.0
#include <filesystem>

#include "host/base/run_status.hpp"
#include "host/judge/judge.hpp"
#include "host/view/scene_parts.hpp"

// What a picture says of a route or a flight is what the judge finds when it is drawn: the files
// may have changed since the run, and so may the stored result.

namespace altiplan::host {

std::string status_of(const CheckResult& check) {
  return name(check.ok()                       ? RunStatus::solved
              : violated_layer(check) != nullptr ? RunStatus::failed
                                               : RunStatus::rejected);
}

std::string first_found(const CheckResult& check) {
  return check.ok() ? "" : verdict_sentence(check, check.violations.front());
}

void set_status(Json& shown, const std::string& file, const std::string& now,
                const std::string& why) {
  const auto stored = shown.at("status").get<std::string>();
  const bool only_the_run_knows =
      stored == name(RunStatus::cancelled) || stored == name(RunStatus::failed);
  shown["judged"] = nullptr;
  if (stored == now || only_the_run_knows) {
    return;
  }
  const std::string both =
      std::filesystem::path(file).filename().string() + " says " + stored + "; judged now: " + now;
  shown["status"] = now;
  shown["judged"] = both;
  shown["message"] = both + (why.empty() ? "" : ": " + why);
}

Json metrics_now(const Json& stored, const Json& now) {
  Json metrics = metrics_scene(stored);
  if (!metrics.is_null()) {  // those of the search, which the judge cannot know, stay
    metrics.update(now);
  }
  return metrics;
}
}  // namespace altiplan::host
