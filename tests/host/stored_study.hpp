// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

#include "altiplan/error.hpp"
#include "study/store/store.hpp"

namespace altiplan::testing {}
namespace altiplan::host::testing {
using namespace altiplan::testing;  // which other files of a unit call `testing`
using namespace study;

/// Makes stores of a study with two pipelines and two scenarios in a folder of the test's own.
class StoredStudy : public ::testing::Test {
 protected:
  StoredStudy()
      : folder_(std::filesystem::path(::testing::TempDir()) /
                ("altiplan_store_" + std::to_string(::getpid()) + "_" +
                 ::testing::UnitTest::GetInstance()->current_test_info()->name())) {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~StoredStudy() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  static std::map<std::string, std::string> study(const std::string& repetitions = "2") {
    return {{"name", "two"},
            {"path", "/somewhere/two.yaml"},
            {"seed", "7"},
            {"text",
             "{altiplan: 1,name: two,scenarios: [{file: city.yaml}],pipelines: [{id: astar,file: "
             "a.yaml},{id: jps,file: j.yaml}],repetitions: " +
                 repetitions + ",seed: 7}"}};
  }

  /// Named as in the study, its key made of its name.
  static StoredRun run(const std::string& pipeline, const std::string& scenario, int repetition,
                       double length_m = 100) {
    StoredRun run;
    run.pipeline = pipeline;
    run.scenario = scenario;
    run.repetition = repetition;
    run.key = std::to_string(std::hash<std::string>()(pipeline + scenario)) + "/" +
              std::to_string(repetition);
    run.seed = repetition;
    run.outcome = "solved";
    run.wall_time_s = 1.5;
    run.result = R"({"status": "solved", "time_s": 0.25, "metrics": {"length_m": )" +
                 std::to_string(length_m) + "}}";
    run.values = {{"length_m", length_m}};
    return run;
  }

  /// A store of these runs, all of one session that began at `started`.
  std::string store(const std::string& name, std::vector<StoredRun> runs,
                    const std::string& started = "2026-11-21T18:00:00Z",
                    const std::string& repetitions = "2") const {
    Store made(path(name), StoreMode::write);
    made.set_study(study(repetitions));
    made.add_variants({{"city[seed=1]", "city", "/s/city.yaml", {"scenario.seed=1"}},
                       {"city[seed=2]", "city", "/s/city.yaml", {"scenario.seed=2"}}},
                      {{"astar", "astar", "/s/a.yaml", {}}, {"jps", "jps", "/s/j.yaml", {}}});
    StoredSession session;
    session.started = started;
    session.version = "0.1.0";
    const std::int64_t id = made.add_session(session);
    for (StoredRun& one : runs) {
      one.session = id;
    }
    made.add(runs);
    return path(name);
  }

  /// What the user would read of the exception; "" without one.
  template <typename Call>
  std::string refusal(const Call& call) const {
    try {
      call();
    } catch (const Error& error) {
      std::string text = error.what();
      for (std::size_t at = 0; (at = text.find(folder_.string() + "/")) != text.npos;) {
        text.erase(at, folder_.string().size() + 1);
      }
      return text;
    }
    return "";
  }

  std::filesystem::path folder_;
};
}  // namespace altiplan::host::testing
