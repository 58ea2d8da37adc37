// SPDX-License-Identifier: Apache-2.0
// A program one of whose files uses these has an operator new that counts.
#pragma once

namespace altiplan::testing {
extern bool counting;
extern long allocations;  // while `counting`
}  // namespace altiplan::testing
