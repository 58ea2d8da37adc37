// SPDX-License-Identifier: Apache-2.0
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <utility>

#include "altiplan/error.hpp"
#include "commands.hpp"
#include "study/store/place.hpp"

namespace altiplan::cli {

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

}  // namespace altiplan::cli
