// SPDX-License-Identifier: Apache-2.0
#include "host/edit/plan_process.hpp"

#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>

#include "altiplan/error.hpp"

namespace altiplan::host {
namespace {

/// Numbers before each text on the socket: its length, the task that it belongs to, and whether the
/// task was ended by a newer one.
struct Header {
  std::uint64_t bytes = 0;
  std::uint64_t number = 0;
  std::uint64_t is_superseded = 0;
};

/// Calls `move(offset, count)`, a system call that takes a part, until all bytes are moved; false
/// if it fails or nothing comes any more.
template <class Move>
bool all_moved(std::size_t count, const Move& move) {
  std::size_t done = 0;
  while (done < count) {
    const ssize_t n = move(done, count - done);
    if (n > 0) {
      done += std::size_t(n);
    } else if (n == 0 || errno != EINTR) {
      return false;
    }
  }
  return true;
}

bool send_all(int to, const void* bytes, std::size_t count) {
  return all_moved(count, [&](std::size_t from, std::size_t left) {
    return ::send(to, static_cast<const char*>(bytes) + from, left, MSG_NOSIGNAL);
  });
}

bool read_all(int from, void* bytes, std::size_t count) {
  return all_moved(count, [&](std::size_t to, std::size_t left) {
    return ::read(from, static_cast<char*>(bytes) + to, left);
  });
}

bool send(int to, Header header, const std::string& text) {
  header.bytes = text.size();
  return send_all(to, &header, sizeof header) && send_all(to, text.data(), text.size());
}

std::optional<std::pair<Header, std::string>> receive_from(int from) {
  Header header;
  if (!read_all(from, &header, sizeof header)) {
    return std::nullopt;
  }
  std::string text(header.bytes, '\0');
  if (!read_all(from, text.data(), text.size())) {
    return std::nullopt;
  }
  return std::pair(header, std::move(text));
}

/// In the forked process.
[[noreturn]] void answer(const PlanTask& task, const std::vector<EditedPipeline>& pipelines,
                         int to) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  ::dup2(STDERR_FILENO, STDOUT_FILENO);  // plugins may print
  const auto hand_in = [to](const std::string& text) {
    send_all(to, text.data(), text.size());
    ::_exit(0);
  };
  try {
    hand_in(plan_answer(task, pipelines, hand_in));
  } catch (const std::exception& error) {
    hand_in(error_answer(error.what()));
  }
  ::_exit(0);
}

/// A forked process at work.
struct AtWork {
  PlanTask task;
  pid_t process = -1;
  int from = -1;
  std::string text{};
};

/// How a process ended that gave no answer.
std::string end_of(int status) {
  if (WIFSIGNALED(status)) {
    return std::string("the planning process was ended by a signal: ") +
           ::strsignal(WTERMSIG(status));
  }
  return "the planning process exited with " + std::to_string(WEXITSTATUS(status));
}

class Forks {
 public:
  Forks(int socket, const std::vector<EditedPipeline>& pipelines)
      : socket_(socket), pipelines_(pipelines) {}
  ~Forks() {
    for (AtWork& work : all_) {
      ::kill(work.process, SIGKILL);
      end(work);
    }
  }
  Forks(const Forks&) = delete;
  Forks& operator=(const Forks&) = delete;

  void operator()() {
    while (true) {
      std::vector<pollfd> ready{{socket_, POLLIN, 0}};
      for (const AtWork& work : all_) {
        ready.push_back({work.from, POLLIN, 0});
      }
      if (::poll(ready.data(), nfds_t(ready.size()), -1) < 0 && errno != EINTR) {
        return;
      }
      for (std::size_t n = ready.size() - 1; n > 0; --n) {
        if (ready[n].revents != 0 && !take(n - 1)) {
          return;
        }
      }
      if (ready[0].revents != 0) {
        const auto message = receive_from(socket_);
        if (!message || !begin(plan_task(parse_json(message->second)))) {
          return;
        }
      }
    }
  }

 private:
  static int end(AtWork& work) {
    int status = 0;
    ::close(work.from);
    ::waitpid(work.process, &status, 0);
    return status;
  }

  /// False if nobody listens any more.
  bool begin(const PlanTask& task) {
    for (std::size_t n = all_.size(); n-- > 0;) {
      const PlanTask& other = all_[n].task;
      if (other.kind == PlanTask::Kind::plan && task.kind == other.kind &&
          task.pipeline == other.pipeline) {
        ::kill(all_[n].process, SIGKILL);
        end(all_[n]);
        const Header header{0, other.number, 1};
        all_.erase(all_.begin() + std::ptrdiff_t(n));
        if (!send(socket_, header, "")) {
          return false;
        }
      }
    }
    std::array<int, 2> pipe{};
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, pipe.data()) != 0) {
      return send(socket_, {0, task.number, 0}, error_answer(std::strerror(errno)));
    }
    const pid_t process = ::fork();
    if (process == 0) {
      ::close(pipe[0]);
      ::close(socket_);
      answer(task, pipelines_, pipe[1]);
    }
    ::close(pipe[1]);
    if (process < 0) {
      ::close(pipe[0]);
      return send(socket_, {0, task.number, 0}, error_answer(std::strerror(errno)));
    }
    all_.push_back({task, process, pipe[0]});
    return true;
  }

  /// Reads what a process has written, and sends it on when the process has ended.
  bool take(std::size_t n) {
    AtWork& work = all_[n];
    std::array<char, 65536> part{};
    const ssize_t count = ::read(work.from, part.data(), part.size());
    if (count > 0) {
      work.text.append(part.data(), std::size_t(count));
      return true;
    }
    const int status = end(work);
    const std::string text =
        work.text.empty() || status != 0 ? error_answer(end_of(status)) : std::move(work.text);
    const Header header{0, work.task.number, 0};
    all_.erase(all_.begin() + std::ptrdiff_t(n));
    return send(socket_, header, text);
  }

  int socket_;
  const std::vector<EditedPipeline>& pipelines_;
  std::vector<AtWork> all_;
};
}  // namespace

void plan_at(int socket, const std::vector<EditedPipeline>& pipelines) {
  Forks(socket, pipelines)();
}

PlanLine::PlanLine(int socket) : socket_(socket), receiver_([this] { receive(); }) {}

PlanLine::~PlanLine() {
  ::shutdown(socket_, SHUT_RDWR);
  receiver_.join();
  ::close(socket_);
}

std::uint64_t PlanLine::begin(PlanTask task) {
  const std::lock_guard in_order(sending_);
  task.number = ++last_;
  // Not under the other lock: the receiver must go on, or both ends could wait for each other.
  send(socket_, {0, task.number, 0}, json_text(to_json(task)));
  return task.number;
}

std::optional<std::string> PlanLine::finish(std::uint64_t number) {
  std::unique_lock lock(mutex_);
  arrived_.wait(lock, [&] { return answers_.contains(number) || !is_open_; });
  const auto found = answers_.find(number);
  if (found == answers_.end()) {
    return error_answer("the planning process has ended");
  }
  const std::optional<std::string> answer = std::move(found->second);
  answers_.erase(found);
  return answer;
}

void PlanLine::receive() {
  while (auto message = receive_from(socket_)) {
    const std::lock_guard lock(mutex_);
    answers_[message->first.number] = message->first.is_superseded != 0
                                          ? std::nullopt
                                          : std::optional(std::move(message->second));
    arrived_.notify_all();
  }
  const std::lock_guard lock(mutex_);
  is_open_ = false;
  arrived_.notify_all();
}
}  // namespace altiplan::host
