// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdlib.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>

namespace altiplan::fuzz {

/// A folder of this process in memory, where the system has such a file system; gone at exit.
class MemoryFolder {
 public:
  MemoryFolder() {
    const bool shm = ::access("/dev/shm", W_OK) == 0;
    std::string made = std::string(shm ? "/dev/shm" : "/tmp") + "/altiplan_fuzz_XXXXXX";
    if (::mkdtemp(made.data()) == nullptr) {
      std::perror("no folder for the files of a fuzz target");
      std::abort();
    }
    path_ = made;
  }
  ~MemoryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  MemoryFolder(const MemoryFolder&) = delete;
  MemoryFolder& operator=(const MemoryFolder&) = delete;

  /// Writes the file anew.
  std::filesystem::path write(const std::string& name, std::string_view bytes) const {
    const std::filesystem::path file = path_ / name;
    std::FILE* stream = std::fopen(file.c_str(), "wb");
    if (stream == nullptr || std::fwrite(bytes.data(), 1, bytes.size(), stream) != bytes.size() ||
        std::fclose(stream) != 0) {
      std::perror(file.c_str());
      std::abort();
    }
    return file;
  }

 private:
  std::filesystem::path path_;
};

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}
}  // namespace altiplan::fuzz

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer calls it by this name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
