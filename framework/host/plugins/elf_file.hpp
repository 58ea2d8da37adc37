// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <elf.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace altiplan::host {

/// The reason why a file cannot be loaded as a library on this machine.
class ElfError : public std::runtime_error {
 public:
  explicit ElfError(const std::string& why) : runtime_error(why) {}
  /// "WHAT: No such file or directory"
  ElfError(const std::string& what, int error)
      : runtime_error(what + ": " + std::strerror(error)), error_(error) {}
  /// The errno of a file that could not be read; 0 if its content is invalid.
  int error() const { return error_; }

 private:
  int error_ = 0;
};

/// A shared library read as a file; none of its code runs. The constructor checks every header
/// against the file's size: the dynamic loader does not, and crashes on a truncated library. Reads
/// only headers and requested parts, not the whole file. Throws ElfError.
class ElfFile {
 public:
  explicit ElfFile(const std::filesystem::path& file);
  ~ElfFile();
  ElfFile(const ElfFile&) = delete;
  ElfFile& operator=(const ElfFile&) = delete;

  struct Section {
    std::string name;
    std::uint64_t offset = 0;
    std::uint64_t size = 0;
  };

  /// The section; null if there is none.
  const Section* find(std::string_view name) const;
  bool has_section(std::string_view name) const { return find(name) != nullptr; }
  /// Bytes of the section; "" if there is none.
  std::string section(std::string_view name) const;
  /// The program headers; their file ranges are within the file.
  const std::vector<Elf64_Phdr>& segments() const { return segments_; }
  /// The file up to the end of the last segment that the loader maps, without debug information.
  std::string loaded_bytes() const;
  /// The strings of the dynamic section with a tag (DT_NEEDED, DT_RUNPATH).
  std::vector<std::string> dynamic_texts(std::int64_t tag) const;
  /// The GNU build id in hexadecimal, or "".
  std::string build_id() const;
  /// Symbols that other libraries can bind to.
  std::vector<std::string> exported_symbols() const;

 private:
  std::string read(std::uint64_t offset, std::uint64_t size, const char* what) const;
  void check_range(std::uint64_t offset, std::uint64_t size, const char* what) const;
  std::string read_all(std::uint64_t offset, std::uint64_t size) const;
  void read_headers();

  int descriptor_ = -1;
  std::uint64_t size_ = 0;
  std::vector<Section> sections_;
  std::vector<Elf64_Phdr> segments_;
};

/// The struct at `offset` of bytes known to be long enough.
template <class T>
T at(const std::string& bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}
}  // namespace altiplan::host
