// SPDX-License-Identifier: Apache-2.0
#include "study/workers/worker.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>

#include "study/workers/job_record.hpp"
#include "study/workers/process_tree.hpp"

namespace altiplan::study {
namespace {

void write_system_file(const char* file, std::string_view text) {
  const int to = ::open(file, O_WRONLY | O_CLOEXEC);
  if (to >= 0) {
    [[maybe_unused]] const ssize_t written = ::write(to, text.data(), text.size());
    ::close(to);
  }
}

void limit(int which, rlim_t soft) {
  rlimit now{};
  ::getrlimit(__rlimit_resource_t(which), &now);
  now.rlim_cur = std::min(soft, now.rlim_max);
  ::setrlimit(__rlimit_resource_t(which), &now);
}

/// Detaches from the parent: session, signals, descriptors, limits.
void stand_alone(const WorkerTask& task) {
  ::setsid();
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != task.parent) {
    ::_exit(0);  // the parent ended before PR_SET_PDEATHSIG
  }
  ::prctl(PR_SET_CHILD_SUBREAPER, 1);  // so that orphans are adopted by the worker
  set_mark(task.mark);
  if (!task.group.empty()) {
    write_system_file(task.group.c_str(), "0");
  }
  const int nothing = ::open("/dev/null", O_RDONLY);
  ::dup2(nothing, STDIN_FILENO);
  ::dup2(task.output, STDOUT_FILENO);
  ::dup2(task.output, STDERR_FILENO);
  ::close_range(3, ~0U, 0);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_FSIZE, rlim_t(task.limits.file_mb * double(1 << 20)));
  write_system_file("/proc/self/oom_score_adj",
                    "1000");  // so that the kernel does not choose the parent
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGCHLD, SIGPIPE, SIGXFSZ}) {
    ::signal(signal, SIG_DFL);
  }
  sigset_t none;
  sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
}

double cpu_s() {
  double sum = 0;
  for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage used{};
    ::getrusage(__rusage_who_t(who), &used);
    sum += double(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
           1e-6 * double(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
  }
  return sum;
}

/// Reaps ended children; returns the number of the others.
int children_left() {
  pid_t reaped = 0;
  while ((reaped = ::waitpid(-1, nullptr, WNOHANG)) > 0) {
  }
  return reaped < 0 ? 0 : std::max(1, int(children_of(::getpid()).size()));
}

std::size_t threads() {
  struct stat tasks {};
  return ::stat("/proc/self/task", &tasks) == 0 ? std::size_t(tasks.st_nlink) : 0;
}

class Worker {
 public:
  Worker(const WorkerTask& task, WorkerStatus& board, const Work& work)
      : task_(task),
        board_(board),
        work_(work),
        memory_at_birth_mb_(use_of(::getpid()).memory_mb),
        threads_at_birth_(threads()) {
    job_.crash_report = task.crash_report;
    job_.scratch = task.scratch;
    job_.note = [this](std::string_view who) {
      const std::size_t size = std::min(who.size(), board_.note.size() - 1);
      std::copy_n(who.begin(), size, board_.note.begin());
      board_.note[size] = '\0';
    };
    job_.retire = [this] { retire_ = true; };
  }

  void all() {
    for (std::size_t i = 0; i < task_.batch.size() && !retire_; ++i) {
      begin(i);
      Ended ended = do_work();
      measure(ended);
      hand_in(ended);
    }
  }

 private:
  void begin(std::size_t i) {
    job_.index = task_.batch[i];
    job_.place = int(i);
    job_.note("");
    if (i > 0) {
      write_system_file("/proc/self/clear_refs", "5");  // resets the peak
      [[maybe_unused]] const int cut = ::ftruncate(STDERR_FILENO, 0);
    }
    before_ = own_use();
    board_.base_memory_mb = before_.memory_mb;
    board_.base_cpu_s = before_.cpu_s;
    cpu_before_s_ = cpu_s();
    began_ns_ = steady_ns();
    board_.began_ns = began_ns_;
    board_.begun = std::uint32_t(i + 1);
  }

  Ended do_work() {
    Ended ended;
    ended.key = task_.keys[std::size_t(job_.place)];
    ended.place = job_.place;
    try {
      ended.payload = work_(job_);
    } catch (const std::exception& error) {
      ended.how = Ending::threw;
      ended.payload = error.what();
    } catch (...) {
      ended.how = Ending::threw;
      ended.payload = "threw something that is not a std::exception";
    }
    return ended;
  }

  void measure(Ended& ended) {
    const ProcessUse now = own_use();
    ended.wall_s = double(steady_ns() - began_ns_) * 1e-9;
    ended.left_behind = children_left();
    ended.cpu_s = cpu_s() - cpu_before_s_;
    // The peak counts file pages too: subtract those present now.
    ended.peak_memory_mb = std::max({0.0, now.memory_mb - before_.memory_mb,
                                     now.peak_resident_mb - now.file_mb - before_.memory_mb});
    constexpr double kHoardMb = 64;
    // Running threads of a plugin would slow down the next jobs.
    retire_ = retire_ || ended.how != Ending::done || ended.left_behind > 0 ||
              threads() > threads_at_birth_ ||
              now.memory_mb - memory_at_birth_mb_ >
                  std::max(kHoardMb, task_.limits.memory_mb.value_or(0) / 4);
  }

  /// Closes what a plugin has left open, so that it does not affect the next jobs.
  void close_descriptors() {
    ::close_range(3, ~0U, 0);
    retire_ = true;
  }

  /// Takes the measurements that limits and the record depend on.
  ProcessUse own_use() {
    ProcessUse use = use_of(::getpid());
    if (!use.alive || use.memory_mb <= 0) {
      close_descriptors();
      use = use_of(::getpid());
    }
    if (!use.alive || use.memory_mb <= 0) {
      give_up(errno != 0 ? errno : EIO, "/proc/self: cannot be read");
    }
    return use;
  }

  /// By the file's name, since the plugin may have closed or reused any descriptor.
  void hand_in(const Ended& ended) {
    ::signal(SIGXFSZ, SIG_IGN);
    const std::string text = record_text(ended);
    int error = append_file(task_.records, text);
    if (error == EMFILE || error == ENFILE) {
      close_descriptors();
      error = append_file(task_.records, text);
    }
    ::signal(SIGXFSZ, SIG_DFL);
    if (error != 0) {
      give_up(error, task_.records + ": cannot be written");
    }
    board_.handed_in = board_.begun.load();
  }

  /// Ends the job without an outcome, because of the machine.
  [[noreturn]] void give_up(int error, const std::string& why) {
    job_.note(why);
    board_.error = error;
    ::_exit(1);
  }

  const WorkerTask& task_;
  WorkerStatus& board_;
  const Work& work_;
  Job job_;
  double memory_at_birth_mb_;
  std::size_t threads_at_birth_;
  ProcessUse before_;
  double cpu_before_s_ = 0;
  std::int64_t began_ns_ = 0;
  bool retire_ = false;
};
}  // namespace

std::int64_t steady_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

void be_worker(const WorkerTask& task, WorkerStatus& board, const Work& work) {
  stand_alone(task);
  Worker(task, board, work).all();
  ::_exit(0);
}
}  // namespace altiplan::study
