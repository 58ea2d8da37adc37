// SPDX-License-Identifier: Apache-2.0
// Figures as the documentation prints them: read, printed again from other runs, and compared.
#include "study/reproduce/figure_text.hpp"

#include <gtest/gtest.h>

namespace altiplan::study::figure_text_test {
namespace {

JudgedClaim found(double estimate, std::optional<Interval> interval = std::nullopt,
                  std::size_t used = 0, std::size_t pairs = 0) {
  JudgedClaim claim;
  claim.estimate = estimate;
  claim.interval = interval;
  claim.used = used;
  claim.pairs = pairs;
  return claim;
}

std::string printed(const std::string& like, const JudgedClaim& claim, bool is_share = false) {
  const auto figure = read_figure(like);
  return figure ? figure->of(claim, is_share) : "cannot be read";
}

TEST(FigureText, IsPrintedAsItWasRead) {
  EXPECT_EQ(printed("1,231", found(1230.6)), "1,231");
  EXPECT_EQ(printed("1231", found(1230.6)), "1,231");
  EXPECT_EQ(printed("0.45", found(0.4449)), "0.44");
  EXPECT_EQ(printed("-0.2", found(-0.04)), "0.0");
  EXPECT_EQ(printed("92.6 %", found(0.9264)), "92.6 %");
  EXPECT_EQ(printed("0.674 [0.63, 0.7]", found(0.67449, Interval{0.631, 0.72})),
            "0.674 [0.63, 0.7]");
  EXPECT_EQ(printed("57 % [49, 64]", found(0.568, Interval{0.491, 0.642})), "57 % [49, 64]");
  EXPECT_EQ(printed("1,785 [1,758, 1,814]", found(1785.2, Interval{1757.6, 1814.4})),
            "1,785 [1,758, 1,814]");
  EXPECT_EQ(printed("0.674 [0.63, 0.7]", found(0.67449)), "0.674 [–, –]");
  EXPECT_EQ(printed("0.45", found(kNone)), "–");
}

TEST(FigureText, CountsAreOfSharesOrOfPairsWithTheValue) {
  EXPECT_EQ(printed("54/100", found(0.55, std::nullopt, 20, 25), true), "11/20");
  EXPECT_EQ(printed("19/100", found(4, std::nullopt, 3, 25)), "3/25");
  EXPECT_EQ(printed("0/10", found(kNone, std::nullopt, 0, 25)), "0/25");
}

TEST(FigureText, RefusesWhatIsNoFigure) {
  for (const char* text :
       {"",      "x",     "12a",     "1,23",      "12,34.5", "1.2.3", "--1", "5 %%",
        "5%",    "1 [2]", "1 [2, 3", "1 [2, 3]]", "3/",      "/3",    "4/3", "1/0",
        "1.5/3", "-1/3",  "1/3 %",   "nan",       "inf",     "1e3",   " 1",  "1 "}) {
    EXPECT_FALSE(read_figure(text)) << text;
  }
}

TEST(FigureText, LiesInARangeThatHoldsANumberPrintedSo) {
  const auto is_within = [](const char* text, double low, double high) {
    return read_figure(text)->is_within({low, high});
  };
  EXPECT_TRUE(is_within("1.53", 1.5349, 1.6)) << "1.5349 is printed as 1.53";
  EXPECT_FALSE(is_within("1.53", 1.5351, 1.6));
  EXPECT_TRUE(is_within("1.53", 1.2, 1.5251));
  EXPECT_FALSE(is_within("1.53", 1.2, 1.5249));
  EXPECT_TRUE(is_within("92.6 %", 0.9264, 1));
  EXPECT_FALSE(is_within("92.6 %", 0.9266, 1));
  EXPECT_TRUE(is_within("54/100", 0.54, 0.6));
  EXPECT_FALSE(is_within("54/100", 0.541, 0.6));
}

TEST(FigureText, RangesHaveADigitMore) {
  EXPECT_EQ(read_figure("0.45")->range({0.4, 0.51249}), "0.400 to 0.512");
  EXPECT_EQ(read_figure("92 %")->range({0.8, 1}), "80.0 to 100.0 %");
  EXPECT_EQ(read_figure("54/100")->range({0.3, 0.7}), "30.0 to 70.0 %");
  EXPECT_EQ(read_figure("5")->range({5, kInfinity}), "at least 5.0");
  EXPECT_EQ(read_figure("5")->range({-kInfinity, 5}), "at most 5.0");
}
}  // namespace
}  // namespace altiplan::study::figure_text_test
