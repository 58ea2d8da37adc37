// SPDX-License-Identifier: Apache-2.0
// Files that are absent, and files that the machine does not give.
#include "host/base/machine_fault.hpp"

#include <gtest/gtest.h>

#include "host/base/sha256.hpp"
#include "support/files.hpp"

namespace altiplan::host::machine_fault_test {
namespace {

namespace fs = std::filesystem;
using altiplan::testing::TempFolder;

TEST(MachineFault, IsNotToBeAbsent) {
  const TempFolder folder;
  const fs::path file = folder.write("file", "abc");
  EXPECT_TRUE(is_there(file));
  EXPECT_FALSE(is_folder(file));
  EXPECT_TRUE(is_folder(folder / ""));
  EXPECT_FALSE(is_there(folder / "none"));
  EXPECT_FALSE(is_there(file / "none")) << "below a file";
  fs::create_symlink("none", folder / "link");
  EXPECT_FALSE(is_there(folder / "link"));
  EXPECT_TRUE(fs::is_symlink(link_status_of(folder / "link")));
}

TEST(MachineFault, GivesNoCheckSum) {
  const TempFolder folder;
  const fs::path file = folder.write("file", "abc");
  EXPECT_EQ(sha256(file), sha256_of("abc"));
  EXPECT_EQ(sha256(folder / ""), "");
  EXPECT_EQ(sha256(folder / "none"), "");
  EXPECT_THROW(sha256("/proc/self/mem"), MachineFault) << "there is no memory at its first byte";
}
}  // namespace
}  // namespace altiplan::host::machine_fault_test
