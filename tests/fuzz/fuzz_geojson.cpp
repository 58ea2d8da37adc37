// SPDX-License-Identifier: Apache-2.0
// The zones' reader of GeoJSON. The bits of the first byte say which properties are asked for.
#include "altiplan/error.hpp"
#include "environment/zones/geojson.hpp"
#include "fuzz/memory_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) {
    return 0;
  }
  static const altiplan::fuzz::MemoryFolder kFolder;
  const auto asked = [&](int bit, const char* name) {
    return (data[0] >> bit & 1) != 0 ? name : "";
  };
  const altiplan::zones::PropertyNames names = {asked(0, "floor"), asked(1, "ceiling"),
                                                asked(2, "from"), asked(3, "until")};
  const auto file =
      kFolder.write("zones.geojson", altiplan::fuzz::text_of(data + 1, size - 1)).string();
  try {
    altiplan::zones::read_geojson(file, names);
  } catch (const altiplan::Error&) {
  }
  return 0;
}
