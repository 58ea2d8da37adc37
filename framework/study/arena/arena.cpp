// SPDX-License-Identifier: Apache-2.0
#include "study/arena/arena.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "altiplan/error.hpp"
#include "host/result/result_json.hpp"
#include "study/arena/arena_columns.hpp"
#include "study/model/progress.hpp"
#include "study/store/place.hpp"
#include "study/store/sqlite.hpp"
#include "study/store/store.hpp"

namespace altiplan::study {
namespace {

namespace fs = std::filesystem;

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

std::string quoted(const std::string& name) { return "\"" + name + "\""; }

/// A line per key, as OMPL prints settings.
std::string settings(const StoredVariant& variant) {
  std::string text = "file = " + variant.file + "\n";
  for (const std::string& assignment : variant.set) {
    const std::size_t equals = assignment.find('=');
    text += assignment.substr(0, equals) + " = " +
            (equals == assignment.npos ? "" : assignment.substr(equals + 1)) + "\n";
  }
  return text;
}

class ArenaWriter {
 public:
  ArenaWriter(const StudyData& data, const fs::path& file)
      : data_(data),
        database_(file, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE),
        columns_(arena_columns(data, names_)),
        experiments_(arena_experiments(data, names_)) {}

  void write() {
    Transaction transaction(database_);
    create();
    add_experiments();
    add_planners();
    add_statuses();
    add_runs();
    add_progress();
    transaction.commit();
  }

 private:
  void create() const {
    std::string parameters;
    for (const ArenaParameter& parameter : experiments_.parameters) {
      parameters += ", " + quoted(parameter.column) + (parameter.numbers ? " REAL" : " TEXT");
    }
    std::string columns;
    for (const ArenaColumn& column : columns_) {
      columns += ", " + quoted(column.name) + " " + column.type;
    }
    database_.run(R"(
      CREATE TABLE experiments(id INTEGER PRIMARY KEY AUTOINCREMENT, name VARCHAR(512),
        totaltime REAL, timelimit REAL, memorylimit REAL, runcount INTEGER, version VARCHAR(128),
        hostname VARCHAR(1024), cpuinfo TEXT, date DATETIME, seed VARCHAR(24), setup TEXT)" +
                  parameters + R"();
      CREATE TABLE plannerConfigs(id INTEGER PRIMARY KEY AUTOINCREMENT, name VARCHAR(512) NOT NULL,
        settings TEXT);
      CREATE TABLE enums(name VARCHAR(512), value INTEGER, description TEXT,
        PRIMARY KEY(name, value));
      CREATE TABLE runs(id INTEGER PRIMARY KEY AUTOINCREMENT, experimentid INTEGER,
        plannerid INTEGER)" +
                  columns + R"(,
        FOREIGN KEY(experimentid) REFERENCES experiments(id) ON DELETE CASCADE,
        FOREIGN KEY(plannerid) REFERENCES plannerConfigs(id) ON DELETE CASCADE);
      CREATE TABLE progress(runid INTEGER, time REAL, iterations INTEGER, evaluations INTEGER,
        best_cost REAL, PRIMARY KEY(runid, time),
        FOREIGN KEY(runid) REFERENCES runs(id) ON DELETE CASCADE);)");
    // OMPL's: for each planner the settings that solve most, then the fastest.
    database_.run(R"(
      CREATE VIEW bestPlannerConfigsPerExperiment AS
        SELECT plannerid, experimentid, MAX(avg_solved) AS avg_solved, avg_total_time FROM
          (SELECT plannerid, plannerConfigs.name AS planner, experimentid,
            AVG(solved) AS avg_solved, AVG(time) AS avg_total_time FROM runs
            JOIN plannerConfigs ON plannerConfigs.id = plannerid GROUP BY plannerid, experimentid)
        GROUP BY planner, experimentid ORDER BY avg_solved DESC, avg_total_time ASC;
      CREATE VIEW bestPlannerConfigs AS
        SELECT plannerid, MAX(avg_solved) AS avg_solved, avg_total_time FROM
          (SELECT plannerid, plannerConfigs.name AS planner,
            AVG(solved) AS avg_solved, AVG(time) AS avg_total_time FROM runs
            JOIN plannerConfigs ON plannerConfigs.id = plannerid GROUP BY plannerid)
        GROUP BY planner ORDER BY avg_solved DESC, avg_total_time ASC;)");
  }

  /// For a row with these columns, and as many more.
  Statement insertion(const std::string& table, std::size_t columns, std::size_t more = 0) const {
    std::string sql = "INSERT INTO " + table + " VALUES(?";
    for (std::size_t n = 1; n < columns + more; ++n) {
      sql += ", ?";
    }
    return database_.prepare(sql + ")");
  }

  double number(const RunRow& row, const std::string& column) const {
    const std::size_t n = data_.column(column);
    return n < row.values.size() ? row.values[n] : kNothing;
  }

