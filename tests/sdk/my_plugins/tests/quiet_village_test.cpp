// SPDX-License-Identifier: Apache-2.0
#include "../quiet_village/quiet_village.cpp"

#include <altiplan/conformance_gtest.hpp>

int main(int argc, char** argv) {
  using namespace altiplan::conformance;
  const auto make = [](double min_m) {
    return [min_m] {
      Params params;
      params.at_m = {400, 300};
      params.radius_m = 200;
      params.min_m = min_m;
      return std::make_unique<QuietVillage>(params);
    };
  };
  register_cases("quiet_village", constraint_cases(make(150), make(200)));
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
