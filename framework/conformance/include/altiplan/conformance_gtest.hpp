// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "altiplan/conformance.hpp"

namespace altiplan::conformance {

/// One GoogleTest case, which fails once for each finding.
class GTestCase : public ::testing::Test {
 public:
  explicit GTestCase(Case the_case) : case_(std::move(the_case)) {}
  void TestBody() override {
    for (const Finding& finding : case_.run()) {
      ADD_FAILURE() << finding.contract << "\n  " << finding.message;
    }
  }

 private:
  Case case_;
};

/// To be called before RUN_ALL_TESTS.
inline void register_cases(const std::string& suite, const Cases& cases) {
  for (const Case& one : cases) {
    ::testing::RegisterTest(suite.c_str(), one.name.c_str(), nullptr, nullptr, __FILE__, __LINE__,
                            [one]() -> GTestCase* { return new GTestCase(one); });
  }
}
}  // namespace altiplan::conformance
