// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "host/plugins/registry.hpp"

namespace altiplan::bench {

/// Rows on the worlds of paper 002: searches within its angle limits, and bidirectional compared
/// with unidirectional search. Throws WrongAnswer if two that must agree do not.
void add_paper_rows(const std::shared_ptr<host::Registry>& registry);
}  // namespace altiplan::bench
