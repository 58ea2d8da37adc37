// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "study/claims/claim_text.hpp"
#include "study/model/study_data.hpp"

namespace altiplan::study {

/// The expression of a claim over the pairs of a study.
struct ClaimPairs {
  std::vector<double> results;         ///< one per pair that counts
  std::vector<std::size_t> scenarios;  ///< the scenario of each
  std::size_t all = 0;                 ///< pairs of which there is any run
  std::vector<std::size_t> missing;    ///< pairs without it, one per value of the quantity
  std::size_t undefined = 0;           ///< pairs that have all values, and give 0 / 0 or the like
};

/// The expression's value; `values` has one entry per value of the quantity. What compares NaN, or
/// comes of it, is NaN.
double evaluate(const ClaimExpression& expression, const std::vector<double>& values);

/// A pair counts where every value named has a number. `p.solved and …` is false where p did not
/// solve: other values of p are then not asked for.
ClaimPairs pairs_of(const StudyData& data, const ClaimQuantity& quantity);
}  // namespace altiplan::study
