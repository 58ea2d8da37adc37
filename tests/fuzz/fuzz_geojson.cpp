// SPDX-License-Identifier: Apache-2.0
// The reader of GeoJSON. The bits of the first byte say which properties are asked for.
#include "altiplan/error.hpp"
#include "altiplan/formats/geojson.hpp"
#include "fuzz/memory_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) {
    return 0;
  }
  static const altiplan::fuzz::MemoryFolder kFolder;
  const auto asked = [&](int bit, const char* name) {
    return (data[0] >> bit & 1) != 0 ? name : "";
  };
  const auto file =
      kFolder.write("zones.geojson", altiplan::fuzz::text_of(data + 1, size - 1)).string();
  try {
    const altiplan::formats::GeoJson json = altiplan::formats::read_geojson(file);
    altiplan::formats::expect_properties(file, json, {asked(0, "floor"), asked(1, "from")});
    for (const altiplan::formats::GeoFeature& feature : json.features) {
      (void)(feature.metres(asked(2, "floor")), feature.text(asked(3, "from")));
    }
  } catch (const altiplan::Error&) {
  }
  return 0;
}
