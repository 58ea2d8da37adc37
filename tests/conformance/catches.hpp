// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "altiplan/conformance.hpp"

namespace altiplan::conformance {

/// Runs the cases and expects a finding of the law that begins with `law`: what is broken on
/// purpose must be caught, and for the reason that it is broken.
inline void expect_caught(const std::string& what, const Cases& cases, const std::string& law) {
  std::string found;
  for (const Case& one : cases) {
    for (const Finding& finding : one.run()) {
      EXPECT_FALSE(finding.message.empty()) << finding.law;
      if (finding.law.starts_with(law)) {
        return;
      }
      found += "\n  " + one.name + ": " + finding.law + ": " + finding.message;
    }
  }
  ADD_FAILURE() << what << ": nothing of '" << law << "' was found, but" << found;
}

/// Expects not a single finding.
inline void expect_clean(const std::string& what, const Cases& cases) {
  for (const Case& one : cases) {
    for (const Finding& finding : one.run()) {
      ADD_FAILURE() << what << ", " << one.name << ": " << finding.law << ": " << finding.message;
    }
  }
}
}  // namespace altiplan::conformance
