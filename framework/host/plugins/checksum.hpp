// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "host/plugins/elf_file.hpp"

namespace altiplan::host {

/// The section `altiplan_checksum` of a library: room that cmake/plugin_checksum.cpp reserves and
/// the tool altiplan-checksum fills after linking. It covers every byte that the dynamic loader
/// maps, but for what strip and `cmake --install` rewrite: where the section headers are, and the
/// text of the run path with its entry in the dynamic section.
struct Checksum {
  static constexpr char kMagic[20] = "altiplan checksum";

  char magic[20];
  std::uint32_t run_path;       ///< where its text is in the strings of the dynamic section
  std::uint32_t run_path_size;  ///< of the text as it was linked; 0 where there is none
  std::uint32_t sum;            ///< CRC-32: no change of up to four bytes in a row keeps it
};

/// As messages and results show it.
std::string hexadecimal(std::uint32_t sum);

/// As the file states it. Throws ElfError where no tool has filled it.
Checksum stated_checksum(const ElfFile& elf);

/// Reads all that is mapped; throws ElfError where it does not fit what is stated.
void verify_checksum(const ElfFile& elf);

/// Fills the room in the file. Throws ElfError where there is none, or it cannot be written.
void write_checksum(const std::filesystem::path& file);
}  // namespace altiplan::host
