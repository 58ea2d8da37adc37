// SPDX-License-Identifier: Apache-2.0
// A planner that does to its process, and to others, what only a process of its own can bear: the
// faults of tests/study/README.md. Those of rogues.cpp a single run survives as well.
#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <stdexcept>
#include <thread>

#include "altiplan/planner.hpp"
#include "altiplan/plugin.hpp"

namespace {
using namespace altiplan;
namespace fs = std::filesystem;

struct Params {
  std::string does = "nothing";
  std::string folder;
  void describe(Fields& f) {
    f("does", does).doc("the fault");
    f("folder", folder).doc("where there are files to damage");
  }
};

[[noreturn]] void sleep_for_ever() {
  while (true) {
    std::this_thread::sleep_for(std::chrono::seconds(1));
  }
}

[[noreturn]] void spin() {
  for (std::atomic<int> turns = 0;; ++turns) {
  }
}

int overflow(int depth) {
  volatile char frame[4096];
  frame[0] = char(depth);
  return depth < 0 ? frame[0] : overflow(depth + 1) + frame[0];
}

/// Its processes fork too, half of them in sessions of their own, up to 300 in all.
void fork_bomb(const std::string& folder) {
  const int count = ::open((folder + "/bombs").c_str(), O_WRONLY | O_CREAT | O_APPEND, 0666);
  while (::write(count, "x", 1) == 1 && ::lseek(count, 0, SEEK_END) < 300) {
    if (::fork() == 0 && ::getpid() % 2 == 0) {
      ::setsid();
    }
  }
  sleep_for_ever();
}

/// A child of a child, in a session of its own.
void leave_child() {
  if (::fork() == 0) {
    ::setsid();
    if (::fork() == 0) {
      sleep_for_ever();
    }
    ::_exit(0);
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
}

void damage_files(const std::string& folder, bool remove) {
  std::error_code error;
  for (const fs::directory_entry& file : fs::directory_iterator(folder, error)) {
    if (file.path().filename() == "lock") {
      continue;
    }
    if (remove) {
      fs::remove(file.path(), error);
    } else {
      std::ofstream(file.path(), std::ios::app) << "garbage";
    }
  }
}

/// A record is at the worst damaged before it is there. More numbers than a study of one row has
/// workers; few enough for the limits of its runs also where making a file takes a millisecond.
void forge_record(const std::string& folder) {
  const std::string self = "worker-" + std::to_string(::getppid()) + "-";
  for (int worker = 1; worker <= 100; ++worker) {
    std::ofstream(folder + "/" + self + std::to_string(worker) + ".records", std::ios::app)
        << "Allirec1 and then garbage";
  }
}

void large_file(const std::string& folder) {
  const int file = ::open((folder + "/large").c_str(), O_WRONLY | O_CREAT, 0666);
  if (::pwrite(file, "x", 1, off_t(1) << 40) < 0) {
    throw std::runtime_error("no space");
  }
}

void damage_heap() {
  char* volatile block = static_cast<char*>(std::malloc(64));
  std::free(block);
  std::free(block);
}

const std::map<std::string, std::function<void(const Params&)>>& faults() {
  static const std::map<std::string, std::function<void(const Params&)>> kTable = {
      {"nothing", [](const Params&) {}},
      {"exits_hard", [](const Params&) { ::_exit(0); }},
      {"exits_hard_with_code", [](const Params&) { ::_exit(42); }},
      {"is_killed", [](const Params&) { ::raise(SIGKILL); }},
      {"terminates_itself", [](const Params&) { ::raise(SIGTERM); }},
      {"stops_itself", [](const Params&) { ::raise(SIGSTOP); }},
      {"kills_group", [](const Params&) { ::kill(0, SIGKILL); }},
      {"sets_an_alarm",
       [](const Params&) {
         ::ualarm(1000, 0);
         sleep_for_ever();
       }},
      {"takes_its_time",
       [](const Params&) { std::this_thread::sleep_for(std::chrono::milliseconds(300)); }},
      {"hangs", [](const Params&) { sleep_for_ever(); }},
      {"hangs_deaf",
       [](const Params&) {
         sigset_t all_signals;
         sigfillset(&all_signals);
         ::sigprocmask(SIG_BLOCK, &all_signals, nullptr);
         sleep_for_ever();
       }},
      {"spins", [](const Params&) { spin(); }},
      {"spins_in_threads",
       [](const Params&) {
         std::thread([] { spin(); }).detach();
         std::thread([] { spin(); }).detach();
         spin();
       }},
      {"leaves_a_thread", [](const Params&) { std::thread([] { spin(); }).detach(); }},
      {"overflows_a_thread",
       [](const Params&) { std::thread([] { std::printf("%d", overflow(1)); }).join(); }},
      {"fork_bomb", [](const Params& params) { fork_bomb(params.folder); }},
      {"leaves_a_child", [](const Params&) { leave_child(); }},
      {"grabs",
       [](const Params&) {
         const std::vector<char> all(std::size_t(1) << 46, 'x');
         std::printf("%d", all[all.size() / 2]);
       }},
      {"hoards_fast",
       [](const Params&) {
         std::vector<std::vector<char>> all;
         while (true) {
           all.emplace_back(16 << 20, 'x');
         }
       }},
      {"closes_descriptors", [](const Params&) { ::close_range(0, ~0U, 0); }},
      {"takes_descriptors",
       [](const Params&) {
         while (::open("/dev/null", O_RDONLY) >= 0) {
         }
       }},
      {"floods_stderr",
       [](const Params&) {
         while (true) {
           std::fputs("and on and on\n", stderr);
         }
       }},
      {"damages_files", [](const Params& params) { damage_files(params.folder, false); }},
      {"removes_files", [](const Params& params) { damage_files(params.folder, true); }},
      {"forges_records", [](const Params& params) { forge_record(params.folder); }},
      {"writes_a_large_file", [](const Params& params) { large_file(params.folder); }},
      {"damages_the_heap", [](const Params&) { damage_heap(); }},
      {"changes_the_environment",
       [](const Params&) {
         ::setenv("TZ", "Nowhere/Else", 1);
         ::setenv("LC_ALL", "xx_XX", 1);
         ::umask(0777);
       }},
  };
  return kTable;
}

class Outlaw final : public Planner {
 public:
  explicit Outlaw(const Params& params) : params_(params) {}

 private:
  PlanResult do_plan(const Request& request) const override {
    faults().at(params_.does)(params_);
    PlanResult result;
    result.status = PlanStatus::solved;
    result.route = {request.start.position, request.goal.position};
    return result;
  }
  Traits do_traits() const override { return {}; }
  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Planner, "outlaw", Outlaw, Params, "misbehaves as a process")
