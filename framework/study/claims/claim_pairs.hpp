// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "study/claims/claim_text.hpp"
#include "study/model/study_data.hpp"

namespace altiplan::study {

/// The expression of a claim over the pairs of a study.
struct ClaimPairs {
  std::vector<double> results;         ///< one per counted pair
  std::vector<std::size_t> scenarios;  ///< the scenario of each
  std::size_t all = 0;                 ///< pairs with at least one run
  bool repeat_themselves = false;      ///< of each scenario one counts: its repetitions are equal
  std::size_t whole = 0;               ///< pairs with runs of all pipelines named
  std::vector<std::size_t> missing;    ///< pairs without it, one per value of the quantity
  std::size_t undefined = 0;  ///< pairs with all values whose result is undefined, such as 0 / 0
};

/// The expression's value; `values` has one entry per value of the quantity. NaN operands give NaN,
/// in comparisons too.
double evaluate(const ClaimExpression& expression, const std::vector<double>& values);

/// Whether equal repetitions are one pair.
enum class EqualRepetitions { count_once, count_each };

/// A pair counts if every named value is a number; one of each scenario if all pipelines named
/// repeat_themselves and these `count_once`. `p.solved and …` is false if p did not solve:
/// other values of p are then not needed.
ClaimPairs pairs_of(const StudyData& data, const ClaimQuantity& quantity,
                    EqualRepetitions equal = EqualRepetitions::count_once);
}  // namespace altiplan::study
