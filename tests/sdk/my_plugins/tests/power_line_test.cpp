// SPDX-License-Identifier: Apache-2.0
#include "../power_line/power_line.cpp"

#include <altiplan/conformance_gtest.hpp>

int main(int argc, char** argv) {
  using namespace altiplan::conformance;
  const auto make = [](const Site& site) {
    Params params;
    params.towers_m = {{100, 100}, {500, 200}, {400, 600}};
    return std::make_unique<PowerLine>(params, site);
  };
  Options options;
  options.volume = Box{{0, 0, 0}, {800, 800, 150}};
  register_cases("power_line", environment_cases(make, options));
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
