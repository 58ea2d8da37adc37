// SPDX-License-Identifier: Apache-2.0
#include "file_watch.hpp"

#include <fcntl.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <future>
#include <thread>

namespace altiplan::cli {
namespace fs = std::filesystem;
namespace {

/// A system call that changes files: the indices of its arguments for the path, the folder that the
/// path is relative to (-1: the working folder) and the flags of open (-1: none).
struct Call {
  int number;
  const char* does;
  int path;
  int folder = -1;
  int flags = -1;
};
constexpr Call kCalls[] = {
    {SYS_openat, "opens", 1, 0, 2},
    {SYS_mkdirat, "creates the folder", 1, 0},
    {SYS_unlinkat, "removes", 1, 0},
    {SYS_renameat, "renames", 1, 0},
    {SYS_renameat2, "renames", 1, 0},
    {SYS_truncate, "truncates", 0},
    {SYS_linkat, "creates the link", 3, 2},
    {SYS_symlinkat, "creates the link", 2, 1},
    {SYS_mknodat, "makes", 1, 0},
    {SYS_fchmodat, "changes", 1, 0},
    {SYS_fchownat, "changes", 1, 0},
    {SYS_utimensat, "changes", 1, 0},
#ifdef SYS_open  // the legacy calls of x86-64
    {SYS_open, "opens", 0, -1, 1},
    {SYS_creat, "opens", 0},
    {SYS_mkdir, "creates the folder", 0},
    {SYS_rmdir, "removes", 0},
    {SYS_unlink, "removes", 0},
    {SYS_rename, "renames", 0},
    {SYS_link, "creates the link", 1},
    {SYS_symlink, "creates the link", 1},
    {SYS_mknod, "makes", 0},
    {SYS_chmod, "changes", 0},
    {SYS_chown, "changes", 0},
#endif
};

/// Those calls wait for the listener's answer, all others pass. Returns the listener's descriptor,
/// -1 if the system refuses the filter.
int install_filter() {
  std::vector<sock_filter> program{BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr))};
  for (const Call& call : kCalls) {
    program.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, std::uint32_t(call.number), 0, 1));
    program.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_USER_NOTIF));
  }
  program.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));
  const sock_fprog filter{static_cast<unsigned short>(program.size()), program.data()};
  if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) {
    return -1;
  }
  return int(
      ::syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, SECCOMP_FILTER_FLAG_NEW_LISTENER, &filter));
}

/// Text in the memory of another thread or process, which may have ended meanwhile.
std::string text_at(pid_t process, std::uint64_t address) {
  std::string text;
  while (text.size() < 4096) {
    std::array<char, 256> part;
    // Never across the end of a page: the next one may be unmapped.
    const std::size_t room = part.size() - address % part.size();
    const iovec here{part.data(), room};
    const iovec there{reinterpret_cast<void*>(address), room};  // NOLINT: as the kernel has it
    const ssize_t got = ::process_vm_readv(process, &here, 1, &there, 1, 0);
    if (got <= 0) {
      return text;
    }
    const char* const end = std::find(part.data(), part.data() + got, '\0');
    text.append(part.data(), std::size_t(end - part.data()));
    if (end != part.data() + got) {
      return text;
    }
    address += std::uint64_t(got);
  }
  return text;
}

fs::path whole_path(const seccomp_notif& asked, const Call& call) {
  const auto argument = [&](int at) { return asked.data.args[std::size_t(at)]; };
  const auto process = pid_t(asked.pid);
  const fs::path path = text_at(process, argument(call.path));
  const int folder = call.folder < 0 ? AT_FDCWD : int(argument(call.folder));
  const std::string from = folder == AT_FDCWD ? "/cwd" : "/fd/" + std::to_string(folder);
  std::error_code error;
  const fs::path base = fs::read_symlink("/proc/" + std::to_string(process) + from, error);
  // Links are resolved; the last part may not exist yet. Only opening resolves that part too.
  const fs::path whole = (base / path).lexically_normal();
  return call.flags >= 0 ? fs::weakly_canonical(whole, error)
                         : fs::weakly_canonical(whole.parent_path(), error) / whole.filename();
}

/// True if the call would change the file at its path. (A file of O_TMPFILE has no name.)
bool changes(const seccomp_notif& asked, const Call& call) {
  if (asked.data.args[std::size_t(call.path)] == 0) {
    return false;  // acts on an open file
  }
  const std::uint64_t flags = call.flags < 0 ? O_WRONLY : asked.data.args[std::size_t(call.flags)];
  return (flags & (O_WRONLY | O_RDWR | O_CREAT | O_TRUNC)) != 0 && (flags & O_TMPFILE) != O_TMPFILE;
}

bool below(const fs::path& path, const fs::path& folder) {
  const auto parted = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return parted.first == folder.end();
}
}  // namespace

FileWatch::FileWatch(fs::path scratch) : scratch_(fs::canonical(scratch)) {
#ifdef ALTIPLAN_SANITIZED
  return;  // the leak sanitizer stops all threads, this one's too, and then opens files
#endif
  std::promise<int> listener;
  // The thread starts before the filter is installed, which therefore does not apply to it.
  std::thread([this, of = listener.get_future()]() mutable { serve(of.get()); }).detach();
  const int filter = install_filter();
  works_ = filter >= 0;
  listener.set_value(filter);
}

void FileWatch::serve(int listener) {
  while (listener >= 0) {
    seccomp_notif asked{};
    if (::ioctl(listener, SECCOMP_IOCTL_NOTIF_RECV, &asked) != 0) {
      continue;  // the caller has gone
    }
    const auto call = std::find_if(std::begin(kCalls), std::end(kCalls),
                                   [&](const Call& one) { return one.number == asked.data.nr; });
    if (changes(asked, *call)) {
      const fs::path path = whole_path(asked, *call);
      if (!below(path, scratch_) && !below(path, "/dev") && !below(path, "/proc")) {
        note(std::string(call->does) + " " + path.string() +
             (call->flags >= 0 ? " for writing" : ""));
      }
    }
    seccomp_notif_resp answer{};
    answer.id = asked.id;
    answer.flags = SECCOMP_USER_NOTIF_FLAG_CONTINUE;
    ::ioctl(listener, SECCOMP_IOCTL_NOTIF_SEND, &answer);
  }
}

void FileWatch::note(const std::string& what) {
  constexpr std::size_t kMax = 5;
  const std::lock_guard lock(mutex_);
  if (written_.size() < kMax && std::count(written_.begin(), written_.end(), what) == 0) {
    written_.push_back(what);
  }
}

std::vector<std::string> FileWatch::written() const {
  const std::lock_guard lock(mutex_);
  return written_;
}
}  // namespace altiplan::cli
