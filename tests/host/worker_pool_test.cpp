// SPDX-License-Identifier: Apache-2.0
#include "host/study/pool/worker_pool.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <numeric>
#include <thread>

#include "altiplan/error.hpp"
#include "host/study/pool/job_record.hpp"
#include "host/study/pool/process_tree.hpp"
#include "support/instrumented.hpp"

namespace altiplan::host {
namespace {

namespace fs = std::filesystem;

void sleep_s(double seconds) {
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

[[noreturn]] void spin() {
  for (std::atomic<int> turns = 0;; ++turns) {
  }
}

[[noreturn]] void hoard() {
  std::vector<std::vector<char>> all;
  while (true) {
    all.emplace_back(1 << 20, 'x');
    sleep_s(0.0005);
  }
}

int overflow(int depth) {
  volatile char frame[4096];
  frame[0] = char(depth);
  return depth < 0 ? frame[0] : overflow(depth + 1) + frame[0];
}

/// Crashes that a sanitizer would answer in its own way go straight to the kernel's.
[[noreturn]] void die_of(int number) {
  ::signal(number, SIG_DFL);
  ::raise(number);
  ::_exit(99);
}

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
INSTANTIATE_TEST_SUITE_P(Reuse, Faults, ::testing::Values(1, 8));

TEST_P(Faults, AnotherProcessForEachUnlessUsedAgain) {
  options_.jobs = 1;
  const auto all = run(40, [](const Job&) { return std::to_string(::getpid()); });
  std::map<std::string, int> jobs_of;
  for (const auto& [job, ended] : all) {
    EXPECT_EQ(ended.place, jobs_of[ended.payload]++) << job;
    EXPECT_EQ(ended.exit_code, 0);
  }
  if (GetParam() == 1) {
    EXPECT_EQ(jobs_of.size(), 40U);
  } else {
    EXPECT_LT(jobs_of.size(), 20U);
    EXPECT_EQ(jobs_of.at(all.at(0).payload), GetParam());
  }
}

TEST_P(Faults, PayloadsOfAllSizes) {
  const auto all = run(20, [](const Job& job) {
    return std::string(job.index == 19 ? 30'000'000 : job.index * 1000, char('a' + job.index));
  });
  for (const auto& [job, ended] : all) {
    EXPECT_EQ(ended.payload,
              std::string(job == 19 ? 30'000'000 : job * 1000, char('a' + int(job))));
  }
}

TEST_P(Faults, Throws) {
  const Ended ended = among_others([](const Job&) { throw std::runtime_error("no luck"); });
  EXPECT_EQ(ended.how, Ending::threw);
  EXPECT_EQ(ended.payload, "no luck");
  EXPECT_EQ(among_others([](const Job&) { throw 42; }).how, Ending::threw);
}

TEST_P(Faults, EveryFatalSignal) {
  for (const int number :
       {SIGSEGV, SIGBUS,  SIGILL,  SIGFPE, SIGABRT, SIGTRAP, SIGSYS,  SIGPIPE,   SIGALRM, SIGUSR1,
        SIGUSR2, SIGKILL, SIGTERM, SIGINT, SIGHUP,  SIGQUIT, SIGXCPU, SIGVTALRM, SIGPROF, SIGIO}) {
    const Ended ended = among_others([&](const Job& job) {
      std::fputs("these are my last words", stderr);
      std::ofstream(job.last_words) << "left in a file";
      die_of(number);
    });
    EXPECT_EQ(ended.how, Ending::killed) << number;
    EXPECT_EQ(ended.signal, number);
    EXPECT_EQ(ended.note, "job 4 is at work");
    EXPECT_EQ(ended.said, "these are my last words");
    EXPECT_EQ(ended.last_words, "left in a file");
  }
}

TEST_P(Faults, StackOverflowOnAThreadOfItsOwn) {
  const Ended ended = among_others([](const Job&) {
    ::signal(SIGSEGV, SIG_DFL);
    std::thread([] { std::printf("%d", overflow(1)); }).join();
  });
  EXPECT_EQ(ended.how, Ending::killed);
  EXPECT_EQ(ended.signal, SIGSEGV);
}

TEST_P(Faults, Exits) {
  for (const int code : {0, 1, 77}) {
    const Ended ended = among_others([&](const Job&) { ::_exit(code); });
    EXPECT_EQ(ended.how, Ending::exited);
    EXPECT_EQ(ended.exit_code, code);
  }
}

TEST_P(Faults, Hangs) {
  options_.limits.wall_s = 0.3;
  const auto began = std::chrono::steady_clock::now();
  const Ended ended = among_others([](const Job&) { sleep_s(1000); });
  EXPECT_EQ(ended.how, Ending::wall_limit);
  EXPECT_NEAR(ended.wall_s, 0.3, 0.25);
  EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(5));
}

TEST_P(Faults, StopsItself) {
  options_.limits.wall_s = 0.3;
  EXPECT_EQ(among_others([](const Job&) { ::raise(SIGSTOP); }).how, Ending::wall_limit);
}

TEST_P(Faults, HangsAndIgnoresAllSignals) {
  options_.limits.wall_s = 0.3;
  const Ended ended = among_others([](const Job&) {
    sigset_t all;
    sigfillset(&all);
    ::sigprocmask(SIG_BLOCK, &all, nullptr);
    sleep_s(1000);
  });
  EXPECT_EQ(ended.how, Ending::wall_limit);
}

TEST_P(Faults, Spins) {
  options_.limits.cpu_s = 0.3;
  const Ended ended = among_others([](const Job&) { spin(); });
  EXPECT_EQ(ended.how, Ending::cpu_limit);
  EXPECT_NEAR(ended.cpu_s, 0.4, 0.2);
}

TEST_P(Faults, ChildrenSpinInItsPlace) {
  options_.limits.cpu_s = 0.4;
  const Ended ended = among_others([](const Job&) {
    for (int i = 0; i < 4; ++i) {
      if (::fork() == 0) {
        ::setsid();
        if (::fork() == 0) {
          spin();
        }
        ::_exit(0);
      }
    }
    sleep_s(1000);
  });
  EXPECT_EQ(ended.how, Ending::cpu_limit);
  EXPECT_GT(ended.cpu_s, 0.35);
}

TEST_P(Faults, LimitsAreForEachJob) {
  options_.limits.wall_s = 0.4;
  options_.jobs = 1;
  for (const auto& [job, ended] : run(12, [](const Job&) {
         sleep_s(0.15);
         return "";
       })) {
    EXPECT_EQ(ended.how, Ending::done) << job;
    EXPECT_NEAR(ended.wall_s, 0.2, 0.1);
  }
}

TEST_P(Faults, MemoryWithoutBound) {
  options_.limits.memory_mb = 100;
  const Ended ended = among_others([](const Job&) { hoard(); });
  EXPECT_EQ(ended.how, Ending::memory_limit);
  EXPECT_GT(ended.peak_memory_mb, 100);
  EXPECT_LT(ended.peak_memory_mb, 400);
}

TEST_P(Faults, MemoryOfChildrenCounts) {
  options_.limits.memory_mb = 100;
  const Ended ended = among_others([](const Job&) {
    for (int i = 0; i < 6; ++i) {
      if (::fork() == 0) {
        const std::vector<char> part(30 << 20, 'x');
        sleep_s(1000 + part[5]);
      }
    }
    sleep_s(1000);
  });
  EXPECT_EQ(ended.how, Ending::memory_limit);
}

TEST_P(Faults, MemoryThatIsSharedCountsOnce) {
  if (altiplan::testing::kInstrumented) {
    GTEST_SKIP() << "a sanitizer takes memory of its own";
  }
  options_.limits.memory_mb = 150;
  const Ended ended = among_others([](const Job&) {
    const std::vector<char> all(80 << 20, 'x');
    for (int i = 0; i < 5; ++i) {
      if (::fork() == 0) {
        sleep_s(0.2);
        ::_exit(all[7] == 'x' ? 0 : 1);
      }
    }
    while (::wait(nullptr) > 0) {
    }
  });
  EXPECT_EQ(ended.how, Ending::done);
  EXPECT_NEAR(ended.peak_memory_mb, 80, 30);
}

TEST_P(Faults, ParentsMemoryDoesNotCount) {
  if (altiplan::testing::kInstrumented) {
    GTEST_SKIP() << "a sanitizer takes memory of its own";
  }
  const std::vector<char> much(300 << 20, 'x');
  options_.limits.memory_mb = 150;
  const Ended ended = among_others([&](const Job&) {
    std::vector<char> own(60 << 20, 'y');
    for (std::size_t i = 0; i < own.size(); ++i) {
      own[i] = char(own[i] ^ much[i]);
    }
    EXPECT_EQ(own[77], 'x' ^ 'y');
    sleep_s(0.1);
  });
  EXPECT_EQ(ended.how, Ending::done);
  EXPECT_NEAR(ended.peak_memory_mb, 60, 10);
}

TEST_P(Faults, PeakOfAShortJob) {
  if (altiplan::testing::kInstrumented) {
    GTEST_SKIP() << "a sanitizer takes memory of its own";
  }
  const auto all = run(10, [](const Job& job) {
    if (job.index % 2 == 0) {
      const std::vector<char> some(40 << 20, 'x');
      return std::string(1, some[job.index]);
    }
    return std::string("y");
  });
  for (const auto& [job, ended] : all) {
    EXPECT_NEAR(ended.peak_memory_mb, job % 2 == 0 ? 40 : 0, 5) << job;
  }
}

TEST_P(Faults, ForkBomb) {
  options_.limits.wall_s = 1;
  const fs::path count = path_.string() + ".count";
  std::ofstream(count).close();
  const Ended ended = among_others([&](const Job&) {
    ::prctl(PR_SET_CHILD_SUBREAPER, 0);
    const int file = ::open(count.c_str(), O_WRONLY | O_APPEND);
    while (::write(file, "x", 1) == 1 && ::lseek(file, 0, SEEK_END) < 300) {
      if (::fork() == 0 && ::getpid() % 2 == 0) {
        ::setsid();
      }
    }
    sleep_s(1000);
  });
  EXPECT_EQ(ended.how, Ending::wall_limit);
  EXPECT_GE(fs::file_size(count), 300U);
  fs::remove(count);
}

TEST_P(Faults, ForkBombBeyondTheLimit) {
  options_.limits.processes = 100;
  const Ended ended = among_others([&](const Job&) {
    for (int depth = 0; depth < 300; ++depth) {
      if (::fork() == 0) {
        sleep_s(1000);
      }
    }
    sleep_s(1000);
  });
  EXPECT_EQ(ended.how, Ending::process_limit);
}

TEST_P(Faults, LeavesChildrenBehind) {
  for (const bool hides : {false, true}) {
    const Ended ended = among_others([&](const Job&) {
      for (int i = 0; i < 3; ++i) {
        if (::fork() == 0) {
          if (hides) {
            ::setsid();
            const rlimit unmarked{RLIM_INFINITY, RLIM_INFINITY};
            ::setrlimit(RLIMIT_RSS, &unmarked);
            if (::fork() != 0) {
              ::_exit(0);
            }
          }
          sleep_s(1000);
        }
      }
      sleep_s(0.05);
    });
    EXPECT_EQ(ended.how, Ending::done);
    EXPECT_EQ(ended.left_behind, 3);
    EXPECT_EQ(ended.payload, "payload 4");
  }
}

TEST_P(Faults, ItsChildrenDieWithIt) {
  const Ended ended = among_others([](const Job&) {
    for (int i = 0; i < 3; ++i) {
      if (::fork() == 0) {
        ::setsid();
        sleep_s(1000);
      }
    }
    die_of(SIGSEGV);
  });
  EXPECT_EQ(ended.how, Ending::killed);
}

TEST_P(Faults, ClosesAllDescriptors) {
  EXPECT_EQ(among_others([](const Job&) { ::close_range(0, ~0U, 0); }).how, Ending::done);
}

TEST_P(Faults, UsesUpAllDescriptors) {
  const Ended ended = among_others([](const Job&) {
    while (::open("/dev/null", O_RDONLY) >= 0) {
    }
  });
  EXPECT_EQ(ended.how, Ending::done);
}

TEST_P(Faults, DamagesItsRecords) {
  const Ended ended = among_others([&](const Job&) {
    for (const fs::directory_entry& file : fs::directory_iterator(path_)) {
      if (file.path().extension() == ".records") {
        std::ofstream(file.path(), std::ios::app) << "garbage";
      }
    }
    std::ofstream(path_ / "worker-x.last") << "garbage";
  });
  // Its own file is not there yet where it has a process for itself: as it has at the second try.
  EXPECT_EQ(ended.how, Ending::done);
}

TEST_P(Faults, DamagesItsRecordAlways) {
  const Ended ended = among_others([&](const Job& job) {
    fs::path own = job.last_words;
    std::ofstream(own.replace_extension(".records"), std::ios::app) << "garbage";
  });
  EXPECT_EQ(ended.how, Ending::garbled);
}

TEST_P(Faults, RemovesItsRecords) {
  const Ended ended = among_others([&](const Job& job) {
    fs::path own = job.last_words;
    fs::remove(own.replace_extension(".records"));
  });
  EXPECT_EQ(ended.how, Ending::done);
}

TEST_P(Faults, RecordIsTooLarge) {
  options_.limits.file_mb = 1;
  const auto all =
      run(6, [](const Job& job) { return std::string(job.index == 3 ? 1 << 21 : 5, 'x'); });
  for (const auto& [job, ended] : all) {
    EXPECT_EQ(ended.how, job == 3 ? Ending::too_large : Ending::done);
  }
}

TEST_P(Faults, FileIsTooLarge) {
  options_.limits.file_mb = 1;
  const Ended ended = among_others([&](const Job& job) {
    const int file = ::open(job.scratch.c_str(), O_WRONLY | O_CREAT, 0666);
    const std::string much(1 << 20, 'x');
    while (::write(file, much.data(), much.size()) > 0) {
    }
  });
  EXPECT_EQ(ended.how, Ending::too_large);
}

TEST_P(Faults, FloodsStderr) {
  options_.limits.wall_s = 0.5;
  const Ended ended = among_others([](const Job&) {
    while (true) {
      std::fputs("and on and on it goes\n", stderr);
    }
  });
  EXPECT_EQ(ended.how, Ending::wall_limit);
  EXPECT_LE(ended.said.size(), 2048U);
  EXPECT_NE(ended.said.find("and on and on"), std::string::npos);
}

TEST_P(Faults, KillsItsOwnGroup) {
  const Ended ended = among_others([](const Job&) { ::kill(0, SIGKILL); });
  EXPECT_EQ(ended.how, Ending::killed);
  EXPECT_EQ(ended.signal, SIGKILL);
}

TEST_P(Faults, KilledOnceFromOutsideIsDoneAgain) {
  const fs::path once = path_.string() + ".once";
  const Ended ended = among_others([&](const Job&) {
    if (!fs::exists(once)) {
      std::ofstream(once) << "x";
      die_of(SIGKILL);
    }
  });
  EXPECT_EQ(ended.how, Ending::done);
  fs::remove(once);
}

TEST_P(Faults, ThreadsThatGoOnAreNotThereForTheNext) {
  const auto all = run(20, [](const Job& job) {
    std::error_code error;
    const auto threads = std::distance(fs::directory_iterator("/proc/self/task", error), {});
    if (job.index == 2) {
      std::thread([] { spin(); }).detach();
    }
    return std::to_string(threads);
  });
  for (const auto& [job, ended] : all) {
    EXPECT_EQ(ended.payload, all.at(0).payload) << job;
  }
}

TEST_P(Faults, DescriptorsOfTheParentAreClosed) {
  const int secret = ::open("/dev/zero", O_RDONLY);  // not close-on-exec
  const auto all = run(6, [&](const Job&) {
    return std::to_string(::fcntl(secret, F_GETFD)) + std::to_string(::fcntl(secret + 1, F_GETFD));
  });
  ::close(secret);
  for (const auto& [job, ended] : all) {
    EXPECT_EQ(ended.payload, "-1-1") << job;
  }
}

TEST_P(Faults, NoDescriptorIsLeft) {
  const auto open_files = [] {
    return std::distance(fs::directory_iterator("/proc/self/fd"), fs::directory_iterator());
  };
  const auto before = open_files();
  run(50, [](const Job& job) {
    if (job.index % 3 == 0) {
      ::_exit(1);
    }
    return std::string();
  });
  EXPECT_EQ(open_files(), before);
}

TEST_P(Faults, ManyCrashesAmongMany) {
  options_.jobs = 4;
  const auto all = run(300, [](const Job& job) {
    switch (job.index % 7) {
      case 2:
        die_of(SIGSEGV);
      case 4:
        ::_exit(3);
      default:
        return std::to_string(job.index);
    }
  });
  for (const auto& [job, ended] : all) {
    EXPECT_EQ(ended.how, job % 7 == 2   ? Ending::killed
                         : job % 7 == 4 ? Ending::exited
                                        : Ending::done)
        << job;
  }
}

// ---- the parent ----

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

TEST(JobRecord, EveryCutAndEveryFlippedByteIsTold) {
  Ended ended;
  ended.key = "scenario pipeline 7";
  ended.payload = "a payload";
  ended.wall_s = 1.5;
  ended.left_behind = 2;
  const std::string whole = record_text(ended);
  Ended taken;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    std::string_view cut = std::string_view(whole).substr(0, size);
    EXPECT_EQ(take_record(cut, taken), RecordState::cut_off) << size;
  }
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::string flipped = whole;
    flipped[at] = char(flipped[at] ^ 0x10);
    std::string_view text = flipped;
    EXPECT_NE(take_record(text, taken), RecordState::whole) << at;
  }
  const std::string two = whole + whole;
  std::string_view text = two;
  EXPECT_EQ(take_record(text, taken), RecordState::whole);
  EXPECT_EQ(text, whole);
  EXPECT_EQ(taken.payload, ended.payload);
  EXPECT_EQ(taken.key, ended.key);
  EXPECT_EQ(taken.wall_s, 1.5);
  EXPECT_EQ(taken.left_behind, 2);
}
}  // namespace
}  // namespace altiplan::host
