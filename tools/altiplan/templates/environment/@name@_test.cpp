// SPDX-License-Identifier: Apache-2.0
#include "@name@.cpp"  // a plugin has no header: only its name is exported

#include <altiplan/conformance_gtest.hpp>

int main(int argc, char** argv) {
  using namespace altiplan::conformance;
  std::size_t count = 0;
  const altiplan::PluginEntry& plugin = *altiplan_plugins(&count)[0];
  register_cases("@name@", plugin_cases(plugin));
  Setup setup;
  setup.options.volume = altiplan::Box{{-150, -150, 0}, {650, 350, 250}};  // the sampled box
  register_cases("@name@", cases_of(plugin, setup));
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
