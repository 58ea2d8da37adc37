// SPDX-License-Identifier: Apache-2.0
#include "study/workers/pool_worker.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <new>

#include "altiplan/error.hpp"
#include "host/base/machine_fault.hpp"
#include "study/workers/job_record.hpp"

namespace altiplan::study {
namespace {

constexpr off_t kSaid = 2048;          ///< bytes of stdout and stderr that are reported
constexpr off_t kMaxOutput = 1 << 20;  ///< … that are kept
constexpr std::size_t kMaxCrashReport = 256 << 20;
}  // namespace

PoolWorker::PoolWorker() {
  void* shared = ::mmap(nullptr, sizeof(WorkerStatus), PROT_READ | PROT_WRITE,
                        MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  output_ = ::memfd_create("altiplan worker", MFD_CLOEXEC);
  if (shared == MAP_FAILED || output_ < 0 || ::fcntl(output_, F_SETFL, O_APPEND) != 0) {
    throw Error(std::string("cannot create the memory file of a worker: ") + std::strerror(errno));
  }
  board_ = new (shared) WorkerStatus;
}

PoolWorker::~PoolWorker() {
  ::munmap(board_, sizeof(WorkerStatus));
  ::close(output_);
}

bool PoolWorker::start(const WorkFolder& folder, std::size_t serial, WorkerTask task,
                       const Work& work) {
  task_ = std::move(task);
  task_.records = folder.file(serial, "records");
  task_.crash_report = folder.file(serial, "last");
  task_.scratch = folder.file(serial, "scratch");
  task_.output = output_;
  task_.parent = ::getpid();
  task_.mark = folder.processes(0, serial).mark;
  new (board_) WorkerStatus;
  for (const std::string& file : {task_.records, task_.crash_report, task_.scratch}) {
    ::unlink(file.c_str());  // whatever another process has put there
  }
  if (::ftruncate(output_, 0) != 0) {
    return false;
  }
  process_ = ::fork();
  if (process_ == 0) {
    be_worker(task_, *board_, work);
  }
  tree_ = folder.processes(process_, serial);
  family_ = folder.processes();
  known_ = 0;
  read_ = 0;
  unread_.clear();
  seen_ = 0;
  reaped_cpu_s_ = 0;
  return process_ > 0;
}

void PoolWorker::look_at_job() {
  if (const std::uint32_t begun = board_->begun; begun != seen_) {
    seen_ = begun;
    peak_mb_ = 0;
    cpu_s_ = 0;
  }
}

std::optional<Ending> PoolWorker::watch(const JobLimits& limits) {
  struct stat status {};
  if (::fstat(output_, &status) == 0 && status.st_size > kMaxOutput) {
    const std::string last = output();
    [[maybe_unused]] const bool kept =
        ::ftruncate(output_, 0) == 0 && ::write(output_, last.data(), last.size()) > 0;
  }
  look_at_job();
  if (seen_ == 0) {
    return std::nullopt;
  }
  const TreeUse use = use_of(tree_.below_root(), board_->base_memory_mb);
  peak_mb_ = std::max(peak_mb_, use.memory_mb);
  cpu_s_ = std::max(cpu_s_, use.cpu_s - board_->base_cpu_s);
  if (board_->begun != seen_) {
    return std::nullopt;  // the next job has begun meanwhile
  }
  if (limits.memory_mb && use.memory_mb > *limits.memory_mb) {
    return Ending::memory_limit;
  }
  if (use.processes > limits.processes) {
    return Ending::process_limit;
  }
  if (limits.cpu_s && cpu_s_ > *limits.cpu_s) {
    return Ending::cpu_limit;
  }
  if (double(steady_ns() - board_->began_ns) * 1e-9 > limits.wall_s) {
    return Ending::wall_limit;
  }
  return std::nullopt;
}

std::string PoolWorker::read(const std::string& file, std::size_t offset, std::size_t at_most) {
  ReadText read = read_from(file, offset, at_most);
  unread_ = host::is_machine_fault(read.error) ? host::unreadable(file, read.error) : "";
  return std::move(read.text);
}

std::vector<Ended> PoolWorker::take_records() {
  std::vector<Ended> all;
  const std::size_t at_most =
      std::size_t(task_.limits.file_mb * double(1 << 20)) * (task_.batch.size() + 1);
  const std::string text = read(task_.records, read_, at_most);
  std::string_view rest = text;
  while (!rest.empty()) {
    Ended ended;
    if (take_record(rest, ended) != RecordState::whole || known_ >= task_.batch.size() ||
        ended.key != task_.keys[known_]) {
      break;  // missing, or damaged: reported when the process has ended
    }
    if (seen_ == known_ + 1) {  // what the parent has seen of this job
      ended.peak_memory_mb = std::max(ended.peak_memory_mb, peak_mb_);
      ended.cpu_s = std::max(ended.cpu_s, cpu_s_);
    }
    ended.job = task_.batch[known_++];
    all.push_back(std::move(ended));
  }
  read_ += text.size() - rest.size();
  if (!lost_record()) {
    unread_.clear();  // there was nothing to be read
  }
  return all;
}

std::string PoolWorker::note() const {
  return {board_->note.begin(), std::find(board_->note.begin(), board_->note.end() - 1, '\0')};
}

std::string PoolWorker::output() const {
  struct stat status {};
  ::fstat(output_, &status);
  std::string text(std::size_t(std::min(kSaid, status.st_size)), '\0');
  const ssize_t got =
      ::pread(output_, text.data(), text.size(), status.st_size - off_t(text.size()));
  text.resize(std::size_t(std::max<ssize_t>(got, 0)));
  return text;
}

std::optional<Ended> PoolWorker::unfinished(Ending how) {
  const bool at_limit = how == Ending::wall_limit || how == Ending::cpu_limit ||
                        how == Ending::memory_limit || how == Ending::process_limit;
  if (known_ >= task_.batch.size() || board_->begun <= known_ ||
      (at_limit && seen_ != known_ + 1)) {  // that job was done just before it was killed
    return std::nullopt;
  }
  Ended ended;
  ended.job = task_.batch[known_];
  ended.key = task_.keys[known_];
  ended.how = how;
  ended.place = int(known_);
  if (unread_.empty()) {
    ended.crash_report = read(task_.crash_report, 0, kMaxCrashReport);
  }
  ended.note = note();
  ended.output = output();
  ended.wall_s = std::max(0.0, double(steady_ns() - board_->began_ns) * 1e-9);
  ended.cpu_s = std::max(cpu_s_, reaped_cpu_s_ - board_->base_cpu_s);
  ended.peak_memory_mb = peak_mb_;
  return ended;
}

std::size_t PoolWorker::clear_away(const std::vector<pid_t>& others) {
  static const bool kListed = ::access("/proc/thread-self/children", R_OK) == 0;
  process_ = -1;
  tree_.root = 0;  // reaped: the process id may be reused by now
  const auto orphans = [&] {
    std::vector<pid_t> children = children_of(::getpid());
    std::erase_if(children, [&](pid_t child) { return std::ranges::count(others, child) > 0; });
    return children;
  };
  const auto alive = [](pid_t child) { return use_of(child).alive; };
  // Orphans of a worker are adopted by this process: usually there are none and no search is
  // needed.
  const std::vector<pid_t> left_to_us = orphans();
  const bool any = std::ranges::any_of(left_to_us, alive);
  const std::size_t left = any || !kListed ? tree_.kill() : 0;
  for (const pid_t orphan : left_to_us) {
    // An orphan with another worker's mark is left to that worker's end, which is near.
    if (alive(orphan) && !is_marked(orphan, family_.mark, family_.mask)) {
      ProcessTree{orphan, tree_.mark}.kill();
    }
  }
  for (const pid_t orphan : orphans()) {
    ::waitpid(orphan, nullptr, WNOHANG);
  }
  ::unlink(task_.crash_report.c_str());
  ::unlink(task_.scratch.c_str());
  return left;
}
}  // namespace altiplan::study
