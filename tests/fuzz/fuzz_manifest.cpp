// SPDX-License-Identifier: Apache-2.0
// The reader of plugin libraries. After an even first byte the input is the file. After an odd one
// it says how a whole library is damaged: three bytes a change (where, where, exclusive or), so
// that the fuzzer need not find the layout of a manifest of this build; where its second bit is set
// the records' checksums are made to fit again, so that what stands behind them is reached.
#include <elf.h>

#include <cstring>

#include "altiplan/planner.hpp"
#include "altiplan/plugin_abi.hpp"
#include "fuzz/memory_file.hpp"
#include "host/plugins/checksum.hpp"
#include "host/plugins/registry.hpp"

namespace {
using namespace altiplan;

constexpr std::size_t kRecordsAt = sizeof(Elf64_Ehdr) + sizeof(Elf64_Phdr);
constexpr std::size_t kRecords = 2;

template <class T>
void append(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

Elf64_Shdr section(unsigned name, unsigned type, std::size_t offset, std::size_t size) {
  Elf64_Shdr header{};
  header.sh_name = name;
  header.sh_type = type;
  header.sh_offset = offset;
  header.sh_size = size;
  return header;
}

/// The least that examine_library takes for a library of two plugins.
std::string whole_library() {
  const std::string names("\0altiplan_manifest\0.note.gnu.build-id\0.shstrtab\0altiplan_checksum\0",
                          66);
  std::string note;
  append(note, Elf64_Nhdr{4, 20, NT_GNU_BUILD_ID});
  note += std::string("GNU\0abcdefghijklmnopqrst", 24);
  std::string body;
  append(body, make_manifest("planner", "fuzz", "a sentence"));
  append(body, make_manifest("smoother", "fuzz", "another"));
  const std::size_t manifest_size = body.size();
  host::Checksum checksum{};
  std::memcpy(checksum.magic, host::Checksum::kMagic, sizeof checksum.magic);
  append(body, checksum);
  const std::size_t start = kRecordsAt;
  const std::size_t note_at = start + body.size();
  const std::size_t names_at = note_at + note.size();
  const std::size_t table_at = names_at + names.size();

  Elf64_Ehdr header{};
  std::memcpy(header.e_ident, ELFMAG, SELFMAG);
  header.e_ident[EI_CLASS] = ELFCLASS64;
  header.e_ident[EI_DATA] = ELFDATA2LSB;
  header.e_type = ET_DYN;
#if defined(__x86_64__)
  header.e_machine = EM_X86_64;
#else
  header.e_machine = EM_AARCH64;
#endif
  header.e_phoff = sizeof(Elf64_Ehdr);
  header.e_shoff = table_at;
  header.e_phentsize = sizeof(Elf64_Phdr);
  header.e_phnum = 1;
  header.e_shentsize = sizeof(Elf64_Shdr);
  header.e_shnum = 5;
  header.e_shstrndx = 3;
  Elf64_Phdr segment{};
  segment.p_type = PT_LOAD;
  segment.p_filesz = table_at;
  std::string file;
  append(file, header);
  append(file, segment);
  file += body + note + names;
  append(file, section(0, SHT_NULL, 0, 0));
  append(file, section(1, SHT_PROGBITS, start, manifest_size));
  append(file, section(19, SHT_NOTE, note_at, note.size()));
  append(file, section(38, SHT_STRTAB, names_at, names.size()));
  append(file, section(48, SHT_PROGBITS, start + manifest_size, sizeof checksum));
  return file;
}

void mend_checksums(std::string& bytes) {
  for (std::size_t i = 0; i < kRecords; ++i) {
    Manifest record;
    char* at = bytes.data() + kRecordsAt + i * sizeof record;
    std::memcpy(&record, at, sizeof record);
    record.checksum = checksum_of(record);
    std::memcpy(at, &record, sizeof record);
  }
}

std::string changed(const std::uint8_t* data, std::size_t size) {
  static const std::string kWhole = whole_library();
  std::string bytes = kWhole;
  for (std::size_t i = 0; i + 3 <= size; i += 3) {
    const std::size_t at = (data[i] | std::size_t{data[i + 1]} << 8) % bytes.size();
    bytes[at] = static_cast<char>(bytes[at] ^ data[i + 2]);
  }
  return bytes;
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) {
    return 0;
  }
  static const fuzz::MemoryFolder kFolder;
  const bool as_it_is = data[0] % 2 == 0;
  std::string bytes =
      as_it_is ? std::string(fuzz::text_of(data + 1, size - 1)) : changed(data + 1, size - 1);
  if (!as_it_is && (data[0] & 2) != 0) {
    mend_checksums(bytes);
  }
  const host::Library library =
      host::examine_library(kFolder.write("libaltiplan_planner_fuzz.so", bytes));
  if (library.refused.empty() && library.plugins.empty()) {
    std::abort();  // neither refused nor offering anything
  }
  if (!as_it_is && size == 1 && !library.refused.empty()) {
    std::abort();  // the undamaged library
  }
  return 0;
}
