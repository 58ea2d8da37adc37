// SPDX-License-Identifier: Apache-2.0
#include "study/workers/worker_pool.hpp"

#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <deque>
#include <fstream>
#include <utility>

#include "altiplan/error.hpp"
#include "study/workers/cgroup.hpp"
#include "study/workers/pool_worker.hpp"
#include "study/workers/retries.hpp"
#include "study/workers/signals.hpp"
#include "study/workers/supervisor.hpp"
#include "study/workers/worker.hpp"

namespace altiplan::study {
namespace {

constexpr double kWatchEveryS = 0.02;

/// The number of kills by the kernel for lack of memory, system-wide or in a group, since boot.
long kernel_kills() {
  std::ifstream counters("/proc/vmstat");
  std::string name;
  long value = 0;
  while (counters >> name >> value) {
    if (name == "oom_kill") {
      return value;
    }
  }
  return 0;
}

/// A child that has ended.
struct Reaped {
  pid_t process = 0;
  int status = 0;
  double cpu_s = 0;  ///< with that of the children that it has waited for

  /// False if none has.
  bool wait(pid_t which, int options) {
    rusage used{};
    do {
      process = ::wait4(which, &status, options, &used);
    } while (process < 0 && errno == EINTR);
    cpu_s = double(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
            1e-6 * double(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
    return process > 0;
  }
};

/// One call of WorkerPool::run.
class PoolRun {
 public:
  PoolRun(WorkFolder& folder, const PoolOptions& options, const ControlGroups* groups,
          const std::vector<std::size_t>& jobs, const Work& work, const Keep& keep,
          std::size_t& serial)
      : folder_(folder),
        options_(options),
        groups_(groups),
        work_(work),
        keep_(keep),
        serial_(serial),
        waiting_(jobs.begin(), jobs.end()),
        retries_(options),
        supervisor_(folder),
        workers_(std::size_t(options.jobs)) {}

  WorkerPool::Finish operator()() {
    try {
      bool stop = false;
      while (!stop && !finished()) {
        start_workers();
        stop = signals_.wait(next_look_s_ - steady_s());
        reap();
        look();
        if (!retries_.failure().empty()) {
          throw Error(retries_.failure() + "; ended runs are kept: repeat the command to continue");
        }
        keep_now_and_then();
      }
    } catch (...) {
      kill_all();
      if (!keep_threw_) {
        keep();
      }
      throw;
    }
    kill_all();
    records_.insert(records_.end(), unread_.begin(), unread_.end());  // done again since
    keep();
    return waiting_.empty() ? WorkerPool::Finish::all : WorkerPool::Finish::interrupted;
  }

 private:
  bool finished() const {
    return waiting_.empty() && std::ranges::none_of(workers_, &PoolWorker::busy);
  }

  /// Up to `reuse` jobs, fewer towards the end so that all workers have some; a job that has ended
  /// a process before runs in its own process.
  std::vector<std::size_t> next_batch() {
    const std::size_t fair = waiting_.size() / (2 * workers_.size());
    const std::size_t size = std::clamp<std::size_t>(fair, 1, std::size_t(options_.reuse));
    std::vector<std::size_t> batch;
    do {
      batch.push_back(waiting_.front());
      waiting_.pop_front();
    } while (batch.size() < size && !waiting_.empty() && !retries_.knows(batch.back()) &&
             !retries_.knows(waiting_.front()));
    return batch;
  }

  void start_workers() {
    if (retries_.is_paused()) {
      return;
    }
    for (std::size_t i = 0; i < workers_.size(); ++i) {
      PoolWorker& worker = workers_[i];
      if (worker.busy() || waiting_.empty()) {
        continue;
      }
      const bool last_try = retries_.is_last_try(waiting_.front());
      if ((last_try || undisturbed_) && std::ranges::any_of(workers_, &PoolWorker::busy)) {
        return;
      }
      undisturbed_ = last_try;
      WorkerTask task;
      task.batch = next_batch();
      for (const std::size_t job : task.batch) {
        task.keys.push_back(options_.key(job));
      }
      task.limits = options_.limits;
      task.group = groups_ != nullptr ? groups_->entrance(i) : "";
      if (!worker.start(folder_, ++serial_, task, work_)) {
        const int error = errno;
        waiting_.insert(waiting_.begin(), task.batch.begin(), task.batch.end());
        if (std::ranges::none_of(workers_, &PoolWorker::busy)) {
          retries_.fault(std::string("cannot start a worker process: ") + std::strerror(error));
        }
        return;  // retried when a worker has ended
      }
    }
  }

  void reap() {
    Reaped reaped;
    while (reaped.wait(-1, WNOHANG)) {
      const auto worker = std::ranges::find(workers_, reaped.process, &PoolWorker::process);
      if (worker != workers_.end()) {
        settle(*worker, reaped, std::nullopt);
      } else if (reaped.process == supervisor_.process()) {
        supervisor_.replace();
      }  // else an orphan that a worker has left
    }
  }

  /// Checks the resource use of all workers, and ends those beyond a limit.
  void look() {
    if (steady_s() < next_look_s_) {
      return;
    }
    for (PoolWorker& worker : workers_) {
      if (!worker.busy()) {
        continue;
      }
      take_records(worker);
      if (const std::optional<Ending> beyond = worker.watch(options_.limits)) {
        end(worker, *beyond);
      }
    }
    next_look_s_ = steady_s() + kWatchEveryS;
  }

  /// Kills the worker and all its processes, because it exceeded a limit.
  void end(PoolWorker& worker, std::optional<Ending> beyond) {
    worker.kill();
    Reaped reaped;
    reaped.wait(worker.process(), 0);
    settle(worker, reaped, beyond);
  }

  void take_records(PoolWorker& worker) {
    for (Ended& ended : worker.take_records()) {
      stillborn_ = 0;
      take(std::move(ended));
    }
  }

  /// Retries the job after the others, or keeps its end.
  void take(Ended ended) {
    if (retries_.try_again(ended)) {
      waiting_.push_back(ended.job);
    } else {
      ended_.push_back(std::move(ended));
    }
  }

  /// The end of the job that was running when the process ended.
  Ending ending(const PoolWorker& worker, int status) {
    if (worker.lost_record()) {  // possibly of a job before the current one
      return Ending::garbled;
    }
    if (worker.error() == EFBIG || (WIFSIGNALED(status) && WTERMSIG(status) == SIGXFSZ)) {
      return Ending::too_large;
    }
    if (!WIFSIGNALED(status)) {
      return Ending::exited;
    }
    const long kills_before = std::exchange(kernel_kills_, kernel_kills());
    return WTERMSIG(status) == SIGKILL && kernel_kills_ > kills_before ? Ending::out_of_memory
                                                                       : Ending::killed;
  }

  /// After the worker's process was reaped: the current job ends or is retried; jobs that had not
  /// begun wait for another worker.
  void settle(PoolWorker& worker, const Reaped& reaped, std::optional<Ending> beyond) {
    worker.add_cpu(reaped.cpu_s);
    take_records(worker);
    std::optional<Ended> last = worker.unfinished(beyond ? *beyond : ending(worker, reaped.status));
    clear_away(worker, !last);
    std::size_t known = worker.known();
    if (last && !stopping_) {
      last->signal = WIFSIGNALED(reaped.status) ? WTERMSIG(reaped.status) : 0;
      last->exit_code = WIFEXITED(reaped.status) ? WEXITSTATUS(reaped.status) : 0;
      const bool study_error = worker.error() != 0 && last->how != Ending::too_large;
      if (!study_error && worker.unread().empty()) {
        ++known;
        take(std::move(*last));
      }
    }
    const std::vector<std::size_t>& batch = worker.task().batch;
    waiting_.insert(waiting_.begin(), batch.begin() + std::ptrdiff_t(known), batch.end());
    if (!stopping_) {
      expect_well(worker, known);
    }
  }

  /// A failure without a job ends the study.
  void expect_well(const PoolWorker& worker, std::size_t known) {
    constexpr int kAtMost = 20;
    if (const int error = worker.error(); error != 0 && error != EFBIG) {
      retries_.fault(worker.note() + ": " + std::strerror(error));
    } else if (!worker.unread().empty()) {
      retries_.fault(worker.unread());
    }
    if (known == 0 && !worker.born() && ++stillborn_ > kAtMost) {
      retries_.give_up("the worker processes end before their runs begin");
    }
  }

  /// Ends the processes that the worker has left behind; counts them for its last job if it was
  /// between jobs.
  void clear_away(PoolWorker& worker, bool between_jobs) {
    std::vector<pid_t> others{supervisor_.process()};
    for (const PoolWorker& other : workers_) {
      if (&other != &worker && other.busy()) {
        others.push_back(other.process());
      }
    }
    const std::size_t left = worker.clear_away(others);
    (worker.unread().empty() ? records_ : unread_).push_back(worker.task().records);
    if (left > 0 && between_jobs && worker.known() > 0 && !ended_.empty() &&
        ended_.back().job == worker.task().batch[worker.known() - 1]) {
      ended_.back().left_behind = std::max(ended_.back().left_behind, int(left));
    }
  }

  /// Kills the current jobs, which have no outcome.
  void kill_all() {
    stopping_ = true;
    for (PoolWorker& worker : workers_) {
      if (worker.busy()) {
        end(worker, std::nullopt);
      }
    }
  }

  void keep_now_and_then() {
    if (steady_s() >= next_keep_s_) {
      keep();
      next_keep_s_ = steady_s() + options_.keep_every_s;
    }
  }

  void keep() {
    if (!ended_.empty()) {
      keep_threw_ = true;
      keep_(std::exchange(ended_, {}));
      keep_threw_ = false;
    }
    for (const std::string& file : std::exchange(records_, {})) {
      ::unlink(file.c_str());
    }
  }

  WorkFolder& folder_;
  const PoolOptions& options_;
  const ControlGroups* groups_;
  const Work& work_;
  const Keep& keep_;
  std::size_t& serial_;
  std::deque<std::size_t> waiting_;
  Retries retries_;
  std::vector<Ended> ended_;          ///< but not yet kept
  std::vector<std::string> records_;  ///< files to remove when those are kept
  std::vector<std::string> unread_;   ///< that may hold jobs which the next call finds
  const Signals signals_;
  Supervisor supervisor_;
  std::deque<PoolWorker> workers_;
  long kernel_kills_ = kernel_kills();
  double next_look_s_ = 0;
  double next_keep_s_ = 0;
  int stillborn_ = 0;
  bool undisturbed_ = false;  ///< the job started last runs alone
  bool stopping_ = false;
  bool keep_threw_ = false;
};
}  // namespace

WorkerPool::WorkerPool(WorkFolder& folder, PoolOptions options)
    : folder_(folder), options_(std::move(options)) {
  const auto group = ControlGroups::delegated();
  const std::optional<double>& memory_mb = options_.limits.memory_mb;
  if (!group || !memory_mb) {
    return;
  }
  try {  // with a margin for memory that a reused process may keep
    constexpr double kRoom = 1.25;
    constexpr double kRoomMb = 128;
    groups_ = std::make_unique<ControlGroups>(*group, std::size_t(options_.jobs),
                                              kRoom * *memory_mb + kRoomMb);
  } catch (const Error&) {  // limits hold without
  }
}

WorkerPool::~WorkerPool() = default;

WorkerPool::Finish WorkerPool::run(const std::vector<std::size_t>& jobs, const Work& work,
                                   const Keep& keep) {
  return PoolRun(folder_, options_, groups_.get(), jobs, work, keep, workers_started_)();
}

std::string WorkerPool::limits_kept() const {
  return std::string("process tree, every 20 ms") + (groups_ ? "; memory also by cgroup v2" : "");
}
}  // namespace altiplan::study
