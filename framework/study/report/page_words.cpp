// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <set>

#include "study/figures/text.hpp"
#include "study/report/page.hpp"

namespace altiplan::study::report {
namespace {

/// "all 3 claims hold", "2 of 3 claims hold, 1 fails (with Holm's correction 1 of these becomes
/// undecided)".
std::string claims_in_short(const std::vector<JudgedClaim>& claims) {
  std::map<Verdict, std::size_t> counts;
  for (const JudgedClaim& judged : claims) {
    ++counts[judged.verdict];
  }
  const std::size_t hold = counts[Verdict::holds];
  const auto lost = std::count_if(claims.begin(), claims.end(), becomes_undecided);
  const std::string after_holm =
      lost == 0 ? ""
                : " (with Holm's correction " + std::to_string(lost) +
                      (lost == 1 ? " of these becomes" : " of these become") + " undecided)";
  if (claims.size() == 1) {
    static constexpr const char* kWords[] = {"holds", "fails", "is undecided", "has no data"};
    return std::string("its claim ") + kWords[int(claims.front().verdict)];
  }
  if (hold == claims.size()) {
    return "all " + grouped(hold) + " claims hold" + after_holm;
  }
  std::string text = (hold == 0 ? "none" : grouped(hold)) + " of " +
                     counted(claims.size(), "claim") + (hold < 2 ? " holds" : " hold");
  if (const std::size_t fail = counts[Verdict::fails]; fail > 0) {
    text += ", " + grouped(fail) + (fail == 1 ? " fails" : " fail");
  }
  if (counts[Verdict::undecided] > 0) {
    text += ", " + grouped(counts[Verdict::undecided]) + " undecided";
  }
  if (counts[Verdict::no_data] > 0) {
    text += ", " + grouped(counts[Verdict::no_data]) + " without data";
  }
  return text + after_holm;
}

std::size_t max_repetitions(const StudyData& data) {
  int repetitions = 0;
  for (const RunRow& row : data.rows) {
    repetitions = std::max(repetitions, row.repetition + 1);
  }
  return std::size_t(repetitions);
}

std::string left_out_text(const Content& content) {
  std::string text;
  for (const std::string& line : content.analysis.left_out) {
    text += line + " ";
  }
  for (const std::string& line : content.claims_left_out) {
    text += line + " ";
  }
  for (const MetricAnalysis& metric : content.analysis.metrics) {
    if (!metric.why_no_ranking.empty()) {
      text += metric_title(metric.metric) + ": no ranking. " + metric.why_no_ranking + " ";
    }
  }
  return text;
}
}  // namespace

std::string summary(const Content& content) {
  const StudyData& data = content.data;
  if (data.rows.empty()) {
    return "No runs yet.";
  }
  std::size_t solved = 0;
  std::size_t faults = 0;
  for (const RunRow& row : data.rows) {
    solved += row.solved();
    faults += unexplained(row.outcome);
  }
  std::string text = counted(data.pipelines.size(), "pipeline") + " on " +
                     counted(data.scenarios.size(), "scenario");
  if (const std::size_t repetitions = max_repetitions(data); repetitions > 1) {
    text += ", " + grouped(repetitions) + " repetitions";
  }
  text += ": " + grouped(solved) + " of " + counted(data.rows.size(), "run") + " solved";
  if (!content.claims.empty()) {
    text += "; " + claims_in_short(content.claims);
  }
  return text + "; " +
         (faults == 0 ? "no unexplained failures" : counted(faults, "unexplained failure")) + ".";
}

std::vector<std::string> lacking(const Content& content) {
  constexpr std::size_t kMaxNames = 12;
  std::vector<std::string> sentences;
  if (const auto& absent = content.absent.pipelines; !absent.empty()) {
    std::string names;
    for (std::size_t at = 0; at < absent.size() && at < kMaxNames; ++at) {
      names += (at == 0 ? "" : ", ") + printable(absent[at]);
    }
    if (absent.size() > kMaxNames) {
      names += " and " + grouped(absent.size() - kMaxNames) + " more";
    }
    sentences.push_back("No run of " + counted(absent.size(), "pipeline") + ": " + names + ".");
  }
  if (content.absent.scenarios > 0) {
    sentences.push_back("No run of " + counted(content.absent.scenarios, "scenario") + ".");
  }
  const auto& rows = content.data.rows;
  const bool has_solved =
      std::any_of(rows.begin(), rows.end(), [](const RunRow& row) { return row.solved(); });
  for (const MetricChoice& metric : content.data.file.metrics) {
    const bool is_left_out = !content.times && is_measured(metric.name);
    if (has_solved && !is_left_out &&
        content.data.column(metric.name) == content.data.columns.size()) {
      sentences.push_back("No run has a value '" + printable(metric.name) +
                          "', a metric of the study.");
    }
  }
  const auto lacks = [](const Comparison& comparison) {
    return comparison.used > 0 && !comparison.effect.interval;
  };
  for (const MetricAnalysis& metric : content.analysis.metrics) {
    if (std::any_of(metric.comparisons.begin(), metric.comparisons.end(), lacks)) {
      sentences.push_back("Comparisons of fewer than " + std::to_string(fewest_units(kConfidence)) +
                          " scenarios (of one: repetitions) have no interval.");
      break;
    }
  }
  return sentences;
}

std::string incomplete(const StudyData& data) {
  const std::size_t stored = data.rows.size();
  if (stored >= data.planned) {
    return "";
  }
  const std::size_t share = 100 * stored / data.planned;
  return grouped(stored) + " of " + counted(data.planned, "planned run") +
         (stored == 1 ? " is" : " are") + " stored (" +
         (share == 0 && stored > 0 ? "less than 1" : std::to_string(share)) +
         " %): verdicts are preliminary.";
}

std::vector<std::string> method_text(const Content& content) {
  std::vector<std::string> text;
  text.emplace_back(
      "A pair is one scenario and repetition; every pipeline runs it with the same seed. A value "
      "counts if its run solved and has it as a finite number; values that describe failures "
      "(reached, collisions, minimum separation) count in every run that has them.");
  text.emplace_back(
      "Success: the 95 % interval of a share is Wilson's score interval. With repetitions it is "
      "that "
      "of the number of independent runs whose share would vary as much as that of these does "
      "between scenarios (Korn and Graubard 1998). Claims on a share use the same. "
      "Two pipelines are compared by the exact two-sided sign test on the numbers of scenarios in "
      "which either solved more of the repetitions that both have run; with one repetition this is "
      "McNemar's test. With one scenario, repetitions are counted. Holm's step-down correction is "
      "over all pairs of pipelines. The difference of their shares has Tango's score interval "
      "(1998), which has a width without any difference too.");
  text.emplace_back(
      "Metrics: a pipeline is compared against another on the pairs that both solved. The effect "
      "is the median of the ratio of its value to the other's if all values of the metric are "
      "positive, otherwise of the difference. Its 95 % interval lies between order statistics "
      "(fractional ranks, Hutson 1999) of as many independent pairs as above; of fewer than " +
      std::to_string(fewest_units(kConfidence)) +
      " scenarios (of one: repetitions) there is none, since not even their whole range contains "
      "the median with that confidence.");
  text.emplace_back(
      "Wilcoxon's signed-rank test is two-sided on the differences (of ratios on their "
      "logarithms), "
      "one per scenario (the median over its repetitions) or, with one scenario, one per "
      "repetition "
      "(repetitions of a pipeline are one run if all their values but times and memory, "
      "which count each, are equal); "
      "zeros are dropped, ties "
      "share the mean of their ranks; exact for at most 50 differences, otherwise by the normal "
      "distribution with correction for ties, not for continuity. n is the number of differences. "
      "Rank-biserial: matched pairs, -1 if the pipeline always has less than the one it is "
      "compared against. Holm's correction is over all pairs of pipelines, for each metric.");
  text.emplace_back(
      "Ranks: Friedman's test, corrected for ties, and Nemenyi's critical difference at 5 % "
      "(Demšar "
      "2006), over scenarios (medians over repetitions) that all pipelines solved, or over "
      "repetitions of one scenario.");
  text.emplace_back(
      "Curves of solved runs count a run that did not solve only in the total: its time is "
      "censored. Performance profiles: Dolan and Moré (2002). Box plots: Tukey's, "
      "whiskers at the last value within 1.5 interquartile ranges.");
  text.push_back("Scenes: " + content.scenes.what);
  if (const std::string left_out = left_out_text(content); !left_out.empty()) {
    text.push_back("Omitted: " + left_out);
  }
  if (!content.times) {
    text.push_back(
        "Made with --no-times: values that vary between equal runs are omitted (names that end in "
        "time_s or memory_mb, run ids, sessions, machines, dates).");
  }
  return text;
}
}  // namespace altiplan::study::report
