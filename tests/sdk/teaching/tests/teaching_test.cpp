// SPDX-License-Identifier: Apache-2.0
#include "../teaching.cpp"

#include <altiplan/conformance_gtest.hpp>

int main(int argc, char** argv) {
  using namespace altiplan::conformance;
  std::size_t count = 0;
  register_cases("teaching", plugin_cases(*altiplan_plugins(&count)[0]));
  register_cases("fifty learners",
                 planner_cases([] { return std::make_unique<Teaching>(Params{}); }));
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
