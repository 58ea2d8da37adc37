// SPDX-License-Identifier: Apache-2.0
#include <filesystem>

#include "altiplan/error.hpp"
#include "commands.hpp"
#include "host/base/output_file.hpp"

namespace altiplan::cli {

void expect_writable(const std::optional<std::string>& file, const char* option) {
  if (!file) {
    return;
  }
  if (const std::string why = host::output_problem(*file); !why.empty()) {
    throw Error(std::string(option) + ": " + why);
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
