// SPDX-License-Identifier: Apache-2.0
#include "../dogleg/dogleg.cpp"  // a plugin has no header: only its name is exported

#include <altiplan/conformance_gtest.hpp>

int main(int argc, char** argv) {
  using namespace altiplan::conformance;
  std::size_t count = 0;
  register_cases("dogleg", plugin_cases(*altiplan_plugins(&count)[0]));
  register_cases("dogleg", planner_cases([] { return std::make_unique<Dogleg>(Params{}); }));
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
