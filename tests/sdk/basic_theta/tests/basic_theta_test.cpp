// SPDX-License-Identifier: Apache-2.0
#include "../basic_theta.cpp"

#include <altiplan/conformance_gtest.hpp>

int main(int argc, char** argv) {
  using namespace altiplan::conformance;
  std::size_t count = 0;
  register_cases("basic_theta", plugin_cases(*altiplan_plugins(&count)[0]));
  for (const double edge : {50.0, 25.0}) {
    const auto make = [=] { return std::make_unique<BasicTheta>(Params{Vec3::Constant(edge)}); };
    register_cases("cells of " + std::to_string(int(edge)) + " m", planner_cases(make));
  }
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
