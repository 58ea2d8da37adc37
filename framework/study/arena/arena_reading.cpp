// SPDX-License-Identifier: Apache-2.0
#include "study/arena/arena_reading.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <tuple>

#include "altiplan/error.hpp"
#include "host/base/json.hpp"
#include "study/arena/arena_columns.hpp"
#include "study/statistics/statistics.hpp"
#include "study/store/place.hpp"
#include "study/store/sqlite.hpp"

namespace altiplan::study {
namespace {

namespace fs = std::filesystem;

constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

/// The columns of a table whose values are numbers, in their order.
std::vector<std::string> number_columns(const Sqlite& database, const std::string& table) {
  std::vector<std::string> columns;
  Statement statement = database.prepare("SELECT name, upper(type) FROM pragma_table_info(?)");
  statement.bind(table);
  while (statement.step()) {
    const std::string type = statement.text(1);
    const bool is_text = type.starts_with("VARCHAR") || type == "TEXT" || type == "STRING";
    if (!is_text) {
      columns.push_back(statement.text(0));
    }
  }
  return columns;
}

std::string identifier(const std::string& name) {
  std::string out = "\"";
  for (const char letter : name) {
    out += letter == '"' ? "\"\"" : std::string(1, letter);
  }
  return out + "\"";
}

double number_or_nothing(const Statement& row, std::size_t column) {
  return row.is_null(int(column)) ? kNoValue : row.number(int(column));
}

class ArenaReader {
 public:
  ArenaReader(StudyData& data, const fs::path& file)
      : data_(data),
        file_(file),
        store_(data.stores.size()),
        database_(file, SQLITE_OPEN_READONLY) {}

  void read() {
    const bool is_alone = data_.stores.empty();
    data_.stores.push_back(file_.string());
    read_experiments(is_alone);
    read_variants("SELECT id, name FROM plannerConfigs ORDER BY id", data_.pipelines, pipelines_);
    read_statuses();
    read_columns();
    read_runs();
    std::sort(data_.rows.begin(), data_.rows.end(), [](const RunRow& a, const RunRow& b) {
      return std::tie(a.scenario, a.pipeline, a.repetition, a.key) <
             std::tie(b.scenario, b.pipeline, b.repetition, b.key);
    });
  }

  /// The progress of the runs as traces, by the run's id.
  std::map<std::int64_t, std::string> traces() const {
    const std::vector<std::string> columns = number_columns(database_, "progress");
    const auto has = [&](const char* name) {
      return std::find(columns.begin(), columns.end(), name) != columns.end();
    };
    std::map<std::int64_t, std::string> traces;
    if (!has("runid") || !has("time") || !has("best_cost")) {
      return traces;
    }
    const std::string effort = has("evaluations")  ? "evaluations"
                               : has("iterations") ? "iterations"
                                                   : "NULL";
    Statement row = database_.prepare("SELECT runid, time, best_cost, " + effort +
                                      " FROM progress ORDER BY runid, time");
    std::map<std::int64_t, int> count;
    std::set<std::int64_t> with_routes;
    while (row.step()) {
      const std::int64_t run = row.integer(0);
      host::Json line{{"kind", "iteration"}, {"step", "plan"}, {"node", ++count[run]}};
      for (int column = 1; const char* key : {"time_s", "value", "expanded"}) {
        const double value = number_or_nothing(row, std::size_t(column++));
        if (std::isfinite(value)) {
          line[key] = value;
        }
      }
      if (line.contains("value")) {
        with_routes.insert(run);
      }
      traces[run] += host::json_text(line) + "\n";
    }
    // Others do not report costs: what they found is in the table of runs.
    std::erase_if(traces, [&](const auto& trace) { return !with_routes.contains(trace.first); });
    return traces;
  }

 private:
  [[noreturn]] void fail(const std::string& why) const {
    throw Error("the benchmark '" + file_.string() + "': " + why);
  }

  /// Index by name; appended if there is none.
  std::size_t index_of(std::vector<StoredVariant>& variants, const std::string& name) const {
    const auto found = std::find_if(variants.begin(), variants.end(),
                                    [&](const auto& variant) { return variant.name == name; });
    const auto index = std::size_t(found - variants.begin());
    if (found == variants.end()) {
      variants.push_back({name, name, file_.string(), {}});
    }
    return index;
  }

  /// Of rows of an id and a name; the second of one name and others get a number.
  void read_variants(const std::string& sql, std::vector<StoredVariant>& variants,
                     std::map<std::int64_t, std::size_t>& by_id) const {
    std::map<std::string, int> count;
    Statement row = database_.prepare(sql);
    while (row.step()) {
      const std::string name = row.text(1);
      const int number = ++count[name];
      by_id[row.integer(0)] =
          index_of(variants, number == 1 ? name : name + " (" + std::to_string(number) + ")");
    }
  }

