// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "altiplan/error.hpp"
#include "commands.hpp"

namespace altiplan::cli {

void expect_writable(const std::optional<std::string>& file, const char* option) {
  if (!file) {
    return;
  }
  if (file->empty()) {
    throw Error(std::string(option) + ": expected a file name, found nothing");
  }
  std::error_code error;
  if (std::filesystem::exists(*file, error) && !std::filesystem::is_directory(*file, error) &&
      access(file->c_str(), W_OK) != 0) {
    throw Error(std::string(option) + ": cannot write '" + *file + "': " + std::strerror(errno));
  }
  if (std::filesystem::is_other(*file, error)) {
    return;  // a device or a pipe: written in place
  }
  const auto folder = std::filesystem::absolute(*file, error).parent_path();
  if (!std::filesystem::is_directory(folder) || access(folder.c_str(), W_OK) != 0) {
    throw Error(std::string(option) + ": cannot write into the folder '" +
                (folder.empty() ? "." : folder.string()) + "'");
  }
  if (std::filesystem::is_directory(*file, error)) {
    throw Error(std::string(option) + ": '" + *file + "' is a folder");
  }
}

void expect_apart(const std::optional<std::string>& file, const char* option,
                  const std::vector<std::string>& others) {
  std::error_code error;
  for (const std::string& other : others) {
    const bool same = file && (*file == other || std::filesystem::equivalent(*file, other, error));
    if (same && !std::filesystem::is_other(*file, error)) {
      throw Error(std::string(option) + ": '" + *file +
                  "' is read, or written, by this call already: give another name");
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
