// SPDX-License-Identifier: Apache-2.0
// Descriptors of a job, and what becomes of the records that it writes.
#include <fcntl.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "study/workers/job_record.hpp"
#include "worker_pool_fixture.hpp"

namespace altiplan::host::worker_pool_files_test {
using namespace study;
namespace {

using FileFaults = Faults;
INSTANTIATE_TEST_SUITE_P(Reuse, FileFaults, ::testing::Values(1, 8));

TEST_P(FileFaults, ClosesAllDescriptors) {
  EXPECT_EQ(among_others([](const Job&) { ::close_range(0, ~0U, 0); }).how, Ending::done);
}

TEST_P(FileFaults, UsesUpAllDescriptors) {
  const Ended ended = among_others([](const Job&) {
    while (::open("/dev/null", O_RDONLY) >= 0) {
    }
  });
  EXPECT_EQ(ended.how, Ending::done);
}

TEST_P(FileFaults, DamagesItsRecords) {
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

TEST_P(FileFaults, DamagesItsRecordAlways) {
  const Ended ended = among_others([&](const Job& job) {
    fs::path own = job.crash_report;
    std::ofstream(own.replace_extension(".records"), std::ios::app) << "garbage";
  });
  EXPECT_EQ(ended.how, Ending::garbled);
}

TEST_P(FileFaults, RemovesItsRecords) {
  const Ended ended = among_others([&](const Job& job) {
    fs::path own = job.crash_report;
    fs::remove(own.replace_extension(".records"));
  });
  EXPECT_EQ(ended.how, Ending::done);
}

TEST_P(FileFaults, DescriptorsOfTheParentAreClosed) {
  const int secret = ::open("/dev/zero", O_RDONLY);  // not close-on-exec
  const auto all = run(6, [&](const Job&) {
    return std::to_string(::fcntl(secret, F_GETFD)) + std::to_string(::fcntl(secret + 1, F_GETFD));
  });
  ::close(secret);
  for (const auto& [job, ended] : all) {
    EXPECT_EQ(ended.payload, "-1-1") << job;
  }
}

TEST_P(FileFaults, NoDescriptorIsLeft) {
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
}  // namespace altiplan::host::worker_pool_files_test
