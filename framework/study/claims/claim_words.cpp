// SPDX-License-Identifier: Apache-2.0
#include "study/claims/claim_words.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>

#include "host/base/words.hpp"
#include "host/config/config_check.hpp"

namespace altiplan::study {
namespace {

/// The number with enough digits to show on which side of the range's ends it lies: 0.95004 is not
/// printed as 0.95 if the end of the range is 0.95.
std::string shown(double number, const ClaimRange& range) {
  constexpr int kAll = 17;
  const bool is_large = std::abs(number) >= 1e4 && std::abs(number) < 1e15;
  for (int digits = is_large ? int(std::log10(std::abs(number))) + 1 : 4; digits < kAll; ++digits) {
    const std::string text = host::with_digits(number, digits);
    double rounded = 0;
    std::from_chars(text.data(), text.data() + text.size(), rounded);
    const bool is_same_side = (rounded < range.low) == (number < range.low) &&
                              (rounded > range.high) == (number > range.high) &&
                              range.contains(rounded) == range.contains(number);
    if (is_same_side) {
      return text;
    }
  }
  return host::with_digits(number, kAll);
}

std::string name_of(const ClaimValue& value, const StudyData& data) {
  return data.pipelines[value.pipeline].name + "." + value.name;
}

/// The values that runs of the pipeline have.
std::vector<std::string> values_of(std::size_t pipeline, const StudyData& data) {
  std::vector<std::string> names{"solved"};
  for (std::size_t at = 0; at < data.columns.size(); ++at) {
    const auto has = [&](const RunRow& row) {
      return row.pipeline == pipeline && at < row.values.size() && !std::isnan(row.values[at]);
    };
    if (std::any_of(data.rows.begin(), data.rows.end(), has)) {
      names.push_back(data.columns[at]);
    }
  }
  return names;
}

/// Why no pair counts: the values that no run has, or how many runs of each pipeline have them.
std::string why_no_data(const ClaimQuantity& quantity, const ClaimPairs& pairs,
                        const StudyData& data) {
  if (pairs.all == 0) {
    return "the study has no runs yet";
  }
  std::string words;
  for (const ClaimValue& value : quantity.values) {
    const std::vector<std::string> own = values_of(value.pipeline, data);
    if (std::find(own.begin(), own.end(), value.name) == own.end()) {
      const bool has_any = data.column(value.name) < data.columns.size();
      words += (words.empty() ? "no run" : "; no run") +
               (has_any ? " of '" + data.pipelines[value.pipeline].name + "'" : "") +
               " has a value '" + value.name + "'" + host::did_you_mean(value.name, own);
    }
  }
  if (words.empty()) {
    words = "no pair has all named values";
  }
  return words;
}

/// The estimate, its interval and their relation to the claim.
std::string result(const JudgedClaim& judged, const ClaimRange& range) {
  const std::string estimate = shown(judged.estimate, range);
  const std::string is = wanted(judged.claim);
  const bool satisfies = range.contains(judged.estimate);
  if (!judged.interval) {
    return judged.why_no_interval.empty()
               ? estimate + ", which is " + (satisfies ? "" : "not ") + is +
                     " (an extreme: of these runs only, without an interval)"
               : estimate + ", claimed was " + is + "; no interval" +
                     (judged.has_too_few ? "" : ", " + judged.why_no_interval);
  }
  const auto [low, high] = *judged.interval;
  const std::string interval = estimate + ", " + host::per_cent(judged.claim.confidence) +
                               " interval " + shown(low, range) + " to " + shown(high, range) +
                               " (" + judged.method + ")";
  switch (judged.verdict) {
    case Verdict::holds:
      return interval + "; all of it is " + is;
    case Verdict::fails:
      return interval + "; none of it is " + is;
    default:
      return interval + "; the estimate is " +
             (satisfies ? is + ", but part of the interval is not"
                        : "not " + is + ", but part of the interval is");
  }
}

/// The number of pairs that the claim is based on, and why others are missing.
std::string basis(const JudgedClaim& judged, const ClaimQuantity& quantity, const ClaimPairs& pairs,
                  const StudyData& data) {
  std::string words;
  const auto add = [&](const std::string& part) { words += (words.empty() ? "; " : ", ") + part; };
  for (std::size_t i = 0; i < quantity.values.size(); ++i) {
    if (pairs.missing[i] > 0) {
      add(name_of(quantity.values[i], data) + " has no number in " +
          std::to_string(pairs.missing[i]));
    }
  }
  if (pairs.undefined > 0) {
    add("the expression is not a number in " + std::to_string(pairs.undefined) +
        " (such as 0 / 0)");
  }
  if (pairs.repeat_themselves) {
    add("repetitions are equal and count once");
  }
  return std::to_string(judged.used) + " of " + host::counted(judged.pairs, "pair") + " counted" +
         words + ".";
}
}  // namespace

void say(JudgedClaim& judged, const ClaimRange& range, const ClaimQuantity& quantity,
         const ClaimPairs& pairs, const StudyData& data) {
  const bool has_data = judged.verdict != Verdict::no_data;
  const std::string found = has_data ? result(judged, range) : why_no_data(quantity, pairs, data);
  const std::string of = pairs.all == 0 ? "" : " " + basis(judged, quantity, pairs, data);
  std::string verdict(name_of(judged.verdict));
  verdict.front() = char(std::toupper(verdict.front()));
  std::string stated = judged.stated.empty() ? "" : " " + host::sentence(judged.stated);
  if (!stated.empty()) {
    stated[1] = char(std::toupper(stated[1]));
  }
  judged.words =
      host::sentence(verdict + ": " + (has_data ? judged.claim.that + " is " : "") + found) + of +
      stated;
  judged.reasons = host::sentence((has_data ? "Found: " : "") + found) + of + stated;
  judged.reasons.front() = char(std::toupper(judged.reasons.front()));
}

std::string wanted(const ClaimEntry& claim) {
  return (claim.is.find("..") == claim.is.npos ? "" : "within ") + claim.is;
}
}  // namespace altiplan::study
