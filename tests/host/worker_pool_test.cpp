// SPDX-License-Identifier: Apache-2.0
// Jobs of a pool that throw, crash, exit, and leave others behind.
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>
#include <thread>

#include "worker_pool_fixture.hpp"

namespace altiplan::host::worker_pool_test {
namespace {

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
      std::fputs("these are my crash report", stderr);
      std::ofstream(job.crash_report) << "left in a file";
      die_of(number);
    });
    EXPECT_EQ(ended.how, Ending::killed) << number;
    EXPECT_EQ(ended.signal, number);
    EXPECT_EQ(ended.note, "job 4 is at work");
    EXPECT_EQ(ended.output, "these are my crash report");
    EXPECT_EQ(ended.crash_report, "left in a file");
  }
}

int overflow(int depth) {
  volatile char frame[4096];
  frame[0] = char(depth);
  return depth < 0 ? frame[0] : overflow(depth + 1) + frame[0];
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

TEST_P(Faults, LeavesChildrenBehind) {
  for (const bool hides : {false, true}) {
    const Ended ended = among_others([&](const Job&) {
      for (int i = 0; i < 3; ++i) {
        const pid_t child = ::fork();
        if (child == 0) {
          if (hides) {
            ::setsid();
            const rlimit unmarked{RLIM_INFINITY, RLIM_INFINITY};
            ::setrlimit(RLIMIT_RSS, &unmarked);
            if (::fork() != 0) {
              ::_exit(0);
            }
          }
          sleep_s(1000);
        } else if (hides) {
          ::waitpid(child, nullptr, 0);  // it is gone; its child is not
        }
      }
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
}  // namespace
}  // namespace altiplan::host::worker_pool_test
