// SPDX-License-Identifier: Apache-2.0
#include "host/plugins/checksum.hpp"

#include <fcntl.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstring>

namespace altiplan::host {
namespace {

constexpr const char* kSection = "altiplan_checksum";

/// Location of the checksum section in the file.
std::uint64_t room_of(const ElfFile& elf) {
  const ElfFile::Section* section = elf.find(kSection);
  if (section == nullptr || section->size < sizeof(Checksum)) {
    throw ElfError(
        "has no checksum (no section altiplan_checksum): build it by altiplan_add_plugin");
  }
  return section->offset;
}

/// The dynamic section as the loader reads it, and the file offset of its strings.
struct Dynamic {
  std::uint64_t offset = 0;
  std::uint64_t size = 0;
  std::vector<Elf64_Dyn> entries;  ///< up to the end mark
  std::uint64_t strings = 0;
  std::uint64_t strings_size = 0;
};

bool is_run_path(const Elf64_Dyn& entry) {
  return entry.d_tag == DT_RPATH || entry.d_tag == DT_RUNPATH;
}

std::uint64_t file_offset(const ElfFile& elf, std::uint64_t address) {
  for (const Elf64_Phdr& segment : elf.segments()) {
    if (segment.p_type == PT_LOAD && address >= segment.p_vaddr &&
        address - segment.p_vaddr < segment.p_filesz) {
      return segment.p_offset + (address - segment.p_vaddr);
    }
  }
  throw ElfError("damaged: the strings of its dynamic section are in no segment");
}

Dynamic dynamic_of(const ElfFile& elf, const std::string& image) {
  Dynamic dynamic;
  for (const Elf64_Phdr& segment : elf.segments()) {
    if (segment.p_type == PT_DYNAMIC) {
      dynamic.offset = segment.p_offset;
      dynamic.size = segment.p_filesz;
    }
  }
  if (dynamic.offset + dynamic.size > image.size()) {
    throw ElfError("damaged: its dynamic section is not loaded");
  }
  for (std::uint64_t i = 0; i + sizeof(Elf64_Dyn) <= dynamic.size; i += sizeof(Elf64_Dyn)) {
    const auto entry = at<Elf64_Dyn>(image, dynamic.offset + i);
    if (entry.d_tag == DT_NULL) {
      break;
    }
    dynamic.entries.push_back(entry);
    if (entry.d_tag == DT_STRTAB) {
      dynamic.strings = file_offset(elf, entry.d_un.d_ptr);
    } else if (entry.d_tag == DT_STRSZ) {
      dynamic.strings_size = entry.d_un.d_val;
    }
  }
  if (dynamic.strings > image.size() || dynamic.strings_size > image.size() - dynamic.strings) {
    throw ElfError("damaged: the strings of its dynamic section are not loaded");
  }
  return dynamic;
}

/// Excludes the section headers' offset: strip moves them, and the loader ignores them.
void blank_section_headers(std::string& image) {
  const auto blank = [&](std::size_t from, std::size_t to) {
    std::fill(image.begin() + std::ptrdiff_t(from), image.begin() + std::ptrdiff_t(to), '\0');
  };
  blank(offsetof(Elf64_Ehdr, e_shoff), offsetof(Elf64_Ehdr, e_flags));
  blank(offsetof(Elf64_Ehdr, e_shentsize), sizeof(Elf64_Ehdr));
}

/// `cmake --install` writes another run path, or removes the entry and moves up the following ones.
/// The present text must begin where the linked one did: the loader checks no bound.
void blank_run_path(std::string& image, const Dynamic& dynamic, const Checksum& stated) {
  std::string kept;
  for (const Elf64_Dyn& entry : dynamic.entries) {
    if (!is_run_path(entry)) {
      kept.append(reinterpret_cast<const char*>(&entry), sizeof entry);
    } else if (stated.run_path_size == 0 || entry.d_un.d_val != stated.run_path) {
      throw ElfError("damaged: its run path is not where it was linked");
    }
  }
  kept.resize(dynamic.size, '\0');
  image.replace(dynamic.offset, dynamic.size, kept);
  if (std::uint64_t{stated.run_path} + stated.run_path_size > dynamic.strings_size) {
    throw ElfError("damaged: its run path is beyond its strings");
  }
  image.replace(dynamic.strings + stated.run_path, stated.run_path_size, stated.run_path_size,
                '\0');
}

std::uint32_t sum_of(const ElfFile& elf, std::string image, const Checksum& stated) {
  const std::uint64_t room = room_of(elf);
  if (room + sizeof(Checksum) > image.size()) {
    throw ElfError("damaged: its checksum is not loaded");
  }
  const Dynamic dynamic = dynamic_of(elf, image);
  blank_section_headers(image);
  blank_run_path(image, dynamic, stated);
  Checksum blank = stated;
  blank.sum = 0;
  std::memcpy(image.data() + room, &blank, sizeof blank);
  uLong sum = ::crc32_z(0, nullptr, 0);
  for (const Elf64_Phdr& segment : elf.segments()) {
    if (segment.p_type == PT_LOAD) {
      sum = ::crc32_z(sum, reinterpret_cast<const Bytef*>(image.data()) + segment.p_offset,
                      segment.p_filesz);
    }
  }
  return std::uint32_t(sum);
}

Checksum with_run_path_of(const Dynamic& dynamic, const std::string& image) {
  Checksum stated{};
  std::memcpy(stated.magic, Checksum::kMagic, sizeof stated.magic);
  for (const Elf64_Dyn& entry : dynamic.entries) {
    if (is_run_path(entry)) {
      const std::size_t from = dynamic.strings + entry.d_un.d_val;
      const std::size_t end = image.find('\0', from);
      if (end == image.npos) {
        throw ElfError("damaged: an unterminated run path");
      }
      stated.run_path = std::uint32_t(entry.d_un.d_val);
      stated.run_path_size = std::uint32_t(end - from);
    }
  }
  return stated;
}
}  // namespace

std::string hexadecimal(std::uint32_t sum) {
  char text[9];
  std::snprintf(text, sizeof text, "%08x", unsigned(sum));
  return text;
}

Checksum stated_checksum(const ElfFile& elf) {
  room_of(elf);
  const auto stated = at<Checksum>(elf.section(kSection), 0);
  if (std::memcmp(stated.magic, Checksum::kMagic, sizeof stated.magic) != 0) {
    throw ElfError("its checksum was not filled in after linking: build it by altiplan_add_plugin");
  }
  return stated;
}

void verify_checksum(const ElfFile& elf) {
  const Checksum stated = stated_checksum(elf);
  const std::uint32_t sum = sum_of(elf, elf.loaded_bytes(), stated);
  if (sum != stated.sum) {
    throw ElfError("damaged: its bytes have the checksum " + hexadecimal(sum) + ", expected " +
                   hexadecimal(stated.sum) + "; build or install it again");
  }
}

void write_checksum(const std::filesystem::path& file) {
  const ElfFile elf(file);
  const std::string image = elf.loaded_bytes();
  Checksum stated = with_run_path_of(dynamic_of(elf, image), image);
  stated.sum = sum_of(elf, image, stated);
  const int to = ::open(file.c_str(), O_WRONLY | O_CLOEXEC);
  const ssize_t written =
      to < 0 ? -1 : ::pwrite(to, &stated, sizeof stated, static_cast<off_t>(room_of(elf)));
  const int error = errno;
  if (to >= 0) {
    ::close(to);
  }
  if (written != ssize_t(sizeof stated)) {
    throw ElfError("cannot be written", error);
  }
}
}  // namespace altiplan::host
