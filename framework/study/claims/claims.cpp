// SPDX-License-Identifier: Apache-2.0
#include "study/claims/claims.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "host/base/words.hpp"
#include "study/claims/claim_pairs.hpp"
#include "study/claims/claim_words.hpp"
#include "study/statistics/clustered.hpp"

namespace altiplan::study {
namespace {
using Function = ClaimQuantity::Function;

std::vector<std::string> names_of(const std::vector<StoredVariant>& variants) {
  std::vector<std::string> names;
  for (const StoredVariant& variant : variants) {
    names.push_back(variant.name);
  }
  return names;
}

Statistic statistic_of(const ClaimQuantity& quantity) {
  switch (quantity.function) {
    case Function::quantile:
      return [q = quantity.q](std::span<double> sample) { return quantile_in_place(sample, q); };
    case Function::min:
      return
          [](std::span<double> sample) { return *std::min_element(sample.begin(), sample.end()); };
    case Function::max:
      return
          [](std::span<double> sample) { return *std::max_element(sample.begin(), sample.end()); };
    case Function::mean:
    case Function::share:
      break;
  }
  return [](std::span<double> sample) { return mean(sample); };
}

void find_interval(const StudyData& data, const ClaimQuantity& quantity, const ClaimPairs& pairs,
                   JudgedClaim& judged) {
  if (quantity.function == Function::min || quantity.function == Function::max) {
    return;
  }
  if (!std::isfinite(judged.estimate)) {
    judged.why_no_interval = "too many values are infinite";  // something over zero
    return;
  }
  const auto seed = static_cast<std::uint64_t>(data.file.seed);
  const double confidence = judged.claim.confidence;
  if (quantity.function == Function::share) {
    const auto found = share_interval(pairs.results, pairs.scenarios, seed, confidence);
    judged.interval = found.interval;
    judged.method = found.method;
  } else {
    judged.interval =
        bootstrap_interval(pairs.results, pairs.scenarios, statistic_of(quantity),
                           RandomStream(seed).sub("claim " + judged.claim.id), confidence);
    judged.method = judged.interval ? "bootstrap of " + units_of(pairs.scenarios).words() : "";
  }
  if (!judged.interval) {
    judged.why_no_interval = why_no_bootstrap(pairs.scenarios, confidence);
    judged.has_too_few = !judged.why_no_interval.empty();
    if (judged.why_no_interval.empty()) {
      judged.why_no_interval = "some resamples are not finite";
    }
  }
}

Verdict verdict_of(const ClaimQuantity& quantity, const ClaimRange& range,
                   const JudgedClaim& judged) {
  if (quantity.function == Function::min || quantity.function == Function::max) {
    return range.contains(judged.estimate) ? Verdict::holds : Verdict::fails;
  }
  if (!judged.interval) {
    return Verdict::undecided;
  }
  const auto [low, high] = *judged.interval;
  if (range.contains(low) && range.contains(high)) {
    return Verdict::holds;
  }
  return range.meets(low, high) ? Verdict::undecided : Verdict::fails;
}
}  // namespace

std::string_view name_of(Verdict verdict) {
  constexpr std::string_view kNames[] = {"holds", "fails", "undecided", "no data"};
  return kNames[std::size_t(verdict)];
}

std::vector<Problem> check_claim(const ClaimEntry& claim, const std::vector<std::string>& pipelines,
                                 const Location& that, const Location& is, const std::string& key) {
  std::vector<Problem> problems;
  try {
    read_quantity(claim.that, pipelines);
  } catch (const Error& error) {
    problems.push_back({that, key + ".that", error.what()});
  }
  try {
    read_range(claim.is);
  } catch (const Error& error) {
    problems.push_back({is, key + ".is", error.what()});
  }
  return problems;
}

JudgedClaim judge_claim(const StudyData& data, const ClaimEntry& claim) {
  JudgedClaim judged;
  judged.claim = claim;
  try {
    const std::vector<std::string> names = names_of(data.pipelines);
    const ClaimQuantity quantity = read_quantity(claim.that, names);
    const ClaimRange range = read_range(claim.is);
    const ClaimPairs pairs = pairs_of(data, quantity);
    judged.used = pairs.results.size();
    judged.pairs = pairs.all;
    judged.lacks_runs = pairs.all > 0 && pairs.whole == 0;
    judged.measured = std::any_of(quantity.values.begin(), quantity.values.end(),
                                  [](const ClaimValue& value) { return is_measured(value.name); });
    if (judged.used > 0) {
      std::vector<double> results = pairs.results;
      judged.estimate = statistic_of(quantity)(results);
      find_interval(data, quantity, pairs, judged);
      judged.verdict = verdict_of(quantity, range, judged);
    }
    say(judged, range, quantity, pairs, data);
  } catch (const Error& error) {
    judged.words =
        host::sentence("No data: the claim cannot be read: " + std::string(error.what()));
    judged.reasons = host::sentence("The claim cannot be read: " + std::string(error.what()));
  }
  return judged;
}

std::vector<std::string> common_reasons(const std::vector<JudgedClaim>& claims) {
  std::map<std::string, std::string> named;  // claims of each reason
  for (const JudgedClaim& judged : claims) {
    std::string reason;
    if (judged.lacks_runs) {
      reason = "No data, as no pair has runs of all pipelines named";
    } else if (judged.has_too_few) {  // "too few scenarios: at least 6 for 95 %"
      const std::string& why = judged.why_no_interval;
      const std::size_t colon = why.find(": ");
      reason = "Undecided, " + why.substr(0, colon) + " (" + why.substr(colon + 2) + ")";
    }
    if (!reason.empty()) {
      named[reason] += (named[reason].empty() ? "" : ", ") + judged.claim.id;
    }
  }
  std::vector<std::string> sentences;
  for (const auto& [reason, ids] : named) {
    sentences.push_back(host::sentence(reason + ": " + ids));
  }
  return sentences;
}

bool is_yes_or_no(std::string_view value) {
  const bool is_of_step = value.starts_with("steps.");
  return value == "solved" || value == "flight.reached" ||
         (is_of_step && (value.ends_with(".accepted") || value.ends_with(".budget_hit")));
}

bool is_of_every_run(std::string_view value) {
  return is_yes_or_no(value) || value == "flight.collisions" ||
         value == "flight.min_separation_m" || value == "peak_memory_mb";
}

bool is_measured(std::string_view value) {
  const bool is_of_flight = value == "time_s" || value == "flight.time_s";
  return (value.ends_with("time_s") && !is_of_flight) || value.ends_with("memory_mb");
}
}  // namespace altiplan::study
