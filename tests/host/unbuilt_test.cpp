// SPDX-License-Identifier: Apache-2.0
#include "host/plugins/unbuilt.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "altiplan/error.hpp"
#include "host/plugins/registry.hpp"
#include "support/folders.hpp"

namespace altiplan::host::unbuilt_test {
namespace {
namespace fs = std::filesystem;

/// A build tree whose `cmake` copies the libraries of this build, and notes what it was asked for.
class UnbuiltTest : public ::testing::Test {
 protected:
  UnbuiltTest()
      : tree_(fs::path(::testing::TempDir()) /
              ("altiplan_unbuilt_" + std::to_string(::getpid()) + "_" +
               ::testing::UnitTest::GetInstance()->current_test_info()->name())),
        plugins_(tree_ / "lib/altiplan/plugins"),
        path_(std::getenv("PATH")) {
    Unbuilt::allow();
    fs::remove_all(tree_);
    fs::create_directories(plugins_);
    fs::create_directories(tree_ / "bin");
    std::ofstream(plugins_ / "buildable.txt") << "planner astar\nplanner jps\nsmoother prune\n";
    ::setenv("PATH", ((tree_ / "bin").string() + ":" + path_).c_str(), 1);
    cmake("for target in \"${@:4}\"; do cp " +
          (folders::build() / "lib/altiplan/plugins").string() + "/lib$target.so " +
          plugins_.string() + "; done");
  }
  ~UnbuiltTest() override {
    ::setenv("PATH", path_.c_str(), 1);
    fs::remove_all(tree_);
  }

  void cmake(const std::string& does) const {
    const fs::path file = tree_ / "bin/cmake";
    std::ofstream(file) << "#!/bin/bash\necho \"$*\" >>" << (tree_ / "asked").string() << "\n"
                        << does << "\n";
    fs::permissions(file, fs::perms::owner_all);
  }
  std::string asked() const {
    std::ifstream stream(tree_ / "asked");
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  const fs::path tree_;
  const fs::path plugins_;
  const std::string path_;
};

TEST_F(UnbuiltTest, APluginIsBuiltWhenItIsNeededAndOnce) {
  Registry registry({plugins_});
  EXPECT_EQ(registry.libraries().size(), 0u);
  EXPECT_EQ(registry.names("planner"), (std::vector<std::string>{"astar", "jps"}));
  EXPECT_EQ(asked(), "");
  const Library* jps = registry.offering("planner", "jps");
  ASSERT_NE(jps, nullptr);
  EXPECT_EQ(jps->refused, "");
  EXPECT_EQ(registry.offering("planner", "jps"), jps);
  EXPECT_EQ(asked(), "--build " + tree_.string() + " --target altiplan_planner_jps\n");
  EXPECT_EQ(registry.get("planner", "jps").name, std::string("jps"));
}

TEST_F(UnbuiltTest, AllAreBuiltByOneCommand) {
  Registry registry({plugins_});
  registry.build_all();
  registry.build_all();
  EXPECT_EQ(registry.libraries().size(), 3u);
  EXPECT_EQ(asked(), "--build " + tree_.string() +
                         " --target altiplan_planner_astar altiplan_planner_jps "
                         "altiplan_smoother_prune\n");
}

TEST_F(UnbuiltTest, WhatIsBuiltAlreadyAndWhatNobodyKnowsIsNotBuilt) {
  fs::copy(folders::build() / "lib/altiplan/plugins/libaltiplan_planner_astar.so", plugins_);
  Registry registry({plugins_});
  EXPECT_NE(registry.offering("planner", "astar"), nullptr);
  EXPECT_EQ(registry.offering("planner", "astra"), nullptr);
  EXPECT_EQ(registry.offering("smoother", "astar"), nullptr);
  EXPECT_EQ(asked(), "");
}

TEST_F(UnbuiltTest, APluginIsBuiltToBeComparedWithAnotherFolders) {
  const fs::path other = tree_ / "other";
  fs::create_directories(other);
  fs::copy(folders::build() / "lib/altiplan/plugins/libaltiplan_planner_jps.so", other / "mine.so");
  Registry registry({other, plugins_});
  ASSERT_NE(registry.offering("planner", "jps"), nullptr);
  EXPECT_NE(asked(), "") << "a copy of the same build, which only building it can tell";
  EXPECT_EQ(registry.copies().size(), 1u);
}

TEST_F(UnbuiltTest, AFailedBuildNamesTheCommandThatShowsWhy) {
  cmake("exit 1");
  Registry registry({plugins_});
  try {
    registry.offering("planner", "jps");
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()),
              "building jps failed; cmake --build " + tree_.string() + " shows why");
  }
}

TEST_F(UnbuiltTest, WithoutAListNothingCanBeBuilt) {
  fs::remove(plugins_ / "buildable.txt");
  Registry registry({plugins_});
  EXPECT_EQ(registry.names("planner").size(), 0u);
  EXPECT_EQ(registry.offering("planner", "jps"), nullptr);
}
}  // namespace
}  // namespace altiplan::host::unbuilt_test
