// SPDX-License-Identifier: Apache-2.0
#include "host/view/screenshot.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <sstream>
#include <thread>
#include <vector>

#include "altiplan/error.hpp"
#include "altiplan/kit/formats/input_file.hpp"
#include "host/base/output_file.hpp"

namespace altiplan::host {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPngSignature = "\x89PNG\r\n\x1a\n";

/// A temporary folder, removed with this object.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    const auto lock = uninterrupted();
    std::string path = (fs::temp_directory_path() / "altiplan_view_XXXXXX").string();
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
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
  std::optional<Unfinished> unfinished_;
};

bool is_program(const fs::path& file) {
  std::error_code error;
  return fs::is_regular_file(file, error) && ::access(file.c_str(), X_OK) == 0;
}

std::vector<std::string> arguments_of(const fs::path& chromium, const fs::path& folder,
                                      const fs::path& page, const std::string& query) {
  std::vector<std::string> arguments{
      chromium.string(),
      "--headless",
      // Software rendering: available, and identical, on every machine.
      "--use-gl=angle",
      "--use-angle=swiftshader",
      "--enable-unsafe-swiftshader",
      // A single process avoids passing frames between processes.
      "--in-process-gpu",
      "--disable-gpu-compositing",
      "--hide-scrollbars",
      "--force-device-scale-factor=1",
      "--window-size=1600,1000",
      "--no-first-run",
      "--disable-background-networking",
      "--disable-component-update",
      "--disable-extensions",
      "--disable-quic",
      "--disable-sync",
      "--user-data-dir=" + (folder / "profile").string(),
      "--screenshot=" + (folder / "page.png").string(),
      "file://" + page.string() + query,
  };
  if (::geteuid() == 0) {
    arguments.insert(arguments.begin() + 1, "--no-sandbox");  // its sandbox refuses root
  }
  return arguments;
}

/// A process and its children, with their output discarded.
class Child {
 public:
  explicit Child(std::vector<std::string> arguments) {
    std::vector<char*> pointers;
    for (std::string& argument : arguments) {
      pointers.push_back(argument.data());
    }
    pointers.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    const auto lock = uninterrupted();
    const int error =
        ::posix_spawn(&pid_, pointers[0], &files, &attributes, pointers.data(), ::environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&files);
    if (error != 0) {
      throw Error("cannot start '" + arguments[0] + "': " + std::strerror(error));
    }
    unfinished_.emplace([pid = pid_] {  // ends what is left of it
      ::kill(-pid, SIGKILL);
      while (::waitpid(pid, nullptr, 0) < 0 && errno == EINTR) {
      }
    });
  }

  bool ends_within(std::chrono::milliseconds patience) const {
    const auto end = std::chrono::steady_clock::now() + patience;
    while (std::chrono::steady_clock::now() < end) {
      siginfo_t info{};
      // Not reaped yet, so that its id is not reused before its group has ended.
      if (::waitid(P_PID, id_t(pid_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
          info.si_pid == pid_) {
        return true;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return false;
  }

 private:
  pid_t pid_ = -1;
  std::optional<Unfinished> unfinished_;
};
}  // namespace

std::optional<fs::path> find_chromium() {
  if (const char* named = std::getenv("ALTIPLAN_CHROMIUM")) {
    return is_program(named) ? std::optional<fs::path>(named) : std::nullopt;
  }
  const char* path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    for (const char* name : {"chromium", "chromium-browser", "google-chrome"}) {
      // An empty entry means the current folder: never run programs from there.
      if (!folder.empty() && is_program(fs::path(folder) / name)) {
        return fs::path(folder) / name;
      }
    }
  }
  return std::nullopt;
}

std::string screenshot(const fs::path& chromium, const std::string& page, const std::string& query,
                       std::chrono::milliseconds patience) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "page.html";
  write_file(file, page);
  {
    const Child child(arguments_of(chromium, folder.path(), file, query));
    if (!child.ends_within(patience)) {
      throw Error("'" + chromium.string() + "' did not render the page within " +
                  std::to_string(patience.count() / 1000) + " s");
    }
  }
  const std::string drawn = (folder.path() / "page.png").string();
  std::string png = kit::why_unreadable(drawn).empty() ? kit::read_file(drawn) : "";
  if (!png.starts_with(kPngSignature)) {
    throw Error("'" + chromium.string() + "' did not render the page");
  }
  return png;
}
}  // namespace altiplan::host
