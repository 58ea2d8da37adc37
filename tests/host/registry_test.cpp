// SPDX-License-Identifier: Apache-2.0
#include "host/plugins/registry.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <thread>

#include "altiplan/error.hpp"
#include "altiplan/params.hpp"
#include "host/base/in_child.hpp"
#include "host/base/machine_fault.hpp"
#include "host/plugins/checksum.hpp"
#include "support/folders.hpp"

namespace altiplan::host::registry_test {
namespace {
namespace fs = std::filesystem;

const fs::path kBroken = altiplan::folders::build() / "tests/broken_plugins";

std::string bytes_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// A folder of the test's own, gone with it.
class RegistryTest : public ::testing::Test {
 protected:
  RegistryTest()
      : folder_(fs::path(::testing::TempDir()) /
                ("altiplan_registry_" + std::to_string(::getpid()) + "_" +
                 ::testing::UnitTest::GetInstance()->current_test_info()->name())) {
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "other");
  }
  ~RegistryTest() override { fs::remove_all(folder_); }

  fs::path write(const std::string& name, const std::string& bytes) const {
    const fs::path file = folder_ / name;
    std::ofstream(file, std::ios::binary) << bytes;
    return file;
  }
  /// A copy of two_plugins whose record of alpha is changed.
  template <class Edit>
  fs::path edited(const std::string& name, Edit edit) const {
    std::string bytes = bytes_of(kBroken / "two_plugins.so");
    const std::string magic(Manifest::kMagic, sizeof Manifest::kMagic);
    Manifest record{};
    std::size_t at = 0;
    for (; std::strcmp(record.name, "alpha") != 0; ++at) {
      at = bytes.find(magic, at);
      std::memcpy(&record, bytes.data() + at, sizeof record);
    }
    --at;
    const std::uint32_t before = checksum_of(record);
    edit(record);
    record.checksum += checksum_of(record) - before;
    std::memcpy(bytes.data() + at, &record, sizeof record);
    const fs::path file = write(name, bytes);
    write_checksum(file);
    return file;
  }

