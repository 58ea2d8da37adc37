// SPDX-License-Identifier: Apache-2.0
#include "study/workers/job_record.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace altiplan::study {
namespace {

constexpr std::uint64_t kMagic = 0x3163'6552'696c'6c41;

struct Head {
  std::uint64_t magic = kMagic;
  std::uint64_t key_length = 0;
  std::uint64_t payload_length = 0;
  double wall_s = 0;
  double cpu_s = 0;
  double peak_memory_mb = 0;
  std::int32_t place = 0;
  std::int32_t left_behind = 0;
  std::uint32_t threw = 0;
  std::uint32_t crc = 0;  ///< of the head with 0 in this field, the key and the payload
};
static_assert(sizeof(Head) == 64);

std::uint32_t crc_of(Head head, std::string_view rest) {
  head.crc = 0;
  uLong crc = ::crc32_z(0, reinterpret_cast<const Bytef*>(&head), sizeof head);
  crc = ::crc32_z(crc, reinterpret_cast<const Bytef*>(rest.data()), rest.size());
  return std::uint32_t(crc);
}
}  // namespace

std::string record_text(const Ended& ended) {
  const std::string rest = ended.key + ended.payload;
  Head head;
  head.key_length = ended.key.size();
  head.payload_length = ended.payload.size();
  head.wall_s = ended.wall_s;
  head.cpu_s = ended.cpu_s;
  head.peak_memory_mb = ended.peak_memory_mb;
  head.place = ended.place;
  head.left_behind = ended.left_behind;
  head.threw = ended.how == Ending::threw ? 1 : 0;
  head.crc = crc_of(head, rest);
  return std::string(reinterpret_cast<const char*>(&head), sizeof head) + rest;
}

RecordState take_record(std::string_view& text, Ended& ended) {
  Head head;
  const std::size_t there = std::min(text.size(), sizeof head);
  if (std::memcmp(text.data(), &kMagic, std::min(there, sizeof kMagic)) != 0) {
    return RecordState::garbled;
  }
  if (there < sizeof head) {
    return RecordState::cut_off;
  }
  std::memcpy(&head, text.data(), sizeof head);
  const std::string_view rest = text.substr(sizeof head);
  if (head.key_length > rest.size() || head.payload_length > rest.size() - head.key_length) {
    return RecordState::cut_off;
  }
  const std::size_t length = head.key_length + head.payload_length;
  if (crc_of(head, rest.substr(0, length)) != head.crc) {
    return RecordState::garbled;
  }
  ended.key = rest.substr(0, head.key_length);
  ended.payload = rest.substr(head.key_length, head.payload_length);
  ended.how = head.threw != 0 ? Ending::threw : Ending::done;
  ended.wall_s = head.wall_s;
  ended.cpu_s = head.cpu_s;
  ended.peak_memory_mb = head.peak_memory_mb;
  ended.place = head.place;
  ended.left_behind = head.left_behind;
  text = rest.substr(length);
  return RecordState::whole;
}

int append_file(const std::string& file, std::string_view text) {
  const int to = ::open(file.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (to < 0) {
    return errno;
  }
  int error = ::fchmod(to, 0600) == 0 ? 0 : errno;  // independent of the umask
  while (!text.empty() && error == 0) {
    const ssize_t written = ::write(to, text.data(), text.size());
    if (written > 0) {
      text.remove_prefix(std::size_t(written));
    } else if (errno != EINTR) {
      error = written == 0 ? EIO : errno;
    }
  }
  if (::close(to) != 0 && error == 0) {
    error = errno;
  }
  return error;
}

ReadText read_from(const std::string& file, std::size_t offset, std::size_t at_most) {
  const int from = ::open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (from < 0) {
    return {"", errno};
  }
  ReadText read;
  struct stat status {};
  if (::fstat(from, &status) != 0) {
    read.error = errno;
  } else if (!S_ISREG(status.st_mode)) {
    read.error = EINVAL;
  } else {
    const std::size_t size = std::size_t(status.st_size);
    read.text.resize(std::min(size - std::min(size, offset), at_most));
    std::size_t there = 0;
    ssize_t got = 1;
    while (there < read.text.size() && got != 0 && read.error == 0) {
      got =
          ::pread(from, read.text.data() + there, read.text.size() - there, off_t(offset + there));
      there += std::size_t(std::max<ssize_t>(got, 0));
      read.error = got < 0 && errno != EINTR ? errno : 0;
    }
    read.text.resize(there);
  }
  ::close(from);
  return read;
}
}  // namespace altiplan::study
