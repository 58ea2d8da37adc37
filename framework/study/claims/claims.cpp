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

double estimate_of(const ClaimQuantity& quantity, const std::vector<double>& results) {
  switch (quantity.function) {
    case Function::quantile:
      return quantile(results, quantity.q);
    case Function::min:
      return *std::min_element(results.begin(), results.end());
    case Function::max:
      return *std::max_element(results.begin(), results.end());
    case Function::mean:
    case Function::share:
      break;
  }
  return mean(results);
}

/// True if it is a value that is 0 or 1.
bool is_success(const ClaimExpression& expression, const ClaimQuantity& quantity) {
  return expression.kind == ClaimExpression::Kind::value &&
         is_yes_or_no(quantity.values[expression.value].name);
}

/// A mean of successes is a share, and one of their differences the difference of two: of equal
/// values too, these have intervals of some width.
MadeInterval interval_of_mean(const ClaimQuantity& quantity, const ClaimPairs& pairs,
                              double confidence, std::size_t fewest) {
  const ClaimExpression& of = quantity.expression;
  if (is_success(of, quantity)) {
    return share_interval(pairs.results, pairs.scenarios, confidence);
  }
  if (of.kind == ClaimExpression::Kind::subtract && is_success(of.operands[0], quantity) &&
      is_success(of.operands[1], quantity)) {
    return difference_interval(pairs.results, pairs.scenarios, confidence);
  }
  return mean_interval(pairs.results, pairs.scenarios, confidence, fewest);
}

/// Without interval or reason for an extreme. `fewest`: the minimum number of units for a mean.
MadeInterval interval_of(const ClaimQuantity& quantity, const ClaimPairs& pairs, double confidence,
                         std::size_t fewest) {
  switch (quantity.function) {
    case Function::min:
    case Function::max:
      return {};
    case Function::share:
      return share_interval(pairs.results, pairs.scenarios, confidence);
    case Function::mean:
      return interval_of_mean(quantity, pairs, confidence, fewest);
    case Function::quantile:
      break;
  }
  return quantile_interval(pairs.results, pairs.scenarios, quantity.q, confidence);
}

void find_interval(const ClaimQuantity& quantity, const ClaimPairs& pairs, JudgedClaim& judged) {
  const bool is_extreme = quantity.function == Function::min || quantity.function == Function::max;
  if (!is_extreme && !std::isfinite(judged.estimate)) {
    judged.why_no_interval = "too many values are infinite";  // something over zero
    return;
  }
  const double confidence = judged.claim.confidence;
  const MadeInterval made = interval_of(quantity, pairs, confidence, fewest_for_mean(confidence));
  judged.interval = made.interval;
  judged.method = made.method;
  judged.why_no_interval = made.why_none;
  judged.has_too_few = made.why_none.starts_with("too few");
}

Verdict verdict_of(const ClaimRange& range, const std::optional<Interval>& interval) {
  if (!interval) {
    return Verdict::undecided;
  }
  const auto [low, high] = *interval;
  if (range.contains(low) && range.contains(high)) {
    return Verdict::holds;
  }
  return range.meets(low, high) ? Verdict::undecided : Verdict::fails;
}

/// The least 1 - confidence of an interval that decides the claim: 1e-9 or less is 1e-9. There are
/// enough units for a mean if there are for the claim itself.
double p_of(const ClaimQuantity& quantity, const ClaimPairs& pairs, const ClaimRange& range) {
  const auto is_decided = [&](double log_p) {
    const double confidence = 1 - std::pow(10, log_p);
    return verdict_of(range, interval_of(quantity, pairs, confidence, 0).interval) !=
           Verdict::undecided;
  };
  double undecided = -9;
  double decided = -1e-6;
  if (is_decided(undecided)) {
    return std::pow(10, undecided);
  }
  if (!is_decided(decided)) {
    return 1;
  }
  for (int step = 0; step < 24; ++step) {
    const double middle = (undecided + decided) / 2;
    (is_decided(middle) ? decided : undecided) = middle;
  }
  return std::pow(10, decided);
}

std::string stated_of(const StudyData& data, const ClaimEntry& claim) {
  const auto found = data.statements.find(claim.id);
  if (found == data.statements.end() || found->second.runs == 0) {
    return "";
  }
  return std::string(found->second.changed ? "changed" : "added") + " after " +
         host::counted(found->second.runs, "run");
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
  judged.stated = stated_of(data, claim);
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
      judged.estimate = estimate_of(quantity, pairs.results);
      find_interval(quantity, pairs, judged);
      if (quantity.function == Function::min || quantity.function == Function::max) {
        judged.verdict = range.contains(judged.estimate) ? Verdict::holds : Verdict::fails;
      } else {
        judged.verdict = verdict_of(range, judged.interval);
        judged.p = judged.interval ? p_of(quantity, pairs, range) : kNone;
      }
    }
    say(judged, range, quantity, pairs, data);
  } catch (const Error& error) {
    judged.words =
        host::sentence("No data: the claim cannot be read: " + std::string(error.what()));
    judged.reasons = host::sentence("The claim cannot be read: " + std::string(error.what()));
  }
  return judged;
}

std::vector<JudgedClaim> judge_claims(const StudyData& data) {
  std::vector<JudgedClaim> all;
  for (const ClaimEntry& claim : data.file.claims) {
    all.push_back(judge_claim(data, claim));
  }
  adjust(all);
  return all;
}

void adjust(std::vector<JudgedClaim>& claims) {
  std::vector<double> p;
  for (const JudgedClaim& judged : claims) {
    p.push_back(judged.p);
  }
  const std::vector<double> adjusted = holm(p);
  for (std::size_t at = 0; at < claims.size(); ++at) {
    claims[at].p_holm = adjusted[at];
  }
}

bool becomes_undecided(const JudgedClaim& judged) {
  const bool is_decided = judged.verdict == Verdict::holds || judged.verdict == Verdict::fails;
  return is_decided && !std::isnan(judged.p) && judged.p_holm > 1 - judged.claim.confidence;
}

std::string multiplicity(const std::vector<JudgedClaim>& claims) {
  std::size_t tested = 0;
  std::size_t decided = 0;
  std::string lost;
  for (const JudgedClaim& judged : claims) {
    tested += std::isnan(judged.p) ? 0 : 1;
    const bool is_decided = !std::isnan(judged.p) &&
                            (judged.verdict == Verdict::holds || judged.verdict == Verdict::fails);
    decided += is_decided ? 1 : 0;
    if (becomes_undecided(judged)) {
      lost += (lost.empty() ? "" : ", ") + judged.claim.id + " (p " +
              host::with_digits(judged.p, 2) + ", adjusted " + host::with_digits(judged.p_holm, 2) +
              ")";
    }
  }
  if (tested < 2 || decided == 0) {
    return "";
  }
  return "Each verdict is of its claim alone; with Holm's correction over all " +
         std::to_string(tested) + " that have an interval " +
         (lost.empty() ? "all decided ones stay decided."
                       : "these become undecided: " + lost + ".");
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
}  // namespace altiplan::study
