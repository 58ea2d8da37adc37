// SPDX-License-Identifier: Apache-2.0
#include "@name@.cpp"  // a plugin has no header: only its name is exported

#include <altiplan/conformance_gtest.hpp>

int main(int argc, char** argv) {
  using namespace altiplan::conformance;
  std::size_t count = 0;
  register_cases("@name@", plugin_cases(*altiplan_plugins(&count)[0]));
  const auto make = [](double min_m) {
    return [min_m](const Site&) {
      Params params;
      params.min_m = min_m;
      return std::make_unique<QuietPlace>(params);
    };
  };
  register_cases("@name@", constraint_cases(make(300), make(400)));  // the second is stricter
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
