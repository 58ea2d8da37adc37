// SPDX-License-Identifier: Apache-2.0
// ZIP archives as APPNOTE.TXT 6.3 of PKWARE describes them, without its 64-bit extension.
#include "host/base/zip.hpp"

#include <zlib.h>

#include "altiplan/error.hpp"
#include "host/base/deflate.hpp"

namespace altiplan::host {
namespace {

constexpr std::uint32_t kLocalEntry = 0x04034b50;
constexpr std::uint32_t kListedEntry = 0x02014b50;
constexpr std::uint32_t kEndOfList = 0x06054b50;
constexpr std::size_t kLocalSize = 30;  // of the records, without their names
constexpr std::size_t kListedSize = 46;
constexpr std::size_t kEndSize = 22;
constexpr std::uint64_t kVersion = 20;         // deflate
constexpr std::uint64_t kDeflated = 8;         // method; 0: stored
constexpr std::uint64_t kUtf8Names = 1 << 11;  // flag
constexpr std::uint64_t kFirstDay = 0x0021;    // 1980-01-01
constexpr std::size_t kMaxContent = 64'000'000;

/// Appends the low bytes of a number, the lowest first.
void put(std::string& out, std::uint64_t value, int bytes) {
  for (int n = 0; n < bytes; ++n) {
    out += static_cast<char>(value >> (8 * n) & 0xff);
  }
}

std::uint64_t number_at(std::string_view zip, std::size_t at, std::size_t bytes) {
  if (at > zip.size() || bytes > zip.size() - at) {
    throw Error("the ZIP archive is damaged: it ends too early");
  }
  std::uint64_t value = 0;
  for (std::size_t n = bytes; n-- > 0;) {
    value = value << 8 | static_cast<unsigned char>(zip[at + n]);
  }
  return value;
}

std::uint32_t checksum_of(std::string_view content) {
  return std::uint32_t(
      crc32(0, reinterpret_cast<const Bytef*>(content.data()), uInt(content.size())));
}

/// What the entry's two records have in common, from its version to the length of its name.
std::string common_part(const std::string& name, const std::string& content,
                        std::size_t compressed_size) {
  std::string part;
  put(part, kVersion, 2);
  put(part, kUtf8Names, 2);
  put(part, kDeflated, 2);
  put(part, 0, 2);  // midnight
  put(part, kFirstDay, 2);
  put(part, checksum_of(content), 4);
  put(part, compressed_size, 4);
  put(part, content.size(), 4);
  put(part, name.size(), 2);
  return part;
}

/// The content of the entry whose record in the archive's list begins there.
std::string content_of(std::string_view zip, std::size_t listed) {
  constexpr std::uint64_t kEncrypted = 1;
  if ((number_at(zip, listed + 8, 2) & kEncrypted) != 0) {
    throw Error("the ZIP archive is encrypted");
  }
  const std::uint64_t method = number_at(zip, listed + 10, 2);
  const std::uint64_t checksum = number_at(zip, listed + 16, 4);
  const std::size_t size = number_at(zip, listed + 20, 4);
  const std::size_t local = number_at(zip, listed + 42, 4);
  const std::size_t begin =
      local + kLocalSize + number_at(zip, local + 26, 2) + number_at(zip, local + 28, 2);
  if (begin > zip.size() || size > zip.size() - begin) {
    throw Error("the ZIP archive is damaged: it ends too early");
  }
  const std::string_view bytes = zip.substr(begin, size);
  if (method != 0 && method != kDeflated) {
    throw Error("the ZIP archive is compressed by another method than deflate");
  }
  const std::optional<std::string> content =
      method == 0 ? std::string(bytes) : inflated(bytes, kMaxContent);
  if (!content) {
    throw Error("the ZIP archive holds more than 64 MB");
  }
  if (checksum_of(*content) != checksum) {
    throw Error("the ZIP archive is damaged: a checksum differs");
  }
  return *content;
}
}  // namespace

bool is_zip(std::string_view bytes) { return bytes.starts_with("PK\x03\x04"); }

std::string zip_of(const std::vector<std::pair<std::string, std::string>>& entries) {
  std::string archive;
  std::string list;
  for (const auto& [name, content] : entries) {
    const std::string bytes = deflated(content);
    const std::string common = common_part(name, content, bytes.size());
    put(list, kListedEntry, 4);
    put(list, kVersion, 2);
    list += common;
    put(list, 0, 8);  // no extra field, comment, further disks
    put(list, 0, 4);  // or attributes
    put(list, archive.size(), 4);
    list += name;
    put(archive, kLocalEntry, 4);
    archive += common;
    put(archive, 0, 2);
    archive += name + bytes;
  }
  const std::size_t begin_of_list = archive.size();
  archive += list;
  put(archive, kEndOfList, 4);
  put(archive, 0, 4);  // the only disk
  put(archive, entries.size(), 2);
  put(archive, entries.size(), 2);
  put(archive, list.size(), 4);
  put(archive, begin_of_list, 4);
  put(archive, 0, 2);
  return archive;
}

namespace {
/// Looks at the names of the entries and where they are listed, until `look` returns false.
template <class Look>
void each_entry(std::string_view zip, const Look& look) {
  const std::size_t end = zip.rfind("PK\x05\x06");
  if (end == std::string_view::npos || zip.size() - end < kEndSize) {
    throw Error("the ZIP archive is damaged: its list of files is missing");
  }
  const std::size_t count = number_at(zip, end + 10, 2);
  std::size_t at = number_at(zip, end + 16, 4);
  for (std::size_t n = 0; n < count; ++n) {
    if (number_at(zip, at, 4) != kListedEntry) {
      throw Error("the ZIP archive is damaged: its list of files ends too early");
    }
    const std::size_t name_size = number_at(zip, at + 28, 2);
    number_at(zip, at + kListedSize + name_size, 0);  // the name is there
    if (!look(zip.substr(at + kListedSize, name_size), at)) {
      return;
    }
    at += kListedSize + name_size + number_at(zip, at + 30, 2) + number_at(zip, at + 32, 2);
  }
}
}  // namespace

std::vector<std::string> zip_names(std::string_view zip) {
  std::vector<std::string> names;
  each_entry(zip, [&](std::string_view name, std::size_t) {
    names.emplace_back(name);
    return true;
  });
  return names;
}

std::optional<std::string> zip_entry(std::string_view zip, std::string_view ending) {
  std::optional<std::string> content;
  each_entry(zip, [&](std::string_view name, std::size_t at) {
    if (name.ends_with(ending)) {
      content = content_of(zip, at);
    }
    return !content;
  });
  return content;
}
}  // namespace altiplan::host
