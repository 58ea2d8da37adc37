// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "study/figures/text.hpp"
#include "study/report/page.hpp"

namespace altiplan::study::report {
namespace {

Cell number(double value, int digits = 4) { return {readable(value, digits), value}; }
/// Columns by their titles; '#' before one of numbers, '[' of intervals, '~' of `spread`.
std::vector<Column> columns(std::initializer_list<std::string> titles) {
  std::vector<Column> all;
  for (const std::string& title : titles) {
    const char kind = title[0];
    Column column{title.substr(kind == '#' || kind == '[' || kind == '~'), true};
    column.number = column.title != title;
    if (kind == '[') {
      column.parts = {" from", " to"};
    } else if (kind == '~') {
      column.parts = {"", " from", " to"};
    }
    all.push_back(std::move(column));
  }
  return all;
}

Cell code(const std::string& text) {
  Cell cell(text);
  cell.kind = "code";
  return cell;
}
Cell count(std::size_t value) { return {grouped(value), double(value)}; }
/// "12 [9, 20]".
Cell spread(const Spread& over) {
  if (!std::isfinite(over.low)) {
    return "–";
  }
  return {readable(over.median) + " [" + readable(over.low) + ", " + readable(over.high) + "]",
          over.median,
          {number(over.median), number(over.low), number(over.high)}};
}
Cell p_value(double p) { return {p_text(p), p}; }
Cell units(const Units& units) {
  return {counted(units.count, units.of_scenarios ? "scenario" : "repetition"),
          double(units.count),
          {count(units.count)}};
}

Cell between(const Cell& low, const Cell& high) {
  return {"[" + low.text + ", " + high.text + "]", kNone, {low, high}};
}

Cell interval_of(const std::optional<Interval>& interval, int digits = 3) {
  return interval ? between(number(interval->low, digits), number(interval->high, digits)) : "–";
}

Cell share(double value) { return {percent(value), value}; }

Cell share_interval(const MadeInterval& made) {
  return made.interval ? between(share(made.interval->low), share(made.interval->high)) : "–";
}

/// "18 scenarios, 4 differ": the test drops the others.
Cell tested(const PairedEffect& effect) {
  Cell cell = units(effect.units);
  const std::size_t differ = effect.test ? effect.test->used : 0;
  cell.parts.push_back(count(differ));
  cell.text += differ < effect.units.count ? ", " + grouped(differ) + " differ" : "";
  return cell;
}

const std::string& name(const Content& content, std::size_t pipeline) {
  return content.short_names[pipeline];
}

/// The pipeline that a comparison favours at 5 % after Holm, or a dash.
std::string winner(const Content& content, const MetricAnalysis& metric,
                   const Comparison& comparison) {
  if (!(comparison.p_holm < kAlpha) || comparison.rank_biserial() == 0) {
    return "–";
  }
  const bool has_less = comparison.rank_biserial() < 0;
  const bool is_better = has_less == (metric.better == Better::lower);
  return name(content, is_better ? comparison.pipeline : comparison.against);
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
      columns({"pipeline", "step", "#runs", "~best within 1 %", "~mean within 3 %",
               "~alive at the end"}),
      {}};
  for (const Convergence& each : content.convergence) {
    const auto of_population = [&](const Spread& over) {
      return each.is_population ? spread(over) : Cell("–");
    };
    table.rows.push_back({name(content, each.pipeline), printable(each.step), count(each.runs),
                          spread(each.best_from), of_population(each.mean_from),
                          of_population(each.alive_at_end)});
  }
  return table;
}

Table anytime_table(const Content& content) {
  Table table{
      "anytime",
      "Seconds to the first route, and to one within 5 % and 1 % of the least cost known of the "
      "scenario, and evaluations in the planner's own unit: median [10th, 90th percentile] over "
      "all runs, a dash if not reached by that part of them; the share of runs that come so near",
      columns({"pipeline", "#runs", "~first route, s", "~to 5 %, s", "~evaluations to 5 %",
               "#runs to 5 %", "~to 1 %, s", "~evaluations to 1 %", "#runs to 1 %"}),
      {}};
  for (const Anytime& each : content.anytime) {
    std::vector<Cell> row{name(content, each.pipeline), count(each.runs),
                          spread(each.first_route_s)};
    for (const TimeTo& to : each.times_to) {
      row.insert(row.end(), {spread(to.time_s), spread(to.evaluations), share(to.share)});
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table failure_table(const Content& content) {
  Table table{"failures",
              "Unexplained failures: runs that ended by a fault of a plugin or its build",
              columns({"pipeline", "outcome", "message", "#runs", "for example", "to reproduce"}),
              {}};
  for (const FailureGroup& group : content.failures) {
    const RunRow& row = content.data.rows[group.rows.front()];
    Cell message(shortened(printable(group.message), 300));
    message.kind = "message";
    Cell example(content.data.scenarios[row.scenario].name + " #" + std::to_string(row.repetition));
    example.open = "run " + std::to_string(group.rows.front());
    Cell command = row.is_imported ? Cell("–") : code(replay_command(content, row));
    table.rows.push_back({name(content, group.pipeline), outcome_text(group.outcome), message,
                          count(group.rows.size()), example, command});
  }
  return table;
}

namespace {
/// "2026-11-21T18:00:00Z, before the first run", "after 12 runs".
std::string stated(const Content& content, const JudgedClaim& judged) {
  const auto found = content.data.statements.find(judged.claim.id);
  if (found == content.data.statements.end()) {
    return "–";
  }
  const std::string when = judged.stated.empty() ? "before the first run" : judged.stated;
  const bool has_time = content.times && !found->second.time.empty();
  return has_time ? found->second.time + ", " + when : when;
}
}  // namespace

Table claim_table(const Content& content) {
  Table table{"verdicts",
              "Claims and their verdicts",
              columns({"claim", "that", "claimed", "verdict", "#estimate", "[interval", "#p",
                       "#p (Holm)", "#pairs used", "#of", "stated"}),
              {}};
  for (const JudgedClaim& judged : content.claims) {
    table.rows.push_back({judged.claim.id, judged.claim.that, wanted(judged.claim),
                          std::string(name_of(judged.verdict)), number(judged.estimate),
                          interval_of(judged.interval, 4), p_value(judged.p),
                          p_value(judged.p_holm), count(judged.used), count(judged.pairs),
                          stated(content, judged)});
  }
  return table;
}

Table success_table(const Content& content) {
  Table table{
      "success",
      "Share of solved runs, of all and of those whose problem is valid (start and goal are "
      "free), with 95 % intervals",
      columns({"pipeline", "#runs", "#solved", "#share", "[interval", "#of valid problems",
               "[their interval", "other outcomes"}),
      {}};
  for (std::size_t p = 0; p < content.data.pipelines.size(); ++p) {
    const Success& success = content.analysis.success[p];
    const auto share_of = [&](std::size_t runs) {
      return share(runs > 0 ? double(success.solved) / double(runs) : kNone);
    };
    std::string others;
    for (const auto& [outcome, runs] : success.outcomes) {
      if (outcome != "solved") {
        others += (others.empty() ? "" : ", ") + grouped(runs) + " " + outcome_text(outcome);
      }
    }
    table.rows.push_back({name(content, p), count(success.runs), count(success.solved),
                          share_of(success.runs), share_interval(success.interval),
                          share_of(success.valid), share_interval(success.of_valid),
                          others.empty() ? "–" : others});
  }
  return table;
}

Table par_table(const Content& content) {
  const StudyData& data = content.data;
  const double limit = data.file.budget.time_s.value_or(kNone);
  Table table{
      "par",
      "Penalised average planning time: mean over all runs, of which one that did not solve, also "
      "of an invalid problem, counts twice, or ten times, the time budget of " +
          readable(limit) + " s",
      columns({"pipeline", "#runs", "#PAR-2, s", "#PAR-10, s"}),
      {}};
  const std::size_t column = data.column("plan_time_s");
  for (std::size_t p = 0; p < data.pipelines.size(); ++p) {
    const auto par = [&](double k) {
      std::vector<double> times;
      for (const RunRow& row : data.rows) {
        if (row.pipeline == p) {
          const bool has_time = row.solved() && column < row.values.size();
          times.push_back(has_time ? row.values[column] : k * limit);
        }
      }
      return number(mean(times));
    };
    table.rows.push_back(
        {name(content, p), count(content.analysis.success[p].runs), par(2), par(10)});
  }
  return table;
}

Table success_comparison_table(const Content& content) {
  Table table{"success-pairs",
              "Success, pipeline against pipeline" +
                  counted_once(content.analysis.repeating, Counted::pairs) +
                  ": exact sign test over n scenarios (repetitions "
                  "if there is one scenario), Holm's correction over all rows; the difference of "
                  "the shares "
                  "with Tango's interval",
              columns({"pipeline", "against", "#n", "#it more often", "#the other more often", "#p",
                       "#p (Holm)", "#difference", "[95 % interval", "#runs of both",
                       "#it alone solved", "#the other alone solved"}),
              {}};
  for (const SuccessComparison& comparison : content.analysis.success_comparisons) {
    const double difference = (double(comparison.only_pipeline) - double(comparison.only_against)) /
                              double(comparison.pairs);
    table.rows.push_back({name(content, comparison.pipeline), name(content, comparison.against),
                          units(comparison.test.units), count(comparison.test.second_more),
                          count(comparison.test.first_more), p_value(comparison.test.p),
                          p_value(comparison.p_holm), number(difference, 3),
                          interval_of(comparison.difference.interval), count(comparison.pairs),
                          count(comparison.only_pipeline), count(comparison.only_against)});
  }
  return table;
}

Table metric_table(const Content& content) {
  Table table{"metrics",
              "Values of solved runs" + counted_once(content.analysis.repeating, Counted::values),
              columns({"metric", "pipeline", "#runs", "#median", "[quartiles", "#mean", "#least",
                       "#greatest"}),
              {}};
  for (const MetricAnalysis& metric : content.analysis.metrics) {
    for (std::size_t p = 0; p < content.data.pipelines.size(); ++p) {
      const Sample& sample = metric.samples[p];
      const auto& values = sample.values;
      const bool any = !values.empty();
      const auto shown = [&](double value) {
        return Cell(readable_value(metric.metric, value), value);
      };
      table.rows.push_back({metric_label(metric.metric), name(content, p), count(values.size()),
                            shown(any ? sample.box->median : kNone),
                            any ? between(shown(sample.box->q1), shown(sample.box->q3)) : "–",
                            shown(mean(values)),
                            shown(any ? *std::min_element(values.begin(), values.end()) : kNone),
                            shown(any ? *std::max_element(values.begin(), values.end()) : kNone)});
    }
  }
  return table;
}

Table common_table(const Content& content) {
  const StudyData& data = content.data;
  Table table{"common",
              "Values over the pairs (scenario, repetition) that all pipelines solved" +
                  counted_once(content.analysis.repeating, Counted::common_pairs),
              columns({"metric", "pipeline", "#pairs", "#median", "#mean", "#least", "#greatest"}),
              {}};
  for (const MetricAnalysis& metric : content.analysis.metrics) {
    const std::size_t column = data.column(metric.metric);
    std::vector<Pair> common = distinct_pairs(data, metric.metric);
    std::erase_if(common, [&](const Pair& pair) {
      return std::any_of(pair.rows.begin(), pair.rows.end(), [&](std::size_t row) {
        return row == kNoRow || !data.rows[row].solved();
      });
    });
    for (std::size_t p = 0; p < data.pipelines.size(); ++p) {
      std::vector<double> values;
      for (const Pair& pair : common) {
        const double value = data.rows[pair.rows[p]].values[column];
        if (std::isfinite(value)) {
          values.push_back(value);
        }
      }
      const auto shown = [&](double value) {
        return Cell(readable_value(metric.metric, value), value);
      };
      const bool any = !values.empty();
      table.rows.push_back({metric_label(metric.metric), name(content, p), count(values.size()),
                            shown(median(values)), shown(mean(values)),
                            shown(any ? *std::min_element(values.begin(), values.end()) : kNone),
                            shown(any ? *std::max_element(values.begin(), values.end()) : kNone)});
    }
  }
  return table;
}

Table comparison_table(const Content& content, const MetricAnalysis& metric) {
  Table table{
      "pairs-" + slug(metric.metric),
      metric_label(metric.metric) + ", pipeline against pipeline on the pairs that both solved (" +
          (metric.better == Better::lower ? "lower" : "higher") + " is better)" +
          counted_once(metric.repeating, Counted::pairs) +
          ": Wilcoxon's signed-rank test over n scenarios (repetitions if "
          "there is one scenario), Holm's correction over all rows",
      columns({"pipeline", "against", metric.is_ratio ? "#median ratio" : "#median difference",
               "[95 % interval", "#n", "#p", "#p (Holm)", "#rank-biserial", "better",
               "#both solved", "#of pairs"}),
      {}};
  table.columns[4].parts = {"", " that differ"};
  for (const Comparison& comparison : metric.comparisons) {
    const std::string sign = !metric.is_ratio && comparison.effect.median > 0 ? "+" : "";
    table.rows.push_back(
        {name(content, comparison.pipeline), name(content, comparison.against),
         Cell(comparison.used > 0 ? sign + readable(comparison.effect.median) : "–",
              comparison.effect.median),
         interval_of(comparison.effect.interval, 4), tested(comparison.effect),
         p_value(comparison.p()), p_value(comparison.p_holm), number(comparison.rank_biserial(), 3),
         winner(content, metric, comparison), count(comparison.used), count(comparison.pairs)});
  }
  return table;
}

Table pareto_table(const Content& content, const Trade& trade) {
  Table table{"pareto-" + slug(trade.metrics[0]) + "-" + slug(trade.metrics[1]),
              metric_title(trade.metrics[0]) + " against " + metric_title(trade.metrics[1]) +
                  ": medians over " + counted(trade.pairs, "pair") +
                  ", whether no pipeline is better in both, and the hypervolume lost without it",
              columns({"pipeline", "#" + metric_label(trade.metrics[0]),
                       "#" + metric_label(trade.metrics[1]), "non-dominated", "#hypervolume lost"}),
              {}};
  for (std::size_t i = 0; i < trade.pipelines.size(); ++i) {
    std::vector<Place> others = trade.places;
    others.erase(others.begin() + std::ptrdiff_t(i));
    const auto shown = [&](std::size_t k) {
      const double value = trade.is_negated[k] ? -trade.places[i][k] : trade.places[i][k];
      return Cell(readable_value(trade.metrics[k], value), value);
    };
    const bool is_on_front =
        std::find(trade.front.begin(), trade.front.end(), i) != trade.front.end();
    table.rows.push_back({name(content, trade.pipelines[i]), shown(0), shown(1),
                          is_on_front ? "yes" : "no",
                          number(trade.hypervolume - hypervolume(others, trade.reference))});
  }
  return table;
}

Table pipeline_table(const Content& content) {
  Table table{"pipelines", "Pipelines", columns({"pipeline", "file", "keys set"}), {}};
  for (const StoredVariant& variant : content.data.pipelines) {
    std::string keys;
    for (const std::string& key : variant.set) {
      keys += (keys.empty() ? "" : ", ") + key;
    }
    Cell file = code(std::filesystem::path(variant.file).filename().string());
    Cell set(keys.empty() ? "–" : keys);
    set.kind = keys.empty() ? "" : "code";
    table.rows.push_back({variant.name, file, set});
  }
  return table;
}

Table session_table(const Content& content) {
  Table table{"sessions",
              "Calls of altiplan study that made the runs",
              columns({"started", "host", "processor", "#cores", "#memory, GB", "system",
                       "altiplan", "#jobs", "#reuse", "limits enforced by", "command"}),
              {}};
  for (const StoredSession& session : content.data.sessions) {
    Cell command = code(session.command);
    table.rows.push_back({session.started, session.host, session.cpu,
                          count(std::size_t(std::max(0, session.cores))),
                          number(session.memory_mb / 1024, 3), session.system, session.version,
                          count(std::size_t(std::max(0, session.jobs))),
                          count(std::size_t(std::max(0, session.reuse))), session.limits, command});
  }
  return table;
}

Table build_table(const Content& content) {
  Table table{"builds", "Builds of the plugins that ran", columns({"kind", "plugin", "build"}), {}};
  for (const auto& plugin : content.builds.plugins) {
    Cell build = code(plugin[2]);
    table.rows.push_back({plugin[0], plugin[1], build});
  }
  return table;
}
}  // namespace altiplan::study::report
