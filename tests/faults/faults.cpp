// SPDX-License-Identifier: Apache-2.0
// Preloaded (LD_PRELOAD), it stands in front of the system's calls and makes some fail (fate.hpp).
// Only calls through the dynamic linker are seen: not those that the C library makes within itself,
// but for streams, whose open, read, flush and close stand below.
#include <dirent.h>
#include <dlfcn.h>
#include <pthread.h>
#include <spawn.h>
#include <stdio_ext.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/uio.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "fate.hpp"

extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* old, std::size_t size);
}

using namespace faults;  // NOLINT: it stands in front of C

namespace {
template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}
}  // namespace

// The function `name`, in whose body real_name() is the one that it hides. It is known to the
// compiler by another name, under which no header has declared anything.
#define IN_FRONT_OF(result, name, ...)                                                        \
  namespace {                                                                                 \
  [[maybe_unused]] auto* real_##name() {                                                      \
    static auto* const found = next<result(__VA_ARGS__)>(#name);                              \
    return found;                                                                             \
  }                                                                                           \
  }                                                                                           \
  extern "C"                                                                                  \
      [[gnu::visibility("default"), gnu::used]] result faulty_##name(__VA_ARGS__) asm(#name); \
  result faulty_##name(__VA_ARGS__)

// --- open

#define OPEN(name)                                                              \
  IN_FRONT_OF(int, name, const char* file, int flags, int mode) {               \
    return fails(kOpen, path_of(file)) ? -1 : real_##name()(file, flags, mode); \
  }
#define OPEN_AT(name)                                                                           \
  IN_FRONT_OF(int, name, int folder, const char* file, int flags, int mode) {                   \
    return fails(kOpen, path_of(file, folder)) ? -1 : real_##name()(folder, file, flags, mode); \
  }
#define OPEN_STREAM(name)                                                     \
  IN_FRONT_OF(FILE*, name, const char* file, const char* mode) {              \
    return fails(kOpen, path_of(file)) ? nullptr : real_##name()(file, mode); \
  }
#define MAKE_TEMPORARY(name)                                              \
  IN_FRONT_OF(int, name, char* file, int flags) {                         \
    return fails(kOpen, path_of(file)) ? -1 : real_##name()(file, flags); \
  }
OPEN(open)
OPEN(open64)
OPEN_AT(openat)
OPEN_AT(openat64)
OPEN_STREAM(fopen)
OPEN_STREAM(fopen64)
MAKE_TEMPORARY(mkstemp)
MAKE_TEMPORARY(mkstemp64)
MAKE_TEMPORARY(mkostemp)
MAKE_TEMPORARY(mkostemp64)
IN_FRONT_OF(DIR*, opendir, const char* file) {
  return fails(kOpen, path_of(file)) ? nullptr : real_opendir()(file);
}

// --- read and write

#define READ_OR_WRITE(name, call, bytes_type)                                \
  IN_FRONT_OF(ssize_t, name, int file, bytes_type bytes, std::size_t size) { \
    const std::size_t part = granted(call, file, size);                      \
    return part == 0 && size > 0 ? -1 : real_##name()(file, bytes, part);    \
  }
#define READ_OR_WRITE_AT(name, call, bytes_type)                                       \
  IN_FRONT_OF(ssize_t, name, int file, bytes_type bytes, std::size_t size, off_t at) { \
    const std::size_t part = granted(call, file, size);                                \
    return part == 0 && size > 0 ? -1 : real_##name()(file, bytes, part, at);          \
  }
#define PARTS(name, call)                                                        \
  IN_FRONT_OF(ssize_t, name, int file, const iovec* parts, int count) {          \
    return granted(call, file, 1) == 0 ? -1 : real_##name()(file, parts, count); \
  }
READ_OR_WRITE(read, kRead, void*)
READ_OR_WRITE(write, kWrite, const void*)
READ_OR_WRITE_AT(pread, kRead, void*)
READ_OR_WRITE_AT(pread64, kRead, void*)
READ_OR_WRITE_AT(pwrite, kWrite, const void*)
READ_OR_WRITE_AT(pwrite64, kWrite, const void*)
PARTS(readv, kRead)
PARTS(writev, kWrite)
IN_FRONT_OF(ssize_t, __read_chk, int file, void* bytes, std::size_t size, std::size_t room) {
  const std::size_t part = granted(kRead, file, size);
  return part == 0 && size > 0 ? -1 : real___read_chk()(file, bytes, part, room);
}

// --- streams: what is written goes out when the buffer is full, and at last when it is closed

