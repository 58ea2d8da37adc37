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

namespace altiplan::host::worker_pool_parent_test {
namespace {

using ParentFaults = Faults;
INSTANTIATE_TEST_SUITE_P(Reuse, ParentFaults, ::testing::Values(1, 8));

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
            fs::path records = job.crash_report;
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

/// Appraises ends by their payloads: "doubtful 2" …
Appraisal by_payload(const Ended& ended) {
  const auto verdict = ended.payload.starts_with("doubtful")   ? Appraisal::doubtful
                       : ended.payload.starts_with("fault")    ? Appraisal::fault
                       : ended.payload.starts_with("hopeless") ? Appraisal::hopeless
                                                               : Appraisal::final;
  return {verdict, ended.payload};
}

TEST_F(WorkerPoolTest, ADoubtfulEndCountsWhenSeenTwiceOrTheThirdTime) {
  options_.appraise = by_payload;
  const fs::path tries = path_.string() + ".tries";
  const auto all = run(3, [&](const Job& job) -> std::string {
    const std::string own = tries.string() + std::to_string(job.index);
    std::ofstream(own, std::ios::app) << "x";
    const std::string number = std::to_string(fs::file_size(own));
    return job.index == 0   ? "doubtful"            // always alike
           : job.index == 1 ? "doubtful " + number  // never
           : number == "1"  ? "doubtful"
                            : "done";  // once only
  });
  const auto ended = [&](std::size_t job) {
    const std::string own = tries.string() + std::to_string(job);
    const auto number = fs::file_size(own);
    fs::remove(own);
    return all.at(job).payload + ", tries: " + std::to_string(number);
  };
  EXPECT_EQ(ended(0), "doubtful, tries: 2");
  EXPECT_EQ(ended(1), "doubtful 3, tries: 3");
  EXPECT_EQ(ended(2), "done, tries: 2");
}

TEST_F(WorkerPoolTest, AFaultThatPassesIsToldAndTheJobIsDoneAgain) {
  std::vector<std::string> said;
  options_.appraise = by_payload;
  options_.say = [&](const std::string& what) { said.push_back(what); };
  const fs::path tries = path_.string() + ".tries";
  const auto all = run(5, [&](const Job& job) -> std::string {
    if (job.index == 1) {
      std::ofstream(tries, std::ios::app) << "x";
    }
    return job.index == 1 && fs::file_size(tries) < 4 ? "fault of the disk" : "done";
  });
  EXPECT_EQ(all.at(1).payload, "done");
  EXPECT_EQ(said, std::vector<std::string>{"fault of the disk; trying again"});
  fs::remove(tries);
}

TEST_F(WorkerPoolTest, AFaultThatDoesNotPassEndsTheCallAfterTheOthers) {
  options_.appraise = by_payload;
  for (const std::string payload : {"fault of the disk", "hopeless"}) {
    WorkFolder folder(path_);
    WorkerPool pool(folder, options_);
    std::map<std::size_t, Ended> all;
    std::string said;
    try {
      pool.run(
          numbers(5), [&](const Job& job) { return job.index == 1 ? payload : "done"; }, into(all));
    } catch (const Error& error) {
      said = error.what();
    }
    EXPECT_EQ(said, payload + "; ended runs are kept: repeat the command to continue");
    EXPECT_EQ(all.size(), payload == "hopeless" ? 1U : 4U);
    EXPECT_FALSE(all.contains(1));
  }
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

TEST_P(ParentFaults, NothingOutlivesAKilledParent) {
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
  const WorkFolder folder(path_);  // waits for the supervisor
  EXPECT_TRUE(folder.processes().find().empty());
  EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(2));
}

TEST_P(ParentFaults, RecordsOfAKilledParentAreFound) {
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

TEST_F(WorkerPoolTest, ASupervisorThatWasKilledIsReplaced) {
  const pid_t self = ::getpid();
  const auto all = run(20, [&](const Job& job) {
    if (job.index == 3 || job.index == 12) {  // the supervisor is the parent's only other child
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
}  // namespace altiplan::host::worker_pool_parent_test
