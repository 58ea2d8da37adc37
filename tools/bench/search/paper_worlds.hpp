// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace altiplan::bench {

/// Rows on the worlds of paper 002: the searches within its angle limits, and both ways beside one
/// way. Throws Error where two that must agree do not.
void add_paper_rows();
}  // namespace altiplan::bench
