// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "host/base/words.hpp"
#include "study/claims/claim_pairs.hpp"
#include "study/claims/claim_text.hpp"
#include "study/reproduce/figure_text.hpp"
#include "study/reproduce/reproduce.hpp"
#include "study/statistics/clustered.hpp"

namespace altiplan::study {
namespace {
using Function = ClaimQuantity::Function;

ClaimQuantity quantity_of(const StudyData& data, const ClaimEntry& claim) {
  std::vector<std::string> names;
  for (const StoredVariant& pipeline : data.pipelines) {
    names.push_back(pipeline.name);
  }
  return read_quantity(claim.that, names);
}

/// Where the figure of all documented runs may lie, given that of a part of them.
struct RangeOfWhole {
  std::optional<Interval> range;  ///< nothing if the part is too small
  std::string why_none;
};

/// An extreme of a part is no farther out than that of the whole.
RangeOfWhole range_of_whole(const StudyData& data, const ClaimQuantity& quantity,
                            const JudgedClaim& found) {
  if (!std::isfinite(found.estimate)) {
    return {std::nullopt, found.why_no_interval};
  }
  if (quantity.function == Function::min) {
    return {Interval{-kInfinity, found.estimate}, ""};
  }
  if (quantity.function == Function::max) {
    return {Interval{found.estimate, kInfinity}, ""};
  }
  if (quantity.function == Function::quantile && found.interval) {
    // A bootstrap does not see beyond the sample, where a far quantile of a small one lies.
    const Units units = units_of(pairs_of(data, quantity).scenarios);
    const std::size_t fewest = fewest_units(kSampleConfidence, quantity.q);
    if (units.count < fewest) {
      return {std::nullopt, std::string("too few ") +
                                (units.of_scenarios ? "scenarios" : "repetitions") + ": at least " +
                                std::to_string(fewest) + " for " +
                                host::per_cent(kSampleConfidence)};
    }
  }
  return {found.interval, found.why_no_interval};
}

/// True for a mean of equal values, whose bootstrap has no width though others may be rare.
bool sees_no_variation(const ClaimQuantity& quantity, const std::optional<Interval>& range) {
  return quantity.function == Function::mean && range && range->low == range->high;
}

ReproducedFigure compare_sample(const StudyData& data, const ClaimQuantity& quantity,
                                const JudgedClaim& sampled, ReproducedFigure result) {
  const PrintedFigure printed = *read_figure(result.figure->documentation);
  const RangeOfWhole whole = range_of_whole(data, quantity, sampled);
  const bool is_within = whole.range && printed.is_within(*whole.range);
  if (!is_within && sees_no_variation(quantity, whole.range)) {
    result.mark = Mark::too_few;
    result.why = "too few: all values are equal";
    return result;
  }
  result.mark = !whole.range ? Mark::too_few : is_within ? Mark::within : Mark::differs;
  result.why = whole.range ? printed.range(*whole.range) : whole.why_none;
  return result;
}

ReproducedFigure compare_verdict(const PaperFigure& figure, const JudgedClaim& found,
                                 Function function, bool is_sample) {
  ReproducedFigure result{&figure, std::string(name_of(found.verdict)), Mark::equal, ""};
  const bool is_equal = result.here == figure.documentation;
  if (found.measured) {
    result.mark = Mark::time;
  } else if (!is_sample) {
    result.mark = is_equal ? Mark::equal : Mark::differs;
  } else if (!is_equal) {
    // An undecided or missing verdict contradicts none, nor does an extreme that only a part of the
    // runs keeps.
    const bool is_extreme = function == Function::min || function == Function::max;
    const bool contradicts =
        figure.documentation == "holds"
            ? found.verdict == Verdict::fails
            : figure.documentation == "fails" && found.verdict == Verdict::holds && !is_extreme;
    result.mark = contradicts ? Mark::differs : Mark::too_few;
  }
  return result;
}
}  // namespace

const char* name(Mark mark) {
  constexpr const char* kNames[] = {"equal", "within", "time", "too few", "DIFFERS"};
  return kNames[std::size_t(mark)];
}

ReproducedFigure compare_figure(const StudyData& data, const PaperFigure& figure, bool is_sample) {
  const JudgedClaim found = judge_claim(data, figure.claim);
  const ClaimQuantity quantity = quantity_of(data, figure.claim);
  if (figure.is_verdict) {
    return compare_verdict(figure, found, quantity.function, is_sample);
  }
  const PrintedFigure printed = *read_figure(figure.documentation);
  const bool is_share = quantity.function == Function::share;
  const bool counts_pairs = printed.form == PrintedFigure::Form::count && !is_share;
  ReproducedFigure result{&figure, printed.of(found, is_share), Mark::equal, ""};
  if (found.measured && !counts_pairs) {
    result.mark = Mark::time;
    return result;
  }
  if (!is_sample) {
    result.mark = result.here == figure.documentation ? Mark::equal : Mark::differs;
    return result;
  }
  if (counts_pairs) {
    const auto interval =
        wilson(std::int64_t(found.used), std::int64_t(found.pairs), kSampleConfidence);
    result.mark = !interval                      ? Mark::too_few
                  : printed.is_within(*interval) ? Mark::within
                                                 : Mark::differs;
    result.why = interval ? printed.range(*interval) : "";
    return result;
  }
  ClaimEntry wide = figure.claim;
  wide.confidence = kSampleConfidence;
  return compare_sample(data, quantity, figure.of_claim ? judge_claim(data, wide) : found,
                        std::move(result));
}
}  // namespace altiplan::study
