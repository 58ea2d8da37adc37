// SPDX-License-Identifier: Apache-2.0
#include "study/store/merge.hpp"

#include "stored_study.hpp"
#include "study/store/place.hpp"
#include "study/workers/work_folder.hpp"

namespace altiplan::host::merge_test {
using namespace study;
namespace {

using Merge = testing::StoredStudy;

TEST_F(Merge, holds_every_run_of_its_parts_with_result_and_session) {
  StoredRun traced = run("jps", "city[seed=2]", 1);
  traced.trace = "{}\n";
  const std::string one = store("one.db", {run("astar", "city[seed=1]", 0), traced});
  const std::string other =
      store("other.db", {run("jps", "city[seed=1]", 0, 120)}, "2026-11-21T19:00:00Z");
  const Merged merged = merge_stores({one, other}, path("all.db"));
  EXPECT_EQ(merged.runs, 3);
  EXPECT_EQ(merged.again, 0);
  EXPECT_TRUE(merged.differing.empty());

  const Store all(path("all.db"), StoreMode::read);
  EXPECT_EQ(all.study(), study());
  ASSERT_EQ(all.sessions().size(), 2);
  const std::vector<StoredRun> runs = all.runs();
  ASSERT_EQ(runs.size(), 3);
  for (const StoredRun& kept : runs) {
    const Store part(kept.pipeline == "jps" && kept.repetition == 0 ? other : one, StoreMode::read);
    const StoredRun before = part.run(kept.key).value();
    const StoredRun now = all.run(kept.id).value();
    EXPECT_EQ(now.result, before.result);
    EXPECT_EQ(now.trace, before.trace);
    EXPECT_EQ(now.values, before.values);
    EXPECT_EQ(now.seed, before.seed);
    EXPECT_EQ(now.wall_time_s, before.wall_time_s);
    const bool is_of_other = part.file() == other;
    EXPECT_EQ(all.sessions().at(std::size_t(now.session - 1)).started,
              is_of_other ? "2026-11-21T19:00:00Z" : "2026-11-21T18:00:00Z");
  }
}

TEST_F(Merge, takes_a_run_that_is_in_two_parts_once) {
  StoredRun again = run("astar", "city[seed=1]", 0);
  again.result.replace(again.result.find("0.25"), 4, "0.75");  // time_s
  const std::string one = store("one.db", {run("astar", "city[seed=1]", 0)});
  const std::string other =
      store("other.db", {again, run("astar", "city[seed=1]", 1)}, "2026-11-21T19:00:00Z");
  const Merged merged = merge_stores({one, other}, path("all.db"));
  EXPECT_EQ(merged.runs, 2);
  EXPECT_EQ(merged.again, 1);
  EXPECT_TRUE(merged.differing.empty());
}

TEST_F(Merge, of_a_store_and_itself_is_that_store) {
  const std::string one = store("one.db", {run("astar", "city[seed=1]", 0)});
  const Merged merged = merge_stores({one, one}, one);
  EXPECT_EQ(merged.runs, 1);
  EXPECT_EQ(merged.again, 1);
  const Store all(one, StoreMode::read);
  EXPECT_EQ(all.sessions().size(), 1);
  EXPECT_EQ(all.runs().size(), 1);
}

TEST_F(Merge, reports_a_run_that_came_out_differently_and_keeps_the_first) {
  StoredRun crashed = run("jps", "city[seed=1]", 0);
  crashed.outcome = "crashed";
  crashed.result = "";
  const std::string one =
      store("one.db", {run("astar", "city[seed=1]", 0, 100), run("jps", "city[seed=1]", 0)});
  const std::string other = store("other.db", {run("astar", "city[seed=1]", 0, 101), crashed});
  const Merged merged = merge_stores({one, other}, path("all.db"));
  EXPECT_EQ(merged.again, 0);
  ASSERT_EQ(merged.differing.size(), 2);
  EXPECT_NE(merged.differing[0].find("'astar city[seed=1] #0' has different results"),
            std::string::npos);
  EXPECT_NE(merged.differing[0].find("metrics.length_m is 100.0 and 101.0"), std::string::npos);
  EXPECT_NE(merged.differing[1].find("outcome is solved and crashed"), std::string::npos);
  const Store all(path("all.db"), StoreMode::read);
  EXPECT_EQ(all.run(run("astar", "city[seed=1]", 0).key)->values.at(0).second, 100);
}

TEST_F(Merge, refuses_another_study_and_says_how_it_differs) {
  const std::string one = store("one.db", {run("astar", "city[seed=1]", 0)});
  const std::string other = store("other.db", {run("jps", "city[seed=1]", 0)}, "then", "5");
  EXPECT_EQ(
      refusal([&] {
        merge_stores({one, other}, path("all.db"));
      }),
      "'one.db' and 'other.db' belong to different studies: their files differ: 'repetitions: 2' "
      "against 'repetitions: 5'");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 2)
      << "nothing is left of the attempt";
}

TEST_F(Merge, refuses_one_run_made_from_different_files_or_builds) {
  StoredRun rebuilt = run("astar", "city[seed=1]", 0);
  rebuilt.key = "0123456789abcdef";
  const std::string one = store("one.db", {run("astar", "city[seed=1]", 0)});
  const std::string other = store("other.db", {rebuilt});
  const std::string why = refusal([&] { merge_stores({one, other}, path("all.db")); });
  EXPECT_NE(why.find("'one.db' and 'other.db' both hold the run 'astar city[seed=1] #0', made from "
                     "different files, plugins or builds"),
            std::string::npos)
      << why;
  EXPECT_FALSE(std::filesystem::exists(path("all.db")));
}

TEST_F(Merge, leaves_what_was_there_when_a_part_cannot_be_read) {
  const std::string one = store("one.db", {run("astar", "city[seed=1]", 0)});
  merge_stores({one}, path("all.db"));
  const auto size = std::filesystem::file_size(path("all.db"));
  EXPECT_NE(refusal([&] { merge_stores({path("all.db"), path("none.db")}, path("all.db")); }), "");
  EXPECT_EQ(std::filesystem::file_size(path("all.db")), size);
  EXPECT_EQ(Store(path("all.db"), StoreMode::read).runs().size(), 1);
  EXPECT_FALSE(std::filesystem::exists(path("all.db.partial")));
}

TEST_F(Merge, does_not_mind_where_the_files_lie) {
  const auto made_in = [&](const std::string& folder, double length_m) {
    StoredRun made = run("astar", "city[seed=1]", 0);
    made.result = R"({"pipeline": "/)" + folder + R"(/a.yaml", "scenario": "/)" + folder +
                  R"(/s.yaml", "files": [{"path": "/)" + folder +
                  R"(/a.yaml", "sha256": "12"}], "overrides": {"scenario": "/)" + folder +
                  R"(/s.yaml"}, "metrics": {"length_m": )" + std::to_string(length_m) + "}}";
    return store(folder + ".db", {made});
  };
  const std::string one = made_in("one", 100);
  const Merged merged = merge_stores({one, made_in("other", 100)}, path("all.db"));
  EXPECT_EQ(merged.again, 1);
  EXPECT_TRUE(merged.differing.empty());
  const Merged differing = merge_stores({one, made_in("third", 101)}, path("all.db"));
  ASSERT_EQ(differing.differing.size(), 1);
  EXPECT_NE(differing.differing[0].find("metrics.length_m"), std::string::npos);
}

TEST_F(Merge, is_refused_while_another_process_is_at_work_on_the_store) {
  const std::string one = store("one.db", {run("astar", "city[seed=1]", 0)});
  {
    const WorkFolder of_a_study(work_folder_of(one));
    EXPECT_NE(refusal([&] {
                merge_stores({one}, one);
              }).find("in use by another process: " + std::to_string(::getpid())),
              std::string::npos);
  }
  EXPECT_EQ(merge_stores({one}, one).runs, 1);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1);
}

TEST_F(Merge, of_many_runs_keeps_every_one) {
  std::vector<StoredRun> odd;
  std::vector<StoredRun> even;
  for (int repetition = 0; repetition < 501; ++repetition) {
    (repetition % 2 == 1 ? odd : even).push_back(run("astar", "city[seed=1]", repetition));
  }
  const std::string one = store("one.db", odd);
  const std::string other = store("other.db", even);
  EXPECT_EQ(merge_stores({one, other}, path("all.db")).runs, 501);
  EXPECT_EQ(Store(path("all.db"), StoreMode::read).keys().size(), 501);
}
}  // namespace
}  // namespace altiplan::host::merge_test
