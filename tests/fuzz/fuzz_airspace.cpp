// SPDX-License-Identifier: Apache-2.0
// The readers of published airspace; whatever they accept can be asked.
#include "altiplan/error.hpp"
#include "altiplan/formats/airspace_index.hpp"
#include "fuzz/memory_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    auto airspace =
        altiplan::formats::read_airspace("file", std::string(altiplan::fuzz::text_of(data, size)));
    if (airspace) {
      const altiplan::formats::AirspaceIndex index(std::move(airspace->zones));
      for (const double time : {0.0, 1655575200.0}) {
        (void)index.find({7, 46, 500, 300}, time);
      }
    }
  } catch (const altiplan::Error&) {
  }
  return 0;
}
