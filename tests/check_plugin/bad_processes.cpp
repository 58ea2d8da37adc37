// SPDX-License-Identifier: Apache-2.0
// Planners that plan well, and do to their process, or declare of themselves, what they should not.
#include "bad_entries.hpp"
#include "sound_planner.hpp"

namespace {
using namespace altiplan;
using namespace altiplan::bad;

void exits() { std::exit(0); }
void exits_at_once() { ::_exit(0); }
void aborts() { std::abort(); }
void ends_by_thread() { std::thread(throws).join(); }
void replaces_itself() { ::execl("/bin/true", "true", nullptr); }
void stops_itself() { ::raise(SIGSTOP); }

/// What leaves the process to be ended at its end.
class CrashesAtExit {
 public:
  CrashesAtExit() {
    std::atexit([] { std::abort(); });
  }
};
void crashes_at_exit() { static const CrashesAtExit kOnce; }

template <double (*kOther)()>
PlanResult noting(const Sound& sound, const Request& request) {
  PlanResult result = sound.plan(request);
  result.counters.push_back({"noted", std::int64_t(1e18 * kOther())});
  return result;
}
}  // namespace

ALTIPLAN_PLUGIN(Planner, "changes_folder", SpoiltPlanner<after<changes_folder>>, NoParams,
                "changes the working folder")
ALTIPLAN_PLUGIN(Planner, "changes_rounding", SpoiltPlanner<after<changes_rounding>>, NoParams,
                "rounds upward from then on")
ALTIPLAN_PLUGIN(Planner, "takes_signal", SpoiltPlanner<after<takes_signal>>, NoParams,
                "ignores a signal from then on")
ALTIPLAN_PLUGIN(Planner, "sets_variable", SpoiltPlanner<after<sets_variable>>, NoParams,
                "sets an environment variable")
ALTIPLAN_PLUGIN(Planner, "leaves_file_open", SpoiltPlanner<after<leaves_file_open>>, NoParams,
                "leaves a file open at each plan")
ALTIPLAN_PLUGIN(Planner, "leaves_thread", SpoiltPlanner<after<leaves_thread>>, NoParams,
                "leaves a thread behind at each plan")
ALTIPLAN_PLUGIN(Planner, "makes_folder", SpoiltPlanner<after<makes_folder>>, NoParams,
                "makes a folder in the home folder")
ALTIPLAN_PLUGIN(Planner, "writes_by_process", SpoiltPlanner<after<writes_by_process>>, NoParams,
                "lets a process of its own write a file in the home folder")
ALTIPLAN_PLUGIN(Planner, "exits", SpoiltPlanner<at_a_wide_goal<exits>>, NoParams,
                "calls exit(0) where the goal has a tolerance")
ALTIPLAN_PLUGIN(Planner, "exits_at_once", SpoiltPlanner<at_a_wide_goal<exits_at_once>>, NoParams,
                "calls _exit(0) where the goal has a tolerance")
ALTIPLAN_PLUGIN(Planner, "replaces_itself", SpoiltPlanner<at_a_wide_goal<replaces_itself>>,
                NoParams, "runs /bin/true in its place where the goal has a tolerance")
ALTIPLAN_PLUGIN(Planner, "aborts", SpoiltPlanner<at_a_wide_goal<aborts>>, NoParams,
                "aborts where the goal has a tolerance")
ALTIPLAN_PLUGIN(Planner, "crashes", SpoiltPlanner<at_a_wide_goal<crashes>>, NoParams,
                "crashes where the goal has a tolerance")
ALTIPLAN_PLUGIN(Planner, "crashes_at_exit", SpoiltPlanner<at_a_wide_goal<crashes_at_exit>>,
                NoParams, "aborts at the end of a process in which the goal had a tolerance")
ALTIPLAN_PLUGIN(Planner, "ends_by_thread", SpoiltPlanner<at_a_wide_goal<ends_by_thread>>, NoParams,
                "a thread of its own throws where the goal has a tolerance")
ALTIPLAN_PLUGIN(Planner, "throws", SpoiltPlanner<at_a_wide_goal<throws>>, NoParams,
                "throws where the goal has a tolerance")
ALTIPLAN_PLUGIN(Planner, "never_returns", SpoiltPlanner<at_a_wide_goal<never_returns>>, NoParams,
                "never returns where the goal has a tolerance")
ALTIPLAN_PLUGIN(Planner, "stops_itself", SpoiltPlanner<at_a_wide_goal<stops_itself>>, NoParams,
                "stops its process where the goal has a tolerance")
ALTIPLAN_PLUGIN(Planner, "hoards", SpoiltPlanner<at_a_wide_goal<hoards>>, NoParams,
                "takes memory without end where the goal has a tolerance")
ALTIPLAN_PLUGIN(Planner, "leaves_process", SpoiltPlanner<at_a_wide_goal<leaves_process>>, NoParams,
                "leaves a process behind where the goal has a tolerance")
ALTIPLAN_PLUGIN(Planner, "depends_on_time", SpoiltPlanner<noting<by_time>>, NoParams,
                "its answer depends on when it was loaded")
ALTIPLAN_PLUGIN(Planner, "depends_on_memory", SpoiltPlanner<noting<by_memory>>, NoParams,
                "its answer depends on memory that nobody has set")
ALTIPLAN_BAD_ENTRIES(Planner, SpoiltPlanner<plain>, NoParams)
ALTIPLAN_BAD_PROCESSES(Planner, SpoiltPlanner<after<changes_locale>>, SpoiltPlanner<after<prints>>,
                       SpoiltPlanner<after<writes_file>>, SpoiltPlanner<after<leaks>>,
                       SpoiltPlanner<noting<by_address>>, NoParams)
