// SPDX-License-Identifier: Apache-2.0
#include "host/base/program.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <fstream>

#include "altiplan/error.hpp"
#include "altiplan/formats/input_file.hpp"

namespace altiplan::host::program_test {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;

/// Late enough for any machine.
Program::Clock::time_point late() { return Program::Clock::now() + std::chrono::seconds(60); }
Program::Clock::time_point soon() { return Program::Clock::now() + milliseconds(50); }

std::vector<std::string> shell(const std::string& script) { return {"/bin/sh", "-c", script}; }

std::string all_of(Program& program) {
  std::string text;
  while (program.receive(text, late())) {
  }
  return text;
}

TEST(Program, TalksThroughTheDescriptorsItIsWiredTo) {
  Program program(shell("cat <&3 >&4"), {.wired = {3, 4}});
  std::string sent(300'000, 'x');  // more than is buffered on the way
  for (const char end : {'\0', '\n', 'y'}) {
    sent += end;
  }
  std::string received;
  std::string_view left = sent;
  while (!left.empty()) {
    const std::string_view part = left.substr(0, 50'000);
    ASSERT_TRUE(program.send(part, late()));
    left.remove_prefix(part.size());
    while (received.size() + left.size() < sent.size()) {
      ASSERT_TRUE(program.receive(received, late()));
    }
  }
  program.finish_sending();
  EXPECT_EQ(received + all_of(program), sent);
  EXPECT_EQ(program.ended(late()), 0);
}

TEST(Program, ReportsHowItEnded) {
  EXPECT_EQ(Program(shell("exit 7")).ended(late()), 7);
  EXPECT_EQ(Program(shell("kill -9 $$")).ended(late()), -1);
  EXPECT_EQ(Program(shell("sleep 1000")).ended(soon()), std::nullopt);
  const TemporaryFolder folder;
  Program said(shell("echo nothing; echo $TMPDIR >&2"),
               {.errors = folder.path() / "errors", .temporary = "/elsewhere"});
  EXPECT_EQ(said.ended(late()), 0);
  EXPECT_EQ(formats::read_file((folder.path() / "errors").string()), "/elsewhere\n");
}

TEST(Program, OneThatHasEndedTakesNothing) {
  Program program(shell("exec 0<&-; exit 0"), {.wired = {0}});
  program.ended(late());
  EXPECT_FALSE(program.send(std::string(1'000'000, 'x'), late())) << "and no signal";
  std::string text;
  EXPECT_FALSE(program.receive(text, late()));
}

TEST(Program, OneThatDoesNotReadOrWriteIsNotWaitedForLonger) {
  Program program(shell("sleep 1000"), {.wired = {0}});
  std::string text;
  EXPECT_FALSE(program.receive(text, soon()));
  EXPECT_FALSE(program.send(std::string(10'000'000, 'x'), soon()));
}

TEST(Program, EndsWithAllThatItStarted) {
  std::string ids;
  {
    Program program(shell("sleep 1000 & echo $! >&3; wait"), {.wired = {3}});
    while (ids.find('\n') == std::string::npos) {
      ASSERT_TRUE(program.receive(ids, late()));
    }
  }
  const auto end = late();
  const pid_t child = std::stoi(ids);
  // Init, or who else adopts it, may take a moment to remove it.
  const auto lives = [&] {
    std::string state;
    std::getline(std::ifstream("/proc/" + std::to_string(child) + "/stat"), state);
    return !state.empty() && state.find(") Z ") == std::string::npos;
  };
  while (lives() && Program::Clock::now() < end) {
  }
  EXPECT_FALSE(lives());
}

TEST(Program, OneThatCannotBeStarted) {
  try {
    const Program program({"/nowhere"});
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "cannot start '/nowhere': No such file or directory");
  }
}

TEST(Program, IsFoundOnThePathButNotInTheCurrentFolder) {
  const TemporaryFolder folder;
  for (const char* name : {"second", "first"}) {
    std::ofstream(folder.path() / name) << "#!/bin/sh\n";
  }
  const std::string before = std::getenv("PATH");
  ::setenv("PATH", (":" + folder.path().string()).c_str(), 1);
  EXPECT_EQ(find_on_path({"first", "second"}), std::nullopt) << "not executable";
  fs::permissions(folder.path() / "second", fs::perms::owner_all);
  EXPECT_EQ(find_on_path({"first", "second"}), folder.path() / "second");
  const fs::path here = fs::current_path();
  fs::current_path(folder.path());
  ::setenv("PATH", "::", 1);
  EXPECT_EQ(find_on_path({"second"}), std::nullopt);
  fs::current_path(here);
  ::setenv("PATH", before.c_str(), 1);
}
}  // namespace
}  // namespace altiplan::host::program_test