namespace {
constexpr int kErrorSeen = 0x20;  // of glibc's _flags

bool stream_fails(Call call, FILE* stream) {
  if (granted(call, ::fileno(stream), 1) != 0) {
    return false;
  }
  stream->_flags |= kErrorSeen;
  return true;
}
}  // namespace

IN_FRONT_OF(std::size_t, fread, void* bytes, std::size_t size, std::size_t count, FILE* stream) {
  return stream_fails(kRead, stream) ? 0 : real_fread()(bytes, size, count, stream);
}
IN_FRONT_OF(std::size_t, fwrite, const void* bytes, std::size_t size, std::size_t count,
            FILE* stream) {
  const bool goes_out = __fpending(stream) + size * count > BUFSIZ;
  return goes_out && stream_fails(kWrite, stream) ? 0 : real_fwrite()(bytes, size, count, stream);
}
IN_FRONT_OF(int, fputs, const char* text, FILE* stream) {
  const bool goes_out = __fpending(stream) + std::strlen(text) > BUFSIZ;
  return goes_out && stream_fails(kWrite, stream) ? EOF : real_fputs()(text, stream);
}
IN_FRONT_OF(int, fflush, FILE* stream) {
  const bool goes_out = stream != nullptr && __fpending(stream) > 0;
  return goes_out && stream_fails(kWrite, stream) ? EOF : real_fflush()(stream);
}
IN_FRONT_OF(int, fclose, FILE* stream) {
  const Path path = path_of(::fileno(stream));
  const bool not_written = __fpending(stream) > 0 && stream_fails(kWrite, stream);
  int error = errno;
  if (not_written) {
    __fpurge(stream);
  }
  const bool not_closed = !not_written && path[0] != '\0' && fails(kClose, path);
  error = not_closed ? errno : error;
  const int closed = real_fclose()(stream);
  if (not_written || not_closed) {
    errno = error;
    return EOF;
  }
  return closed;
}

// --- what is done to open files

