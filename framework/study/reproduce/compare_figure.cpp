// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
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
RangeOfWhole range_of_whole(const ClaimQuantity& quantity, const JudgedClaim& found) {
  if (!std::isfinite(found.estimate)) {
    return {std::nullopt, found.why_no_interval};
  }
  if (quantity.function == Function::min) {
    return {Interval{-kInfinity, found.estimate}, ""};
  }
  if (quantity.function == Function::max) {
    return {Interval{found.estimate, kInfinity}, ""};
  }
  return {found.interval, found.why_no_interval};
}

ReproducedFigure compare_sample(const ClaimQuantity& quantity, const JudgedClaim& sampled,
                                ReproducedFigure result) {
  const PrintedFigure printed = *read_figure(result.figure->documentation);
  const RangeOfWhole whole = range_of_whole(quantity, sampled);
  // Of a mean of equal values there is no interval, though others may be rare.
  const bool is_equal =
      !sampled.has_too_few && printed.is_within({sampled.estimate, sampled.estimate});
  result.mark = whole.range ? (printed.is_within(*whole.range) ? Mark::within : Mark::differs)
                : is_equal  ? Mark::within
                            : Mark::too_few;
  result.why = whole.range ? printed.range(*whole.range) : whole.why_none;
  return result;
}

/// The documentation's figure; without one the form of the paper's, or of an own: a count of a
/// share, otherwise four digits.
PrintedFigure printed_of(const PaperFigure& figure, const ClaimQuantity& quantity,
                         const JudgedClaim& found) {
  for (const std::string& text : {figure.documentation, figure.paper}) {
    if (const std::optional<PrintedFigure> printed = read_figure(text)) {
      return *printed;
    }
  }
  PrintedFigure own;
  if (quantity.function == Function::share) {
    own.form = PrintedFigure::Form::count;
  } else if (std::isfinite(found.estimate) && found.estimate != 0) {
    const int whole = int(std::floor(std::log10(std::abs(found.estimate)))) + 1;
    own.estimate.decimals = std::clamp(4 - whole, 0, 12);
  }
  if (figure.of_claim && own.form == PrintedFigure::Form::number) {
    own.low = own.high = own.estimate;
  }
  return own;
}

ReproducedFigure compare_verdict(const PaperFigure& figure, const JudgedClaim& found,
                                 Function function, bool is_sample) {
  ReproducedFigure result{&figure, std::string(name_of(found.verdict)), Mark::equal, ""};
  if (figure.documentation.empty()) {
    result.mark = Mark::none;
    return result;
  }
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
  constexpr const char* kNames[] = {"equal",   "within",  "time",
                                    "too few", "DIFFERS", "not compared"};
  return kNames[std::size_t(mark)];
}

ReproducedFigure compare_figure(const StudyData& data, const PaperFigure& figure, bool is_sample) {
  JudgedClaim found = judge_claim(data, figure.claim);
  const ClaimQuantity quantity = quantity_of(data, figure.claim);
  if (figure.is_verdict) {
    return compare_verdict(figure, found, quantity.function, is_sample);
  }
  const PrintedFigure printed = printed_of(figure, quantity, found);
  const bool is_share = quantity.function == Function::share;
  const bool counts_pairs = printed.form == PrintedFigure::Form::count && !is_share;
  if (is_share && printed.form == PrintedFigure::Form::count) {
    // As the report's table of success: runs, which equal repetitions are too.
    const ClaimPairs all = pairs_of(data, quantity, EqualRepetitions::count_each);
    found.used = all.results.size();
    found.estimate = mean(all.results);
  }
  ReproducedFigure result{&figure, printed.of(found, is_share), Mark::equal, ""};
  if (figure.documentation.empty()) {
    result.mark = Mark::none;
    return result;
  }
  if (found.measured && !counts_pairs) {
    result.mark = Mark::time;
    return result;
  }
  if (!is_sample) {
    result.mark = result.here == figure.documentation ? Mark::equal : Mark::differs;
    return result;
  }
  if (counts_pairs) {
    const auto interval = wilson(double(found.used), double(found.pairs), kSampleConfidence);
    result.mark = !interval                      ? Mark::too_few
                  : printed.is_within(*interval) ? Mark::within
                                                 : Mark::differs;
    result.why = interval ? printed.range(*interval) : "";
    return result;
  }
  ClaimEntry wide = figure.claim;
  wide.confidence = kSampleConfidence;
  return compare_sample(quantity, figure.of_claim ? judge_claim(data, wide) : found,
                        std::move(result));
}
}  // namespace altiplan::study
