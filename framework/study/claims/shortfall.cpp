// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "host/base/words.hpp"
#include "study/claims/claims.hpp"
#include "study/statistics/clustered.hpp"

namespace altiplan::study {
namespace {

/// The verdicts that a share may get from so many units of which some number succeed.
class Verdicts {
 public:
  Verdicts(const ClaimRange& range, double confidence) : range_(range), confidence_(confidence) {}

  bool may_fail(std::size_t units) const {
    return !meets(interval(0, units)) || !meets(interval(units, units));
  }
  /// If all succeed or all fail.
  bool may_hold_agreeing(std::size_t units) const {
    return contains(interval(0, units)) || contains(interval(units, units));
  }
  /// Both ends grow with the number of successes: of the intervals that begin in the range, the
  /// first ends first.
  bool may_hold(std::size_t units) const {
    std::size_t below = 0;
    std::size_t first = units + 1;
    while (below < first) {
      const std::size_t middle = (below + first) / 2;
      const double low = interval(middle, units).low;
      if (low > range_.low || (range_.low_counts && low == range_.low)) {
        first = middle;
      } else {
        below = middle + 1;
      }
    }
    return first <= units && contains(interval(first, units));
  }

 private:
  Interval interval(std::size_t successes, std::size_t units) const {
    return wilson(double(successes), double(units), confidence_).value_or(Interval{0, 1});
  }
  bool contains(const Interval& interval) const {
    return range_.contains(interval.low) && range_.contains(interval.high);
  }
  bool meets(const Interval& interval) const { return range_.meets(interval.low, interval.high); }

  const ClaimRange& range_;
  double confidence_;
};

constexpr std::size_t kMaxUnits = 10'000;

/// The first number of units from `min_units` on for which the condition is met; kMaxUnits if none.
template <class Condition>
std::size_t first_from(std::size_t min_units, const Condition& is_met) {
  while (min_units < kMaxUnits && !is_met(min_units)) {
    ++min_units;
  }
  return min_units;
}

std::string too_few(const Units& units) {
  return std::string("too few ") + (units.of_scenarios ? "scenarios" : "repetitions") + ": ";
}

/// Of independent pairs, the interval is Wilson's.
std::string of_independent(const Verdicts& verdicts, const Units& units,
                           const std::string& confidence) {
  if (verdicts.may_hold(units.count)) {
    return "";
  }
  const auto holds = [&](std::size_t n) { return verdicts.may_hold(n); };
  if (!verdicts.may_fail(units.count)) {
    const std::size_t enough = first_from(
        units.count, [&](std::size_t n) { return verdicts.may_fail(n) || verdicts.may_hold(n); });
    return "will be undecided: " + too_few(units) + "at least " + std::to_string(enough) +
           confidence;
  }
  const std::size_t enough = first_from(units.count, holds);
  return enough < kMaxUnits
             ? "cannot hold: " + too_few(units) + std::to_string(enough) + " would do" + confidence
             : "cannot hold: the interval of a share is too wide, even of " +
                   std::to_string(kMaxUnits) + (units.of_scenarios ? " scenarios" : " repetitions");
}

/// With repetitions, the interval is Wilson's of the scenarios if all agree, else at best that of
/// as many independent pairs.
std::string of_repeated(const Verdicts& verdicts, const Units& units, std::size_t pairs,
                        const std::string& confidence) {
  const auto is_decided = [&](std::size_t n) {
    const std::size_t repeated = n * pairs / units.count;
    return verdicts.may_hold_agreeing(n) || verdicts.may_hold(repeated) ||
           verdicts.may_fail(repeated);
  };
  if (is_decided(units.count)) {
    return "";
  }
  return "will be undecided: " + too_few(units) + "at least " +
         std::to_string(first_from(units.count, is_decided)) + confidence;
}
}  // namespace

std::string shortfall(const ClaimEntry& claim, const ClaimQuantity& quantity,
                      std::span<const std::size_t> groups) {
  using Function = ClaimQuantity::Function;
  if (groups.empty() || quantity.function == Function::min || quantity.function == Function::max) {
    return "";
  }
  const Units units = units_of(groups);
  if (quantity.function != Function::share) {
    const std::size_t fewest = quantity.function == Function::mean
                                   ? fewest_for_mean(claim.confidence)
                                   : fewest_units(claim.confidence, quantity.q);
    const std::string why = why_no_interval(units, claim.confidence, fewest);
    return why.empty() ? "" : "will be undecided: " + why;
  }
  const ClaimRange range = read_range(claim.is);
  const Verdicts verdicts(range, claim.confidence);
  const std::string confidence = " for " + host::per_cent(claim.confidence);
  return units.count == groups.size() ? of_independent(verdicts, units, confidence)
                                      : of_repeated(verdicts, units, groups.size(), confidence);
}
}  // namespace altiplan::study
