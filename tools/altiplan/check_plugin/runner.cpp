// SPDX-License-Identifier: Apache-2.0
#include "runner.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <thread>

#include "altiplan/error.hpp"
#include "commands.hpp"
#include "host/study/pool/process_tree.hpp"

namespace altiplan::cli {
namespace fs = std::filesystem;
namespace {

using Clock = std::chrono::steady_clock;
using Json = nlohmann::json;

constexpr const char* kEnds = "Process: the test ends well, with a result";
constexpr const char* kSame = "Process: equal requests give equal answers in two processes";
constexpr rlim_t kMostOutput = 64 << 20;

/// A folder that goes with all that is in it.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::error_code error;
    const fs::path folder = fs::temp_directory_path(error);
    if (error) {
      throw Error("TMPDIR: no such folder: " + std::string(std::getenv("TMPDIR")));
    }
    std::string name = (fs::absolute(folder) / "altiplan-check-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) {
      throw Error("cannot make the folder " + name + ": " + std::strerror(errno));
    }
    path_ = name;
  }
  ~ScratchFolder() {
    std::error_code error;
    fs::remove_all(path_, error);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// The last bytes of a file, at most that many; "" of what is no regular file: a test may have put
/// anything in its place.
std::string end_of(const fs::path& file, std::size_t most) {
  const int from = ::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_NOFOLLOW | O_CLOEXEC);
  struct stat status {};
  std::string text;
  if (from >= 0 && ::fstat(from, &status) == 0 && S_ISREG(status.st_mode)) {
    text.resize(std::min(most, std::size_t(status.st_size)));
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

/// A test under way, in its process.
class Child {
 public:
  Child(const PluginTest& test, std::size_t index, std::uint64_t mark, bool again,
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
      throw Error(std::string("no process for a test: ") + std::strerror(errno));
    }
    if (process_ == 0) {
      become(arguments.data());
    }
  }
  ~Child() { end(); }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  std::size_t index() const { return index_; }
  bool again() const { return again_; }
  pid_t process() const { return process_; }

  /// What is wrong once it has ended, or has used more than it may; nullopt while neither is so.
  std::optional<Verdict> look(const RunnerOptions& options, const std::vector<pid_t>& others) {
    int status = 0;
    rusage use{};
    const pid_t got = ::wait4(process_, &status, WNOHANG, &use);
    const double time_s = std::chrono::duration<double>(Clock::now() - began_).count();
    if (got == process_) {
      process_ = 0;
      Verdict verdict = verdict_of(status, others);
      verdict.time_s = time_s;
      verdict.peak_memory_mb = double(use.ru_maxrss) / 1024;
      return verdict;
    }
    const double memory_mb = host::use_of(process_).memory_mb;
    peak_mb_ = std::max(peak_mb_, memory_mb);
    std::string over;
    if (time_s > options.time_limit_s) {
      over = "did not end within " + fixed(options.time_limit_s, 0) + " s";
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
    verdict.said = end_of(scratch_.path() / "said", 2000);
    verdict.time_s = time_s;
    verdict.peak_memory_mb = peak_mb_;
    return verdict;
  }
  /// Of a test of two processes that has passed.
  const std::string& answers() const { return answers_; }

 private:
  [[noreturn]] void become(char* const* arguments) const {
    ::setsid();  // what it sends to its group stays there, and the terminal's signals away
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    host::set_mark(mark_);
    const rlimit output{kMostOutput, kMostOutput};
    ::setrlimit(RLIMIT_FSIZE, &output);
    const int said =
        ::open((scratch_.path() / "said").c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
    const int nothing = ::open("/dev/null", O_RDONLY);
    ::dup2(nothing, STDIN_FILENO);
    ::close(nothing);
    ::dup2(said, STDOUT_FILENO);
    ::dup2(said, STDERR_FILENO);
    ::close(said);
    ::setenv("TMPDIR", (scratch_.path() / "tmp").c_str(), 1);
    ::setenv("HOME", (scratch_.path() / "home").c_str(), 1);
    if (again_) {
      // Memory that nobody has set holds something else, also where it was in use before.
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

  void end() {
    if (process_ > 0) {
      host::ProcessTree{process_, mark_}.kill(process_);
      ::kill(process_, SIGKILL);
      ::waitpid(process_, nullptr, 0);
      process_ = 0;
    }
  }

  /// Ends what has become this process's child when its own parent ended: the test's, though it
  /// does not bear its mark. `others` are tests under way. How many there were.
  static std::size_t end_orphans(const std::vector<pid_t>& others) {
    std::size_t count = 0;
    for (const pid_t child : host::children_of(::getpid())) {
      if (std::find(others.begin(), others.end(), child) == others.end()) {
        ::kill(child, SIGKILL);
        count += ::waitpid(child, nullptr, 0) == child;
      }
    }
    return count;
  }

  Verdict verdict_of(int status, const std::vector<pid_t>& others) {
    Verdict verdict;
    verdict.said = end_of(scratch_.path() / "said", 2000);
    const auto fault = [&](const std::string& what) {
      verdict.findings.push_back({kEnds, "the process " + what});
      verdict.seen_from_outside = true;
    };
    const std::string answer = end_of(scratch_.path() / "answer", kMostOutput);
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
    if (const std::size_t left = host::ProcessTree{0, mark_}.kill() + end_orphans(others);
        left > 0) {
      fault("left " + std::to_string(left) + " processes behind");
    }
    return verdict;
  }

  ScratchFolder scratch_;
  std::size_t index_;
  std::uint64_t mark_;
  bool again_;
  pid_t process_ = 0;
  Clock::time_point began_ = Clock::now();
  double peak_mb_ = 0;
  std::string answers_;
};

/// Where the answers of two processes part; "" where they are equal.
std::string difference(const std::string& one, const std::string& other) {
  std::istringstream a(one);
  std::istringstream b(other);
  std::string in_one;
  std::string in_other;
  for (int line = 1; a || b; ++line) {
    std::getline(a, in_one);
    std::getline(b, in_other);
    if (bool(a) != bool(b) || in_one != in_other) {
      return "answer " + std::to_string(line) + ": '" + in_one.substr(0, 300) + "' in one, '" +
             in_other.substr(0, 300) + "' in the other";
    }
  }
  return "";
}

/// The tests of one run, as they are begun and end.
class Runner {
 public:
  Runner(const std::vector<PluginTest>& tests, const RunnerOptions& options,
         const std::function<void(const Verdict&)>& done)
      : tests_(tests),
        options_(options),
        done_(done),
        verdicts_(tests.size()),
        first_answers_(tests.size()) {}

  std::vector<Verdict> run() {
    run_those(false, options_.jobs);
    run_those(true, 1);
    std::vector<Verdict> all;
    for (std::optional<Verdict>& verdict : verdicts_) {
      if (verdict) {
        all.push_back(std::move(*verdict));
      }
    }
    return all;
  }

 private:
  void run_those(bool alone, std::size_t jobs) {
    std::vector<std::size_t> waiting;
    for (std::size_t i = tests_.size(); i-- > 0;) {
      if (tests_[i].alone == alone) {
        waiting.push_back(i);
      }
    }
    std::vector<std::unique_ptr<Child>> children;
    while ((!waiting.empty() || !children.empty()) && !options_.stop.stop_requested()) {
      while (!waiting.empty() && children.size() < jobs) {
        try {
          start(children, waiting.back(), false);
        } catch (const Error&) {
          if (children.empty()) {
            throw;
          }
          break;  // there is room again when one of them has ended
        }
        waiting.pop_back();
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
      for (std::size_t i = 0; i < children.size(); ++i) {
        if (std::optional<Verdict> verdict = children[i]->look(options_, processes(children))) {
          const std::unique_ptr<Child> ended = std::move(children[i]);
          children.erase(children.begin() + std::ptrdiff_t(i--));
          take(children, *ended, std::move(*verdict));
        }
      }
    }
  }

  static std::vector<pid_t> processes(const std::vector<std::unique_ptr<Child>>& children) {
    std::vector<pid_t> all;
    for (const std::unique_ptr<Child>& child : children) {
      all.push_back(child->process());
    }
    return all;
  }

  void start(std::vector<std::unique_ptr<Child>>& children, std::size_t index, bool again) {
    const std::uint64_t mark = std::uint64_t(::getpid()) << 24 | ++started_;
    children.push_back(std::make_unique<Child>(tests_[index], index, mark, again, options_));
  }

  void take(std::vector<std::unique_ptr<Child>>& children, const Child& ended, Verdict verdict) {
    const std::size_t index = ended.index();
    verdict.test = tests_[index].name;
    if (tests_[index].in_two_processes && !verdict.failed()) {
      if (!ended.again()) {
        first_answers_[index] = ended.answers();
        start(children, index, true);
        return;
      }
      const std::string parted = difference(first_answers_[index], ended.answers());
      if (!parted.empty()) {
        verdict.findings.push_back({kSame, parted});
        verdict.seen_from_outside = true;
      }
    }
    done_(verdict);
    verdicts_[index] = std::move(verdict);
  }

  const std::vector<PluginTest>& tests_;
  const RunnerOptions& options_;
  const std::function<void(const Verdict&)>& done_;
  std::vector<std::optional<Verdict>> verdicts_;
  std::vector<std::string> first_answers_;
  std::uint64_t started_ = 0;
};
}  // namespace

std::string outcome_text(const Outcome& outcome) {
  Json findings = Json::array();
  for (const conformance::Finding& finding : outcome.findings) {
    findings.push_back({finding.law, finding.message});
  }
  return Json{{"findings", findings},
              {"skipped", outcome.skipped},
              {"misfit", outcome.misfit},
              {"answers", outcome.answers}}
      .dump(-1, ' ', false, Json::error_handler_t::replace);
}

Outcome outcome_of(const std::string& text) {
  try {
    const Json json = Json::parse(text);
    Outcome outcome;
    for (const Json& finding : json.at("findings")) {
      outcome.findings.push_back({finding.at(0), finding.at(1)});
    }
    outcome.skipped = json.at("skipped");
    outcome.misfit = json.at("misfit");
    outcome.answers = json.at("answers");
    return outcome;
  } catch (const Json::exception&) {
    throw Error("wrote over its result");
  }
}

std::vector<Verdict> run_apart(const std::vector<PluginTest>& tests, const RunnerOptions& options,
                               const std::function<void(const Verdict&)>& done) {
  ::signal(SIGCHLD,
           SIG_DFL);  // a parent may have left it ignored, and then nothing can be waited for
  ::prctl(PR_SET_CHILD_SUBREAPER, 1);
  return Runner(tests, options, done).run();
}
}  // namespace altiplan::cli
