// SPDX-License-Identifier: Apache-2.0
// Reports of a part of a study, and of scenarios of different scales.
#include <gtest/gtest.h>

#include "report_study.hpp"
#include "study/report/panels.hpp"

namespace altiplan::study::report::report_parts_test {
namespace {

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t found = 0;
  for (std::size_t at = text.find(what); at != text.npos; at = text.find(what, at + 1)) {
    ++found;
  }
  return found;
}

/// Three pipelines, of which the second has not run, in four of ten scenarios.
StudyData part() {
  StudyData data = study(3, 10);
  data.planned = data.rows.size();
  std::erase_if(data.rows, [](const RunRow& row) { return row.pipeline == 1 || row.scenario > 3; });
  data.file.claims = {{"first", "median(p1.length_m / p0.length_m)", "> 1", 0.95},
                      {"second", "share(p1.solved)", ">= 0.5", 0.95},
                      {"third", "max(p2.length_m / p0.length_m)", "<= 2", 0.95}};
  return data;
}

TEST(ReportParts, SaysOnceWhatIsMissing) {
  const auto files = written(part());
  const std::string& page = files.at("index.html");
  EXPECT_EQ(count(page, "No run of 1 pipeline: p1."), 1u);
  EXPECT_EQ(count(page, "No run of 6 scenarios."), 1u);
  EXPECT_EQ(count(page, "No data, as no pair has runs of all pipelines named: first, second."), 1u);
  EXPECT_EQ(count(page, "No pair has all named values"), 0u);
  EXPECT_NE(page.find("2 pipelines on 4 scenarios: 8 of 8 runs solved; 1 of 3 claims holds, 2 "
                      "without data"),
            std::string::npos);
  EXPECT_NE(files.at("tables/verdicts.md").find("second"), std::string::npos);
  for (const auto& [name, text] : files) {
    if (name.starts_with("figures/") || name == "tables/success.md" || name == "runs.csv") {
      EXPECT_EQ(text.find("p1"), std::string::npos) << name;
    }
  }
  const TempFolder temp;
  EXPECT_EQ(write_report(source_of(part()), options(), temp / "report").lacking,
            (std::vector<std::string>{
                "No run of 1 pipeline: p1.", "No run of 6 scenarios.",
                "Comparisons of fewer than 6 scenarios (of one: repetitions) have no interval."}));
  EXPECT_TRUE(write_report(source_of(study(3, 10)), options(), temp / "report").lacking.empty());
}

TEST(ReportParts, PipelinesKeepTheirColors) {
  const auto whole = written(study(3, 10));
  const auto some = written(part());
  for (const std::string figure : {"boxes-length_m", "success", "solved-by-expanded"}) {
    const std::string& all = whole.at("figures/" + figure + ".svg");
    const std::string& less = some.at("figures/" + figure + ".svg");
    EXPECT_GT(count(all, "class=\"f1\"") + count(all, "class=\"s1\""), 0u) << figure;
    EXPECT_EQ(count(less, "class=\"f1\"") + count(less, "class=\"s1\""), 0u) << figure;
    EXPECT_GT(count(less, "class=\"f2\"") + count(less, "class=\"s2\""), 0u) << figure;
  }
  // Of p2 / p0, drawn as p2.
  EXPECT_GT(count(some.at("figures/pairs-length_m.svg"), "class=\"f2\""), 0u);
}

/// The panels' titles where each scenario is of that entry and has that length.
std::vector<std::string> titles(const std::vector<std::pair<std::string, double>>& scenarios) {
  StudyData data = study(2, scenarios.size());
  for (std::size_t s = 0; s < scenarios.size(); ++s) {
    data.scenarios[s].of = scenarios[s].first;
  }
  for (RunRow& row : data.rows) {
    row.values[1] = scenarios[row.scenario].second * (1 + 0.01 * double(row.pipeline));
  }
  const StudyData ordered = in_order(data, false);
  std::vector<std::string> titles;
  for (const MetricAnalysis& metric : analyse(ordered, false).metrics) {
    if (metric.metric == "length_m") {
      for (const Panel& panel : panels_of(ordered, metric)) {
        titles.push_back(panel.title);
      }
    }
  }
  return titles;
}

TEST(ReportPanels, AreOfScenariosOfOneScale) {
  using Titles = std::vector<std::string>;
  EXPECT_EQ(titles({{"a", 1}, {"a", 2}, {"b", 8}}), Titles{""});
  EXPECT_EQ(titles({{"far", 100}, {"near", 1}, {"near", 1.2}}), (Titles{"near", "far"}));
  EXPECT_EQ(titles({{"a", 1}, {"b", 5}, {"c", 25}, {"d", 125}}), (Titles{"a, b", "c, d"}));
  // Random worlds differ from little to much: cut only at a gap.
  EXPECT_EQ(titles({{"a", 1}, {"a", 7}, {"a", 40}, {"a", 200}}), Titles{""});
  EXPECT_EQ(titles({{"a", 1}, {"a", 2}, {"a", 30}}), (Titles{"s0, s1", "s2"}));
  EXPECT_EQ(titles({{"a", 0}, {"b", 50}, {"c", -20}}), Titles{""});
  EXPECT_EQ(titles({{"a", kNaN}, {"b", 50}}), Titles{""});
  EXPECT_EQ(titles({{"a", kNaN}}), Titles{});
}

TEST(ReportPanels, HaveAxesOfTheirOwn) {
  StudyData data = study(2, 4);
  for (RunRow& row : data.rows) {
    row.values[1] *= row.scenario < 2 ? 1 : 1000;
  }
  for (std::size_t s = 0; s < 4; ++s) {
    data.scenarios[s].of = s < 2 ? "small" : "large";
  }
  const auto files = written(data);
  const std::string& svg = files.at("figures/boxes-length_m.svg");
  EXPECT_EQ(count(svg, ">Length, m<"), 2u);
  EXPECT_LT(svg.find(">small<"), svg.find(">large<"));
  EXPECT_EQ(svg.find("logarithmic"), std::string::npos);
  EXPECT_NE(files.at("figures/boxes-length_m.csv").find("p1,n,2,,,large"), std::string::npos);
  EXPECT_EQ(count(written(study(2, 4)).at("figures/boxes-length_m.svg"), ">Length, m<"), 1u);
}
}  // namespace
}  // namespace altiplan::study::report::report_parts_test
