// SPDX-License-Identifier: Apache-2.0
#include <sha256.h>
#include <sys/types.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "altiplan_build.hpp"
#include "host/base/machine_fault.hpp"
#include "host/base/words.hpp"
#include "host/plugins/checksum.hpp"
#include "host/plugins/registry.hpp"
#include "host/scripts/script.hpp"

namespace altiplan::host {
namespace {

constexpr std::array<std::string_view, 8> kKinds = {"environment",   "constraint", "planner",
                                                    "local_planner", "smoother",   "tuner",
                                                    "objective",     "task"};

template <std::size_t N>
bool ends_with_nul(const char (&text)[N]) {
  return std::memchr(text, '\0', N) != nullptr;
}

std::string sanitizer_text(unsigned bits) {
  std::string text;
  for (const auto& [bit, name] :
       {std::pair{1U, "address"}, std::pair{2U, "thread"}, std::pair{4U, "memory"}}) {
    if ((bits & bit) != 0) {
      text += (text.empty() ? "" : "+") + std::string(name);
    }
  }
  return text.empty() ? "no sanitizer" : "sanitizer " + text;
}

/// Says that the record was built for an API that this host does not offer; "" if it offers it.
std::string other_api(const Manifest& plugin) {
  const auto version = [](int major, int minor) {
    return std::to_string(major) + "." + std::to_string(minor);
  };
  if (plugin.api_major == ALTIPLAN_API_MAJOR && plugin.api_minor <= ALTIPLAN_API_MINOR) {
    return "";
  }
  return "built for API " + version(plugin.api_major, plugin.api_minor) +
         ", this altiplan offers " + version(ALTIPLAN_API_MAJOR, ALTIPLAN_API_MINOR) +
         "; build it again (docs/how-to/write-a-plugin.md)";
}

/// The reason why this host cannot load a plugin with this manifest, naming both sides; "" if it
/// can.
std::string mismatch(const Manifest& plugin) {
  const Manifest host = make_manifest("", "", "");
  if (const std::string other = other_api(plugin); !other.empty()) {
    return other;
  }
  const auto differ = [](const char* what, unsigned theirs, unsigned ours) {
    return "built with " + std::string(what) + " = " + std::to_string(theirs) +
           ", this altiplan with " + std::to_string(ours);
  };
  if (plugin.cxx11_abi != host.cxx11_abi) {
    return differ("_GLIBCXX_USE_CXX11_ABI", plugin.cxx11_abi, host.cxx11_abi);
  }
  if (plugin.glibcxx_debug != host.glibcxx_debug) {
    return differ("_GLIBCXX_DEBUG", plugin.glibcxx_debug, host.glibcxx_debug);
  }
  if (plugin.sanitizers != host.sanitizers) {
    return "built with " + sanitizer_text(plugin.sanitizers) + ", this altiplan with " +
           sanitizer_text(host.sanitizers);
  }
  if (std::strcmp(plugin.api_hash, host.api_hash) != 0) {
    return "its headers' declarations have the hash " + std::string(plugin.api_hash) +
           ", this altiplan's " + host.api_hash + ": built with other headers; build it again";
  }
  return "";
}

/// The reason why the kit, or the formats, that this library was built with are not this host's; ""
/// if they are, or are not used. A plugin that brings along its own would bind to this process's.
std::string other_version(const ElfFile& elf) {
  constexpr std::string_view kPrefix = "libaltiplan-";
  constexpr std::string_view kEnd = ".so.";
  for (const std::string& needed : elf.dynamic_texts(DT_NEEDED)) {
    const std::size_t end = needed.find(kEnd);
    if (!needed.starts_with(kPrefix) || end == std::string::npos) {
      continue;
    }
    const std::string version = needed.substr(end + kEnd.size());
    if (version != ALTIPLAN_VERSION) {
      return "built with the " + needed.substr(kPrefix.size(), end - kPrefix.size()) +
             " of altiplan " + version + ", this is altiplan " ALTIPLAN_VERSION ": build it again";
    }
  }
  return "";
}

/// Adds the record to the library; throws ElfError if it is invalid.
void take_record(const Manifest& record, Library& library) {
  if (!ends_with_nul(record.api_hash) || !ends_with_nul(record.compiler) ||
      !ends_with_nul(record.kind) || !ends_with_nul(record.name) ||
      !ends_with_nul(record.sentence) || !ends_with_nul(record.file)) {
    throw ElfError("damaged manifest: an unterminated text");
  }
  if (std::find(kKinds.begin(), kKinds.end(), record.kind) == kKinds.end()) {
    throw ElfError("offers '" + std::string(record.name) + "' of the unknown kind '" + record.kind +
                   "'");
  }
  if (!is_snake_case(record.name)) {
    throw ElfError("offers a " + std::string(record.kind) + " named '" + record.name +
                   "', expected lower-case letters, digits and '_'");
  }
  for (const Manifest& other : library.plugins) {
    if (std::strcmp(other.kind, record.kind) == 0 && std::strcmp(other.name, record.name) == 0) {
      throw ElfError("offers the " + std::string(record.kind) + " '" + record.name +
                     "' twice: in " + other.file + " and in " + record.file);
    }
  }
  library.plugins.push_back(record);
}

/// The records of the manifest section; compilers may align each, with zeros in between.
void read_manifest(const std::string& bytes, Library& library) {
  std::size_t at = 0;
  while (at + sizeof(std::uint32_t) <= bytes.size()) {
    if (bytes.compare(at, 4, std::string(4, '\0')) == 0) {
      at += 4;
      continue;
    }
    constexpr std::size_t kFixed = offsetof(Manifest, cxx11_abi);
    if (bytes.size() - at < kFixed ||
        std::memcmp(bytes.data() + at, Manifest::kMagic, sizeof Manifest::kMagic) != 0) {
      throw ElfError("damaged manifest: expected 'altiplan plugin' at byte " + std::to_string(at));
    }
    Manifest record;
    std::memcpy(&record, bytes.data() + at, kFixed);
    if (record.struct_size != sizeof(Manifest)) {
      if (const std::string other = other_api(record); !other.empty()) {
        throw ElfError(other);
      }
      throw ElfError("its manifest has " + std::to_string(record.struct_size) +
                     " bytes per plugin, this altiplan's " + std::to_string(sizeof(Manifest)) +
                     ": built with other headers; build it again");
    }
    if (bytes.size() - at < sizeof(Manifest)) {
      throw ElfError("damaged manifest: cut off in a record");
    }
    std::memcpy(&record, bytes.data() + at, sizeof record);
    if (record.checksum != checksum_of(record)) {
      throw ElfError("damaged manifest: a record does not fit its checksum");
    }
    take_record(record, library);
    at += sizeof(Manifest);
  }
  if (library.plugins.empty()) {
    throw ElfError("its manifest is empty");
  }
  // The order of the records depends on the compiler.
  std::sort(library.plugins.begin(), library.plugins.end(),
            [](const Manifest& a, const Manifest& b) {
              const int kinds = std::strcmp(a.kind, b.kind);
              return kinds < 0 || (kinds == 0 && std::strcmp(a.name, b.name) < 0);
            });
}

std::string hash_of(const std::filesystem::path& file) {
  std::array<char, SHA256_DIGEST_STRING_LENGTH> digest;
  if (SHA256File(file.c_str(), digest.data()) == nullptr) {
    throw ElfError("cannot be read", errno);
  }
  return digest.data();
}
}  // namespace

Library examine_library(const std::filesystem::path& file) {
  if (is_script(file)) {
    return examine_script(file);
  }
  Library library;
  library.file = file;
  try {
    const ElfFile elf(file);
    library.build = elf.build_id();
    if (library.build.empty()) {
      library.build = hash_of(file);
    }
    if (!elf.has_section("altiplan_manifest")) {
      throw ElfError("not an altiplan plugin (no section altiplan_manifest)");
    }
    read_manifest(elf.section("altiplan_manifest"), library);
    for (const Manifest& plugin : library.plugins) {
      if (library.refused.empty()) {
        library.refused = mismatch(plugin);
      }
    }
    if (library.refused.empty()) {
      library.refused = other_version(elf);
    }
    if (library.refused.empty()) {
      library.checksum = hexadecimal(stated_checksum(elf).sum);
    }
  } catch (const ElfError& error) {
    library.refused = error.what();
    library.is_machine_fault = is_machine_fault(error.error());
  }
  return library;
}
}  // namespace altiplan::host
