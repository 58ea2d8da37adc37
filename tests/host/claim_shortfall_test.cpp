// SPDX-License-Identifier: Apache-2.0
// What too few runs keep from a claim, against all that such runs could give.
#include "claim_study.hpp"

namespace altiplan::study::claim_shortfall_test {
namespace {

class Shortfall : public ::testing::Test {
 protected:
  static std::string of(const std::string& that, const std::string& is,
                        const std::vector<std::size_t>& groups) {
    return shortfall({"claim", that, is, 0.95}, read_quantity(that, {"a", "b"}), groups);
  }
  static std::vector<std::size_t> groups_of(std::size_t scenarios, std::size_t repetitions) {
    std::vector<std::size_t> groups;
    for (std::size_t pair = 0; pair < scenarios * repetitions; ++pair) {
      groups.push_back(pair / repetitions);
    }
    return groups;
  }

  struct Verdicts {
    bool hold = false;
    bool fail = false;
  };
  /// The verdicts on share(a.solved) over all numbers of scenarios that solve none, some or all of
  /// their repetitions.
  static Verdicts possible(std::size_t scenarios, std::size_t repetitions, const std::string& is) {
    Verdicts all;
    const std::size_t some_of = repetitions == 1 ? 0 : scenarios;
    for (std::size_t none = 0; none <= scenarios; ++none) {
      for (std::size_t some = 0; none + some <= scenarios && some <= some_of; ++some) {
        Study study(int(scenarios), int(repetitions), 0.5);
        for (std::size_t s = 0; s < none + some; ++s) {
          for (std::size_t r = 0; r < (s < none ? repetitions : 1); ++r) {
            study.row(s, 0, int(r)).outcome = "timed_out";
          }
        }
        const Verdict verdict = study.judge("share(a.solved)", is).verdict;
        all.hold = all.hold || verdict == Verdict::holds;
        all.fail = all.fail || verdict == Verdict::fails;
      }
    }
    return all;
  }
  /// The number that a sentence asks for.
  static std::size_t number_in(const std::string& sentence) {
    const std::size_t colon = sentence.rfind(": ");
    return std::stoul(sentence.substr(sentence.find_first_of("0123456789", colon)));
  }
};

TEST_F(Shortfall, OfIndependentPairsIsWhatNoRunsCouldGive) {
  for (const std::string is :
       {">= 0.5", ">= 0.8", "< 0.3", "0.2..0.5", "0.05..0.95", "== 0", "> 0", "<= 1"}) {
    for (std::size_t scenarios = 1; scenarios <= 14; ++scenarios) {
      SCOPED_TRACE(is + " of " + std::to_string(scenarios));
      const std::string found = of("share(a.solved)", is, groups_of(scenarios, 1));
      const Verdicts can = possible(scenarios, 1, is);
      EXPECT_EQ(found.empty(), can.hold) << found;
      EXPECT_EQ(found.starts_with("will be undecided: "), !can.hold && !can.fail) << found;
      if (found.starts_with("will")) {
        const Verdicts then = possible(number_in(found), 1, is);
        EXPECT_TRUE(then.hold || then.fail) << found;
      } else if (found.ends_with(" would do for 95 %")) {
        EXPECT_TRUE(possible(number_in(found), 1, is).hold) << found;
        EXPECT_FALSE(possible(number_in(found) - 1, 1, is).hold) << found;
      }
    }
  }
}

TEST_F(Shortfall, OfRepetitionsIsWhatNoRunsCouldDecide) {
  for (const std::string is : {">= 0.5", ">= 0.9", "0.4..0.6", "0.1..0.2", "== 0.5"}) {
    for (std::size_t scenarios = 2; scenarios <= 7; ++scenarios) {
      SCOPED_TRACE(is + " of " + std::to_string(scenarios));
      const std::string found = of("share(a.solved)", is, groups_of(scenarios, 2));
      const Verdicts can = possible(scenarios, 2, is);
      if (!found.empty()) {
        EXPECT_FALSE(can.hold || can.fail) << found;
        EXPECT_LT(scenarios, number_in(found)) << found;
      } else {  // as many independent pairs could decide it
        const Verdicts independent = possible(2 * scenarios, 1, is);
        EXPECT_TRUE(can.hold || independent.hold || independent.fail);
      }
    }
  }
}

TEST_F(Shortfall, OfNumbersIsThatOfTheirQuantile) {
  const std::pair<std::string, std::size_t> kinds[] = {
      {"mean(b.length_m)", 10}, {"median(a.length_m)", 6}, {"p95(b.length_m)", 72}};
  for (const auto& [that, fewest] : kinds) {
    for (const std::size_t scenarios : {std::size_t(1), fewest - 1, fewest, fewest + 1}) {
      const Study study(int(scenarios), 1, 0.5);
      const std::string found = of(that, ">= 0", groups_of(scenarios, 1));
      EXPECT_EQ(found.empty(), study.judge(that, ">= 0").verdict == Verdict::holds) << found;
      EXPECT_TRUE(found.empty() || number_in(found) == fewest) << found;
    }
  }
  EXPECT_EQ(of("max(a.length_m)", "<= 9", {0}), "");
  EXPECT_EQ(of("min(a.length_m)", "<= 9", {0, 0}), "");
}

TEST_F(Shortfall, IsSaidInWords) {
  EXPECT_EQ(of("mean(a.length_m)", "<= 9", {0, 1}),
            "will be undecided: too few scenarios: at least 10 for 95 %");
  EXPECT_EQ(of("share(a.solved)", ">= 0.5", {0, 0}),
            "will be undecided: too few repetitions: at least 4 for 95 %");
  EXPECT_EQ(of("share(a.solved)", ">= 0.95", groups_of(20, 1)),
            "cannot hold: too few scenarios: 73 would do for 95 %");
  EXPECT_EQ(of("share(a.solved)", "== 1", groups_of(20, 1)),
            "cannot hold: the interval of a share is too wide, even of 10000 scenarios");
}
}  // namespace
}  // namespace altiplan::study::claim_shortfall_test
