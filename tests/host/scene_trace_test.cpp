// SPDX-License-Identifier: Apache-2.0
#include "scene_stored.hpp"

namespace altiplan::host::scene_trace_test {
namespace {

using testing::kTold;
using testing::numbers;

class SceneTrace : public testing::SceneResult {
 protected:
  /// The trace of a step with two iterations and `count` nodes, each the child of the one before.
  void traced(int count) const {
    std::string text = "{\"altiplan_trace\": 1}\n";
    for (int i = 0; i < count; ++i) {
      text += event("added", i, i - 1, i);
      if (i == 1 || i == count - 1) {
        text += event("iteration", i, -1, 0);
      }
    }
    write("t.jsonl", text);
    result(kTold);
    edit("result.json", [&](Json& json) { json["trace"] = (folder_ / "t.jsonl").string(); });
  }
  static std::string event(const char* kind, int node, int parent, double x) {
    return "{\"step\": \"told\", \"kind\": \"" + std::string(kind) +
           "\", \"node\": " + std::to_string(node) + ", \"parent\": " + std::to_string(parent) +
           ", \"at\": [" + std::to_string(x) + ", 2, 3], \"value\": 7.5}\n";
  }
  static std::string iteration(int number, const std::string& best, const std::string& mean,
                               int alive) {
    return "{\"step\": \"told\", \"kind\": \"iteration\", \"node\": " + std::to_string(number) +
           ", \"parent\": -1, \"at\": [9, 2, 3], \"value\": " + best + ", \"mean\": " + mean +
           ", \"alive\": " + std::to_string(alive) + "}\n";
  }
};

TEST_F(SceneTrace, EventsAndTheirParents) {
  traced(3);
  const Json trace = shown().at("trace");
  EXPECT_EQ(trace.at("events"), 5);
  EXPECT_EQ(trace.at("kept"), 5);
  EXPECT_EQ(trace.at("steps"), Json{"told"});
  EXPECT_EQ(numbers<std::uint8_t>(trace.at("kind")), (std::vector<std::uint8_t>{1, 1, 4, 1, 4}));
  const auto at = numbers<float>(trace.at("at"));
  const auto parent = numbers<float>(trace.at("parent"));
  EXPECT_EQ(at[9], 2);
  EXPECT_EQ(parent[9], 1);
  EXPECT_EQ(parent[0], at[0]) << "a root is its own parent";
  EXPECT_EQ(numbers<float>(trace.at("value")).at(3), 7.5);
  const Json& iterations = trace.at("iterations");
  EXPECT_EQ(numbers<float>(iterations.at("number")), (std::vector<float>{1, 2}));
  EXPECT_EQ(numbers<float>(iterations.at("alive")), (std::vector<float>{-1, -1}));
}

TEST_F(SceneTrace, ReportsHowMuchHasBeenRead) {
  traced(25'000);
  Overrides only_plugins;
  only_plugins.plugin_path = overrides_.plugin_path;
  std::vector<std::string> reported;
  build_scene({read_result((folder_ / "result.json").string(), only_plugins)},
              [&](const std::string& what) {
                if (const std::size_t at = what.find("reading the trace"); at == 0) {
                  reported.push_back(what.substr(what.rfind(':') + 2));
                }
              });
  EXPECT_EQ(reported, (std::vector<std::string>{"39 %", "79 %"}));
}

TEST_F(SceneTrace, IterationsOfAPopulation) {
  result(kTold);
  edit("result.json", [&](Json& json) { json["trace"] = (folder_ / "t.jsonl").string(); });
  write("t.jsonl", "{\"altiplan_trace\": 1}\n" + iteration(1, "null", "null", 0) +
                       iteration(2, "20.5", "30.5", 2) + event("added", 2, -1, 1) +
                       event("added", 3, 2, 2));
  const Json trace = shown().at("trace");
  const Json& iterations = trace.at("iterations");
  EXPECT_EQ(numbers<float>(iterations.at("number")), (std::vector<float>{1, 2}));
  EXPECT_EQ(numbers<float>(iterations.at("alive")), (std::vector<float>{0, 2}));
  const auto means = numbers<float>(iterations.at("mean"));
  EXPECT_TRUE(std::isnan(means.at(0)));
  EXPECT_EQ(means.at(1), 30.5);
  const auto values = numbers<float>(trace.at("value"));
  EXPECT_TRUE(std::isnan(values.at(0)));
  EXPECT_EQ(values.at(1), 20.5);
  EXPECT_EQ(numbers<float>(trace.at("parent")).at(6), 1)
      << "an iteration is no node, whatever its number";
}

TEST_F(SceneTrace, OfAPopulationWholeRoutesAreKept) {
  constexpr int kNodes = 10;
  constexpr int kIterations = 200;
  constexpr int kRoutes = 100;
  std::string text = "{\"altiplan_trace\": 1}\n";
  for (int i = 1; i <= kIterations; ++i) {
    text += iteration(i, "20.5", "30.5", kRoutes);
    for (int node = 0; node < kRoutes * kNodes; ++node) {
      text += event("added", node, node % kNodes == 0 ? -1 : node - 1, node % kNodes);
    }
  }
  write("t.jsonl", text);
  result(kTold);
  edit("result.json", [&](Json& json) { json["trace"] = (folder_ / "t.jsonl").string(); });
  const Json trace = shown().at("trace");
  EXPECT_EQ(trace.at("events"), kIterations * (kRoutes * kNodes + 1));
  EXPECT_EQ(trace.at("kept"), kIterations * (kRoutes / 2 * kNodes + 1));
  const auto kind = numbers<std::uint8_t>(trace.at("kind"));
  const auto at = numbers<float>(trace.at("at"));
  int expected = 0;
  for (std::size_t i = 0; i < kind.size(); ++i) {
    if (kind[i] != 4) {
      ASSERT_EQ(at[3 * i], float(expected++ % kNodes)) << "no node is missing in between";
    }
  }
  // One route that is longer than all that is kept.
  text = "{\"altiplan_trace\": 1}\n" + iteration(1, "20.5", "30.5", 1);
  for (int node = 0; node < 190'000; ++node) {
    text += event("added", node, node - 1, node);
  }
  write("t.jsonl", text);
  EXPECT_EQ(shown().at("trace").at("kept"), 190'001);
}

TEST_F(SceneTrace, ManyEventsAreThinnedEvenly) {
  traced(250'001);
  const Json trace = shown().at("trace");
  EXPECT_EQ(trace.at("events"), 250'003);
  const auto kind = numbers<std::uint8_t>(trace.at("kind"));
  const auto at = numbers<float>(trace.at("at"));
  EXPECT_EQ(trace.at("kept"), kind.size());
  EXPECT_EQ(std::count(kind.begin(), kind.end(), 4), 2) << "no iteration is lost";
  float expected = 0;
  for (std::size_t i = 0; i < kind.size(); ++i) {
    if (kind[i] != 4) {
      ASSERT_EQ(at[3 * i], expected);
      expected += 2;
    }
  }
  EXPECT_EQ(expected, 250'002);
}

TEST_F(SceneTrace, WhatIsNoTraceIsSaid) {
  traced(3);
  const auto warning = [&] {
    const Scene got = scene_of({(folder_ / "result.json").string()});
    EXPECT_EQ(got.warnings.size(), 1U);
    return without_folder(got.warnings.at(0));
  };
  const std::string begin = "{\"altiplan_trace\": 1}\n" + event("added", 0, -1, 1);
  for (const char* wrong :
       {"{\"step\": \"told\", \"ki", "7", "{}", "{\"step\": 1, \"kind\": \"added\"}",
        "{\"step\": \"told\", \"kind\": \"grown\"}"}) {
    write("t.jsonl", begin + wrong);
    EXPECT_EQ(warning(), "t.jsonl:3: this is not a search event: the search is shown up to here");
    EXPECT_EQ(shown().at("trace").at("events"), 1);
  }
  for (const char* wrong : {"", "{}\n", "[1]\n", "{\"altiplan_trace\": 2}\n"}) {
    write("t.jsonl", wrong);
    EXPECT_EQ(warning(), "t.jsonl:1: expected a trace of altiplan run: the search is not shown");
    EXPECT_TRUE(shown().at("trace").is_null());
  }
  std::filesystem::remove(folder_ / "t.jsonl");
  EXPECT_EQ(warning(), "t.jsonl: there is no such file: the search is not shown");
}

}  // namespace
}  // namespace altiplan::host::scene_trace_test
