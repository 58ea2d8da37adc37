// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "host/study/statistics/claim_pairs.hpp"
#include "host/study/statistics/claims.hpp"

namespace altiplan::host {

/// "1 pair", "2 pairs".
std::string counted(std::size_t count, std::string_view what);

/// The text with a full stop, unless it ends in a question.
std::string sentence(const std::string& text);

/// "95 %", "99.9 %".
std::string per_cent(double confidence);

/// Fills in the verdict with all that it rests on, in sentences: `words` and `reasons`.
void say(JudgedClaim& judged, const ClaimRange& range, const ClaimQuantity& quantity,
         const ClaimPairs& pairs, const StudyData& data);
}  // namespace altiplan::host
