// SPDX-License-Identifier: Apache-2.0
#include "altiplan/formats/input_file.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "support/files.hpp"

namespace altiplan::formats::input_file_test {
namespace {

using altiplan::testing::TempFolder;

std::string refusal(const std::string& file) {
  std::string why;
  try {
    read_file(file);
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(), file + ": " + error.why());
    why = error.why();
  }
  EXPECT_EQ(why_unreadable(file), why);
  try {
    const InputFile stream(file);
  } catch (const InputError& error) {
    EXPECT_EQ(error.why(), why);
  }
  return why;
}

TEST(InputFile, OnlyRegularFilesAreOpened) {
  const TempFolder folder;
  const std::string pipe = (folder / "pipe").string();
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(refusal(pipe), "is a pipe, expected a file");
  std::filesystem::create_symlink("pipe", folder / "link");
  EXPECT_EQ(refusal((folder / "link").string()), "is a pipe, expected a file");
  EXPECT_EQ(refusal("/dev/zero"), "is a device, expected a file");
  EXPECT_EQ(refusal((folder / "").string()), "is a folder, expected a file");
  EXPECT_EQ(refusal((folder / "none").string()), "there is no such file");
  EXPECT_EQ(refusal(folder.write("file", "").string() + "/of"),
            "cannot be opened: Not a directory");
  EXPECT_EQ(refusal(""), "there is no such file");

  const int made = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string socket = (folder / "socket").string();
  ASSERT_LT(socket.size(), sizeof address.sun_path);
  std::strcpy(address.sun_path, socket.c_str());
  ASSERT_EQ(::bind(made, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  EXPECT_EQ(refusal(socket), "is a socket, expected a file");
  ::close(made);
}

TEST(InputFile, ReadsAllBytes) {
  const TempFolder folder;
  std::string bytes(200'000, 'x');
  bytes[7] = '\0';
  bytes[70'000] = '\r';
  const std::string file = folder.write("file", bytes).string();
  EXPECT_EQ(read_file(file), bytes);
  EXPECT_EQ(read_file(file, bytes.size()), bytes);
  EXPECT_EQ(read_file(folder.write("empty", "").string()), "");
  EXPECT_NE(read_file("/proc/self/status").find("Name:"), std::string::npos)
      << "a file that says that it has no bytes";

  InputFile stream(folder.write("lines", "one\ntwo\n").string());
  std::string line;
  std::getline(stream, line);
  EXPECT_EQ(line, "one");
  std::getline(stream, line);
  EXPECT_EQ(line, "two");
  EXPECT_FALSE(std::getline(stream, line));
  stream.clear();
  stream.seekg(0);
  std::getline(stream, line);
  EXPECT_EQ(line, "one");
}

TEST(InputFile, NamesWhatCannotBeReadOn) {
  const std::string file = "/proc/self/mem";  // at its first byte there is no memory
  InputFile stream(file);
  std::string line;
  try {
    std::getline(stream, line);
    FAIL() << "no exception";
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(), file + ": cannot be read: Input/output error");
  }
}

TEST(InputFile, NeverReadsMoreThanItsCap) {
  const TempFolder folder;
  const std::string file = folder.write("file", "12345").string();
  EXPECT_THROW(read_file(file, 4), InputError);
  EXPECT_THROW(read_file("/proc/self/status", 4), InputError) << "found only while it is read";
}
}  // namespace
}  // namespace altiplan::formats::input_file_test