  void read_experiments(bool is_alone) {
    std::set<std::string> known;
    for (const StoredVariant& scenario : data_.scenarios) {
      known.insert(scenario.name);
    }
    read_variants("SELECT id, name FROM experiments ORDER BY id", data_.scenarios, scenarios_);
    const auto is_known = [&](const auto& each) {
      return known.contains(data_.scenarios[each.second].name);
    };
    if (!is_alone && std::none_of(scenarios_.begin(), scenarios_.end(), is_known)) {
      fail("none of its experiments has the name of a scenario of the study; the first is '" +
           (scenarios_.empty() ? "" : data_.scenarios[scenarios_.begin()->second].name) +
           "': give the scenario that id");
    }
    Statement row = database_.prepare(
        "SELECT id, version, hostname, cpuinfo, date, seed, timelimit FROM experiments "
        "ORDER BY id");
    std::set<double> limits_s;
    while (row.step()) {
      const std::string seed = row.text(5);
      std::from_chars(seed.data(), seed.data() + seed.size(), seeds_[row.integer(0)]);
      limits_s.insert(row.is_null(6) ? 0 : row.number(6));
      StoredSession session;
      session.started = row.text(4);
      session.version = row.text(1);
      session.host = row.text(2);
      session.cpu = row.text(3).substr(0, row.text(3).find('\n'));
      data_.sessions.push_back(session);
    }
    if (is_alone && limits_s.size() == 1 && *limits_s.begin() > 0) {
      data_.file.budget.time_s = *limits_s.begin();  // of all, or of none
    }
    if (is_alone) {
      data_.file.name = file_.stem().string();
    }
  }

  void read_statuses() {
    Statement row = database_.prepare("SELECT value, description FROM enums WHERE name = 'status'");
    while (row.step()) {
      statuses_[row.integer(0)] = row.text(1);
    }
  }

  /// Adds the names of the values to those of the study.
  void read_columns() {
    for (const std::string& column : number_columns(database_, "runs")) {
      if (column == "id" || column == "experimentid" || column == "plannerid") {
        continue;
      }
      columns_.push_back(column);
      names_.push_back(value_of_column(column));
    }
    const auto has = [&](const char* column) {
      return std::find(columns_.begin(), columns_.end(), column) != columns_.end();
    };
    if (!has("solved") || !has("time")) {
      fail("its runs have no columns 'solved' and 'time'");
    }
    names_.push_back("cost");
    std::set<std::string> all(data_.columns.begin(), data_.columns.end());
    all.insert(names_.begin(), names_.end());
    std::vector<std::string> merged(all.begin(), all.end());
    for (RunRow& row : data_.rows) {
      std::vector<double> values(merged.size(), kNoValue);
      for (std::size_t n = 0; n < merged.size(); ++n) {
        const std::size_t old = data_.column(merged[n]);
        values[n] = old < data_.columns.size() ? row.values[old] : kNoValue;
      }
      row.values = std::move(values);
    }
    data_.columns = std::move(merged);
  }

  void read_runs() {
    std::string sql = "SELECT id, experimentid, plannerid";
    for (const std::string& column : columns_) {
      sql += ", " + identifier(column);
    }
    Statement statement = database_.prepare(sql + " FROM runs ORDER BY id");
    // Runs of one planner in several databases are further repetitions.
    std::map<std::pair<std::size_t, std::size_t>, int> repetitions;
    for (const RunRow& row : data_.rows) {
      int& next = repetitions[{row.scenario, row.pipeline}];
      next = std::max(next, int(row.repetition) + 1);
    }
    bool costs_are_lengths = true;
    std::size_t added = 0;
    while (statement.step()) {
      const auto scenario = scenarios_.find(statement.integer(1));
      const auto pipeline = pipelines_.find(statement.integer(2));
      RunRow row;
      row.id = statement.integer(0);
      if (scenario == scenarios_.end() || pipeline == pipelines_.end()) {
        fail("run " + std::to_string(row.id) + " is of no experiment or planner");
      }
      row.store = store_;
      row.scenario = scenario->second;
      row.pipeline = pipeline->second;
      row.repetition = repetitions[{row.scenario, row.pipeline}]++;
      row.is_imported = true;
      row.seed = seeds_[statement.integer(1)];
      row.key = "arena " + file_.string() + " " + std::to_string(row.id);
      std::map<std::string, double> values;
      for (std::size_t n = 0; n < columns_.size(); ++n) {
        values[columns_[n]] = number_or_nothing(statement, n + 3);
      }
      if (const double time_s = at(values, "time"); time_s < 0 || std::isinf(time_s)) {
        fail("the time of run " + std::to_string(row.id) + " is none: expected seconds from 0");
      }
      take_outcome(row, values);
      take_values(row, values);
      const double length = at(values, "solution_length");
      const double cost = at(values, "best_cost");
      costs_are_lengths = costs_are_lengths && !(std::abs(cost - length) > 0.01 * length);
      data_.rows.push_back(std::move(row));
      ++added;
    }
    if (added == 0) {
      fail("it has no runs");
    }
    data_.planned += added;
    if (costs_are_lengths) {
      use_lengths_as_costs(added);
    }
  }

