// SPDX-License-Identifier: Apache-2.0
#include "altiplan/api.hpp"

#include <gtest/gtest.h>

#if !ALTIPLAN_API_AT_LEAST(ALTIPLAN_API_MAJOR, ALTIPLAN_API_MINOR) || !ALTIPLAN_API_AT_LEAST(1, 0)
#error "an API is at least itself, and at least the first"
#endif
#if ALTIPLAN_API_AT_LEAST(ALTIPLAN_API_MAJOR, ALTIPLAN_API_MINOR + 1) || \
    ALTIPLAN_API_AT_LEAST(ALTIPLAN_API_MAJOR + 1, 0)
#error "an API is no later one"
#endif

namespace api_test {

constexpr int kMajor = ALTIPLAN_API_MAJOR;
constexpr int kMinor = ALTIPLAN_API_MINOR;

TEST(Api, AtLeastComparesTheMajorFirst) {
  EXPECT_TRUE(ALTIPLAN_API_AT_LEAST(kMajor - 1, kMinor + 1));
  EXPECT_TRUE(ALTIPLAN_API_AT_LEAST(kMajor, kMinor - 1));
  EXPECT_FALSE(ALTIPLAN_API_AT_LEAST(kMajor + 1, kMinor - 1));
}
}  // namespace api_test
