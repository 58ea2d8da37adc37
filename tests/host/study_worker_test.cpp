// SPDX-License-Identifier: Apache-2.0
#include "study/run/study_worker.hpp"

#include <map>
#include <numeric>

#include "files.hpp"
#include "host/result/result_json.hpp"
#include "support/instrumented.hpp"

namespace altiplan::host::study_worker_test {
using namespace study;
namespace {

/// Runs of a study, each in the pool as the study command has it. What misbehaves, and how it is
/// told, is in tests/study/README.md and tests/study/misbehaving_study_test.py.
class StudyWorker : public testing::Files {
 protected:
  RunOutcome run(const std::string& steps, bool trace = false) {
    const auto file = pipeline("steps: [" + steps + "]\n");
    return run([&] { return load_config(file, overrides_); }, trace);
  }
  RunOutcome run(const std::function<Config()>& load, bool trace = false) {
    WorkFolder folder(folder_ / "work");
    PoolOptions options;
    options.limits = job_limits(budget_);
    options.key = [](std::size_t) { return "key"; };
    WorkerPool pool(folder, options);
    RunOutcome outcome;
    pool.run(
        {0}, [&](const Job& job) { return study_run(job, {load}, budget_, trace); },
        [&](std::vector<Ended> ended) {
          ended_ = ended.at(0);
          outcome = outcome_of(ended_, budget_);
        });
    return outcome;
  }
  StudyBudget budget_;
  Ended ended_;
};

TEST_F(StudyWorker, GivesTheResultThatARunGives) {
  const RunOutcome told = run("{plan: told}");
  EXPECT_EQ(told.outcome, Outcome::solved);
  EXPECT_EQ(told.trace, "");
  const Config config = load_config(folder_ / "p.yaml", overrides_);
  Json here = result_json(config, host::run(config, {}));
  Json there = Json::parse(told.result);
  EXPECT_EQ(told.message, here["message"]);
  for (Json* json : {&here, &there}) {
    for (Json& step : (*json)["steps"]) {
      step.erase("time_s");
      step.erase("setup_time_s");
    }
    for (const char* time : {"plan_time_s", "smooth_time_s"}) {
      (*json)["metrics"].erase(time);
    }
    json->erase("setup_time_s");
  }
  EXPECT_EQ(here, there);
}

TEST_F(StudyWorker, KeepsTheTrace) {
  const RunOutcome told = run("{plan: told}", true);
  EXPECT_EQ(told.outcome, Outcome::solved);
  EXPECT_HAS(told.trace, "told");
  EXPECT_TRUE(Json::parse(told.result)["trace"].is_null());
}

TEST_F(StudyWorker, ACrashNamesThePluginAndKeepsWhatWasThereBefore) {
  if (altiplan::testing::kInstrumented) {
    GTEST_SKIP() << "a sanitizer answers the crash in its own way";
  }
  const RunOutcome told = run("{plan: told}, {plan: rogue, with: {does: segfaults}}");
  EXPECT_EQ(told.outcome, Outcome::crashed);
  EXPECT_HAS(told.message, "the planner 'rogue' (steps.1) crashed (SIGSEGV)");
  EXPECT_EQ(Json::parse(told.result)["steps"][0]["status"], "solved");
}

TEST_F(StudyWorker, WhatItWroteLastIsTold) {
  const RunOutcome told = run("{plan: rogue, with: {does: terminates}}");
  EXPECT_EQ(told.outcome, Outcome::crashed);
  EXPECT_HAS(told.message, "nobody catches this");
}

TEST_F(StudyWorker, FilesThatHaveBecomeWrongAreNoOutcome) {
  const RunOutcome told = run("{plan: no_such_plugin}");
  EXPECT_EQ(told.outcome, Outcome::not_done);
  EXPECT_HAS(told.message, "no_such_plugin");
}

TEST_F(StudyWorker, MoreThanItsTimeIsNotSolved) {
  budget_.time_s = 0.001;
  EXPECT_EQ(run("{plan: outlaw, with: {does: takes_its_time}}").outcome, Outcome::timed_out);
  EXPECT_HAS(run("{plan: outlaw, with: {does: takes_its_time}}").message,
             "reports solved, but exceeded the");
  EXPECT_EQ(run("{plan: told}").outcome, Outcome::solved);
}

TEST_F(StudyWorker, DamagedPayloads) {
  Ended ended;
  for (const std::string payload : {"", "\n", "{}", "{}\n", "[1]\n", "{\"outcome\": \"solved\"}\n",
                                    "{\"outcome\": \"fine\", \"message\": \"\", \"values\": [], "
                                    "\"result_bytes\": 0, \"trace_bytes\": 0}\n",
                                    "{\"outcome\": \"solved\", \"message\": 7, \"values\": [], "
                                    "\"result_bytes\": 0, \"trace_bytes\": 0}\n",
                                    "{\"outcome\": \"solved\", \"message\": \"\", \"values\": [], "
                                    "\"result_bytes\": 5, \"trace_bytes\": 0}\n{}",
                                    "{\"outcome\": \"solved\", \"message\": \"\", \"values\": [], "
                                    "\"result_bytes\": 3, \"trace_bytes\": "
                                    "0}\n{]}",
                                    "{\"outcome\": \"solved\", \"message\": \"\", \"values\": [], "
                                    "\"result_bytes\": 3, \"trace_bytes\": 0}\n"
                                    "\"\xff\"",
                                    "{\"outcome\": \"solved\", \"message\": \"\", \"values\": [], "
                                    "\"result_bytes\": 99999999999, "
                                    "\"trace_bytes\": 0}\n{]}"}) {
    ended.payload = payload;
    EXPECT_EQ(outcome_of(ended, budget_).outcome, Outcome::bad_output) << payload;
  }
}

TEST_F(StudyWorker, EveryEnding) {
  budget_.cpu_s = 30;
  Ended ended;
  ended.note = "the planner 'x' (steps.0)";
  const auto told = [&](Ending how) {
    ended.how = how;
    const RunOutcome run = outcome_of(ended, budget_);
    return name(run.outcome) + (": " + run.message);
  };
  EXPECT_EQ(told(Ending::wall_limit),
            "timed_out: the planner 'x' (steps.0) did not end within 600 s");
  EXPECT_EQ(told(Ending::cpu_limit),
            "timed_out: the planner 'x' (steps.0) used more than 30 s of CPU time");
  EXPECT_EQ(told(Ending::memory_limit),
            "out_of_memory: the planner 'x' (steps.0) used more than 4096 MB of memory");
  EXPECT_HAS(told(Ending::out_of_memory), "out_of_memory: the planner 'x' (steps.0) was killed by");
  EXPECT_HAS(told(Ending::process_limit), "failed: the planner 'x' (steps.0) had more than 1000");
  EXPECT_HAS(told(Ending::too_large), "bad_output: the planner 'x' (steps.0) wrote a file");
  EXPECT_EQ(told(Ending::garbled), "bad_output: the run's record is damaged");
  ended.exit_code = 3;
  EXPECT_EQ(told(Ending::exited),
            "crashed: the planner 'x' (steps.0) ended the process with exit code 3");
  ended.signal = SIGKILL;
  ended.output = "one\n\x1b[31m\xff two\n\n";
  EXPECT_EQ(told(Ending::killed),
            "crashed: the planner 'x' (steps.0) was killed by SIGKILL; last output: one "
            "[31m\xEF\xBF\xBD two");
}
}  // namespace
}  // namespace altiplan::host::study_worker_test
