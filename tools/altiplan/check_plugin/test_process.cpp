// SPDX-License-Identifier: Apache-2.0
#include "test_process.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <sstream>

#include "altiplan/error.hpp"
#include "commands.hpp"
#include "study/workers/process_tree.hpp"

namespace altiplan::cli {
namespace fs = std::filesystem;
namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* kEnds = "Process: the test ends normally, with a result";
constexpr rlim_t kMaxOutput = 64 << 20;

/// The last bytes of a file, at most that many; "" if it is not a regular file, since a test may
/// have replaced it by anything.
std::string end_of(const fs::path& file, std::size_t max_bytes) {
  const int from = ::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_NOFOLLOW | O_CLOEXEC);
  struct stat status {};
  std::string text;
  if (from >= 0 && ::fstat(from, &status) == 0 && S_ISREG(status.st_mode)) {
    text.resize(std::min(max_bytes, std::size_t(status.st_size)));
    const ssize_t got =
        ::pread(from, text.data(), text.size(), status.st_size - off_t(text.size()));
    text.resize(std::size_t(std::max(ssize_t(0), got)));
  }
  if (from >= 0) {
    ::close(from);
  }
  return text;
}

/// "SIGSEGV", "signal 37"
std::string signal_name(int number) {
  const char* const name = ::sigabbrev_np(number);
  return name != nullptr ? std::string("SIG") + name : "signal " + std::to_string(number);
}

/// True if the process descends from the test of that scratch folder, named in its TMPDIR.
bool stems_from(pid_t process, const fs::path& scratch) {
  std::ifstream variables("/proc/" + std::to_string(process) + "/environ", std::ios::binary);
  std::ostringstream text;
  text << variables.rdbuf();
  return text.str().find(scratch.string()) != std::string::npos;
}

/// Kills the orphans of the test that this process has adopted, even those without the test's mark.
/// Returns their number.
std::size_t end_orphans(const fs::path& scratch) {
  std::size_t count = 0;
  for (bool more = true; more;) {  // the children of those killed are adopted next
    more = false;
    for (const pid_t child : study::children_of(::getpid())) {
      if (stems_from(child, scratch)) {
        ::kill(child, SIGKILL);
        ::waitpid(child, nullptr, 0);
        more = true;
        ++count;
      }
    }
  }
  return count;
}
}  // namespace

ScratchFolder::ScratchFolder() {
  std::error_code error;
  const fs::path folder = fs::temp_directory_path(error);
  if (error) {
    throw Error("TMPDIR: folder not found: " + std::string(std::getenv("TMPDIR")));
  }
  std::string name = (fs::absolute(folder) / "altiplan-check-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) {
    throw Error("cannot create the folder " + name + ": " + std::strerror(errno));
  }
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code error;
  fs::remove_all(path_, error);
}

TestProcess::TestProcess(const PluginTest& test, std::size_t index, std::uint64_t mark, bool again,
                         const RunnerOptions& options)
    : index_(index), mark_(mark), again_(again) {
  for (const char* name : {"tmp", "home", "here"}) {
    fs::create_directory(scratch_.path() / name);
  }
  std::vector<std::string> words = options.command;
  for (const std::string& word :
       {std::string("--only"), "^" + test.name + "$", std::string("--here"),
        std::string("--answer"), (scratch_.path() / "answer").string()}) {
    words.push_back(word);
  }
  std::vector<char*> arguments;
  for (std::string& word : words) {
    arguments.push_back(word.data());
  }
  arguments.push_back(nullptr);
  process_ = ::fork();
  if (process_ < 0) {
    throw Error(std::string("cannot start a process for a test: ") + std::strerror(errno));
  }
  if (process_ == 0) {
    become(arguments.data());
  }
}

