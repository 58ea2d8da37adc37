// SPDX-License-Identifier: Apache-2.0
// A fuzz target on its seeds, and on the inputs that once broke it.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "fuzz/memory_file.hpp"
#include "support/folders.hpp"

namespace {
namespace fs = std::filesystem;

std::size_t replay(const fs::path& folder) {
  std::size_t count = 0;
  if (!fs::is_directory(folder)) {
    return count;
  }
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    SCOPED_TRACE(entry.path().string());
    std::ifstream stream(entry.path(), std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    EXPECT_EQ(
        LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()),
        0);
    ++count;
  }
  return count;
}

TEST(FuzzReplay, SeedsAndOldCrashes) {
  const fs::path inputs = altiplan::folders::source() / "tests/fuzz";
  EXPECT_GT(replay(inputs / "seeds" / ALTIPLAN_FUZZ_TARGET), 0U);
  replay(inputs / "crashes" / ALTIPLAN_FUZZ_TARGET);
}
}  // namespace
