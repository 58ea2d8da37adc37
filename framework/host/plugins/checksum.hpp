// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "host/plugins/elf_file.hpp"

namespace altiplan::host {

/// The section `altiplan_checksum` of a library: space that cmake/plugin_checksum.cpp reserves and
/// the tool altiplan-checksum fills after linking. It covers every byte that the dynamic loader
/// maps, except what strip and `cmake --install` rewrite: the offset of the section headers, and
/// the run path with its entry in the dynamic section.
struct Checksum {
  static constexpr char kMagic[20] = "altiplan checksum";

  char magic[20];
  std::uint32_t run_path;       ///< offset of its text in the strings of the dynamic section
  std::uint32_t run_path_size;  ///< of the text as linked; 0 if there is none
  std::uint32_t sum;            ///< CRC-32: detects any change of up to four consecutive bytes
};

/// The checksum as shown in messages and results.
std::string hexadecimal(std::uint32_t sum);

/// The checksum stated in the file. Throws ElfError if the section was never filled.
Checksum stated_checksum(const ElfFile& elf);

/// Reads all mapped bytes; throws ElfError if they do not match the stated checksum.
void verify_checksum(const ElfFile& elf);

/// Fills the section in the file. Throws ElfError if it is missing or cannot be written.
void write_checksum(const std::filesystem::path& file);
}  // namespace altiplan::host
