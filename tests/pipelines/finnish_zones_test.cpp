// SPDX-License-Identifier: Apache-2.0
// Real airspace of southern Finland: a route from the west of Helsinki-Vantaa to its east.
#include <gtest/gtest.h>

#include "altiplan/geometry.hpp"
#include "support/files.hpp"
#include "support/support.hpp"

namespace altiplan::testing::finnish_zones_test {
namespace {

host::Json flown_over_finland(const TempFolder& folder, const std::string& data,
                              const std::string& height) {
  folder.write("s.yaml",
               "altiplan: 1\nframe: {origin_lonlat: [24.0, 60.15]}\nenvironment:\n"
               "  - zones: {file: " +
                   data +
                   "/finland_rajoitukset.geojson, clip: true}\n"
                   "  - zones:\n      file: " +
                   data +
                   "/finland_valvottu.geojson\n      type_property: type\n"
                   "      types: [{is: L, floor_m: 50}]\n      clip: true\n"
                   "volume: {min_m: [0, -40000, " +
                   height +
                   "], max_m: [140000, 40000, 400]}\n"
                   "vehicle: {radius_m: 5}\nstart: {at_lonlat: [24.5, 60.3, " +
                   height + "]}\ngoal: {at_lonlat: [25.4, 60.3, " + height +
                   "], tolerance_m: 100}\n");
  const Ran ran = run_file(folder.write("p.yaml",
                                        "altiplan: 1\nscenario: s.yaml\nsteps:\n  - plan: astar\n"
                                        "    with: {cell_m: [500, 500, 20]}\n  - smooth: prune\n"));
  EXPECT_EQ(ran.exit_code, 0) << ran.json.at("message");
  return ran.json;
}

// At 100 m the controlled zones of Helsinki-Vantaa are closed; at 40 m, below their floor, they are
// open, and the way is shorter.
TEST(FinnishZones, ARouteGoesAroundThem) {
  ALTIPLAN_DATA_OR_SKIP(data, "city");
  const TempFolder folder;
  const host::Json high = flown_over_finland(folder, data.string(), "100");
  const host::Json low = flown_over_finland(folder, data.string(), "40");
  for (const host::Json& json : {high, low}) {
    EXPECT_EQ(json.at("status"), "solved");
    EXPECT_GE(json.at("metrics").at("min_clearance_m"), 5);
  }
  EXPECT_EQ(low.at("route").size(), 2U);  // straight
  EXPECT_GT(high.at("route").size(), 2U);
  EXPECT_GT(high.at("metrics").at("length_m"),
            1.05 * low.at("metrics").at("length_m").get<double>());
}
}  // namespace
}  // namespace altiplan::testing::finnish_zones_test
