// SPDX-License-Identifier: Apache-2.0
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <utility>

#include "altiplan/error.hpp"
#include "commands.hpp"
#include "host/base/output_file.hpp"
#include "study/store/place.hpp"

namespace altiplan::cli {

void expect_writable(const std::optional<std::string>& file, const char* option) {
  if (!file) {
    return;
  }
  if (const std::string why = host::output_problem(*file); !why.empty()) {
    throw Error(std::string(option) + ": " + why);
  }
}

void expect_store_writable(const std::string& store, const char* option) {
  const std::filesystem::path place = study::place_of(store);
  expect_writable(place.string(), option);
  struct stat file {};
  if (::stat(place.c_str(), &file) != 0) {
    return;
  }
  for (const auto& [descriptor, name] :
       {std::pair(STDOUT_FILENO, "stdout"), {STDERR_FILENO, "stderr"}}) {
    struct stat stream {};
    if (::fstat(descriptor, &stream) == 0 && stream.st_dev == file.st_dev &&
        stream.st_ino == file.st_ino) {
      throw Error(std::string(option) + ": '" + store + "' is the file that " + name +
                  " is redirected to, which would overwrite the database: give another name");
    }
  }
}

void expect_apart(const std::optional<std::string>& file, const char* option,
                  const std::vector<std::string>& others) {
  std::error_code error;
  for (const std::string& other : others) {
    if (file && (*file == other || std::filesystem::equivalent(*file, other, error))) {
      throw Error(std::string(option) + ": '" + *file +
                  "' is already read or written by this command: give another name");
    }
  }
}

std::vector<std::string> files_of(const host::StoredResult& stored) {
  std::vector<std::string> files{stored.file};
  for (const host::Json& used : stored.json.at("files")) {
    files.push_back(used.at("path").get<std::string>());
  }
  return files;
}
}  // namespace altiplan::cli