std::optional<Verdict> TestProcess::look(const RunnerOptions& options) {
  int status = 0;
  rusage use{};
  const pid_t got = ::wait4(process_, &status, WNOHANG, &use);
  const double time_s = std::chrono::duration<double>(Clock::now() - began_).count();
  if (got == process_) {
    process_ = 0;
    Verdict verdict = verdict_of(status);
    verdict.time_s = time_s;
    verdict.peak_memory_mb = double(use.ru_maxrss) / 1024;
    return verdict;
  }
  const double memory_mb = study::use_of(process_).memory_mb;
  peak_mb_ = std::max(peak_mb_, memory_mb);
  std::string over;
  if (time_s > options.time_limit_s) {
    over = "did not end within " + fixed(options.time_limit_s, 0) +
           " s: does each of its loops come to an end, or ask the budget?";
  } else if (memory_mb > options.memory_limit_mb) {
    over = "used more than " + fixed(options.memory_limit_mb, 0) + " MB";
  }
  if (over.empty()) {
    return std::nullopt;
  }
  end();
  Verdict verdict;
  verdict.findings = {{kEnds, "it " + over}};
  verdict.seen_from_outside = true;
  verdict.hung = time_s > options.time_limit_s;
  verdict.output = end_of(scratch_.path() / "said", 2000);
  verdict.time_s = time_s;
  verdict.peak_memory_mb = peak_mb_;
  return verdict;
}

void TestProcess::become(char* const* arguments) const {
  ::setsid();  // signals to its group stay in it, and the terminal's do not reach it
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  study::set_mark(mark_);
  const rlimit output{kMaxOutput, kMaxOutput};
  ::setrlimit(RLIMIT_FSIZE, &output);
  const int output_file =
      ::open((scratch_.path() / "said").c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
  const int nothing = ::open("/dev/null", O_RDONLY);
  ::dup2(nothing, STDIN_FILENO);
  ::close(nothing);
  ::dup2(output_file, STDOUT_FILENO);
  ::dup2(output_file, STDERR_FILENO);
  ::close(output_file);
  ::setenv("TMPDIR", (scratch_.path() / "tmp").c_str(), 1);
  ::setenv("HOME", (scratch_.path() / "home").c_str(), 1);
  if (again_) {
    // Uninitialised memory has other contents than in the first process, also when reused.
    ::setenv("GLIBC_TUNABLES", "glibc.malloc.perturb=165:glibc.malloc.tcache_count=0", 1);
  }
  sigset_t none;
  sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  if (::chdir((scratch_.path() / "here").c_str()) == 0) {
    ::execv("/proc/self/exe", arguments);
  }
  ::_exit(127);
}

void TestProcess::end() {
  if (process_ > 0) {
    study::ProcessTree{process_, mark_}.kill(process_);
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
    end_orphans(scratch_.path());
    process_ = 0;
  }
}

Verdict TestProcess::verdict_of(int status) {
  Verdict verdict;
  verdict.output = end_of(scratch_.path() / "said", 2000);
  const auto fault = [&](const std::string& what) {
    verdict.findings.push_back({kEnds, "the process " + what});
    verdict.seen_from_outside = true;
  };
  const std::string answer = end_of(scratch_.path() / "answer", kMaxOutput);
  if (!answer.empty()) {
    try {
      Outcome outcome = outcome_of(answer);
      verdict.findings = std::move(outcome.findings);
      verdict.skipped = std::move(outcome.skipped);
      verdict.misfit = outcome.misfit;
      answers_ = std::move(outcome.answers);
    } catch (const Error& error) {
      fault(error.what());
    }
  }
  if (WIFSIGNALED(status)) {
    fault("crashed (" + signal_name(WTERMSIG(status)) + ")" +
          (answer.empty() ? "" : ", after the test"));
  } else if (answer.empty() || WEXITSTATUS(status) != 0) {
    fault("ended with exit code " + std::to_string(WEXITSTATUS(status)) +
          (answer.empty() ? ", but without a result" : " after the test"));
  }
  if (const std::size_t left = study::ProcessTree{0, mark_}.kill() + end_orphans(scratch_.path());
      left > 0) {
    fault("left " + std::to_string(left) + " processes behind");
  }
  return verdict;
}
}  // namespace altiplan::cli
