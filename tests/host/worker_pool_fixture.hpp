// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <map>
#include <numeric>
#include <string>
#include <thread>
#include <vector>

#include "study/workers/process_tree.hpp"
#include "study/workers/worker_pool.hpp"

namespace altiplan::host {
using namespace study;
namespace fs = std::filesystem;

inline void sleep_s(double seconds) {
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

[[noreturn]] inline void spin() {
  for (std::atomic<int> turns = 0;; ++turns) {
  }
}

/// Crashes that a sanitizer would answer in its own way go straight to the kernel's.
[[noreturn]] inline void die_of(int number) {
  ::signal(number, SIG_DFL);
  ::raise(number);
  ::_exit(99);
}

/// A pool in a folder of the test's own; no process and no file may be left behind.
class WorkerPoolTest : public ::testing::Test {
 protected:
  WorkerPoolTest()
      : path_(fs::path(::testing::TempDir()) / ("altiplan_pool_" + std::to_string(::getpid()))) {
    fs::remove_all(path_);
    options_.key = [](std::size_t job) { return "job " + std::to_string(job); };
    options_.limits.wall_s = 30;
  }
  ~WorkerPoolTest() override {
    EXPECT_TRUE(children_of(::getpid()).empty()) << "processes were left behind";
    fs::remove_all(path_);
  }

  /// The end of each of `count` jobs; each must come once.
  std::map<std::size_t, Ended> run(std::size_t count, const Work& work) {
    std::map<std::size_t, Ended> all;
    {
      WorkFolder folder(path_);
      WorkerPool pool(folder, options_);
      EXPECT_EQ(pool.run(numbers(count), work, into(all)), WorkerPool::Finish::all);
      EXPECT_TRUE(folder.processes().find().empty());
    }
    EXPECT_FALSE(fs::exists(path_)) << "the work folder is still there";
    EXPECT_EQ(all.size(), count);
    return all;
  }
  static std::vector<std::size_t> numbers(std::size_t count) {
    std::vector<std::size_t> jobs(count);
    std::iota(jobs.begin(), jobs.end(), 0);
    return jobs;
  }
  static Keep into(std::map<std::size_t, Ended>& all) {
    return [&all](std::vector<Ended> some) {
      for (Ended& ended : some) {
        EXPECT_EQ(ended.key, "job " + std::to_string(ended.job));
        const std::size_t job = ended.job;
        EXPECT_TRUE(all.emplace(job, std::move(ended)).second) << job << " ended twice";
      }
    };
  }
  /// Nine jobs of which the fifth misbehaves: the others must not notice. Returns the fifth.
  Ended among_others(const std::function<void(const Job&)>& misbehave) {
    const std::map<std::size_t, Ended> all = run(9, [&](const Job& job) {
      job.note("job " + std::to_string(job.index) + " is at work");
      if (job.index == 4) {
        misbehave(job);
      }
      return "payload " + std::to_string(job.index);
    });
    for (const auto& [job, ended] : all) {
      if (job != 4) {
        EXPECT_EQ(ended.how, Ending::done) << job;
        EXPECT_EQ(ended.payload, "payload " + std::to_string(job));
        EXPECT_EQ(ended.left_behind, 0);
      }
    }
    return all.at(4);
  }

  fs::path path_;
  PoolOptions options_;
};

/// Every fault with a process each, and with processes that are used again.
class Faults : public WorkerPoolTest, public ::testing::WithParamInterface<int> {
 protected:
  Faults() {
    options_.reuse = GetParam();
    options_.jobs = 2;
  }
};
}  // namespace altiplan::host
