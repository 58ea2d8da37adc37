// SPDX-License-Identifier: Apache-2.0
#include "study/store/store.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "files.hpp"
#include "host/base/deflate.hpp"
#include "study/model/study_data.hpp"
#include "study/store/load_study.hpp"
#include "study/store/place.hpp"
#include "study/store/sqlite.hpp"

namespace altiplan::host::store_test {
using namespace study;
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
  /// What is said by what throws; "" where nothing is.
  template <typename Call>
  static std::string refusal(const Call& call) {
    try {
      call();
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

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
    StoredRun traced = made_run("k3", "a", 0);
    traced.trace = "{\"altiplan_trace\": 1}\n";
    store.add({made_run("k2", "a", 1), traced});  // k2 is there already
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
  EXPECT_EQ(store.trace(runs[0].id), "{\"altiplan_trace\": 1}\n");
  EXPECT_EQ(store.trace(runs[2].id) + store.trace(99), "");
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
  const auto error_of = [&](StoreMode mode) { return refusal([&] { Store(file_, mode); }); };
  EXPECT_NE(error_of(StoreMode::read).find("cannot be opened"), std::string::npos);
  for (const StoreMode mode : {StoreMode::read, StoreMode::write}) {
    write("out.db", "altiplan: 1\nthis is no database at all, but long enough to be one\n");
    EXPECT_NE(error_of(mode).find("not a database"), std::string::npos) << error_of(mode);
    EXPECT_NE(error_of(mode).find(file_.string()), std::string::npos);
  }
  fs::remove(file_);
  Sqlite(file_, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE).run("CREATE TABLE t(x)");
  EXPECT_HAS(error_of(StoreMode::write), "not of altiplan study");
  fs::remove(file_);
  { const Store store(file_, StoreMode::write); }
  Sqlite(file_, SQLITE_OPEN_READWRITE).run("PRAGMA user_version = 1");
  EXPECT_HAS(error_of(StoreMode::read),
             "is of version 1 of the store; this program supports version 2: run the study again "
             "with another --out, or use the program of that version");
}

TEST_F(StoreTest, TakesAnEmptyFileAloneForANewOne) {
  write("out.db", "x");
  for (const StoreMode mode : {StoreMode::read, StoreMode::write}) {
    EXPECT_HAS(refusal([&] { Store(file_, mode); }), "not a database");
  }
  EXPECT_EQ(fs::file_size(file_), 1U);
  write("out.db", "");
  EXPECT_HAS(refusal([&] { Store(file_, StoreMode::read); }), "is empty");
  const Store opened(file_, StoreMode::write);
  EXPECT_TRUE(Store(file_, StoreMode::read).keys().empty());
  EXPECT_HAS(refusal([&] { Store(folder_, StoreMode::read); }), "is a folder");
}

TEST_F(StoreTest, RemovesNothingButAStore) {
  write("notes.txt", "years of work");
  Sqlite(folder_ / "other.db", SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE).run("CREATE TABLE t(x)");
  fs::create_symlink("notes.txt", folder_ / "link.db");
  EXPECT_HAS(refusal([&] { remove_store(folder_ / "notes.txt"); }), "not a database");
  EXPECT_HAS(refusal([&] { remove_store(folder_ / "link.db"); }), "not a database");
  EXPECT_HAS(refusal([&] { remove_store(folder_ / "other.db"); }), "not of altiplan study");
  EXPECT_HAS(refusal([&] { remove_store(folder_); }), "is a folder");
  EXPECT_HAS(refusal([&] { expect_replaceable(folder_ / "notes.txt"); }), "not a database");
  expect_replaceable(folder_ / "other.db");
  EXPECT_TRUE(fs::exists(folder_ / "notes.txt") && fs::exists(folder_ / "other.db"));

  const Store opened(file_, StoreMode::write);
  EXPECT_HAS(refusal([&] { expect_replaceable(file_); }), "a database of altiplan study");
  fs::create_symlink("out.db", folder_ / "to_store.db");
  remove_store(folder_ / "to_store.db");
  EXPECT_FALSE(fs::exists(file_));
  EXPECT_TRUE(fs::is_symlink(folder_ / "to_store.db"));
  remove_store(file_);  // absent is well
}

TEST_F(StoreTest, AJournalLeftBehindGoesAndAnotherFileOfThatNameStays) {
  write("out.db-journal", "\xd9\xd5\x05\xf9\x20\xa1\x63\xd7 and pages");
  const Store opened(file_, StoreMode::write);
  EXPECT_FALSE(fs::exists(folder_ / "out.db-journal"));
  remove_store(file_);
  write("out.db-journal", "what I did today");
  EXPECT_HAS(refusal([&] { Store(file_, StoreMode::write); }), "is not a journal");
  EXPECT_FALSE(fs::exists(file_));
  EXPECT_TRUE(fs::exists(folder_ / "out.db-journal"));
}

TEST_F(StoreTest, IsOnePlaceByEveryName) {
  fs::create_symlink("out.db", folder_ / "link.db");  // before there is anything
  fs::create_directory_symlink(".", folder_ / "here");
  const fs::path place = fs::canonical(folder_) / "out.db";
  EXPECT_EQ(place_of(folder_ / "link.db"), place);
  EXPECT_EQ(place_of(folder_ / "here" / "link.db"), place);
  EXPECT_EQ(work_folder_of(folder_ / "here/./out.db"), place.string() + ".work");
}

TEST_F(StoreTest, HasOneWriterByEveryName) {
  {
    const Store opened(file_, StoreMode::write);
    fs::create_hard_link(file_, folder_ / "hard.db");
    fs::create_symlink("out.db", folder_ / "soft.db");
    for (const char* name : {"out.db", "hard.db", "soft.db"}) {
      const std::string why = refusal([&] { Store(folder_ / name, StoreMode::write); });
      EXPECT_HAS(why, "is being written by process " + std::to_string(::getpid()));
      EXPECT_HAS(why, name);
      EXPECT_TRUE(Store(folder_ / name, StoreMode::read).keys().empty());
    }
    EXPECT_HAS(refusal([&] { Store(file_, StoreMode::write); }), "is being written by process");
  }
  EXPECT_TRUE(Store(folder_ / "hard.db", StoreMode::write).keys().empty());
}

TEST_F(StoreTest, TellsDamage) {
  const auto damaged = [&](const char* sql) {
    fs::remove(file_);
    {
      Store store(file_, StoreMode::write);
      fill(store);
      store.add({made_run("k1", "a", 0)});
    }
    Sqlite(file_, SQLITE_OPEN_READWRITE).run(sql);
    const std::string why = refusal([&] {
      const Store store(file_, StoreMode::read);
      store.runs();
      store.run(std::string_view("k1"));
    });
    EXPECT_HAS(why, file_.string());
    return why;
  };
  EXPECT_HAS(damaged("UPDATE run_values SET value = 'abc'"), "'value' is 'abc', expected a number");
  EXPECT_HAS(damaged("UPDATE runs SET repetition = 'abc'"), "expected a whole number");
  EXPECT_HAS(damaged("UPDATE runs SET repetition = 4294967296"), "from 0 to 2147483647");
  EXPECT_HAS(damaged("UPDATE runs SET scenario = 99"), "the scenario of the run k1 is not stored");
  EXPECT_HAS(damaged("CREATE TRIGGER t AFTER INSERT ON runs BEGIN DELETE FROM runs; END"),
             "it has a trigger 't'");
  EXPECT_HAS(damaged("DELETE FROM quantities"), "a value of the run k1 has no name");
  EXPECT_HAS(damaged("UPDATE results SET result = x'0011'"),
             "the result of 'a hills[seed=1] #0' cannot be unpacked");
}

TEST_F(StoreTest, TellsWhatIsNestedTooDeep) {
  Store store(file_, StoreMode::write);
  fill(store);
  StoredRun deep = made_run("deep", "a", 0);
  deep.result = std::string(1000000, '[') + std::string(1000000, ']');
  StoredRun text = made_run("text", "a", 1);
  text.result = "[\"\\\"" + std::string(1000, '[') + "\"]";
  store.add({deep, text});
  EXPECT_HAS(refusal([&] { store.run(std::string_view("deep")); }), "nested deeper than 500");
  EXPECT_EQ(store.run(std::string_view("text"))->result, text.result) << "brackets in a text";
}

TEST(Decompressed, stops_at_the_most_that_is_wanted) {
  const std::string bytes = compressed(std::string(1000000, 'x'), 9);
  EXPECT_EQ(decompressed(bytes, 1000000)->size(), 1000000U);
  EXPECT_FALSE(decompressed(bytes, 999999));
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
}  // namespace altiplan::host::store_test
