// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "claim_study.hpp"

namespace altiplan::host::claims_test {
using namespace study;
namespace {

TEST(Claims, TheWholeIntervalDecides) {
  const Study study(40, 1, 0.9);
  const std::string that = "median(b.length_m / a.length_m)";
  const JudgedClaim holds = study.judge(that, "<= 0.95");
  EXPECT_EQ(holds.verdict, Verdict::holds) << holds.words;
  EXPECT_NEAR(holds.estimate, 0.9, 0.009);
  ASSERT_TRUE(holds.interval);
  EXPECT_LT(holds.interval->low, holds.estimate);
  EXPECT_GT(holds.interval->high, holds.estimate);
  EXPECT_EQ(holds.method, "order statistics, 40 pairs");
  EXPECT_EQ(holds.used, 40U);
  EXPECT_EQ(holds.pairs, 40U);
  EXPECT_FALSE(holds.measured);
  EXPECT_EQ(study.judge(that, "> 0.95").verdict, Verdict::fails);
  EXPECT_EQ(study.judge(that, "0.85..0.95").verdict, Verdict::holds);
  EXPECT_EQ(study.judge(that, "0.5..0.6").verdict, Verdict::fails);
  EXPECT_EQ(study.judge(that, "== 0.9").verdict, Verdict::undecided);
  const JudgedClaim undecided = study.judge(that, "<= " + std::to_string(holds.estimate));
  EXPECT_EQ(undecided.verdict, Verdict::undecided) << undecided.words;
}

TEST(Claims, AreSaidInWords) {
  Study study(7, 1, 0.5);
  for (RunRow& row : study.data().rows) {
    row.values[2] = row.pipeline == 0 ? 100 : 50;
  }
  study.fail(3, 1);
  const JudgedClaim holds = study.judge("median(b.length_m / a.length_m)", "<= 0.95");
  EXPECT_EQ(holds.words,
            "Holds: median(b.length_m / a.length_m) is 0.5, 95 % interval 0.5 to 0.5 (order "
            "statistics, 6 pairs); all of it is <= 0.95. 6 of 7 pairs counted; b.length_m has no "
            "number in "
            "1.");
  EXPECT_EQ(holds.reasons,
            "Found: 0.5, 95 % interval 0.5 to 0.5 (order statistics, 6 pairs); all of it is <= "
            "0.95. 6 of 7 pairs counted; b.length_m has no number in 1.");
  EXPECT_EQ(study.judge("max(b.length_m / a.length_m)", "> 0.6").words,
            "Fails: max(b.length_m / a.length_m) is 0.5, which is not > 0.6 (an extreme: of these "
            "runs only, without an interval). 6 of 7 pairs counted; b.length_m has no number in "
            "1.");
  study.fail(2, 1);
  study.fail(5, 1);
  EXPECT_EQ(study.judge("share(b.solved)", ">= 0.5").words,
            "Undecided: share(b.solved) is 0.5714, 95 % interval 0.2505 to 0.8418 (Wilson, 7 "
            "pairs); the estimate is >= 0.5, but part of the interval is not. 7 of 7 pairs "
            "counted.");
  EXPECT_EQ(study.judge("share(b.solved)", "0.6..1").reasons,
            "Found: 0.5714, 95 % interval 0.2505 to 0.8418 (Wilson, 7 pairs); the estimate is not "
            "within 0.6..1, but part of the interval is. 7 of 7 pairs counted.");
  EXPECT_EQ(study.judge("share(b.solved)", "0.97..1").words,
            "Fails: share(b.solved) is 0.5714, 95 % interval 0.2505 to 0.8418 (Wilson, 7 pairs); "
            "none of it is within 0.97..1. 7 of 7 pairs counted.");
  // Something over zero is infinite, of which there is no interval.
  EXPECT_EQ(
      study.judge("mean(a.length_m / (b.length_m - 50))", ">= 1").words,
      "Undecided: mean(a.length_m / (b.length_m - 50)) is inf, claimed was >= 1; no "
      "interval, too many values are infinite. 4 of 7 pairs counted; b.length_m has no number "
      "in 3.");
}

TEST(Claims, RoundingDoesNotHideTheSide) {
  Study study(3, 1, 1);
  for (RunRow& row : study.data().rows) {
    row.values[2] = 0.95004;
  }
  EXPECT_EQ(study.judge("max(a.length_m)", "<= 0.95").words.substr(0, 64),
            "Fails: max(a.length_m) is 0.95004, which is not <= 0.95 (an extr");
  for (RunRow& row : study.data().rows) {
    row.values[2] = 123456.7;
  }
  EXPECT_EQ(study.judge("max(a.length_m)", ">= 3").words.substr(0, 41),
            "Holds: max(a.length_m) is 123457, which i");
}

TEST(Claims, ASingleShareHasWilsonsInterval) {
  Study study(20, 1, 1);
  for (const std::size_t s : {2U, 7U, 11U}) {
    study.fail(s, 1);
  }
  const JudgedClaim solved = study.judge("share(b.solved)", ">= 0.5");
  const auto expected = wilson(17, 20, 0.95);
  ASSERT_TRUE(solved.interval);
  EXPECT_EQ(solved.interval->low, expected->low);
  EXPECT_EQ(solved.interval->high, expected->high);
  EXPECT_EQ(solved.used, 20U);
  EXPECT_EQ(solved.verdict, Verdict::holds);
  // Both solved in 17 pairs, which are all that can be compared.
  const JudgedClaim shorter = study.judge("share(b.length_m <= 2 * a.length_m)", ">= 0.5");
  EXPECT_EQ(shorter.used, 17U);
  EXPECT_EQ(shorter.interval->low, wilson(17, 17, 0.95)->low);
}

TEST(Claims, RepetitionsOfAScenarioStayTogether) {
  Study study(10, 3, 1);
  for (int r = 0; r < 3; ++r) {
    study.row(4, 1, r).outcome = "no_route";
  }
  study.row(5, 1, 0).outcome = "no_route";
  const JudgedClaim solved = study.judge("share(b.solved)", ">= 0.5");
  EXPECT_EQ(solved.method, "Wilson, 10 scenarios");
  EXPECT_NEAR(solved.estimate, 26.0 / 30, 1e-15);
  // As if each pair stood for itself, the interval would be narrower.
  const auto independent = wilson(26, 30, 0.95);
  EXPECT_LT(solved.interval->low, independent->low);
}

TEST(Claims, AUnanimousShareIsNotCertain) {
  const Study study(3, 5, 1);
  const JudgedClaim solved = study.judge("share(b.solved)", ">= 0.99");
  EXPECT_EQ(solved.method, "Wilson, 3 scenarios");
  EXPECT_EQ(solved.verdict, Verdict::undecided);
  const Study one(1, 200, 1);
  EXPECT_EQ(one.judge("share(b.solved)", ">= 0.9").method, "Wilson, 200 pairs");
  EXPECT_EQ(one.judge("share(b.solved)", ">= 0.9").verdict, Verdict::holds);
  EXPECT_EQ(one.judge("median(b.length_m)", ">= 0.9").method, "order statistics, 200 pairs");
}

TEST(Claims, TooFewScenariosGiveNoInterval) {
  const Study five(5, 4, 0.5);
  const JudgedClaim judged = five.judge("median(b.length_m / a.length_m)", "<= 0.95");
  EXPECT_EQ(judged.verdict, Verdict::undecided);
  EXPECT_FALSE(judged.interval);
  EXPECT_TRUE(judged.words.starts_with("Undecided: median(b.length_m / a.length_m) is 0.5"));
  EXPECT_TRUE(
      judged.words.ends_with(", claimed was <= 0.95; no interval. 20 of "
                             "20 pairs counted."))
      << judged.words;
  const Study six(6, 4, 0.5);
  EXPECT_EQ(six.judge("median(b.length_m / a.length_m)", "<= 0.95").verdict, Verdict::holds);
  const ClaimEntry surer{"surer", "median(b.length_m / a.length_m)", "<= 0.95", 0.99};
  Study seven(7, 1, 0.5);
  EXPECT_EQ(judge_claim(seven.data(), surer).why_no_interval,
            "too few scenarios: at least 8 for 99 %");
}

TEST(Claims, SharesOfOneStudyHaveOneInterval) {
  Study study(10, 3, 1);
  study.row(4, 1, 1).outcome = "no_route";
  const JudgedClaim one = judge_claim(study.data(), {"one", "share(b.solved)", ">= 0.5", 0.95});
  const JudgedClaim other = judge_claim(study.data(), {"other", "share(b.solved)", "< 1", 0.95});
  EXPECT_EQ(one.method, "Wilson, 10 scenarios");
  EXPECT_EQ(one.interval->low, other.interval->low);
  EXPECT_EQ(one.interval->high, other.interval->high);
}

TEST(Claims, OnePairGivesNoInterval) {
  const Study study(1, 1, 0.5);
  const JudgedClaim judged = study.judge("median(b.length_m / a.length_m)", "<= 0.95");
  EXPECT_EQ(judged.verdict, Verdict::undecided);
  EXPECT_FALSE(judged.interval);
  EXPECT_EQ(judged.words,
            "Undecided: median(b.length_m / a.length_m) is 0.5, claimed was <= 0.95; no "
            "interval. 1 of 1 pair counted.");
  EXPECT_EQ(judged.why_no_interval, "too few repetitions: at least 6 for 95 %");
  EXPECT_EQ(study.judge("max(b.length_m / a.length_m)", "<= 0.95").verdict, Verdict::holds);
}

TEST(Claims, ValuesOfRunsThatDidNotSolve) {
  Study study(4, 1, 1);
  study.row(0, 1).outcome = "collided";  // with its length and its collisions
  study.row(0, 1).values = {10, 2, 1, 500, 0.1};
  EXPECT_EQ(study.judge("min(b.length_m)", ">= 90").verdict, Verdict::holds);
  EXPECT_EQ(study.judge("min(b.length_m)", ">= 90").used, 3U);
  EXPECT_EQ(study.judge("max(b.flight.collisions)", "<= 0").estimate, 2);
  const JudgedClaim memory = study.judge("max(b.peak_memory_mb)", "<= 100");
  EXPECT_EQ(memory.estimate, 500);
  EXPECT_TRUE(memory.measured);
  EXPECT_TRUE(study.judge("max(b.plan_time_s)", "<= 100").measured);
}

TEST(Claims, ARunThatDidNotSolveFailsWhatStartsWithSolved) {
  Study study(20, 1, 1);
  study.fail(3, 1);
  study.fail(5, 0);
  const JudgedClaim judged =
      study.judge("share(b.solved and b.length_m <= 2 * a.length_m)", ">= 0.5");
  EXPECT_EQ(judged.used, 19U);  // a's length is missing in one
  EXPECT_NEAR(judged.estimate, 18.0 / 19, 1e-15);
  // No guard below an `or`: it would count such pairs by what the other side happens to be.
  EXPECT_EQ(study.judge("share(b.solved or b.length_m < 5)", ">= 0").used, 19U);
  // Nor for a run that solved and still lacks the value.
  study.row(7, 1).values[2] = kNone;
  EXPECT_EQ(study.judge("share(b.solved and b.length_m < 5)", ">= 0").used, 19U);
}

TEST(Claims, ZeroOverZeroDoesNotCount) {
  Study study(5, 1, 1);
  study.row(0, 0).values[0] = 0;
  study.row(0, 1).values[0] = 0;
  for (const char* that :
       {"median(b.expanded / a.expanded)", "share(b.expanded / a.expanded < 2)"}) {
    const JudgedClaim judged = study.judge(that, ">= 0");
    EXPECT_EQ(judged.used, 4U);
    EXPECT_TRUE(judged.words.ends_with(
        "4 of 5 pairs counted; the expression is not a number in 1 (such as 0 / 0)."))
        << judged.words;
  }
}

TEST(Claims, ValuesThatNoRunHas) {
  Study study(2, 1, 1);
  const JudgedClaim judged = study.judge("median(b.lenght_m)", "<= 1");
  EXPECT_EQ(judged.verdict, Verdict::no_data);
  EXPECT_TRUE(std::isnan(judged.estimate));
  EXPECT_EQ(
      judged.words,
      "No data: no run has a value 'lenght_m'; did you mean 'length_m'? 0 of 2 pairs counted; "
      "b.lenght_m has no number in 2.");
  study.fail(0, 0);
  study.fail(1, 1);
  EXPECT_EQ(study.judge("median(b.length_m / a.length_m)", "<= 1").words,
            "No data: no pair has all named values. 0 of 2 pairs counted; b.length_m has no number "
            "in 1, a.length_m has no number in 1.");
  EXPECT_EQ(study.judge("median(b.lenght_m)", "<= 1").reasons.substr(0, 50),
            "No run has a value 'lenght_m'; did you mean 'lengt");
  EXPECT_EQ(study.judge("share(c.solved)", "<= 1").words,
            "No data: the claim cannot be read: at character 7: no pipeline is named 'c'; "
            "did you mean 'a'?");
  study.data().rows.clear();
  EXPECT_EQ(study.judge("share(a.solved)", "<= 1").words, "No data: the study has no runs yet.");
}

TEST(Claims, ValuesThatOnlyAnotherPipelineHas) {
  Study study(2, 1, 1);
  study.data().columns.emplace_back("steps.route.length_m");
  study.data().columns.emplace_back("steps.rout.length_m");
  for (RunRow& row : study.data().rows) {
    row.values.push_back(row.pipeline == 0 ? 1 : kNone);
    row.values.push_back(row.pipeline == 1 ? 1 : kNone);
  }
  EXPECT_EQ(study.judge("median(b.steps.route.length_m)", "<= 1").words,
            "No data: no run of 'b' has a value 'steps.route.length_m'; did you mean "
            "'steps.rout.length_m'? 0 of 2 pairs counted; b.steps.route.length_m has no number in "
            "2.");
}

TEST(Claims, ARunThatIsNotThereIsNoFailure) {
  Study study(5, 1, 1);
  study.data().rows.erase(study.data().rows.begin() + 1);  // b of the first scenario
  const JudgedClaim judged = study.judge("share(b.solved)", ">= 0");
  EXPECT_EQ(judged.used, 4U);
  EXPECT_EQ(judged.pairs, 5U);
  EXPECT_EQ(judged.estimate, 1);
}

TEST(Claims, PercentilesNeedRunsBeyondThem) {
  const Study few(71, 1, 0.9);
  const JudgedClaim undecided = few.judge("p95(b.length_m / a.length_m)", "<= 5");
  EXPECT_EQ(undecided.verdict, Verdict::undecided) << undecided.words;
  EXPECT_EQ(undecided.why_no_interval, "too few scenarios: at least 72 for 95 %");
  EXPECT_TRUE(undecided.has_too_few);
  EXPECT_EQ(Study(72, 1, 0.9).judge("p95(b.length_m / a.length_m)", "<= 5").verdict,
            Verdict::holds);
  EXPECT_EQ(Study(71, 9, 0.9).judge("p95(b.length_m / a.length_m)", "<= 5").verdict,
            Verdict::undecided)
      << "repetitions are no scenarios";
  EXPECT_EQ(few.judge("p99(a.length_m)", "<= 1000").why_no_interval,
            "too few scenarios: at least 368 for 95 %");
}

TEST(Claims, NoDifferenceOfSuccessIsNoCertainty) {
  Study study(20, 1, 1);
  const JudgedClaim none = study.judge("mean(a.solved - b.solved)", "<= 0.05");
  EXPECT_EQ(none.estimate, 0);
  EXPECT_EQ(none.method, "Tango, 20 pairs");
  EXPECT_EQ(none.verdict, Verdict::undecided) << none.words;
  EXPECT_EQ(study.judge("mean(a.solved - b.solved)", "<= 0.17").verdict, Verdict::holds);
  for (const std::size_t s : {1U, 2U, 3U, 4U, 5U, 6U, 7U, 8U}) {
    study.fail(s, 1);
  }
  const JudgedClaim some = study.judge("mean(a.solved - b.solved)", "> 0");
  EXPECT_EQ(some.interval->low, tango(8, 0, 20, 0.95)->low);
  EXPECT_EQ(some.verdict, Verdict::holds);
  EXPECT_EQ(study.judge("mean(b.solved - a.solved)", "< 0").verdict, Verdict::holds);
  const JudgedClaim share = study.judge("mean(b.solved)", ">= 0.3");
  EXPECT_EQ(share.interval->low, wilson(12, 20, 0.95)->low);
}

TEST(Claims, AClearMeanOfTenScenariosStaysDecidedAmongSeveral) {
  Study ten(10, 1, 0.9);
  const std::string ratio = "mean(b.length_m / a.length_m)";
  ten.data().file.claims = {{"shorter", ratio, "<= 0.95", 0.95},
                            {"not by half", ratio, ">= 0.5", 0.95},
                            {"near", ratio, "0.85..0.95", 0.95}};
  for (const JudgedClaim& judged : judge_claims(ten.data())) {
    EXPECT_EQ(judged.verdict, Verdict::holds) << judged.words;
    EXPECT_LT(judged.p, 0.001) << judged.claim.id;
    EXPECT_FALSE(becomes_undecided(judged)) << judged.claim.id;
  }
  const ClaimEntry surer{"surer", ratio, "<= 0.95", 0.99};
  const JudgedClaim few = judge_claim(ten.data(), surer);
  EXPECT_EQ(few.why_no_interval, "too few scenarios: at least 12 for 99 %");
  EXPECT_TRUE(std::isnan(few.p)) << "not a test, and none of several";
}

TEST(Claims, AMeanWithoutVariationIsUndecided) {
  const Study study(30, 1, 1);
  const JudgedClaim judged = study.judge("mean(a.flight.collisions)", "<= 0.01");
  EXPECT_EQ(judged.estimate, 0);
  EXPECT_EQ(judged.verdict, Verdict::undecided) << "a collision in 50 flights may be missed";
  EXPECT_TRUE(judged.words.ends_with(
      "claimed was <= 0.01; no interval, all values are equal. 30 of 30 pairs counted."))
      << judged.words;
  EXPECT_FALSE(judged.has_too_few);
}
}  // namespace
}  // namespace altiplan::host::claims_test
