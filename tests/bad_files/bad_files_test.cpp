// SPDX-License-Identifier: Apache-2.0
// Every mistake of expected.tsv in the valid files beside it. A row names the file, the text that
// is replaced ('*': all of it), what stands there instead, and a problem that must be reported:
// line:column, key, and how its message starts. Rows without a file add problems to the one above.
// Files without a mistake that reading alone finds have their world built.
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "altiplan/error.hpp"
#include "host/config/config.hpp"
#include "host/mission/mission.hpp"
#include "study/plan/study_plan.hpp"
#include "support/folders.hpp"

namespace altiplan::host::bad_files_test {
using namespace study;
namespace {
namespace fs = std::filesystem;

const fs::path kValid = altiplan::folders::source() / "tests/bad_files";
constexpr std::array kFiles = {"pipeline.yaml", "scenario.yaml", "ground.asc", "zones.geojson",
                               "study.yaml"};

struct Case {
  std::string file;
  std::string before;
  std::string after;
  int row = 0;
  std::vector<std::string> problems;  ///< "LINE:COLUMN KEY: MESSAGE"
};

std::string read(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// \n, \r, \t, \\ and \xHH.
std::string unescaped(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '\\') {
      out += text[i];
    } else if (text.at(++i) == 'x') {
      out += static_cast<char>(std::stoi(text.substr(i + 1, 2), nullptr, 16));
      i += 2;
    } else {
      out += text[i] == 'n' ? '\n' : text[i] == 'r' ? '\r' : text[i] == 't' ? '\t' : text[i];
    }
  }
  return out;
}

std::vector<Case> cases() {
  std::vector<Case> all;
  std::istringstream table(read(kValid / "expected.tsv"));
  std::string line;
  for (int row = 1; std::getline(table, line); ++row) {
    if (line.empty() || line.front() == '#') {
      continue;
    }
    std::array<std::string, 6> cells;
    std::istringstream cells_of(line);
    for (std::string& cell : cells) {
      std::getline(cells_of, cell, '\t');
    }
    if (!cells[0].empty()) {
      all.push_back({cells[0], unescaped(cells[1]), unescaped(cells[2]), row, {}});
    }
    all.back().problems.push_back(cells[3] + " " + cells[4] + ": " + cells[5]);
  }
  return all;
}

class BadFiles : public ::testing::Test {
 protected:
  BadFiles()
      : folder_(fs::path(::testing::TempDir()) /
                ("altiplan_bad_files_" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
    overrides_.plugin_path = {altiplan::folders::build() / "lib/altiplan/plugins"};
  }
  ~BadFiles() override { fs::remove_all(folder_); }

  void lay_out(const Case& one) const {
    for (const char* file : kFiles) {
      std::string text = read(kValid / file);
      if (one.file == file && one.before == "*") {
        text = one.after;
      } else if (one.file == file) {
        const std::size_t at = text.find(one.before);
        ASSERT_NE(at, text.npos) << "row " << one.row << ": the valid file has no such text";
        ASSERT_EQ(text.find(one.before, at + 1), text.npos) << "row " << one.row << ": twice";
        text.replace(at, one.before.size(), one.after);
      }
      std::ofstream(folder_ / file, std::ios::binary) << text;
    }
  }
  std::vector<Problem> problems(const std::string& file) const {
    try {
      if (file == "study.yaml") {
        load_study(folder_ / file, {}, overrides_.plugin_path);
      } else {
        build_mission(load_config(folder_ / "pipeline.yaml", overrides_), 1);
      }
    } catch (const ConfigError& error) {
      return error.problems();
    }
    return {};
  }
  std::string without_folder(std::string text) const {
    const std::string folder = folder_.string() + "/";
    for (std::size_t at = text.find(folder); at != text.npos; at = text.find(folder)) {
      text.erase(at, folder.size());
    }
    return text;
  }

  fs::path folder_;
  Overrides overrides_;
};

TEST_F(BadFiles, TheFilesAreValidBeforeTheyAreDamaged) {
  lay_out({});
  EXPECT_TRUE(problems("pipeline.yaml").empty());
  EXPECT_TRUE(problems("study.yaml").empty());
}

TEST_F(BadFiles, EveryMistakeIsReportedOnceAndInItsPlace) {
  const std::vector<Case> all = cases();
  EXPECT_GE(all.size(), 300U);
  for (const Case& one : all) {
    lay_out(one);
    const std::vector<Problem> found = problems(one.file);
    std::string shown;
    for (const Problem& problem : found) {
      shown += "\n  " + without_folder(problem.where.file) + " " +
               std::to_string(problem.where.line) + ":" + std::to_string(problem.where.column) +
               " " + problem.key + ": " + without_folder(problem.message);
    }
    EXPECT_EQ(found.size(), one.problems.size()) << "row " << one.row << shown;
    for (std::size_t i = 0; i < std::min(found.size(), one.problems.size()); ++i) {
      const Problem& problem = found[i];
      const std::string text = std::to_string(problem.where.line) + ":" +
                               std::to_string(problem.where.column) + " " + problem.key + ": " +
                               without_folder(problem.message);
      EXPECT_TRUE(text.starts_with(one.problems[i]))
          << "row " << one.row << ": " << one.problems[i] << "\nfound:" << shown;
      EXPECT_EQ(fs::path(problem.where.file).parent_path(), folder_) << "row " << one.row;
    }
  }
}
}  // namespace
}  // namespace altiplan::host::bad_files_test