#define ON_FILE(name, call) \
  IN_FRONT_OF(int, name, int file) { return fails(call, path_of(file)) ? -1 : real_##name()(file); }
#define ON_FILE_WITH(name, call, type)                                   \
  IN_FRONT_OF(int, name, int file, type value) {                         \
    return fails(call, path_of(file)) ? -1 : real_##name()(file, value); \
  }
ON_FILE(fsync, kSync)
ON_FILE(fdatasync, kSync)
ON_FILE_WITH(ftruncate, kTruncate, off_t)
ON_FILE_WITH(ftruncate64, kTruncate, off_t)
ON_FILE_WITH(fstat, kStat, struct stat*)
ON_FILE_WITH(fstat64, kStat, struct stat*)
ON_FILE_WITH(flock, kLock, int)
IN_FRONT_OF(int, close, int file) {  // it is closed, whatever is said
  const bool not_closed = fails(kClose, path_of(file));
  const int error = errno;
  const int closed = real_close()(file);
  errno = not_closed ? error : errno;
  return not_closed ? -1 : closed;
}
IN_FRONT_OF(int, posix_fallocate, int file, off_t from, off_t size) {
  return fails(kTruncate, path_of(file)) ? errno : real_posix_fallocate()(file, from, size);
}

namespace {
constexpr int kDuplicate = 0;  // F_DUPFD
constexpr int kDuplicateCloseOnExec = 1030;
constexpr int kSetLock = 6;
constexpr int kSetLockAndWait = 7;

bool control_fails(int file, int command) {
  return ((command == kDuplicate || command == kDuplicateCloseOnExec) && fails(kDescriptor)) ||
         ((command == kSetLock || command == kSetLockAndWait) && fails(kLock, path_of(file)));
}
}  // namespace
IN_FRONT_OF(int, fcntl, int file, int command, long value) {
  return control_fails(file, command) ? -1 : real_fcntl()(file, command, value);
}
IN_FRONT_OF(int, fcntl64, int file, int command, long value) {
  return control_fails(file, command) ? -1 : real_fcntl64()(file, command, value);
}

// --- what is done by name

#define ON_NAME(name, call)                                       \
  IN_FRONT_OF(int, name, const char* file) {                      \
    return fails(call, path_of(file)) ? -1 : real_##name()(file); \
  }
#define ON_NAME_WITH(name, call, type)                                   \
  IN_FRONT_OF(int, name, const char* file, type value) {                 \
    return fails(call, path_of(file)) ? -1 : real_##name()(file, value); \
  }
#define ON_NAMES(name, call)                                        \
  IN_FRONT_OF(int, name, const char* from, const char* to) {        \
    return fails(call, path_of(to)) ? -1 : real_##name()(from, to); \
  }
ON_NAME(unlink, kUnlink)
ON_NAME(rmdir, kUnlink)
ON_NAME(remove, kUnlink)
ON_NAME_WITH(truncate, kTruncate, off_t)
ON_NAME_WITH(mkdir, kMkdir, mode_t)
ON_NAME_WITH(stat, kStat, struct stat*)
ON_NAME_WITH(stat64, kStat, struct stat*)
ON_NAME_WITH(lstat, kStat, struct stat*)
ON_NAME_WITH(lstat64, kStat, struct stat*)
ON_NAME_WITH(access, kStat, int)
ON_NAMES(rename, kRename)
ON_NAMES(link, kLink)
ON_NAMES(symlink, kLink)
IN_FRONT_OF(int, unlinkat, int folder, const char* file, int flags) {
  return fails(kUnlink, path_of(file, folder)) ? -1 : real_unlinkat()(folder, file, flags);
}
IN_FRONT_OF(int, renameat2, int folder, const char* from, int other, const char* to,
            unsigned flags) {
  return fails(kRename, path_of(to, other)) ? -1 : real_renameat2()(folder, from, other, to, flags);
}
IN_FRONT_OF(int, renameat, int folder, const char* from, int other, const char* to) {
  return fails(kRename, path_of(to, other)) ? -1 : real_renameat()(folder, from, other, to);
}
IN_FRONT_OF(int, linkat, int folder, const char* from, int other, const char* to, int flags) {
  return fails(kLink, path_of(to, other)) ? -1 : real_linkat()(folder, from, other, to, flags);
}

// --- processes, threads and memory

IN_FRONT_OF(pid_t, fork) {
  if (fails(kFork)) {
    return -1;
  }
  const pid_t child = real_fork()();
  if (child == 0) {
    begin_own_count();
  }
  return child;
}
#define SPAWN(name)                                                                               \
  IN_FRONT_OF(int, name, pid_t* child, const char* file, const posix_spawn_file_actions_t* files, \
              const posix_spawnattr_t* attributes, char* const* arguments,                        \
              char* const* variables) {                                                           \
    return fails(kFork) ? errno                                                                   \
                        : real_##name()(child, file, files, attributes, arguments, variables);    \
  }
SPAWN(posix_spawn)
SPAWN(posix_spawnp)
IN_FRONT_OF(int, pthread_create, pthread_t* thread, const pthread_attr_t* attributes,
            void* (*work)(void*), void* with) {
  return fails(kFork) ? EAGAIN : real_pthread_create()(thread, attributes, work, with);
}

#define MAP(name)                                                                           \
  IN_FRONT_OF(void*, name, void* at, std::size_t size, int protection, int flags, int file, \
              off_t from) {                                                                 \
    return fails(kMap, file < 0 ? Path{} : path_of(file))                                   \
               ? MAP_FAILED                                                                 \
               : real_##name()(at, size, protection, flags, file, from);                    \
  }
MAP(mmap)
MAP(mmap64)

// As much as malloc asks the system for anew.
namespace {
constexpr std::size_t kLarge = 128 * 1024;
bool no_memory(std::size_t size) { return size >= kLarge && fails(kMap); }
}  // namespace
IN_FRONT_OF(void*, malloc, std::size_t size) {
  return no_memory(size) ? nullptr : __libc_malloc(size);
}
IN_FRONT_OF(void*, calloc, std::size_t count, std::size_t size) {
  return no_memory(count * size) ? nullptr : __libc_calloc(count, size);
}
IN_FRONT_OF(void*, realloc, void* old, std::size_t size) {
  return no_memory(size) ? nullptr : __libc_realloc(old, size);
}

// --- descriptors that are no files'

#define DESCRIPTOR(name, arguments, ...) \
  IN_FRONT_OF(int, name, __VA_ARGS__) { return fails(kDescriptor) ? -1 : real_##name() arguments; }
DESCRIPTOR(pipe, (ends), int* ends)
DESCRIPTOR(pipe2, (ends, flags), int* ends, int flags)
DESCRIPTOR(socketpair, (domain, type, protocol, ends), int domain, int type, int protocol,
           int* ends)
DESCRIPTOR(memfd_create, (name, flags), const char* name, unsigned flags)
DESCRIPTOR(signalfd, (file, mask, flags), int file, const sigset_t* mask, int flags)
DESCRIPTOR(dup, (file), int file)
