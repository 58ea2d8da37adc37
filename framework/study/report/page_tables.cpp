// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "study/figures/text.hpp"
#include "study/report/page.hpp"

namespace altiplan::study::report {
namespace {

Cell number(double value, int digits = 4) { return {readable(value, digits), value}; }
Cell count(std::size_t value) { return {grouped(value), double(value)}; }
/// "12 [9, 20]".
Cell spread(const Spread& over) {
  if (!std::isfinite(over.low)) {
    return "–";
  }
  return {readable(over.median) + " [" + readable(over.low) + ", " + readable(over.high) + "]",
          over.median};
}
Cell p_value(double p) { return {p_text(p), p}; }
Cell units(const Units& units) {
  return {counted(units.count, units.of_scenarios ? "scenario" : "repetition"),
          double(units.count)};
}

std::string interval_of(const std::optional<Interval>& interval, int digits = 3) {
  return interval
             ? "[" + readable(interval->low, digits) + ", " + readable(interval->high, digits) + "]"
             : "–";
}

std::string share_interval_text(const Success& success) {
  const auto& interval = success.interval.interval;
  return interval ? "[" + percent(interval->low) + ", " + percent(interval->high) + "]" : "–";
}

/// "18 scenarios, 4 differ": the test drops the others.
Cell tested(const PairedEffect& effect) {
  Cell cell = units(effect.units);
  const std::size_t differ = effect.test ? effect.test->used : 0;
  cell.text += differ < effect.units.count ? ", " + grouped(differ) + " differ" : "";
  return cell;
}

const std::string& name(const Content& content, std::size_t pipeline) {
  return content.short_names[pipeline];
}

/// The pipeline that a comparison favours at 5 % after Holm, or a dash.
std::string winner(const Content& content, const MetricAnalysis& metric, const Comparison& made) {
  if (!(made.p_holm < kAlpha) || made.rank_biserial() == 0) {
    return "–";
  }
  const bool has_less = made.rank_biserial() < 0;
  const bool is_better = has_less == (metric.better == Better::lower);
  return name(content, is_better ? made.pipeline : made.against);
}

}  // namespace

std::string replay_command(const Content& content, const RunRow& row) {
  const std::string store = content.times ? content.data.stores.at(row.store) : "DB";
  return "altiplan replay " + shell(store) + " " + shell(run_name(content.data, row));
}

Table convergence_table(const Content& content) {
  Table table{
      "convergence",
      "The first iteration with a best length within 1 % of the final best, and with a mean "
      "within 3 % of it; the number of a population that found a route in the last "
      "iteration: median [10th, 90th percentile] over runs, a dash if not reached",
      {{"pipeline"},
       {"step"},
       {"runs", true},
       {"best within 1 %", true},
       {"mean within 3 %", true},
       {"alive at the end", true}},
      {}};
  for (const Convergence& made : content.convergence) {
    const auto of_population = [&](const Spread& over) {
      return made.is_population ? spread(over) : Cell("–");
    };
    table.rows.push_back({name(content, made.pipeline), printable(made.step), count(made.runs),
                          spread(made.best_from), of_population(made.mean_from),
                          of_population(made.alive_at_end)});
  }
  return table;
}

Table failure_table(const Content& content) {
  Table table{
      "failures",
      "Unexplained failures: runs that ended by a fault of a plugin or its build",
      {{"pipeline"}, {"outcome"}, {"message"}, {"runs", true}, {"for example"}, {"to reproduce"}},
      {}};
  for (const FailureGroup& group : content.failures) {
    const RunRow& row = content.data.rows[group.rows.front()];
    Cell message(shortened(printable(group.message), 300));
    message.kind = "message";
    Cell example(content.data.scenarios[row.scenario].name + " #" + std::to_string(row.repetition));
    example.open = "run " + std::to_string(group.rows.front());
    Cell command(replay_command(content, row));
    command.kind = "code";
    table.rows.push_back({name(content, group.pipeline), outcome_text(group.outcome), message,
                          count(group.rows.size()), example, command});
  }
  return table;
}

Table claim_table(const Content& content) {
  Table table{"verdicts",
              "Claims and their verdicts",
              {{"claim"},
               {"that"},
               {"claimed"},
               {"verdict"},
               {"estimate", true},
               {"interval", true},
               {"pairs used", true},
               {"of", true}},
              {}};
  for (const JudgedClaim& judged : content.claims) {
    table.rows.push_back({judged.claim.id, judged.claim.that, wanted(judged.claim),
                          std::string(name_of(judged.verdict)), number(judged.estimate),
                          interval_of(judged.interval, 4), count(judged.used),
                          count(judged.pairs)});
  }
  return table;
}

Table success_table(const Content& content) {
  Table table{"success",
              "Share of solved runs, with its 95 % interval",
              {{"pipeline"},
               {"runs", true},
               {"solved", true},
               {"share", true},
               {"interval", true},
               {"other outcomes"}},
              {}};
  for (std::size_t p = 0; p < content.data.pipelines.size(); ++p) {
    const Success& success = content.analysis.success[p];
    const double share = success.runs > 0 ? double(success.solved) / double(success.runs) : kNone;
    std::string others;
    for (const auto& [outcome, runs] : success.outcomes) {
      if (outcome != "solved") {
        others += (others.empty() ? "" : ", ") + grouped(runs) + " " + outcome_text(outcome);
      }
    }
    table.rows.push_back({name(content, p), count(success.runs), count(success.solved),
                          Cell(percent(share), share), share_interval_text(success),
                          others.empty() ? "–" : others});
  }
  return table;
}

Table success_comparison_table(const Content& content) {
  Table table{"success-pairs",
              "Success, pipeline against pipeline: exact sign test over n scenarios (repetitions "
              "if there is one scenario), Holm's correction over all rows",
              {{"pipeline"},
               {"against"},
               {"n", true},
               {"it more often", true},
               {"the other more often", true},
               {"p", true},
               {"p (Holm)", true},
               {"runs of both", true},
               {"it alone solved", true},
               {"the other alone solved", true}},
              {}};
  for (const SuccessComparison& made : content.analysis.success_comparisons) {
    table.rows.push_back({name(content, made.pipeline), name(content, made.against),
                          units(made.test.units), count(made.test.second_more),
                          count(made.test.first_more), p_value(made.test.p), p_value(made.p_holm),
                          count(made.pairs), count(made.only_pipeline), count(made.only_against)});
  }
  return table;
}

Table metric_table(const Content& content) {
  Table table{"metrics",
              "Values of solved runs",
              {{"metric"},
               {"pipeline"},
               {"runs", true},
               {"median", true},
               {"quartiles", true},
               {"mean", true},
               {"least", true},
               {"greatest", true}},
              {}};
  for (const MetricAnalysis& metric : content.analysis.metrics) {
    for (std::size_t p = 0; p < content.data.pipelines.size(); ++p) {
      const Sample& sample = metric.samples[p];
      const auto& values = sample.values;
      const bool any = !values.empty();
      const auto shown = [&](double value) {
        return Cell(readable_value(metric.metric, value), value);
      };
      table.rows.push_back(
          {metric_label(metric.metric), name(content, p), count(values.size()),
           shown(any ? sample.box->median : kNone),
           any ? "[" + shown(sample.box->q1).text + ", " + shown(sample.box->q3).text + "]"
               : std::string("–"),
           shown(mean(values)),
           shown(any ? *std::min_element(values.begin(), values.end()) : kNone),
           shown(any ? *std::max_element(values.begin(), values.end()) : kNone)});
    }
  }
  return table;
}

Table comparison_table(const Content& content, const MetricAnalysis& metric) {
  Table table{"pairs-" + slug(metric.metric),
              metric_label(metric.metric) +
                  ", pipeline against pipeline on the pairs that both solved (" +
                  (metric.better == Better::lower ? "lower" : "higher") +
                  " is better): Wilcoxon's signed-rank test over n scenarios (repetitions if "
                  "there is one scenario), Holm's correction over all rows",
              {{"pipeline"},
               {"against"},
               {metric.is_ratio ? "median ratio" : "median difference", true},
               {"95 % interval", true},
               {"n", true},
               {"p", true},
               {"p (Holm)", true},
               {"rank-biserial", true},
               {"better"},
               {"both solved", true},
               {"of pairs", true}},
              {}};
  for (const Comparison& made : metric.comparisons) {
    const std::string sign = !metric.is_ratio && made.effect.median > 0 ? "+" : "";
    table.rows.push_back(
        {name(content, made.pipeline), name(content, made.against),
         Cell(made.used > 0 ? sign + readable(made.effect.median) : "–", made.effect.median),
         interval_of(made.effect.interval, 4), tested(made.effect), p_value(made.p()),
         p_value(made.p_holm), number(made.rank_biserial(), 3), winner(content, metric, made),
         count(made.used), count(made.pairs)});
  }
  return table;
}

Table pipeline_table(const Content& content) {
  Table table{"pipelines", "Pipelines", {{"pipeline"}, {"file"}, {"keys set"}}, {}};
  for (const StoredVariant& variant : content.data.pipelines) {
    std::string keys;
    for (const std::string& key : variant.set) {
      keys += (keys.empty() ? "" : ", ") + key;
    }
    Cell file(std::filesystem::path(variant.file).filename().string());
    file.kind = "code";
    Cell set(keys.empty() ? "–" : keys);
    set.kind = keys.empty() ? "" : "code";
    table.rows.push_back({variant.name, file, set});
  }
  return table;
}

Table session_table(const Content& content) {
  Table table{"sessions",
              "Calls of altiplan study that made the runs",
              {{"started"},
               {"host"},
               {"processor"},
               {"cores", true},
               {"memory, GB", true},
               {"system"},
               {"altiplan"},
               {"jobs", true},
               {"reuse", true},
               {"limits enforced by"},
               {"command"}},
              {}};
  for (const StoredSession& session : content.data.sessions) {
    Cell command(session.command);
    command.kind = "code";
    table.rows.push_back({session.started, session.host, session.cpu,
                          count(std::size_t(std::max(0, session.cores))),
                          number(session.memory_mb / 1024, 3), session.system, session.version,
                          count(std::size_t(std::max(0, session.jobs))),
                          count(std::size_t(std::max(0, session.reuse))), session.limits, command});
  }
  return table;
}

Table build_table(const Content& content) {
  Table table{"builds", "Builds of the plugins that ran", {{"kind"}, {"plugin"}, {"build"}}, {}};
  for (const auto& plugin : content.builds.plugins) {
    Cell build(plugin[2]);
    build.kind = "code";
    table.rows.push_back({plugin[0], plugin[1], build});
  }
  return table;
}
}  // namespace altiplan::study::report
