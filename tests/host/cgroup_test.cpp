// SPDX-License-Identifier: Apache-2.0
#include "study/workers/cgroup.hpp"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <fstream>

#include "altiplan/error.hpp"
#include "study/workers/worker_pool.hpp"

namespace altiplan::host::cgroup_test {
using namespace study;
namespace {

namespace fs = std::filesystem;

std::string line_of(const fs::path& file) {
  std::string line;
  std::getline(std::ifstream(file) >> std::ws, line);
  return line;
}

TEST(ControlGroups, WhatIsNoGroupIsRefused) {
  EXPECT_THROW(ControlGroups("/proc/no_such_group", 2, 100), Error);
}

/// Needs a delegated group: `systemd-run --user --scope -p Delegate=yes test_host_cgroup`.
class Delegated : public ::testing::Test {
 protected:
  void SetUp() override {
    own_ = ControlGroups::delegated();
    if (!own_) {
      GTEST_SKIP() << "no control group with the memory controller is delegated to this process";
    }
  }
  std::optional<fs::path> own_;
};

TEST_F(Delegated, GroupsComeAndGo) {
  {
    const ControlGroups groups(*own_, 2, 100);
    EXPECT_EQ(line_of(*own_ / "altiplan-worker-2/memory.max"), std::to_string(100 << 20));
    EXPECT_EQ(groups.entrance(1), (*own_ / "altiplan-worker-2/cgroup.procs").string());
    EXPECT_NE(line_of(*own_ / "altiplan-program/cgroup.procs"), "");
    EXPECT_EQ(line_of(*own_ / "cgroup.procs"), "") << "the process has not moved";
  }
  EXPECT_FALSE(fs::exists(*own_ / "altiplan-worker-1"));
  EXPECT_FALSE(fs::exists(*own_ / "altiplan-program"));
  EXPECT_EQ(ControlGroups::delegated(), own_) << "the process is not back in its group";
}

/// Memory that belongs to no process, as no page of it is mapped.
TEST_F(Delegated, TheKernelBoundsWhatTheProcessTreeDoesNotShow) {
  WorkFolder folder(fs::path(::testing::TempDir()) / "altiplan_cgroup_test");
  PoolOptions options;
  options.limits.memory_mb = 64;
  options.key = [](std::size_t job) { return std::to_string(job); };
  WorkerPool pool(folder, options);
  EXPECT_NE(pool.limits_kept().find("cgroup v2"), std::string::npos);
  const auto work = [](const Job& job) {
    const int file = ::memfd_create("a file in memory", 0);
    const std::string part(1 << 20, 'x');
    for (int mb = 0; mb < (job.index % 2 == 0 ? 400 : 10); ++mb) {
      [[maybe_unused]] const ssize_t written = ::write(file, part.data(), part.size());
    }
    return std::string("done");
  };
  std::size_t ended_jobs = 0;
  pool.run({0, 1, 2, 3, 4, 5}, work, [&](const std::vector<Ended>& some) {
    for (const Ended& ended : some) {
      ++ended_jobs;
      EXPECT_EQ(ended.how, ended.job % 2 == 0 ? Ending::out_of_memory : Ending::done) << ended.job;
    }
  });
  EXPECT_EQ(ended_jobs, 6U);
}
}  // namespace
}  // namespace altiplan::host::cgroup_test