  /// Of the last runs, where they have no cost of their own.
  void use_lengths_as_costs(std::size_t added) {
    const std::size_t length = data_.column("length_m");
    const std::size_t cost = data_.column("cost");
    for (std::size_t n = data_.rows.size() - added; n < data_.rows.size(); ++n) {
      RunRow& row = data_.rows[n];
      if (length < row.values.size() && row.solved() && std::isnan(row.values[cost])) {
        row.values[cost] = row.values[length];
      }
    }
  }

  static double at(const std::map<std::string, double>& values, const char* column) {
    const auto found = values.find(column);
    return found == values.end() ? kNoValue : found->second;
  }

  /// Solved by an exact solution that OMPL found to be valid.
  void take_outcome(RunRow& row, const std::map<std::string, double>& values) const {
    const double number = at(values, "status");
    const auto status = statuses_.find(std::isfinite(number) ? std::int64_t(number) : -1);
    const std::string words = status == statuses_.end() ? "" : status->second;
    const auto& ours = arena_statuses();
    const auto known = std::find_if(ours.begin(), ours.end(), [&](const ArenaStatus& each) {
      return *each.outcome != '\0' && words == each.description;
    });
    if (at(values, "solved") == 1) {
      const bool is_approximate = at(values, "approximate_solution") == 1;
      const bool is_wrong = at(values, "correct_solution") == 0;
      row.outcome = is_approximate ? "no_route" : is_wrong ? "rejected" : "solved";
      row.message = is_approximate ? "Approximate solution" : is_wrong ? "Invalid solution" : "";
    } else {
      const bool is_of_ends = words == "Invalid start" || words == "Invalid goal";
      row.outcome = is_of_ends ? "invalid_problem"
                    : known == ours.end() || std::string_view(known->outcome) == "solved"
                        ? "no_route"
                        : known->outcome;
      row.message = words;
    }
  }

  void take_values(RunRow& row, const std::map<std::string, double>& values) const {
    row.values.assign(data_.columns.size(), kNoValue);
    for (std::size_t n = 0; n < columns_.size(); ++n) {
      const double value = at(values, columns_[n].c_str());
      row.values[data_.column(names_[n])] =
          in_12_digits(columns_[n] == "solution_segments" ? value + 1 : value);
    }
    row.values[data_.column("solved")] = row.solved() ? 1 : 0;
    if (const double best = at(values, "best_cost"); std::isfinite(best)) {
      row.values[data_.column("cost")] = in_12_digits(best);
    }
  }

  StudyData& data_;
  fs::path file_;
  std::size_t store_;
  Sqlite database_;
  std::map<std::int64_t, std::size_t> scenarios_;  // by the experiment's id
  std::map<std::int64_t, std::size_t> pipelines_;  // by the planner's id
  std::map<std::int64_t, std::int64_t> seeds_;     // by the experiment's id
  std::map<std::int64_t, std::string> statuses_;
  std::vector<std::string> columns_;  // of numbers, in the table of runs
  std::vector<std::string> names_;    // of the values that they are, and "cost"
};
}  // namespace

bool is_arena(const fs::path& file) {
  try {
    if (!fs::is_regular_file(file)) {
      return false;
    }
    const Sqlite database(file, SQLITE_OPEN_READONLY);
    Statement identity = database.prepare("PRAGMA application_id");
    Statement tables = database.prepare(
        "SELECT count(*) FROM sqlite_master WHERE type = 'table' AND name IN "
        "('experiments', 'plannerConfigs', 'enums', 'runs')");
    return identity.step() && identity.integer(0) != kApplicationId && tables.step() &&
           tables.integer(0) == 4;
  } catch (const std::exception&) {
    return false;  // who opens it as a store says why it is none
  }
}

std::function<std::string(const RunRow&)> add_arena(StudyData& data, const fs::path& file) {
  ArenaReader reader(data, file);
  reader.read();
  const auto traces = std::make_shared<const std::map<std::int64_t, std::string>>(reader.traces());
  return [traces](const RunRow& row) {
    const auto found = traces->find(row.id);
    return found == traces->end() ? std::string() : found->second;
  };
}
}  // namespace altiplan::study
