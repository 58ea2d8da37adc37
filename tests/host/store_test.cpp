// SPDX-License-Identifier: Apache-2.0
#include "host/study/store/store.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "files.hpp"
#include "host/study/store/sqlite.hpp"
#include "host/study/store/study_data.hpp"

namespace altiplan::host {
namespace {

namespace fs = std::filesystem;

StoredRun made_run(const std::string& key, const std::string& pipeline, int repetition) {
  StoredRun run;
  run.key = key;
  run.scenario = "hills[seed=1]";
  run.pipeline = pipeline;
  run.repetition = repetition;
  run.seed = 9007199254740991;
  run.outcome = "solved";
  run.message = "stands, \xff no UTF-8, 'quoted'";
  run.wall_time_s = 0.25;
  run.peak_memory_mb = 12.5;
  run.session = 1;
  run.result = std::string(5000, 'x') + '\0' + "end";
  run.values = {{"flight.length_m", 3.5}, {"length_m", 1e300}};
  return run;
}

class StoreTest : public testing::Files {
 protected:
  void fill(Store& store) const {
    store.set_study(
        {{"text", "{altiplan: 1, scenarios: [{file: s}], pipelines: [{id: a, file: p}]}"},
         {"path", "study.yaml"}});
    store.add_variants({{"hills[seed=1]", "hills", "hills.yaml", {"scenario.seed=1"}}},
                       {{"a", "a", "a.yaml", {}}, {"b[w=1]", "b", "b.yaml", {"steps.0.with.w=1"}}});
    EXPECT_EQ(store.add_session({0, "2026-01-01T00:00:00Z", "altiplan study", "0.1", "host",
                                 "Linux", "cpu", 2, 1000, 2, 1, "process tree"}),
              1);
  }
  const fs::path file_ = folder_ / "out.db";
};

TEST_F(StoreTest, GivesBackWhatWasPutIn) {
  {
    Store store(file_, StoreMode::write);
    fill(store);
    store.add({made_run("k1", "b[w=1]", 0), made_run("k2", "a", 1)});
    store.add({made_run("k2", "a", 1), made_run("k3", "a", 0)});  // k2 is there already
  }
  const Store store(file_, StoreMode::read);
  EXPECT_EQ(store.study().at("path"), "study.yaml");
  EXPECT_EQ(store.pipelines()[1].set, std::vector<std::string>{"steps.0.with.w=1"});
  EXPECT_EQ(store.sessions().at(0).limits, "process tree");
  const std::vector<StoredRun> runs = store.runs();
  ASSERT_EQ(runs.size(), 3U);
  EXPECT_EQ(runs[0].key + runs[1].key + runs[2].key, "k3k2k1") << "by pipeline, then repetition";
  EXPECT_EQ(runs[0].result, "");
  const StoredRun put = made_run("k1", "b[w=1]", 0);
  for (const auto& got : {store.run(std::string_view("k1")), store.run(runs[2].id)}) {
    ASSERT_TRUE(got);
    EXPECT_EQ(got->result, put.result);
    EXPECT_EQ(got->message, put.message);
    EXPECT_EQ(got->seed, put.seed);
    EXPECT_EQ(got->values, put.values);
    EXPECT_EQ(got->wall_time_s, put.wall_time_s);
  }
  EXPECT_FALSE(store.run(std::string_view("k4")));
  EXPECT_FALSE(store.run(99));
}

TEST_F(StoreTest, ABatchIsAllThereOrNot) {
  Store store(file_, StoreMode::write);
  fill(store);
  StoredRun stray = made_run("k2", "of no pipeline", 0);
  EXPECT_THROW(store.add({made_run("k1", "a", 0), stray}), Error);
  EXPECT_TRUE(store.keys().empty());
  store.add({made_run("k1", "a", 0)});
  store.remove({"k1", "not there"});
  EXPECT_TRUE(store.runs().empty());
}

TEST_F(StoreTest, RefusesWhatIsNoStore) {
  const auto error_of = [&](StoreMode mode) -> std::string {
    try {
      Store(file_, mode);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(error_of(StoreMode::read).find("cannot be opened"), std::string::npos);
  for (const StoreMode mode : {StoreMode::read, StoreMode::write}) {
    write("out.db", "altiplan: 1\nthis is no database at all, but long enough to be one\n");
    EXPECT_NE(error_of(mode).find("no database"), std::string::npos) << error_of(mode);
    EXPECT_NE(error_of(mode).find(file_.string()), std::string::npos);
  }
  fs::remove(file_);
  Sqlite(file_, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE).run("CREATE TABLE t(x)");
  EXPECT_HAS(error_of(StoreMode::write), "not of altiplan study");
}

TEST_F(StoreTest, DataOfSeveralShards) {
  const fs::path other = folder_ / "other.db";
  for (const fs::path& file : {file_, other}) {
    Store store(file, StoreMode::write);
    fill(store);
    store.add({made_run("shared", "a", 0)});
    StoredRun own = made_run(file.string(), "b[w=1]", file == other ? 0 : 1);
    own.values.front().second += file == other ? 1e-14 : 0;
    own.values.emplace_back("only_here", file == other ? 1 : 2);
    store.add({own});
  }
  const StudyData data = load_study_data({file_.string(), other.string()});
  ASSERT_EQ(data.rows.size(), 3U);
  EXPECT_EQ(data.columns, (std::vector<std::string>{"flight.length_m", "length_m", "only_here"}));
  EXPECT_TRUE(std::isnan(data.rows[0].values[data.column("only_here")]));
  EXPECT_EQ(data.rows[1].values[data.column("only_here")], 1);
  EXPECT_EQ(data.rows[1].values[data.column("length_m")], 1e300);
  EXPECT_EQ(data.rows[1].values[data.column("flight.length_m")], 3.5)
      << "what differs in the last bits alone is equal";
  EXPECT_EQ(data.rows[1].store, 1U);
  EXPECT_EQ(data.column("nothing"), data.columns.size());
  EXPECT_EQ(data.file.pipelines.at(0).id, "a");
  {
    Store store(other, StoreMode::write);
    store.set_study({{"text", "another"}});
  }
  EXPECT_THROW(load_study_data({file_.string(), other.string()}), Error);
}
}  // namespace
}  // namespace altiplan::host
