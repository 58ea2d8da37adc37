// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <fstream>

#include "altiplan/error.hpp"
#include "host/plugins/checksum.hpp"
#include "host/plugins/private_copy.hpp"
#include "host/plugins/registry.hpp"
#include "support/folders.hpp"

namespace altiplan::host::library_checksum_test {
namespace {
namespace fs = std::filesystem;

const fs::path kWhole = altiplan::folders::build() / "tests/broken_plugins/two_plugins.so";

std::string bytes_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

class LibraryChecksum : public ::testing::Test {
 protected:
  LibraryChecksum()
      : file_(fs::path(::testing::TempDir()) /
              ("altiplan_checksum_" + std::to_string(::getpid()) + ".so")),
        whole_(bytes_of(kWhole)) {}
  ~LibraryChecksum() override { fs::remove(file_); }

  fs::path write(const std::string& bytes) const {
    std::ofstream(file_, std::ios::binary) << bytes;
    return file_;
  }

  /// What keeps a library with this byte changed from being loaded; "" where nothing does.
  std::string refusal(std::size_t at, int change) const {
    std::string bytes = whole_;
    bytes[at] = char(bytes[at] ^ change);
    try {
      verify_checksum(ElfFile(write(bytes)));
      return "";
    } catch (const ElfError& error) {
      return error.what();
    }
  }

  /// Whether the loader maps the byte, and neither strip nor `cmake --install` rewrites it.
  bool is_covered(std::size_t at) const {
    const ElfFile elf(kWhole);
    if ((at >= offsetof(Elf64_Ehdr, e_shoff) && at < offsetof(Elf64_Ehdr, e_flags)) ||
        (at >= offsetof(Elf64_Ehdr, e_shentsize) && at < sizeof(Elf64_Ehdr))) {
      return false;
    }
    const ElfFile::Section& strings = *elf.find(".dynstr");
    const Checksum stated = stated_checksum(elf);
    if (const std::size_t text = strings.offset + stated.run_path;
        at >= text && at < text + stated.run_path_size) {
      return false;
    }
    const auto in = [&](std::uint64_t offset, std::uint64_t size) {
      return at >= offset && at - offset < size;
    };
    // Behind the end mark of the dynamic section nothing is read.
    const ElfFile::Section& dynamic = *elf.find(".dynamic");
    if (in(dynamic.offset, dynamic.size)) {
      std::size_t used = 0;
      while (host::at<Elf64_Dyn>(whole_, dynamic.offset + used).d_tag != DT_NULL) {
        used += sizeof(Elf64_Dyn);
      }
      return at < dynamic.offset + used + sizeof(Elf64_Sxword);
    }
    return std::any_of(elf.segments().begin(), elf.segments().end(), [&](const Elf64_Phdr& s) {
      return s.p_type == PT_LOAD && in(s.p_offset, s.p_filesz);
    });
  }

  void expect_every_byte_covered(std::size_t step) const {
    std::size_t covered = 0;
    std::size_t others = 0;
    for (std::size_t at = 0; at < whole_.size(); at += step) {
      for (const int change : {1, 0x80, 0xFF}) {
        if (is_covered(at)) {
          ASSERT_NE(refusal(at, change), "") << at << " ^ " << change;
          ++covered;
        } else {
          ++others;  // refused for another reason, or as good as before
        }
      }
    }
    EXPECT_GT(covered, 3 * whole_.size() / step / 4);
    EXPECT_GT(others, 0U);
  }

  fs::path file_;
  std::string whole_;
};

TEST_F(LibraryChecksum, FitsTheLibraryThatWasLinked) {
  EXPECT_NO_THROW(verify_checksum(ElfFile(kWhole)));
  EXPECT_EQ(examine_library(kWhole).checksum, hexadecimal(stated_checksum(ElfFile(kWhole)).sum));
  write_checksum(write(whole_));
  EXPECT_EQ(bytes_of(file_), whole_) << "filled in twice it is the same";
}

TEST_F(LibraryChecksum, CoversWhatIsLoaded) { expect_every_byte_covered(101); }

class NightlyLibraryChecksum : public LibraryChecksum {};
TEST_F(NightlyLibraryChecksum, CoversEveryByteThatIsLoaded) { expect_every_byte_covered(1); }

TEST_F(LibraryChecksum, SaysWhatIsWrong) {
  const std::size_t text = ElfFile(kWhole).find(".text")->offset;
  EXPECT_NE(refusal(text, 4).find("damaged: its bytes have the checksum "), std::string::npos);
  std::string empty = whole_;
  empty.replace(ElfFile(kWhole).find("altiplan_checksum")->offset, 32, 32, '\0');
  EXPECT_EQ(examine_library(write(empty)).refused,
            "its checksum was not filled in after linking: build it by altiplan_add_plugin");
}

TEST_F(LibraryChecksum, APrivateCopyStaysAsItWas) {
  write(whole_);
  PrivateCopy copy(file_);
  write("something else");
  EXPECT_EQ(bytes_of(copy.path()), whole_);
  std::ofstream(copy.path(), std::ios::binary | std::ios::in) << "x";
  EXPECT_EQ(bytes_of(copy.path()), whole_);
  const fs::path first = copy.path_to_load();
  EXPECT_NE(copy.path_to_load(), first);
  EXPECT_EQ(bytes_of(copy.path()), whole_);
  fs::remove(file_);
  EXPECT_THROW(PrivateCopy{file_}, Error);
}

TEST_F(LibraryChecksum, ALibraryThatHasChangedSinceItWasExaminedIsNotLoaded) {
  const Library library = examine_library(write(whole_));
  EXPECT_TRUE(is_unchanged(library));
  std::string other = whole_;
  const std::size_t text = other.find("a distance");
  ASSERT_NE(text, std::string::npos);
  other[text] = 'A';
  write_checksum(write(other));
  EXPECT_FALSE(is_unchanged(library));
  try {
    load_library(library);
    FAIL();
  } catch (const PluginError& error) {
    EXPECT_EQ(error.what(),
              file_.string() + " has changed since this program started: run it again");
  }
  write(whole_);
  EXPECT_TRUE(is_unchanged(library));
  EXPECT_EQ(load_library(library).size(), 2U);
  write(other);  // what is loaded is loaded
  EXPECT_EQ(load_library(library).size(), 2U);
}

TEST_F(LibraryChecksum, ARegistryNamesEachChangeOnce) {
  const fs::path folder = file_.parent_path() / (file_.stem().string() + "_folder");
  fs::create_directories(folder);
  const fs::path file = folder / "two.so";
  fs::copy_file(kWhole, file, fs::copy_options::overwrite_existing);
  Registry registry({folder});
  registry.get("planner", "alpha");
  EXPECT_TRUE(registry.changed().empty());
  fs::remove(file);
  fs::copy_file(kWhole, file);
  EXPECT_TRUE(registry.changed().empty()) << "the same again";
  fs::resize_file(file, 1000);
  EXPECT_EQ(registry.changed(), std::vector<fs::path>{file});
  EXPECT_TRUE(registry.changed().empty());
  fs::remove_all(folder);
}
}  // namespace
}  // namespace altiplan::host::library_checksum_test
