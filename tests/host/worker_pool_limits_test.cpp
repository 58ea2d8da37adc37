// SPDX-License-Identifier: Apache-2.0
// Jobs of a pool that would take all the time, memory, processes and disk there is.
#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "support/instrumented.hpp"
#include "worker_pool_fixture.hpp"

namespace altiplan::host::worker_pool_limits_test {
namespace {

using LimitFaults = Faults;
INSTANTIATE_TEST_SUITE_P(Reuse, LimitFaults, ::testing::Values(1, 8));

TEST_P(LimitFaults, Hangs) {
  options_.limits.wall_s = 0.3;
  const auto began = std::chrono::steady_clock::now();
  const Ended ended = among_others([](const Job&) { sleep_s(1000); });
  EXPECT_EQ(ended.how, Ending::wall_limit);
  EXPECT_NEAR(ended.wall_s, 0.3, 0.25);
  EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(5));
}

TEST_P(LimitFaults, StopsItself) {
  options_.limits.wall_s = 0.3;
  EXPECT_EQ(among_others([](const Job&) { ::raise(SIGSTOP); }).how, Ending::wall_limit);
}

TEST_P(LimitFaults, HangsAndIgnoresAllSignals) {
  options_.limits.wall_s = 0.3;
  const Ended ended = among_others([](const Job&) {
    sigset_t all;
    sigfillset(&all);
    ::sigprocmask(SIG_BLOCK, &all, nullptr);
    sleep_s(1000);
  });
  EXPECT_EQ(ended.how, Ending::wall_limit);
}

TEST_P(LimitFaults, Spins) {
  options_.limits.cpu_s = 0.3;
  const Ended ended = among_others([](const Job&) { spin(); });
  EXPECT_EQ(ended.how, Ending::cpu_limit);
  EXPECT_NEAR(ended.cpu_s, 0.4, 0.2);
}

TEST_P(LimitFaults, ChildrenSpinInItsPlace) {
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

TEST_P(LimitFaults, LimitsAreForEachJob) {
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

[[noreturn]] void hoard() {
  std::vector<std::vector<char>> all;
  while (true) {
    all.emplace_back(1 << 20, 'x');
    sleep_s(0.0005);
  }
}

TEST_P(LimitFaults, MemoryWithoutBound) {
  options_.limits.memory_mb = 100;
  const Ended ended = among_others([](const Job&) { hoard(); });
  EXPECT_EQ(ended.how, Ending::memory_limit);
  EXPECT_GT(ended.peak_memory_mb, 100);
  EXPECT_LT(ended.peak_memory_mb, 400);
}

TEST_P(LimitFaults, MemoryOfChildrenCounts) {
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

TEST_P(LimitFaults, MemoryThatIsSharedCountsOnce) {
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

TEST_P(LimitFaults, ParentsMemoryDoesNotCount) {
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

TEST_P(LimitFaults, PeakOfAShortJob) {
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

TEST_P(LimitFaults, ForkBomb) {
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

TEST_P(LimitFaults, ForkBombBeyondTheLimit) {
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

TEST_P(LimitFaults, RecordIsTooLarge) {
  options_.limits.file_mb = 1;
  const auto all =
      run(6, [](const Job& job) { return std::string(job.index == 3 ? 1 << 21 : 5, 'x'); });
  for (const auto& [job, ended] : all) {
    EXPECT_EQ(ended.how, job == 3 ? Ending::too_large : Ending::done);
  }
}

TEST_P(LimitFaults, FileIsTooLarge) {
  options_.limits.file_mb = 1;
  const Ended ended = among_others([&](const Job& job) {
    const int file = ::open(job.scratch.c_str(), O_WRONLY | O_CREAT, 0666);
    const std::string much(1 << 20, 'x');
    while (::write(file, much.data(), much.size()) > 0) {
    }
  });
  EXPECT_EQ(ended.how, Ending::too_large);
}

TEST_P(LimitFaults, FloodsStderr) {
  options_.limits.wall_s = 0.5;
  const Ended ended = among_others([](const Job&) {
    while (true) {
      std::fputs("and on and on it goes\n", stderr);
    }
  });
  EXPECT_EQ(ended.how, Ending::wall_limit);
  EXPECT_LE(ended.output.size(), 2048U);
  EXPECT_NE(ended.output.find("and on and on"), std::string::npos);
}
}  // namespace
}  // namespace altiplan::host::worker_pool_limits_test
