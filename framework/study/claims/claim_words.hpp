// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "study/claims/claim_pairs.hpp"
#include "study/claims/claims.hpp"

namespace altiplan::study {

/// Fills in the sentences of the verdict and its basis: `words` and `reasons`.
void say(JudgedClaim& judged, const ClaimRange& range, const ClaimQuantity& quantity,
         const ClaimPairs& pairs, const StudyData& data);
}  // namespace altiplan::study