  void add_experiments() const {
    constexpr int kColumns = 12;
    Statement insert = insertion("experiments", kColumns, experiments_.parameters.size());
    std::vector<double> seconds(data_.scenarios.size(), 0);
    std::vector<std::int64_t> repetitions(data_.scenarios.size(), 0);
    for (const RunRow& row : data_.rows) {
      const double wall = number(row, "wall_time_s");
      seconds[row.scenario] += wall > 0 ? wall : 0;
      repetitions[row.scenario] =
          std::max(repetitions[row.scenario], std::int64_t(row.repetition) + 1);
    }
    const StoredSession session = data_.sessions.empty() ? StoredSession() : data_.sessions.back();
    std::string date = session.started.substr(0, 19);  // 2026-11-21T18:00:00Z
    std::replace(date.begin(), date.end(), 'T', ' ');
    const StudyBudget& budget = data_.file.budget;
    for (std::size_t n = 0; n < data_.scenarios.size(); ++n) {
      const ArenaExperiment& experiment = experiments_.experiments[n];
      insert.bind(n + 1, experiment.name, seconds[n], budget.time_s.value_or(budget.wall_s),
                  budget.memory_mb, repetitions[n], "altiplan " + session.version, session.host,
                  session.cpu + "\n" + std::to_string(session.cores) + " cores\n", date,
                  std::to_string(data_.file.seed), settings(data_.scenarios[n]));
      for (int column = kColumns; const std::string& value : experiment.parameters) {
        // The column's type converts a numeric text to a number.
        value.empty() ? insert.set(++column, kNothing) : insert.set(++column, value);
      }
      insert.run();
    }
  }

  /// "step = plan astar (route)" for each step, of the first run that solved.
  std::string steps_of(std::size_t pipeline) const {
    const auto row = std::find_if(data_.rows.begin(), data_.rows.end(), [&](const RunRow& one) {
      return one.pipeline == pipeline && one.solved();
    });
    if (row == data_.rows.end()) {
      return "";
    }
    const auto run = Store(data_.stores[row->store], StoreMode::read).run(row->id);
    const host::Json json = run ? host::json_or_discarded(run->result) : host::Json();
    std::string text;
    for (const host::Json& step :
         json.is_object() ? json.value("steps", host::Json::array()) : host::Json()) {
      if (step.value("instead_of", host::Json()).is_null()) {
        text += "step = " + step.value("verb", "") + " " + step.value("plugin", "") + " (" +
                step.value("id", "") + ")\n";
      }
    }
    return text;
  }

  void add_planners() const {
    Statement insert = insertion("plannerConfigs", 3);
    for (std::size_t n = 0; n < data_.pipelines.size(); ++n) {
      // Planner Arena removes these words of OMPL from names, which could merge two of ours.
      std::string name = data_.pipelines[n].name;
      for (const char* word : {"geometric_", "control_"}) {
        const std::size_t at = name.find(word);
        if (at != name.npos) {
          name.replace(at + std::string_view(word).size() - 1, 1, "-");
        }
      }
      insert.run(n + 1, name, settings(data_.pipelines[n]) + steps_of(n));
    }
  }

  void add_statuses() const {
    Statement insert = insertion("enums", 3);
    for (const ArenaStatus& status : arena_statuses()) {
      insert.run("status", status.value, status.description);
    }
  }

  void add_runs() const {
    Statement insert = insertion("runs", 3, columns_.size());
    for (std::size_t n = 0; n < data_.rows.size(); ++n) {
      const RunRow& row = data_.rows[n];
      insert.bind(n + 1, row.scenario + 1, row.pipeline + 1);
      for (int index = 3; const ArenaColumn& column : columns_) {
        insert.set(++index, cell(row, column));
      }
      insert.run();
    }
  }

  /// The iterations of the runs' traces; best_cost is null while there is no route.
  void add_progress() const {
    // Of two iterations at one time the later counts.
    Statement insert = database_.prepare("INSERT OR REPLACE INTO progress VALUES(?, ?, ?, ?, ?)");
    std::vector<std::unique_ptr<Store>> stores;
    for (const std::string& store : data_.stores) {
      stores.push_back(std::make_unique<Store>(store, StoreMode::read));
    }
    for (std::size_t n = 0; n < data_.rows.size(); ++n) {
      const RunRow& row = data_.rows[n];
      const std::vector<Progress> progress = progress_of(stores.at(row.store)->trace(row.id));
      for (const Iteration& iteration :
           progress.empty() ? std::vector<Iteration>() : progress.front().iterations) {
        if (std::isfinite(iteration.time_s)) {
          insert.run(n + 1, iteration.time_s, iteration.number, iteration.expanded,
                     std::isfinite(iteration.best) ? iteration.best : kNothing);
        }
      }
    }
  }

  double cell(const RunRow& row, const ArenaColumn& column) const {
    if (column.name == "status") {
      return arena_status(row.outcome);
    }
    if (column.name == "approximate_solution") {
      return 0;  // a route, if there is one, ends within the goal's tolerance
    }
    if (column.name == "correct_solution" || column.name == "solved") {
      return row.solved() ? 1 : 0;
    }
    const double number = column.value < row.values.size() ? row.values[column.value] : kNothing;
    return column.name == "solution_segments" ? number - 1 : number;
  }

  const StudyData& data_;
  Sqlite database_;
  ColumnNames names_;
  std::vector<ArenaColumn> columns_;
  ArenaExperiments experiments_;
};
}  // namespace

void write_arena(const StudyData& data, const std::filesystem::path& file) {
  expect_replaceable(file);
  NewDatabase unfinished(file);
  ArenaWriter(data, unfinished.file()).write();
  unfinished.put_in_place();
}
}  // namespace altiplan::study
