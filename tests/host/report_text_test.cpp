// SPDX-License-Identifier: Apache-2.0
// Names and messages hold any bytes; no form of the report may be broken by them.
#include "study/figures/text.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "study/figures/svg.hpp"
#include "study/figures/tables.hpp"
#include "study/report/packed.hpp"

namespace altiplan::study::report::report_text_test {
namespace {

using std::string;

TEST(ReportText, IsValidUtf8) {
  EXPECT_EQ(printable("a\xC3\xA9z"), "a\xC3\xA9z");
  EXPECT_EQ(printable("a\xFFz"), "a\xEF\xBF\xBDz");
  EXPECT_EQ(printable("\xC3"), "\xEF\xBF\xBD");                                  // cut off
  EXPECT_EQ(printable("\xC0\xAF"), "\xEF\xBF\xBD\xEF\xBF\xBD");                  // too long
  EXPECT_EQ(printable("\xED\xA0\x80"), "\xEF\xBF\xBD\xEF\xBF\xBD\xEF\xBF\xBD");  // a surrogate
  EXPECT_EQ(printable("\xF4\x90\x80\x80").substr(0, 3), "\xEF\xBF\xBD");         // beyond the last
  EXPECT_EQ(printable("\xF0\x9F\x9B\xA9"), "\xF0\x9F\x9B\xA9");                  // an aeroplane
  EXPECT_EQ(printable(string("a\0b\x1B[31mc\x7F", 10)), "a b [31mc ");
  EXPECT_EQ(printable("right\xE2\x80\xAEtfel"), "right tfel");
  EXPECT_EQ(printable("a\nb"), "a b");
  EXPECT_EQ(printable("a\nb", true), "a\nb");
}

TEST(ReportText, IsEscapedForEveryForm) {
  EXPECT_EQ(html("<script>\"&'\n"), "&lt;script&gt;&quot;&amp;&#39; ");
  EXPECT_EQ(html_lines("<\n"), "&lt;\n");
  EXPECT_EQ(latex("a_b%&$#{}~^\\"),
            "a\\_b\\%\\&\\$\\#\\{\\}\\textasciitilde{}\\textasciicircum{}\\textbackslash{}");
  EXPECT_EQ(latex("hills[seed=1]"), "hills{[}seed=1{]}");  // after \\ a bracket is an argument
  EXPECT_EQ(markdown("a|b*c_d`<b>\n"), "a\\|b\\*c\\_d\\`&lt;b\\> ");
  EXPECT_EQ(csv("plain"), "plain");
  EXPECT_EQ(csv("a,\"b\"\nc"), "\"a,\"\"b\"\" c\"");
  EXPECT_EQ(csv("=1+1"), "\" =1+1\"");  // no formula
  EXPECT_EQ(shell("a-b_c.db"), "a-b_c.db");
  EXPECT_EQ(shell("it's $HOME"), "'it'\\''s $HOME'");
  EXPECT_EQ(shell(""), "''");
  EXPECT_EQ(slug("steps.route.counters.x/../y"), "steps.route.counters.x-..-y");
  EXPECT_EQ(slug("../../etc"), "etc");
  EXPECT_EQ(slug("<>"), "unnamed");
}

TEST(ReportText, NumbersOfCsvAreNotText) {
  EXPECT_EQ(csv_text({{"a", "b"}, {{"-1.5", "x"}, {"1e-9", "-x"}}}),
            "a,b\r\n-1.5,x\r\n1e-9,\" -x\"\r\n");
}

TEST(ReportText, IsShortenedByCharacters) {
  EXPECT_EQ(shortened("abcdef", 6), "abcdef");
  EXPECT_EQ(shortened("abcdefgh", 5), "ab…gh");
  const string accents = "\xC3\xA9\xC3\xA9\xC3\xA9\xC3\xA9\xC3\xA9";
  EXPECT_EQ(shortened(accents, 3), "\xC3\xA9…\xC3\xA9");
}

TEST(ReportText, Numbers) {
  EXPECT_EQ(exact(0.1), "0.1");
  EXPECT_EQ(exact(-0.0), "0");
  EXPECT_EQ(exact(std::nan("")), "");
  EXPECT_EQ(exact(1e300), "1e+300");
  EXPECT_EQ(readable(1234567), "1,234,567");
  EXPECT_EQ(readable(0.012345), "0.01235");
  EXPECT_EQ(readable(9.9999, 3), "10.0");
  EXPECT_EQ(readable(1e-9, 3), "1.00e-09");
  EXPECT_EQ(readable(-26390.4), "-26,390");
  EXPECT_EQ(readable(std::nan("")), "–");
  EXPECT_EQ(readable(std::numeric_limits<double>::infinity()), "–");
  EXPECT_EQ(percent(1), "100 %");
  EXPECT_EQ(percent(0.9994), "99.9 %");
  EXPECT_EQ(readable_value("max_turn_deg", 1.0108e-13), "0");
  EXPECT_EQ(readable_value("max_turn_deg", 0.25), "0.2500");
  EXPECT_EQ(readable_value("min_radius_m", 2.2753e15), "straight");
  EXPECT_EQ(readable_value("flight.min_radius_m", 250), "250");
  EXPECT_EQ(readable_value("length_m", 2.2753e15), "2.275e+15");
  EXPECT_EQ(readable_value("plan_time_s", 1e-7, 3), "1.00e-07");  // no noise: a short time
  EXPECT_EQ(readable_value("min_radius_m", std::nan("")), "–");
  EXPECT_EQ(p_text(0.5), "0.50");
  EXPECT_EQ(p_text(0.00001), "< 0.0001");
  EXPECT_EQ(counted(1, "run"), "1 run");
  EXPECT_EQ(counted(2000, "run"), "2,000 runs");
}

TEST(ReportText, MetricsHaveUnits) {
  EXPECT_EQ(metric_label("plan_time_s"), "Plan time, s");
  EXPECT_EQ(metric_label("flight.min_separation_m"), "Flight min separation, m");
  EXPECT_EQ(metric_label("expanded"), "Expansions");
  EXPECT_EQ(metric_label("steps.route.counters.opened"), "Opened of step route");
  EXPECT_EQ(metric_label("steps.my.step"), "Step of step my");
  EXPECT_EQ(metric_label("steps.route.length_m"), "Length of step route, m");
  EXPECT_EQ(metric_label("steps."), "Steps ");
}

TEST(ReportText, NamesAreOrderedByTheirNumbers) {
  std::vector<string> names{"h[10]", "h[2]", "a", "h[2]x", "h[02]", "", "h"};
  std::sort(names.begin(), names.end(), natural_less);
  EXPECT_EQ(names, (std::vector<string>{"", "a", "h", "h[02]", "h[2]", "h[2]x", "h[10]"}));
}

TEST(ReportText, TablesHoldHostileCells) {
  const Table table{
      "x", "<caption>|", {{"a|b"}, {"n", true}}, {{"</td><script>", "1"}, {"x & y \\", "|"}}};
  const string page = html_text(table);
  EXPECT_EQ(page.find("<script"), string::npos);
  EXPECT_EQ(page.find("<caption>"), string::npos);
  const string text = markdown_text(table);
  for (std::size_t line = text.find("| a"); line < text.size(); line = text.find('\n', line) + 1) {
    const string row = text.substr(line, text.find('\n', line) - line);
    std::size_t bars = 0;
    for (std::size_t at = 0; at < row.size(); ++at) {
      bars += row[at] == '|' && (at == 0 || row[at - 1] != '\\');
    }
    EXPECT_EQ(bars, 3u) << row;
  }
  EXPECT_NE(latex_text(table).find("x \\& y \\textbackslash{} & {\\textbar{}} \\\\\n"),
            string::npos);
}

TEST(ReportText, FilesHaveNumbersInColumns) {
  const Cell spread{"12.5 [9, 20]", 12.5, {{"12.5", 12.5}, {"9", 9}, {"20.25", 20.25}}};
  const Table table{"x",
                    "Times",
                    {{"name"}, {"share", true}, {"p", true}, {"time", true, {"", " from", " to"}}},
                    {{"a", {"98.2 %", 0.9821}, {"< 0.0001", 1e-9}, spread},
                     {"b", {"100 %", 1}, {"1,234.5", 1234.5}, "–"},
                     {"c", "–", {"-2e-05", -2e-5}, "–"}}};
  EXPECT_EQ(csv_text(number_grid(table)),
            "name,share,p,time,time from,time to\r\n"
            "a,0.9821,1e-09,12.5,9,20.25\r\n"
            "b,1,1234.5,,,\r\n"
            "c,,-2e-05,,,\r\n");
  const string text = latex_text(table);
  EXPECT_NE(text.find("{lS[table-format=3.1]S[table-format=-4.1e-2]S[table-format=2.1]"
                      "S[table-format=1.0]S[table-format=2.2]}"),
            string::npos)
      << text;
  EXPECT_NE(text.find("name & {share, \\%} & {p} & {time} & {time from} & {time to} \\\\\n"),
            string::npos);
  EXPECT_NE(text.find("a & 98.2 & {\\textless{} 0.0001} & 12.5 & 9 & 20.25 \\\\\n"), string::npos);
  EXPECT_NE(text.find("b & 100 & 1234.5 & {–} & {–} & {–} \\\\\n"), string::npos);
  EXPECT_NE(text.find("c & {–} & -2e-05 & {–} & {–} & {–} \\\\\n"), string::npos);
}

TEST(ReportAxis, TicksLieWithin) {
  for (const std::vector<double>& values : {std::vector<double>{1, 2},
                                            {0, 0},
                                            {-5, 5},
                                            {1e-9, 1},
                                            {5, 5},
                                            {1e300, -1e300},
                                            {1e-300},
                                            {},
                                            {std::nan("")},
                                            {26390, 26391},
                                            {0.001, 1e12}}) {
    const Axis axis = Axis::around(values, 10, 410);
    for (const double value : values) {
      if (std::isfinite(value)) {
        EXPECT_GE(axis(value), 10);
        EXPECT_LE(axis(value), 410);
      }
    }
    std::vector<string> labels;
    for (const Axis::Tick& tick : axis.ticks()) {
      EXPECT_GE(tick.value, axis.low());
      EXPECT_LE(tick.value, axis.high());
      if (!tick.label.empty()) {
        EXPECT_EQ(std::count(labels.begin(), labels.end(), tick.label), 0) << tick.label;
        labels.push_back(tick.label);
      }
    }
  }
  EXPECT_TRUE(Axis::around({1, 31}, 0, 1).logarithmic());
  EXPECT_FALSE(Axis::around({1, 30}, 0, 1).logarithmic());
  EXPECT_FALSE(Axis::around({0, 1000}, 0, 1).logarithmic());
}

TEST(ReportText, PacksAsZlib) {
  EXPECT_EQ(packed("aaaa").substr(0, 3), "eNp");  // 78 da: deflate, the best compression
}
}  // namespace
}  // namespace altiplan::study::report::report_text_test
