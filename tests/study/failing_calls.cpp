// SPDX-License-Identifier: Apache-2.0
/// Preloaded (LD_PRELOAD), it makes calls of the system fail for a while:
///
///   FAIL_COUNT   a file of two int32: how many calls go well yet, and how many fail then; less
///   than
///                0: all from then on
///   FAIL_CALL    open, fork or write
///   FAIL_PATH    what the name of an opened file holds
///   FAIL_ERROR   errno
///   FAIL_IN      first: in the first process; children: in the others; else in all
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

struct Count {
  std::atomic<std::int32_t> well;
  std::atomic<std::int32_t> fail;
};
Count* count = nullptr;
const pid_t first = ::getpid();

template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

Count* shared_count() {
  const char* file = std::getenv("FAIL_COUNT");
  const int opened = file == nullptr ? -1 : next<int(const char*, int, ...)>("open")(file, O_RDWR);
  void* memory = ::mmap(nullptr, sizeof(Count), PROT_READ | PROT_WRITE, MAP_SHARED, opened, 0);
  ::close(opened);
  return memory == MAP_FAILED ? nullptr : static_cast<Count*>(memory);
}

bool is(const char* variable, const char* value) {
  const char* text = std::getenv(variable);
  return text != nullptr && std::strcmp(text, value) == 0;
}

/// Whether this call is to fail; errno is set then.
bool fails(const char* call, const char* path) {
  static const bool kReady = (count = shared_count()) != nullptr;
  const char* part = std::getenv("FAIL_PATH");
  if (!kReady || !is("FAIL_CALL", call) ||
      (::getpid() == first ? is("FAIL_IN", "children") : is("FAIL_IN", "first")) ||
      (path != nullptr && (part == nullptr || std::strstr(path, part) == nullptr))) {
    return false;
  }
  if (count->well > 0 && count->well.fetch_sub(1) > 0) {
    return false;
  }
  if (count->fail == 0 || (count->fail > 0 && count->fail.fetch_sub(1) <= 0)) {
    return false;
  }
  errno = std::atoi(std::getenv("FAIL_ERROR"));
  return true;
}
}  // namespace

#pragma GCC visibility push(default)
extern "C" {

int open(const char* path, int flags, ...) {
  std::va_list more;
  va_start(more, flags);
  const mode_t mode = va_arg(more, mode_t);
  va_end(more);
  return fails("open", path) ? -1 : next<int(const char*, int, ...)>("open")(path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  std::va_list more;
  va_start(more, flags);
  const mode_t mode = va_arg(more, mode_t);
  va_end(more);
  return fails("open", path) ? -1 : next<int(const char*, int, ...)>("open64")(path, flags, mode);
}

FILE* fopen(const char* path, const char* mode) {
  return fails("open", path) ? nullptr : next<FILE*(const char*, const char*)>("fopen")(path, mode);
}

FILE* fopen64(const char* path, const char* mode) {
  return fails("open", path) ? nullptr
                             : next<FILE*(const char*, const char*)>("fopen64")(path, mode);
}

pid_t fork() noexcept { return fails("fork", nullptr) ? -1 : next<pid_t()>("fork")(); }

ssize_t write(int file, const void* bytes, std::size_t size) {
  return fails("write", nullptr)
             ? -1
             : next<ssize_t(int, const void*, std::size_t)>("write")(file, bytes, size);
}
}
