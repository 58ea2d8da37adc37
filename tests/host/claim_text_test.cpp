// SPDX-License-Identifier: Apache-2.0
#include "study/claims/claim_text.hpp"

#include <gtest/gtest.h>

#include "study/claims/claim_pairs.hpp"
#include "study/claims/claims.hpp"

namespace altiplan::host::claim_text_test {
using namespace study;
namespace {

const std::vector<std::string> kPipelines{"astar", "fusion[weight_g=0.3]", "fusion[weight_g=0.7]",
                                          "jps[corner=any]"};

/// What is said against `that`; "" where nothing is.
std::string against(const std::string& that, const std::string& is = "<= 1") {
  const std::vector<Problem> problems =
      check_claim({"shorter", that, is, 0.95}, kPipelines, {"s.yaml", 7, 3, ""},
                  {"s.yaml", 8, 3, ""}, "claims.0");
  return problems.empty() ? "" : problems.front().message;
}

TEST(ClaimText, IsRead) {
  for (const char* that :
       {"median(astar.length_m)", " mean ( astar . length_m )", "p05(astar.steps.route.time_s)",
        "p99(-(astar.length_m + 1) * 2.5e-3 / jps.length_m)", "share(astar.solved)",
        "share(astar.steps.route.accepted and jps.steps.x.budget_hit)",
        "share(astar.length_m <= 1.05 * fusion[weight_g=0.3].length_m)",
        "share(astar.solved and (jps.flight.reached or jps[corner=any].expanded > 3))",
        "max(astar.flight.collisions)", "min(astar.length_m - jps.length_m)"}) {
    EXPECT_EQ(against(that), that[0] == ' ' ? against(that) : "") << that;
  }
}

TEST(ClaimText, ValuesAreNamedOnce) {
  const ClaimQuantity quantity = read_quantity(
      "p90(astar.length_m / fusion[weight_g=0.7].length_m + astar.length_m)", kPipelines);
  EXPECT_EQ(quantity.function, ClaimQuantity::Function::quantile);
  EXPECT_DOUBLE_EQ(quantity.q, 0.9);
  EXPECT_EQ(quantity.values, (std::vector<ClaimValue>{{0, "length_m"}, {2, "length_m"}}));
  EXPECT_EQ(read_quantity("mean(jps.x)", kPipelines).values.front().pipeline, 3U);
}

TEST(ClaimText, WhatIsExpectedIsSaidWithItsPlace) {
  EXPECT_EQ(against("median(astar.length_m"),
            "at character 22: expected an operator or ')', found the end");
  EXPECT_EQ(against("median(astar.length_m) + 1"),
            "at character 24: expected nothing after the function's ')', found '+ 1'");
  EXPECT_EQ(against("median astar.length_m"),
            "at character 8: expected '(' after median, found 'astar.length_m'");
  EXPECT_EQ(against("median(astar.length_m / )"),
            "at character 25: expected a number, '(' or PIPELINE.value, found ')'");
  EXPECT_EQ(against("median(astar)"),
            "at character 13: expected '.' and a value's name after the pipeline (as in "
            "astar.length_m), found ')'");
  EXPECT_EQ(against("median(astar.)"), "at character 14: expected a value's name, found ')'");
  EXPECT_EQ(against("median(1 + 2)"),
            "at character 8: expected a PIPELINE.value somewhere, found numbers only");
  EXPECT_EQ(against("median(1e999 * astar.length_m)"),
            "at character 8: expected a number, '(' or PIPELINE.value, found '1e999 * "
            "astar.length_m)'");
  EXPECT_EQ(against(""),
            "at character 1: expected median(, mean(, min(, max(, share( or one of p01( to p99(, "
            "found the end");
}

TEST(ClaimText, UnknownNamesGetTheNearest) {
  EXPECT_EQ(against("medain(astar.length_m)"),
            "at character 1: expected median(, mean(, min(, max(, share( or one of p01( to p99(, "
            "found 'medain(astar.length_m)'; did you mean 'median'?");
  EXPECT_EQ(against("p00(astar.length_m)").substr(0, 34), "at character 1: expected median(, ");
  EXPECT_EQ(against("median(asta.length_m)"),
            "at character 8: no pipeline is named 'asta'; did you mean 'astar'?");
  EXPECT_EQ(against("median(Astar.length_m)"),
            "at character 8: no pipeline is named 'Astar'; did you mean 'astar'?");
}

TEST(ClaimText, AnIdOfSeveralVariantsNeedsItsBracket) {
  EXPECT_EQ(against("median(fusion.length_m)"),
            "at character 8: 'fusion' stands for 2 variants; expected one of "
            "fusion[weight_g=0.3], fusion[weight_g=0.7]");
  EXPECT_EQ(against("median(fusion[weight_g=0.5].length_m)"),
            "at character 8: no variant is named 'fusion[weight_g=0.5]'; expected one of "
            "fusion[weight_g=0.3], fusion[weight_g=0.7]");
  EXPECT_EQ(against("median(fusion[weight_g=0.3.length_m)"),
            "at character 14: the '[' is not closed");
  EXPECT_EQ(against("median(jps.length_m)"), "");  // the only one
  const std::vector<std::string> nested{"a[on=[1]]", "a[on=[1]].b]"};
  EXPECT_EQ(read_quantity("mean(a[on=[1]].b].c)", nested).values,
            (std::vector<ClaimValue>{{1, "c"}}));
  const std::vector<std::string> turned{nested[1], nested[0]};
  EXPECT_EQ(read_quantity("mean(a[on=[1]].b].c)", turned).values,
            (std::vector<ClaimValue>{{0, "c"}}));
  EXPECT_EQ(read_quantity("mean(a[on=[1]].c)", nested).values, (std::vector<ClaimValue>{{0, "c"}}));
}

TEST(ClaimText, ComparisonsAreForShare) {
  EXPECT_EQ(against("median(astar.length_m < 3)"),
            "at character 8: a comparison is for share(); the other functions take a number");
  EXPECT_EQ(against("share(astar.length_m)").substr(0, 40),
            "at character 7: expected a comparison (s");
  EXPECT_EQ(against("share(astar.steps.route.length_m)").substr(0, 40),
            "at character 7: expected a comparison (s");
  EXPECT_EQ(against("share(astar.solved and astar.length_m)").substr(0, 41),
            "at character 24: expected a comparison (s");
  EXPECT_EQ(against("share(1 + (astar.length_m < 3) < 2)"),
            "at character 12: expected a number, found a comparison");
  EXPECT_EQ(against("share(1 < astar.length_m < 3)"),
            "at character 26: expected an operator or ')', found '< 3)'");
  EXPECT_EQ(against("share(-(astar.length_m < 3) < 2)"),
            "at character 9: expected a number, found a comparison");
}

TEST(ClaimText, IsBounded) {
  const std::string deep(90, '(');
  EXPECT_EQ(against("median(" + deep + "astar.length_m" + std::string(90, ')') + ")"), "");
  EXPECT_EQ(against("median(" + std::string(3000, '(')),
            "at character 108: nested deeper than 100");
  EXPECT_EQ(against("median(" + std::string(3000, '-')),
            "at character 108: nested deeper than 100");
  EXPECT_EQ(against("median(" + std::string(5000, ' ')),
            "at character 4001: longer than 4000 characters");
  std::string chain = "median(astar.length_m";
  while (chain.size() < 3990) {
    chain += "+1";
  }
  EXPECT_EQ(against(chain + ")"), "");
}

TEST(ClaimText, AnyTextIsReadOrRefused) {
  const std::vector<std::string> parts{"share(", "median(", "(",  ")",   "-", "+",  "*",    "/",
                                       "<=",     "==",      ".5", "2",   ".", "..", "and",  "or",
                                       "astar",  ".solved", "[",  "jps", "]", " ",  "\xff", "1e9"};
  RandomStream stream(2);
  int read = 0;
  int refused = 0;
  for (int i = 0; i < 20'000; ++i) {
    std::string text = i % 2 == 0 ? "share(astar.solved" : "";
    for (std::int64_t n = stream.integer(0, 8); n > 0; --n) {
      text += parts[std::size_t(stream.integer(0, std::int64_t(parts.size()) - 1))];
    }
    for (const std::string& said : {against(text), against("median(astar.length_m)", text)}) {
      ++(said.empty() ? read : refused);
      EXPECT_TRUE(said.empty() || said.starts_with("at character ")) << text << ": " << said;
    }
  }
  EXPECT_GT(refused, 10'000);
  EXPECT_GT(read, 50);
}

TEST(ClaimText, Ranges) {
  EXPECT_TRUE(read_range("<= 0.95").contains(0.95));
  EXPECT_FALSE(read_range("<0.95").contains(0.95));
  EXPECT_TRUE(read_range(">= -1").contains(-1));
  EXPECT_FALSE(read_range("> -1").contains(-1));
  EXPECT_TRUE(read_range("== 0").contains(0));
  EXPECT_FALSE(read_range("== 0").contains(1e-300));
  const ClaimRange range = read_range(" 0.9..1.1 ");
  EXPECT_TRUE(range.contains(0.9) && range.contains(1.1) && !range.contains(1.2));
  EXPECT_EQ(read_range("-1 .. 2").low, -1);
  EXPECT_TRUE(range.meets(1.1, 2));
  EXPECT_FALSE(range.meets(1.2, 2));
  EXPECT_FALSE(read_range("< 1").meets(1, 2));
  EXPECT_TRUE(read_range("<= 1").meets(1, 2));
  EXPECT_FALSE(read_range("> 1").meets(0, 1));
  EXPECT_TRUE(read_range(">= 1").meets(0, 1));
}

TEST(ClaimText, ObjectivesNameValuesAlone) {
  const ClaimQuantity read = read_objective("2 * length_m - steps.route.counters.expanded / 4");
  ASSERT_EQ(read.values.size(), 2U);
  EXPECT_EQ(read.values[0].name, "length_m");
  EXPECT_EQ(read.values[1].name, "steps.route.counters.expanded");
  EXPECT_EQ(evaluate(read.expression, {10, 8}), 18);
  EXPECT_EQ(read_objective("(length_m)").values.size(), 1U);
  for (const char* text : {"", "3", "length_m <= 4", "length_m +", "length_m.", ".x", "length_m x",
                           "median(length_m)"}) {
    EXPECT_THROW(read_objective(text), Error) << text;
  }
}

TEST(ClaimText, RangesThatCannotBeRead) {
  const auto said = [](const char* is) { return against("median(astar.length_m)", is); };
  EXPECT_EQ(said("0.95"),
            "at character 5: expected '..' and a number (as in 0.9..1.1), or <=, <, >=, > or == "
            "before the first, found the end");
  EXPECT_EQ(said("less than 1"),
            "at character 1: expected <=, <, >=, > or == before a number, or FROM..TO, found "
            "'less than 1'");
  EXPECT_EQ(said("<= "), "at character 4: expected a number, found the end");
  EXPECT_EQ(said("<= nan"), "at character 4: expected a number, found 'nan'");
  EXPECT_EQ(said("<= 5 %"), "at character 6: expected nothing after the comparison, found '%'");
  EXPECT_EQ(said("2..1"), "at character 1: expected FROM..TO with FROM at most TO, found '2..1'");
  EXPECT_EQ(said("=< 1").substr(0, 30), "at character 1: expected <=, <");
}

TEST(ClaimText, BothTextsAreChecked) {
  const auto problems = check_claim({"x", "median(", "<", 0.95}, kPipelines, {"s.yaml", 7, 9, ""},
                                    {"s.yaml", 8, 9, ""}, "claims.2");
  ASSERT_EQ(problems.size(), 2U);
  EXPECT_EQ(problems[0].key, "claims.2.that");
  EXPECT_EQ(problems[0].where.line, 7);
  EXPECT_EQ(problems[1].key, "claims.2.is");
  EXPECT_EQ(problems[1].where.line, 8);
}

}  // namespace
}  // namespace altiplan::host::claim_text_test
