// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <map>
#include <random>
#include <string>

#include "study/report/page.hpp"
#include "study/report/report.hpp"
#include "support/files.hpp"

namespace altiplan::study::report {
using namespace host;

namespace fs = std::filesystem;
using altiplan::testing::TempFolder;
using altiplan::testing::text_of;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Pipelines p0 …, scenarios s0 …; values that differ from run to run are among them.
inline StudyData study(std::size_t pipelines, std::size_t scenarios, int repetitions = 1) {
  StudyData data;
  data.file.name = "made up";
  data.file.seed = 3;
  data.stores = {"/somewhere/study.db"};
  data.columns = {"expanded", "length_m", "peak_memory_mb", "plan_time_s"};
  for (std::size_t p = 0; p < pipelines; ++p) {
    data.pipelines.push_back({"p" + std::to_string(p), "p" + std::to_string(p), "p.yaml", {}});
    data.file.pipelines.push_back({"p" + std::to_string(p), {}, {}});
  }
  for (std::size_t s = 0; s < scenarios; ++s) {
    data.scenarios.push_back({"s" + std::to_string(s), "s", "s.yaml", {}});
    for (std::size_t p = 0; p < pipelines; ++p) {
      for (int r = 0; r < repetitions; ++r) {
        RunRow row;
        row.id = std::int64_t(data.rows.size());
        row.key = "key" + std::to_string(data.rows.size());
        row.scenario = s;
        row.pipeline = p;
        row.repetition = r;
        row.outcome = "solved";
        row.values = {100.0 * double(s + 1), 1000.0 + 10 * double(s) + double(p) + r, 40, 0.1};
        data.rows.push_back(std::move(row));
      }
    }
  }
  return data;
}

inline Source source_of(StudyData data) {
  return {std::move(data), "altiplan: 1\n", [](const RunRow&) { return std::string(); }};
}

inline Options options(bool times = false) {
  Options made;
  made.times = times;
  made.command = "altiplan report DB -o DIR";
  return made;
}

inline std::map<std::string, std::string> files_of(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) {
      files[fs::relative(entry.path(), folder).string()] = text_of(entry.path());
    }
  }
  return files;
}

/// The report's files; NaN and infinity must not have come into any picture.
inline std::map<std::string, std::string> written(const StudyData& data, bool times = false) {
  const TempFolder temp;
  write_report(source_of(data), options(times), temp / "report");
  auto files = files_of(temp / "report");
  for (const char* must :
       {"index.html", "runs.csv", "figures/success.svg", "figures/success.csv", "tables/success.md",
        "tables/success.tex", "tables/verdicts.md", "tables/scenarios.csv"}) {
    EXPECT_EQ(files.count(must), 1u) << must;
  }
  for (const auto& [name, text] : files) {
    if (name.ends_with(".svg")) {
      EXPECT_EQ(text.find("nan"), std::string::npos) << name;
      EXPECT_EQ(text.find("inf"), std::string::npos) << name;
    }
  }
  return files;
}
}  // namespace altiplan::study::report
