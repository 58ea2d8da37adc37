// SPDX-License-Identifier: Apache-2.0
#include "study/model/outcome.hpp"

#include <algorithm>
#include <array>

namespace altiplan::study {
namespace {

// In the order of the outcomes.
constexpr std::array kNames = {"solved",          "no_route",       "timed_out",     "cancelled",
                               "invalid_problem", "rejected",       "failed",        "collided",
                               "not_reached",     "crashed",        "out_of_memory", "bad_output",
                               "refused",         "bad_parameters", "not done",      "changed"};
static_assert(kNames.size() == std::size_t(Outcome::changed) + 1);
}  // namespace

Outcome outcome_of(host::RunStatus status) { return *outcome_named(host::name(status)); }

const char* name(Outcome outcome) { return kNames[std::size_t(outcome)]; }

std::optional<Outcome> outcome_named(std::string_view word) {
  const auto found = std::find(kNames.begin(), kNames.end(), word);
  return found == kNames.end() ? std::nullopt : std::optional(Outcome(found - kNames.begin()));
}
}  // namespace altiplan::study
