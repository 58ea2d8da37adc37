// SPDX-License-Identifier: Apache-2.0
// What befalls the parent of a pool: full disks, signals, kills.
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <numeric>
#include <string>
#include <vector>

#include "altiplan/error.hpp"
#include "support/instrumented.hpp"
#include "worker_pool_fixture.hpp"

namespace altiplan::host {
namespace {

INSTANTIATE_TEST_SUITE_P(Reuse, Faults, ::testing::Values(1, 8));

TEST_F(WorkerPoolTest, FullDiskIsAnErrorOfTheStudy) {
  WorkFolder folder(path_);
  WorkerPool pool(folder, options_);
  std::map<std::size_t, Ended> all;
  std::string said;
  try {
    pool.run(
        numbers(10),
        [&](const Job& job) {
          if (job.index == 5) {  // as if the disk were full from now on
            fs::path records = job.last_words;
            fs::create_symlink("/dev/full", records.replace_extension(".records"));
          }
          return std::string("x");
        },
        into(all));
  } catch (const Error& error) {
    said = error.what();
  }
  EXPECT_NE(said.find(path_.string()), std::string::npos) << said;
  EXPECT_NE(said.find("cannot be written"), std::string::npos) << said;
  EXPECT_EQ(all.size(), 5U);
}

TEST_F(WorkerPoolTest, FolderThatVanishesIsAnErrorOfTheStudy) {
  WorkFolder folder(path_);
  WorkerPool pool(folder, options_);
  EXPECT_THROW(pool.run(
                   numbers(10),
                   [&](const Job& job) {
                     if (job.index == 5) {
                       fs::remove_all(path_);
                     }
                     return std::string("x");
                   },
                   [](const std::vector<Ended>&) {}),
               Error);
}

TEST_F(WorkerPoolTest, WhatKeepThrowsEndsThePoolAndTheRecordsStay) {
  {
    WorkFolder folder(path_);
    options_.jobs = 3;
    WorkerPool pool(folder, options_);
    EXPECT_THROW(pool.run(
                     numbers(2000), [](const Job&) { return std::string("safe"); },
                     [](const std::vector<Ended>&) { throw Error("the database is gone"); }),
                 Error);
  }
  WorkFolder folder(path_);
  const std::vector<Ended> records = folder.records();
  EXPECT_GT(records.size(), 0U);
  for (const Ended& record : records) {
    EXPECT_EQ(record.payload, "safe");
    EXPECT_TRUE(record.key.starts_with("job "));
  }
  folder.clear();
  EXPECT_TRUE(folder.records().empty());
}

TEST_F(WorkerPoolTest, ASignalEndsItAtOnce) {
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    WorkFolder folder(path_);
    WorkerPool pool(folder, options_);
    std::map<std::size_t, Ended> all;
    const pid_t self = ::getpid();
    const auto began = std::chrono::steady_clock::now();
    EXPECT_EQ(pool.run(
                  numbers(10),
                  [&](const Job& job) {
                    if (job.index == 6) {
                      ::kill(self, number);
                      sleep_s(1000);
                    }
                    return std::string();
                  },
                  into(all)),
              WorkerPool::Finish::interrupted);
    EXPECT_EQ(all.size(), 6U);
    EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(3));
  }
}

TEST_F(WorkerPoolTest, OneParentAtATime) {
  const WorkFolder folder(path_);
  try {
    const WorkFolder other(path_);
    FAIL() << "two parents have one folder";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(std::to_string(::getpid()) + " on "),
              std::string::npos)
        << error.what();
  }
}

TEST_F(WorkerPoolTest, FolderThatCannotBeWritten) {
  std::ofstream(path_.string()) << "a file";
  EXPECT_THROW(WorkFolder{path_}, Error);
  EXPECT_THROW(WorkFolder{"/proc/no_such_thing"}, Error);
}

/// A parent in a process of its own, that is killed after that time.
void kill_parent(const fs::path& path, const PoolOptions& options, double after_s,
                 const Work& work) {
  const pid_t parent = ::fork();
  if (parent == 0) {
    WorkFolder folder(path);
    std::vector<std::size_t> jobs(1000);
    std::iota(jobs.begin(), jobs.end(), 0);
    WorkerPool(folder, options).run(jobs, work, [](const std::vector<Ended>&) {});
    ::_exit(0);
  }
  sleep_s(after_s);
  ::kill(parent, SIGKILL);
  ::waitpid(parent, nullptr, 0);
}

TEST_P(Faults, NothingOutlivesAKilledParent) {
  kill_parent(path_, options_, 0.3, [](const Job&) -> std::string {
    if (::fork() == 0) {
      ::setsid();
      if (::fork() == 0) {
        sleep_s(1000);
      }
      ::_exit(0);
    }
    sleep_s(1000);
    return "";
  });
  const auto began = std::chrono::steady_clock::now();
  const WorkFolder folder(path_);  // waits for the warden
  EXPECT_TRUE(folder.processes().find().empty());
  EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(2));
}

TEST_P(Faults, RecordsOfAKilledParentAreFound) {
  options_.keep_every_s = 1000;  // it stores nothing
  options_.jobs = 2;
  kill_parent(path_, options_, 0.5, [](const Job& job) {
    sleep_s(0.002);
    return "the payload of " + std::to_string(job.index);
  });
  WorkFolder folder(path_);
  const std::vector<Ended> records = folder.records();
  EXPECT_GT(records.size(), 5U);
  std::map<std::string, int> keys;
  for (const Ended& record : records) {
    EXPECT_EQ(++keys[record.key], 1);
    EXPECT_EQ("job " + record.payload.substr(15), record.key);
    EXPECT_EQ(record.how, Ending::done);
  }
  folder.clear();
}

TEST_F(WorkerPoolTest, AWardenThatWasKilledIsReplaced) {
  const pid_t self = ::getpid();
  const auto all = run(20, [&](const Job& job) {
    if (job.index == 3 || job.index == 12) {  // the warden is the parent's only other child
      for (const pid_t sibling : children_of(self)) {
        if (sibling != ::getpid()) {
          ::kill(sibling, SIGKILL);
        }
      }
      sleep_s(0.05);
    }
    return std::string();
  });
  for (const auto& [job, ended] : all) {
    EXPECT_EQ(ended.how, Ending::done) << job;
  }
}

TEST_F(WorkerPoolTest, MemoryStaysFlat) {
  if (altiplan::testing::kInstrumented) {
    GTEST_SKIP() << "a sanitizer takes memory of its own";
  }
  options_.reuse = 8;
  run(500, [](const Job&) { return std::string(20'000, 'x'); });
  const double before = use_of(::getpid()).memory_mb;
  WorkFolder folder(path_);
  WorkerPool pool(folder, options_);
  pool.run(
      numbers(3000), [](const Job&) { return std::string(20'000, 'x'); },
      [](const std::vector<Ended>&) {});
  // What the jobs sent is 60 MB; a batch of records comes and goes with 5 MB.
  EXPECT_LT(use_of(::getpid()).memory_mb, before + 20);
}
}  // namespace
}  // namespace altiplan::host
