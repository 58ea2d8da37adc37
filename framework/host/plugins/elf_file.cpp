// SPDX-License-Identifier: Apache-2.0
#include "host/plugins/elf_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace altiplan::host {
namespace {

#if defined(__x86_64__)
constexpr int kMachine = EM_X86_64;
#elif defined(__aarch64__)
constexpr int kMachine = EM_AARCH64;
#else
#error "the registry reads libraries of x86-64 and aarch64"
#endif

// Generous: a plugin library has a few dozen sections, and notes of about a hundred bytes.
constexpr std::uint64_t kMaxRead = std::uint64_t{1} << 20;

void check_identity(const Elf64_Ehdr& header) {
  if (std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0) {
    throw ElfError("not a library (not an ELF file)");
  }
  if (header.e_ident[EI_CLASS] != ELFCLASS64 || header.e_ident[EI_DATA] != ELFDATA2LSB ||
      header.e_machine != kMachine) {
    throw ElfError("built for another machine (ELF class " +
                   std::to_string(header.e_ident[EI_CLASS]) + ", machine " +
                   std::to_string(header.e_machine) + "), this one takes class " +
                   std::to_string(ELFCLASS64) + ", machine " + std::to_string(kMachine));
  }
  if (header.e_type != ET_DYN) {
    throw ElfError("not a shared library (ELF type " + std::to_string(header.e_type) + ")");
  }
  if (header.e_phentsize != sizeof(Elf64_Phdr) || header.e_shentsize != sizeof(Elf64_Shdr) ||
      header.e_phnum == 0 || header.e_shnum == 0 || header.e_shstrndx >= header.e_shnum) {
    throw ElfError("damaged: its ELF headers contradict each other");
  }
}
}  // namespace

