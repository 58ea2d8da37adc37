// SPDX-License-Identifier: Apache-2.0
#include "altiplan/formats/input_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <ext/stdio_filebuf.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <vector>

#include "altiplan/formats/descriptor.hpp"

namespace altiplan::formats {
namespace {

/// What the path is instead of a regular file; "" for a regular file.
std::string why_irregular(const struct stat& found) {
  const char* const what = S_ISREG(found.st_mode)    ? ""
                           : S_ISDIR(found.st_mode)  ? "a folder"
                           : S_ISFIFO(found.st_mode) ? "a pipe"
                           : S_ISSOCK(found.st_mode) ? "a socket"
                                                     : "a device";
  return *what == '\0' ? "" : "is " + std::string(what) + ", expected a file";
}

std::string why_not_opened(const std::string& file, int error) {
  return error == ENOENT ? "there is no such file" + nearest_beside(file, false)
                         : std::string("cannot be opened: ") + std::strerror(error);
}

/// Opens a regular file; for anything else `why` gets the reason.
Descriptor open_regular(const std::string& file, std::string& why) {
  struct stat found {};
  if (::stat(file.c_str(), &found) != 0) {
    why = why_not_opened(file, errno);
    return Descriptor(-1);
  }
  // Checked before opening too, as opening a device has side effects.
  if (why = why_irregular(found); !why.empty()) {
    return Descriptor(-1);
  }
  Descriptor opened(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
  if (opened.number() < 0) {
    why = why_not_opened(file, errno);
    return opened;
  }
  why = ::fstat(opened.number(), &found) != 0 ? why_not_opened(file, errno) : why_irregular(found);
  return opened;
}

Descriptor open_or_throw(const std::string& file) {
  std::string why;
  Descriptor opened = open_regular(file, why);
  if (!why.empty()) {
    throw InputError(file, why);
  }
  return opened;
}

/// Names the file that cannot be read, and the reason, where the library only reports "underflow
/// error".
class NamedBuffer : public __gnu_cxx::stdio_filebuf<char> {
  template <class Read>
  auto named(const Read& read) {
    try {
      return read();
    } catch (const std::ios_base::failure& error) {
      throw InputError(file_, "cannot be read: " + error.code().message());
    }
  }

 public:
  explicit NamedBuffer(const std::string& file)
      : stdio_filebuf(open_or_throw(file).release(), std::ios::in | std::ios::binary),
        file_(file) {}

 protected:
  int_type underflow() override {
    return named([this] { return stdio_filebuf::underflow(); });
  }
  std::streamsize xsgetn(char* to, std::streamsize count) override {
    return named([&] { return stdio_filebuf::xsgetn(to, count); });
  }

 private:
  std::string file_;
};

std::string in_mega(std::uintmax_t bytes) {
  constexpr std::uintmax_t kMega = 1'000'000;
  return bytes % kMega == 0 ? std::to_string(bytes / kMega) + " MB"
                            : std::to_string(bytes >> 20) + " MiB";
}
}  // namespace

std::string nearest_beside(const std::string& missing, bool is_folder) {
  namespace fs = std::filesystem;
  const fs::path path(missing);
  std::vector<std::string> names;
  std::error_code unlisted;
  for (const auto& entry :
       fs::directory_iterator(path.has_parent_path() ? path.parent_path() : ".", unlisted)) {
    std::error_code unknown;
    if (is_folder ? entry.is_directory(unknown) : entry.is_regular_file(unknown)) {
      names.push_back(entry.path().filename().string());
    }
  }
  const std::string near = nearest_name(path.filename().string(), names);
  const bool is_printable =
      std::all_of(near.begin(), near.end(), [](unsigned char c) { return c >= ' ' && c < 127; });
  return near.empty() || !is_printable ? "" : "; did you mean '" + near + "'?";
}

InputError::~InputError() = default;

std::string why_unreadable(const std::string& file) {
  std::string why;
  open_regular(file, why);
  return why;
}

InputFile::InputFile(const std::string& file) : std::istream(nullptr) {
  buffer_ = std::make_unique<NamedBuffer>(file);
  rdbuf(buffer_.get());
  exceptions(std::ios::badbit);  // rethrows the buffer's exceptions
}

InputFile::~InputFile() = default;

std::string ending_of(const std::string& file) {
  std::string ending = std::filesystem::path(file).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char letter) { return char(std::tolower(letter)); });
  return ending;
}

std::string read_file(const std::string& file, std::uintmax_t max_bytes) {
  const Descriptor opened = open_or_throw(file);
  struct stat found {};
  ::fstat(opened.number(), &found);
  const auto refuse_size = [&] {
    throw InputError(file, "is larger than " + in_mega(max_bytes) + ", the largest size accepted");
  };
  if (std::uintmax_t(found.st_size) > max_bytes) {
    refuse_size();
  }
  // A file of size 0 may have content, as below /proc, and a growing file gets longer.
  constexpr std::size_t kBlock = 65536;
  std::string text(std::size_t(found.st_size) + 1, '\0');
  std::size_t size = 0;
  while (true) {
    if (size == text.size()) {
      text.resize(size + kBlock);
    }
    const ssize_t got = ::read(opened.number(), text.data() + size, text.size() - size);
    if (got == 0) {
      break;
    }
    if (got < 0 && errno != EINTR) {
      throw InputError(file, std::string("cannot be read: ") + std::strerror(errno));
    }
    size += std::size_t(std::max<ssize_t>(got, 0));
    if (size > max_bytes) {
      refuse_size();
    }
  }
  text.resize(size);
  return text;
}
}  // namespace altiplan::formats
