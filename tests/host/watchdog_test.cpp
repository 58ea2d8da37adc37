// SPDX-License-Identifier: Apache-2.0
#include "host/run/watchdog.hpp"

#include <cstdio>

#include "files.hpp"

namespace altiplan::host::watchdog_test {
namespace {

class WatchdogTest : public testing::Files {
 protected:
  /// Ends the process with the exit code of the result so far, which it prints.
  RunOptions crash_report() const {
    RunOptions options;
    options.on_stuck = [](const RunResult& result) {
      for (const StepResult& step : result.steps) {
        std::fprintf(stderr, "%s %s; ", step.id.c_str(), name(step.status));
      }
      std::fprintf(stderr, "all %s: %s\n", name(result.status), result.message.c_str());
      _exit(result.exit_code());
    };
    return options;
  }
};

TEST(Watchdog, FiresTheTokenAndKnowsWhy) {
  Watchdog watchdog([](const std::string&) { _exit(9); });
  EXPECT_FALSE(watchdog.arm(1e300, std::nullopt).stop_requested()) << "no time is too long";
  watchdog.disarm();
  for (int again = 0; again < 3; ++again) {
    const std::stop_token token = watchdog.arm(again == 2 ? 1e6 : 0.01, std::nullopt);
    if (again == 2) {
      watchdog.stop_now();
    }
    while (!token.stop_requested()) {
      std::this_thread::yield();
    }
    watchdog.disarm();
    EXPECT_FALSE(watchdog.out_of_memory());
  }
  const std::stop_token token = watchdog.arm(1e6, 10.0);
  // More than the limit, and with a sanitizer's shadow not so much that the grace is cut short.
  const std::vector<char> much(14'000'000, 'x');
  while (!token.stop_requested()) {
    std::this_thread::yield();
  }
  watchdog.disarm();
  EXPECT_TRUE(watchdog.out_of_memory());
  EXPECT_EQ(much.back(), 'x');
  EXPECT_FALSE(watchdog.arm(1e6, std::nullopt).stop_requested());
  EXPECT_FALSE(watchdog.out_of_memory());
  watchdog.disarm();
}

TEST_F(WatchdogTest, APlannerThatNeverStopsEndsTheProcess) {
  EXPECT_EXIT(
      run("steps: [{plan: told, within_s: 0.1, with: {does: never_stops}}]\n", crash_report()),
      ::testing::ExitedWithCode(4),
      "^told failed; all failed: told: the planner 'told' .steps.0. did not stop within two "
      "seconds");
}

TEST_F(WatchdogTest, TheRouteSoFarIsInTheCrashReport) {
  EXPECT_EXIT(
      run("steps: [{plan: told}, {smooth: told_smoother, id: s, within_s: 0.1, with: "
          "{does: nothing}}, {plan: told_pilot, within_s: 0.1, with: {does: never_stops}}]\n",
          crash_report()),
      ::testing::ExitedWithCode(1),
      "^told solved; s solved; told_pilot failed; all failed: told_pilot: the local_planner "
      "'told_pilot'");
}

TEST_F(WatchdogTest, APilotThatNeverStopsEndsTheProcess) {
  EXPECT_EXIT(run("steps: [{plan: told}, {fly: told_pilot, command: always, within_s: 0.1, with: "
                  "{does: never_stops}}]\n",
                  crash_report()),
              ::testing::ExitedWithCode(1), "^told solved; told_pilot failed; all failed");
}
}  // namespace
}  // namespace altiplan::host::watchdog_test
