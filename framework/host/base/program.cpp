// SPDX-License-Identifier: Apache-2.0
#include "host/base/program.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <thread>
#include <utility>

#include "altiplan/error.hpp"

namespace altiplan::host {
namespace {

namespace fs = std::filesystem;

/// The two ends of a connection, above the descriptors that programs are wired to.
std::array<int, 2> connected_ends() {
  constexpr int kAbove = 16;
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    throw Error(std::string("cannot create a connection: ") + std::strerror(errno));
  }
  for (int& end : ends) {
    const int high = ::fcntl(end, F_DUPFD_CLOEXEC, kAbove);
    if (high >= 0) {
      ::close(std::exchange(end, high));
    }
  }
  return ends;
}

/// How the descriptors of a program are opened.
class Descriptors {
 public:
  Descriptors(const ProgramFiles& files, int end) {
    posix_spawn_file_actions_init(&actions_);
    add(STDIN_FILENO, "/dev/null", O_RDONLY);
    if (files.errors.empty()) {
      posix_spawn_file_actions_adddup2(&actions_, STDERR_FILENO, STDOUT_FILENO);
    } else {
      add(STDOUT_FILENO, "/dev/null", O_WRONLY);
      add(STDERR_FILENO, files.errors.c_str(), O_WRONLY | O_CREAT);
    }
    for (const int descriptor : files.wired) {
      posix_spawn_file_actions_adddup2(&actions_, end, descriptor);
    }
  }
  ~Descriptors() { posix_spawn_file_actions_destroy(&actions_); }
  Descriptors(const Descriptors&) = delete;
  Descriptors& operator=(const Descriptors&) = delete;
  const posix_spawn_file_actions_t* actions() const { return &actions_; }

 private:
  void add(int descriptor, const char* file, int mode) {
    posix_spawn_file_actions_addopen(&actions_, descriptor, file, mode, 0600);
  }
  posix_spawn_file_actions_t actions_;
};

/// The environment of a program.
std::vector<std::string> variables_of(const ProgramFiles& files) {
  constexpr std::string_view kTemporary = "TMPDIR=";
  std::vector<std::string> variables;
  for (char** variable = ::environ; *variable != nullptr; ++variable) {
    if (files.temporary.empty() || !std::string_view(*variable).starts_with(kTemporary)) {
      variables.emplace_back(*variable);
    }
  }
  if (!files.temporary.empty()) {
    variables.push_back(std::string(kTemporary) + files.temporary.string());
  }
  return variables;
}

/// Ended by a null, as the system takes them.
std::vector<char*> pointers_to(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& text : texts) {
    pointers.push_back(text.data());
  }
  pointers.push_back(nullptr);
  return pointers;
}

/// Waits until the socket is ready; false at the time limit.
bool wait_for(int socket, short events, Program::Clock::time_point until) {
  pollfd ready{socket, events, 0};
  while (true) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Program::Clock::now());
    const int found = ::poll(&ready, 1, int(std::clamp<long>(left.count(), 0, 1'000'000)));
    if (found > 0) {
      return true;
    }
    if (found == 0 || errno != EINTR) {
      return false;
    }
  }
}
}  // namespace

bool is_program(const fs::path& file) {
  std::error_code error;
  return fs::is_regular_file(file, error) && ::access(file.c_str(), X_OK) == 0;
}

std::optional<fs::path> find_on_path(std::initializer_list<const char*> names) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    for (const char* name : names) {
      // An empty entry means the current folder: never run programs from there.
      if (!folder.empty() && is_program(fs::path(folder) / name)) {
        return fs::path(folder) / name;
      }
    }
  }
  return std::nullopt;
}

TemporaryFolder::TemporaryFolder() {
  const auto lock = uninterrupted();
  std::string path = (fs::temp_directory_path() / "altiplan_XXXXXX").string();
  if (::mkdtemp(path.data()) == nullptr) {
    throw Error("cannot create a folder in '" + fs::temp_directory_path().string() +
                "': " + std::strerror(errno));
  }
  path_ = path;
  unfinished_.emplace([path] {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  });
}

Program::Program(std::vector<std::string> arguments, const ProgramFiles& files) {
  std::vector<std::string> variables = variables_of(files);
  std::vector<char*> argument_list = pointers_to(arguments);
  std::vector<char*> variable_list = pointers_to(variables);
  const std::array<int, 2> ends = connected_ends();
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  const auto lock = uninterrupted();
  const int error = ::posix_spawn(&pid_, argument_list[0], Descriptors(files, ends[1]).actions(),
                                  &attributes, argument_list.data(), variable_list.data());
  posix_spawnattr_destroy(&attributes);
  ::close(ends[1]);
  socket_ = ends[0];
  if (error != 0) {
    ::close(socket_);
    throw Error("cannot start '" + arguments[0] + "': " + std::strerror(error));
  }
  unfinished_.emplace([pid = pid_] {  // ends what is left of it
    ::kill(-pid, SIGKILL);
    while (::waitpid(pid, nullptr, 0) < 0 && errno == EINTR) {
    }
  });
}

Program::~Program() { ::close(socket_); }

bool Program::send(std::string_view bytes, Clock::time_point until) {
  while (!bytes.empty()) {
    // No signal if it has ended.
    const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent > 0) {
      bytes.remove_prefix(std::size_t(sent));
    } else if (errno == EAGAIN ? !wait_for(socket_, POLLOUT, until) : errno != EINTR) {
      return false;
    }
  }
  return true;
}

void Program::finish_sending() { ::shutdown(socket_, SHUT_WR); }

bool Program::receive(std::string& to, Clock::time_point until) {
  std::array<char, 1 << 16> bytes{};
  while (wait_for(socket_, POLLIN, until)) {
    const ssize_t count = ::recv(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT);
    if (count > 0) {
      to.append(bytes.data(), std::size_t(count));
      return true;
    }
    if (count == 0 || (errno != EINTR && errno != EAGAIN)) {
      return false;
    }
  }
  return false;
}

std::optional<int> Program::ended(Clock::time_point until) const {
  while (true) {
    siginfo_t info{};
    // Not reaped yet, so that its id is not reused before its group has ended.
    if (::waitid(P_PID, id_t(pid_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
        info.si_pid == pid_) {
      return info.si_code == CLD_EXITED ? info.si_status : -1;
    }
    if (Clock::now() >= until) {
      return std::nullopt;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}
}  // namespace altiplan::host