ElfFile::ElfFile(const std::filesystem::path& file) {
  // O_NONBLOCK: opening a FIFO would wait for its other end.
  descriptor_ = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor_ < 0) {
    throw ElfError("cannot be opened", errno);
  }
  try {
    read_headers();
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

ElfFile::~ElfFile() { ::close(descriptor_); }

void ElfFile::read_headers() {
  struct stat status;
  if (::fstat(descriptor_, &status) != 0) {
    throw ElfError("cannot be read", errno);
  }
  if (!S_ISREG(status.st_mode)) {
    throw ElfError("not a regular file");
  }
  size_ = static_cast<std::uint64_t>(status.st_size);
  const auto header = at<Elf64_Ehdr>(read(0, sizeof(Elf64_Ehdr), "the ELF header"), 0);
  check_identity(header);

  const std::string segments =
      read(header.e_phoff, std::uint64_t{header.e_phnum} * sizeof(Elf64_Phdr), "program headers");
  for (std::size_t i = 0; i < header.e_phnum; ++i) {
    const auto segment = at<Elf64_Phdr>(segments, i * sizeof(Elf64_Phdr));
    check_range(segment.p_offset, segment.p_filesz, "a segment");
    segments_.push_back(segment);
  }

  const std::string table =
      read(header.e_shoff, std::uint64_t{header.e_shnum} * sizeof(Elf64_Shdr), "section headers");
  const auto names_header = at<Elf64_Shdr>(table, header.e_shstrndx * sizeof(Elf64_Shdr));
  const std::string names = read(names_header.sh_offset, names_header.sh_size, "section names");
  for (std::size_t i = 0; i < header.e_shnum; ++i) {
    const auto section = at<Elf64_Shdr>(table, i * sizeof(Elf64_Shdr));
    if (section.sh_type == SHT_NULL || section.sh_type == SHT_NOBITS) {
      continue;
    }
    check_range(section.sh_offset, section.sh_size, "a section");
    const std::size_t end = names.find('\0', section.sh_name);
    if (end == names.npos) {
      throw ElfError("damaged: a section without a name");
    }
    sections_.push_back(
        {names.substr(section.sh_name, end - section.sh_name), section.sh_offset, section.sh_size});
  }
}

void ElfFile::check_range(std::uint64_t offset, std::uint64_t size, const char* what) const {
  if (offset > size_ || size > size_ - offset) {
    throw ElfError(std::string("truncated: ") + what + " beyond the end of its " +
                   std::to_string(size_) + " bytes");
  }
}

std::string ElfFile::read(std::uint64_t offset, std::uint64_t size, const char* what) const {
  check_range(offset, size, what);
  if (size > kMaxRead) {
    throw ElfError(std::string("damaged: ") + what + " of " + std::to_string(size) + " bytes");
  }
  return read_all(offset, size);
}

std::string ElfFile::read_all(std::uint64_t offset, std::uint64_t size) const {
  std::string bytes(size, '\0');
  std::size_t done = 0;
  while (done < size) {
    const ssize_t got =
        ::pread(descriptor_, bytes.data() + done, size - done, static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) {
      continue;
    }
    if (got < 0) {
      throw ElfError("cannot be read", errno);
    }
    if (got == 0) {
      throw ElfError("cannot be read: it was truncated meanwhile");
    }
    done += static_cast<std::size_t>(got);
  }
  return bytes;
}

const ElfFile::Section* ElfFile::find(std::string_view name) const {
  const auto found = std::find_if(sections_.begin(), sections_.end(),
                                  [&](const Section& section) { return section.name == name; });
  return found == sections_.end() ? nullptr : &*found;
}

std::string ElfFile::section(std::string_view name) const {
  const Section* found = find(name);
  return found == nullptr ? "" : read(found->offset, found->size, "a section");
}

std::string ElfFile::loaded_bytes() const {
  std::uint64_t end = 0;
  for (const Elf64_Phdr& segment : segments_) {
    end = segment.p_type == PT_LOAD ? std::max(end, segment.p_offset + segment.p_filesz) : end;
  }
  return read_all(0, end);
}

std::vector<std::string> ElfFile::dynamic_texts(std::int64_t tag) const {
  const std::string entries = section(".dynamic");
  const std::string names = section(".dynstr");
  std::vector<std::string> texts;
  for (std::size_t i = 0; i + sizeof(Elf64_Dyn) <= entries.size(); i += sizeof(Elf64_Dyn)) {
    const auto entry = at<Elf64_Dyn>(entries, i);
    const std::size_t end = names.find('\0', entry.d_un.d_val);
    if (entry.d_tag == tag && end != names.npos) {
      texts.push_back(names.substr(entry.d_un.d_val, end - entry.d_un.d_val));
    }
  }
  return texts;
}

std::vector<std::string> ElfFile::exported_symbols() const {
  const std::string symbols = section(".dynsym");
  const std::string names = section(".dynstr");
  std::vector<std::string> exported;
  for (std::size_t i = 0; i + sizeof(Elf64_Sym) <= symbols.size(); i += sizeof(Elf64_Sym)) {
    const auto symbol = at<Elf64_Sym>(symbols, i);
    const bool local = ELF64_ST_BIND(symbol.st_info) == STB_LOCAL ||
                       ELF64_ST_VISIBILITY(symbol.st_other) != STV_DEFAULT;
    const std::size_t end = names.find('\0', symbol.st_name);
    if (symbol.st_shndx != SHN_UNDEF && !local && end != names.npos) {
      exported.push_back(names.substr(symbol.st_name, end - symbol.st_name));
    }
  }
  return exported;
}

std::string ElfFile::build_id() const {
  const std::string note = section(".note.gnu.build-id");
  if (note.size() < sizeof(Elf64_Nhdr) + 4) {
    return "";
  }
  const auto header = at<Elf64_Nhdr>(note, 0);
  const std::size_t start = sizeof(Elf64_Nhdr) + 4;  // after the name "GNU"
  if (header.n_type != NT_GNU_BUILD_ID || header.n_namesz != 4 ||
      header.n_descsz > note.size() - start) {
    return "";
  }
  constexpr const char* kDigits = "0123456789abcdef";
  std::string text;
  for (std::size_t i = start; i < start + header.n_descsz; ++i) {
    text += kDigits[static_cast<unsigned char>(note[i]) >> 4];
    text += kDigits[static_cast<unsigned char>(note[i]) & 15];
  }
  return text;
}
}  // namespace altiplan::host