  fs::path folder_;
};

/// Text of the exception of this type; "" where none came.
template <class Exception, class Call>
std::string text_of(Call call) {
  try {
    call();
  } catch (const Exception& error) {
    return error.what();
  }
  return "";
}

#define EXPECT_HAS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

TEST_F(RegistryTest, ReadsAManifestWithoutRunningAnything) {
  const Library library = examine_library(kBroken / "two_plugins.so");
  EXPECT_EQ(library.refused, "");
  ASSERT_EQ(library.plugins.size(), 2U);
  EXPECT_STREQ(library.plugins[1].kind, "planner");
  EXPECT_STREQ(library.plugins[1].name, "alpha");
  EXPECT_STREQ(library.plugins[0].name, "beta");
  EXPECT_STREQ(library.plugins[0].sentence, "admits every route");
  EXPECT_EQ(library.build.size(), 40U);
  EXPECT_EQ(library.build.find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_EQ(library.checksum.size(), 8U);
  EXPECT_EQ(examine_library(kBroken / "no_manifest.so").refused,
            "not an altiplan plugin (no section altiplan_manifest)");
}

TEST_F(RegistryTest, PrintsBothSidesOfAMismatch) {
  const auto refusal = [&](auto edit) { return examine_library(edited("e.so", edit)).refused; };
  EXPECT_EQ(refusal([](Manifest& m) { m.api_major = 7; }),
            "built for API 7.0, this altiplan offers 3.0; build it again "
            "(docs/how-to/write-a-plugin.md)");
  EXPECT_EQ(refusal([](Manifest& m) { m.api_minor = 1; }),
            "built for API 3.1, this altiplan offers 3.0; build it again "
            "(docs/how-to/write-a-plugin.md)");
  EXPECT_EQ(refusal([](Manifest& m) { m.api_minor = 0; }), "");
  EXPECT_EQ(refusal([](Manifest& m) { m.cxx11_abi ^= 1; }),
            "built with _GLIBCXX_USE_CXX11_ABI = 0, this altiplan with 1");
  EXPECT_HAS(refusal([](Manifest& m) { m.glibcxx_debug ^= 1; }), "built with _GLIBCXX_DEBUG = ");
  EXPECT_HAS(refusal([](Manifest& m) { m.sanitizers ^= 3; }), "this altiplan with ");
  EXPECT_EQ(refusal([](Manifest& m) { std::strcpy(m.api_hash, "0123456789abcdef"); }),
            "its headers' declarations have the hash 0123456789abcdef, this altiplan's " +
                std::string(ALTIPLAN_API_HASH) + ": built with other headers; build it again");
  EXPECT_EQ(refusal([](Manifest& m) { m.struct_size = 400; }),
            "its manifest has 400 bytes per plugin, this altiplan's " +
                std::to_string(sizeof(Manifest)) + ": built with other headers; build it again");
  // As those of 0.1 were, whose manifest was longer.
  EXPECT_EQ(refusal([](Manifest& m) {
              m.struct_size = 592;
              m.api_major = 1;
            }),
            "built for API 1.0, this altiplan offers 3.0; build it again "
            "(docs/how-to/write-a-plugin.md)");
  EXPECT_EQ(refusal([](Manifest& m) { m.optimised ^= 1; }), "") << "information, no reason";
}

TEST_F(RegistryTest, RefusesAPluginBuiltWithHeadersThatDeclareOtherwise) {
  EXPECT_EQ(examine_library(kBroken / "other_comments/other_comments.so").refused, "");
  EXPECT_HAS(examine_library(kBroken / "other_order/other_order.so").refused,
             ", this altiplan's " + std::string(ALTIPLAN_API_HASH) +
                 ": built with other headers; build it again");
}

TEST_F(RegistryTest, RefusesALibraryBuiltWithAnotherKit) {
  const std::string refused = examine_library(kBroken / "neighbours/other_kit.so").refused;
  EXPECT_TRUE(refused.starts_with("built with the kit of altiplan 0.0.9, this is altiplan 0."))
      << refused;
  EXPECT_TRUE(refused.ends_with(": build it again")) << refused;
}

TEST_F(RegistryTest, NamesTheFilesOfANameThatIsOfferedTwice) {
  const auto rename = [](Manifest& m) {
    EXPECT_STREQ(m.file, "two_plugins.cpp");
    std::strcpy(m.kind, "constraint");
    std::strcpy(m.name, "beta");
    std::strcpy(m.file, "copied.cpp");
  };
  EXPECT_EQ(examine_library(edited("twice.so", rename)).refused,
            "offers the constraint 'beta' twice: in two_plugins.cpp and in copied.cpp");
}

TEST_F(RegistryTest, RefusesARecordThatDoesNotFitItsChecksum) {
  const auto damage = [](Manifest& m) {
    m.sentence[3] ^= 4;
    m.checksum ^= 1;
  };
  const fs::path file = edited("libaltiplan_planner_alpha.so", damage);
  EXPECT_EQ(examine_library(file).refused, "damaged manifest: a record does not fit its checksum");
  Registry registry({folder_});
  EXPECT_HAS(text_of<PluginError>([&] { registry.get("planner", "alpha"); }),
             "the library of the planner 'alpha' is refused: " + file.string());
  EXPECT_HAS(text_of<Error>([&] { registry.get("smoother", "alpha"); }),
             "no library provides the smoother 'alpha'");
}

TEST_F(RegistryTest, RefusesADamagedManifest) {
  const auto refusal = [&](auto edit) { return examine_library(edited("e.so", edit)).refused; };
  EXPECT_HAS(refusal([](Manifest& m) { m.magic[3] = 'x'; }), "expected 'altiplan plugin'");
  EXPECT_HAS(refusal([](Manifest& m) { std::memset(m.name, 'a', sizeof m.name); }),
             "an unterminated text");
  EXPECT_HAS(refusal([](Manifest& m) { std::strcpy(m.kind, "painter"); }),
             "the unknown kind 'painter'");
  EXPECT_HAS(refusal([](Manifest& m) { std::strcpy(m.name, "A*"); }), "named 'A*'");
  EXPECT_HAS(refusal([](Manifest& m) { std::strcpy(m.name, ""); }), "named ''");
  EXPECT_HAS(refusal([](Manifest& m) {
               std::strcpy(m.kind, "constraint");
               std::strcpy(m.name, "beta");
             }),
             "offers the constraint 'beta' twice");
}

TEST_F(RegistryTest, RefusesEveryTruncation) {
  const std::string whole = bytes_of(kBroken / "two_plugins.so");
  ASSERT_GT(whole.size(), 5000U);
  for (std::size_t size = 0; size < whole.size(); size += size < 200 ? 1 : 509) {
    EXPECT_NE(examine_library(write("cut.so", whole.substr(0, size))).refused, "") << size;
  }
  EXPECT_NE(examine_library(write("cut.so", whole.substr(0, whole.size() - 1))).refused, "");
  EXPECT_EQ(examine_library(write("cut.so", whole)).refused, "");
}

TEST_F(RegistryTest, SurvivesAnyByteOfTheHeadersChanged) {
  const std::string whole = bytes_of(kBroken / "two_plugins.so");
  for (std::size_t at = 0; at < 64 + 56 * 4; ++at) {
    for (const char value : {'\x00', '\x7F', '\xFF'}) {
      std::string changed = whole;
      changed[at] = value;
      examine_library(write("changed.so", changed));
    }
  }
  EXPECT_HAS(examine_library(write("x.so", "#!/bin/sh\n" + std::string(100, ' '))).refused,
             "not an ELF file");
  EXPECT_HAS(examine_library(folder_ / "none.so").refused, "cannot be opened");
  EXPECT_EQ(examine_library(folder_).refused, "not a regular file");
}

TEST_F(RegistryTest, LoadsAtTheFirstCallFromManyThreads) {
  fs::copy(kBroken / "two_plugins.so", folder_ / "two.so");
  Registry registry({folder_ / "missing", folder_, folder_ / "../" / folder_.filename()});
  EXPECT_EQ(registry.libraries().size(), 1U);
  EXPECT_EQ(registry.names("planner"), std::vector<std::string>{"alpha"});
  EXPECT_EQ(registry.names("smoother"), std::vector<std::string>{});
  std::vector<const PluginEntry*> seen(4);
  {
    std::vector<std::jthread> threads;
    for (const PluginEntry*& entry : seen) {
      threads.emplace_back([&] { entry = &registry.get("planner", "alpha"); });
    }
  }
  for (const PluginEntry* entry : seen) {
    EXPECT_EQ(entry, seen[0]);
  }
  EXPECT_STREQ(seen[0]->name, "alpha");
  EXPECT_NE(seen[0]->planner(nullptr), nullptr);
  EXPECT_EQ(seen[0]->describe(nullptr, "").fields.at(0).spec.name, "min_m");
  EXPECT_NE(registry.get("constraint", "beta").constraint(nullptr, Site()), nullptr);
}

TEST_F(RegistryTest, SaysWhatIsPresentWhereNoLibraryOffersAName) {
  fs::copy(kBroken / "two_plugins.so", folder_ / "two.so");
  Registry registry({folder_, folder_ / "nowhere"});
  EXPECT_EQ(registry.offering("planner", "alpa"), nullptr);
  EXPECT_EQ(text_of<Error>([&] { registry.get("planner", "alpa"); }),
            "no library provides the planner 'alpa'; did you mean 'alpha'?");
  const std::string text = text_of<Error>([&] { registry.get("planner", "nothing"); });
  EXPECT_HAS(text, "no library provides the planner 'nothing'; present: alpha");
  EXPECT_HAS(text, folder_.string());
  EXPECT_HAS(text, "nowhere (no such folder)");
  EXPECT_EQ(text_of<PluginError>([&] { EXPECT_THROW(registry.get("planner", "alpa"), Error); }),
            "");
  EXPECT_HAS(text_of<Error>([&] { registry.get("smoother", "alpha"); }), "'alpha' is a planner");
}

TEST_F(RegistryTest, TwoLibrariesWithOneNameAreRefusedByName) {
  fs::copy(kBroken / "two_plugins.so", folder_ / "first.so");
  edited("other/second.so", [](Manifest& m) {
    std::strcpy(m.kind, "local_planner");
    m.optimised ^= 1;
  });
  Registry registry({folder_, folder_ / "other"});
  ASSERT_EQ(registry.libraries().size(), 2U);
  EXPECT_HAS(registry.libraries()[0].refused, "second.so offers a local_planner of that name too");
  EXPECT_HAS(registry.libraries()[1].refused, "first.so offers a planner of that name too");
  const std::string text = text_of<PluginError>([&] { registry.get("planner", "alpha"); });
  EXPECT_HAS(text, "first.so");
  EXPECT_HAS(text, "second.so");
  EXPECT_NE(text_of<PluginError>([&] { registry.offering("local_planner", "alpha"); }), "");
  EXPECT_NE(text_of<PluginError>([&] { registry.offering("constraint", "beta"); }), "");
}

TEST_F(RegistryTest, OfTwoCopiesOfOneBuildTheFirstIsUsed) {
  fs::copy(kBroken / "two_plugins.so", folder_ / "first.so");
  fs::copy(kBroken / "two_plugins.so", folder_ / "other/second.so");
  Registry registry({folder_ / "other", folder_});
  ASSERT_EQ(registry.libraries().size(), 1U);
  EXPECT_EQ(registry.libraries()[0].file, folder_ / "other/second.so");
  EXPECT_EQ(registry.libraries()[0].refused, "");
  ASSERT_EQ(registry.copies().size(), 1U);
  EXPECT_EQ(registry.copies()[0].file, folder_ / "first.so");
  EXPECT_EQ(registry.copies()[0].used, folder_ / "other/second.so");
  EXPECT_STREQ(registry.get("planner", "alpha").name, "alpha");
}

TEST_F(RegistryTest, TwoBuildsWithOneNameAreRefused) {
  fs::copy(kBroken / "two_plugins.so", folder_ / "first.so");
  std::string bytes = bytes_of(kBroken / "two_plugins.so");
  const std::string build = examine_library(folder_ / "first.so").build;
  std::string id;
  for (std::size_t i = 0; i < build.size(); i += 2) {
    id += char(std::stoi(build.substr(i, 2), nullptr, 16));
  }
  const std::size_t at = bytes.find(id);
  ASSERT_NE(at, std::string::npos);
  bytes[at] = char(bytes[at] ^ 1);
  write("other/second.so", bytes);
  Registry registry({folder_, folder_ / "other"});
  ASSERT_EQ(registry.libraries().size(), 2U);
  EXPECT_TRUE(registry.copies().empty());
  EXPECT_HAS(registry.libraries()[0].refused, "second.so offers it too");
  EXPECT_HAS(registry.libraries()[1].refused, "first.so offers it too");
}

TEST_F(RegistryTest, ALibraryThatCannotBeUsedIsAPluginError) {
  edited("announced.so", [](Manifest& m) { std::strcpy(m.name, "omega"); });
  edited("api.so", [](Manifest& m) {
    std::strcpy(m.name, "old");
    m.api_major = 9;
  });
  fs::remove(folder_ / "api.so");
  fs::copy(kBroken / "undefined_symbol.so", folder_ / "undefined.so");
  fs::copy(kBroken / "no_list.so", folder_ / "no_list.so");
  Registry registry({folder_});
  EXPECT_HAS(text_of<PluginError>([&] { registry.get("planner", "omega"); }),
             "announces the planner 'omega', but does not contain it");
  EXPECT_HAS(text_of<PluginError>([&] { registry.get("constraint", "delta"); }),
             "no_list.so does not export altiplan_plugins");
  const std::string text = text_of<PluginError>([&] { registry.get("constraint", "gamma"); });
  EXPECT_HAS(text, "missing_function_of_a_test() (_Z");
  EXPECT_EQ(text.find("Bad file descriptor"), std::string::npos) << text;
}

/// Gives the process no further descriptor while it lives.
class NoDescriptors {
 public:
  NoDescriptors() {
    ::getrlimit(RLIMIT_NOFILE, &before_);
    const rlimit none{0, before_.rlim_max};
    ::setrlimit(RLIMIT_NOFILE, &none);
  }
  ~NoDescriptors() { ::setrlimit(RLIMIT_NOFILE, &before_); }
  NoDescriptors(const NoDescriptors&) = delete;
  NoDescriptors& operator=(const NoDescriptors&) = delete;

 private:
  rlimit before_{};
};

TEST_F(RegistryTest, WhatTheMachineDoesNotGiveIsNotTheLibrarysFault) {
#if defined(__has_feature)
#if __has_feature(address_sanitizer)
  GTEST_SKIP() << "sanitizers need descriptors to look at exceptions";
#endif
#endif
  const fs::path file = folder_ / "libaltiplan_planner_alpha.so";
  fs::copy(kBroken / "two_plugins.so", file);
  Registry registry({folder_});
  {
    const NoDescriptors none;
    EXPECT_HAS(text_of<MachineFault>([&] { registry.get("planner", "alpha"); }),
               "Too many open files");
    EXPECT_HAS(text_of<MachineFault>([&] { Registry{{folder_}}; }), "Too many open files");
    EXPECT_EQ(examine_library(file).refused, "cannot be opened: Too many open files");
  }
  EXPECT_STREQ(registry.get("planner", "alpha").name, "alpha") << "the fault has passed";
}

TEST_F(RegistryTest, ALibraryIsNotExcusedByTheWordsOfItsName) {
  const fs::path folder = folder_ / "Input" / "output error";  // as EIO is called
  fs::create_directories(folder);
  fs::copy(kBroken / "undefined_symbol.so", folder / "undefined_symbol.so");
  Registry registry({folder});
  const Library& library = registry.libraries().front();
  EXPECT_HAS(text_of<PluginError>(
                 [&] { registry.get(library.plugins.front().kind, library.plugins.front().name); }),
             "Input/output error/undefined_symbol.so cannot be loaded");
}

TEST_F(RegistryTest, AChildsReportNeedsNoDescriptor) {
  EXPECT_EQ(text_of<Error>([] { in_child("it: ", [] { ::close_range(0, ~0U, 0); }); }), "");
  EXPECT_EQ(text_of<PluginError>([] { in_child("it: ", [] { throw Error("is bad"); }); }),
            "is bad");
  EXPECT_EQ(text_of<MachineFault>([] { in_child("it: ", [] { throw MachineFault("a disk"); }); }),
            "a disk");
  EXPECT_EQ(text_of<PluginError>([] { in_child("it: ", [] { ::_exit(3); }); }),
            "it: loading it ends the process with exit code 3");
  EXPECT_HAS(text_of<PluginError>([] { in_child("it: ", [] { ::raise(SIGKILL); }); }), "Killed");
  const std::string long_text(1 << 20, 'x');
  EXPECT_EQ(text_of<Error>([&] { in_child("it: ", [&] { throw Error(long_text); }); }).size(),
            std::size_t(65535));
}

TEST_F(RegistryTest, AParameterWithoutAProperNameIsAPluginError) {
  std::string bytes = bytes_of(kBroken / "two_plugins.so");
  const std::size_t at = bytes.find(std::string("min_m") + '\0');
  ASSERT_NE(at, std::string::npos);
  bytes.replace(at, 2, "\xF1\0", 2);
  const fs::path file = write("two.so", bytes);
  write_checksum(file);
  Registry registry({folder_});
  EXPECT_EQ(text_of<PluginError>([&] { registry.get("planner", "alpha"); }),
            file.string() + ": describing the constraint 'beta': a parameter is named '??n_m', " +
                "expected lower-case letters, digits and '_'");
}

TEST_F(RegistryTest, SearchPath) {
  ::setenv("ALTIPLAN_PLUGIN_PATH", "/a::/b:", 1);
  const std::vector<fs::path> folders = Registry::search_path({"/first"});
  ::unsetenv("ALTIPLAN_PLUGIN_PATH");
  ASSERT_GE(folders.size(), 4U);
  EXPECT_EQ(folders[0], "/first");
  EXPECT_EQ(folders[1], "/a");
  EXPECT_EQ(folders[2], "/b");
  EXPECT_TRUE(fs::is_directory(folders[3])) << folders[3];
  for (const fs::path& folder : folders) {
    EXPECT_TRUE(folder.is_absolute());
  }
}
}  // namespace
}  // namespace altiplan::host::registry_test
