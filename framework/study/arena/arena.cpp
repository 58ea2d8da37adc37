// SPDX-License-Identifier: Apache-2.0
#include "study/arena/arena.hpp"

#include <algorithm>
#include <limits>

#include "altiplan/error.hpp"
#include "host/result/result_json.hpp"
#include "study/arena/arena_columns.hpp"
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
    const std::string schema =
        "CREATE TABLE experiments(id INTEGER PRIMARY KEY AUTOINCREMENT, name VARCHAR(512), "
        "totaltime REAL, timelimit REAL, memorylimit REAL, runcount INTEGER, version VARCHAR(128), "
        "hostname VARCHAR(1024), cpuinfo TEXT, date DATETIME, seed VARCHAR(24), setup TEXT" +
        parameters +
        ");"
        "CREATE TABLE plannerConfigs(id INTEGER PRIMARY KEY AUTOINCREMENT, name VARCHAR(512) NOT "
        "NULL, settings TEXT);"
        "CREATE TABLE enums(name VARCHAR(512), value INTEGER, description TEXT, PRIMARY KEY(name, "
        "value));"
        "CREATE TABLE runs(id INTEGER PRIMARY KEY AUTOINCREMENT, experimentid INTEGER, plannerid "
        "INTEGER" +
        columns +
        ", FOREIGN KEY(experimentid) REFERENCES experiments(id) ON DELETE CASCADE, "
        "FOREIGN KEY(plannerid) REFERENCES plannerConfigs(id) ON DELETE CASCADE);"
        "CREATE TABLE progress(runid INTEGER, time REAL, PRIMARY KEY(runid, time), FOREIGN "
        "KEY(runid) REFERENCES runs(id) ON DELETE CASCADE);"
        // OMPL's: for each planner the settings that solve most, then the fastest.
        "CREATE VIEW bestPlannerConfigsPerExperiment AS SELECT plannerid, experimentid, "
        "MAX(avg_solved) AS avg_solved, avg_total_time FROM (SELECT plannerid, "
        "plannerConfigs.name AS planner, experimentid, AVG(solved) AS avg_solved, AVG(time) AS "
        "avg_total_time FROM runs JOIN plannerConfigs ON plannerConfigs.id = plannerid GROUP BY "
        "plannerid, experimentid) GROUP BY planner, experimentid ORDER BY avg_solved DESC, "
        "avg_total_time ASC;"
        "CREATE VIEW bestPlannerConfigs AS SELECT plannerid, MAX(avg_solved) AS avg_solved, "
        "avg_total_time FROM (SELECT plannerid, plannerConfigs.name AS planner, AVG(solved) AS "
        "avg_solved, AVG(time) AS avg_total_time FROM runs JOIN plannerConfigs ON "
        "plannerConfigs.id = plannerid GROUP BY plannerid) GROUP BY planner ORDER BY avg_solved "
        "DESC, avg_total_time ASC;";
    database_.run(schema.c_str());
  }

  double number(const RunRow& row, const std::string& column) const {
    const std::size_t n = data_.column(column);
    return n < row.values.size() ? row.values[n] : kNothing;
  }

  void add_experiments() const {
    std::string sql = "INSERT INTO experiments VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?";
    for (std::size_t n = 0; n < experiments_.parameters.size(); ++n) {
      sql += ", ?";
    }
    Statement insert = database_.prepare((sql + ")").c_str());
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
      insert.bind(1, std::int64_t(n + 1)).bind(2, experiments_.experiments[n].name);
      insert.bind(3, seconds[n]).bind(4, budget.time_s.value_or(budget.wall_s));
      insert.bind(5, budget.memory_mb).bind(6, repetitions[n]);
      insert.bind(7, "altiplan " + session.version).bind(8, session.host);
      insert.bind(9, session.cpu + "\n" + std::to_string(session.cores) + " cores\n");
      insert.bind(10, date).bind(11, std::to_string(data_.file.seed));
      insert.bind(12, settings(data_.scenarios[n]));
      for (std::size_t p = 0; p < experiments_.parameters.size(); ++p) {
        const std::string& set = experiments_.experiments[n].parameters[p];
        // The column's type converts a numeric text to a number.
        set.empty() ? insert.bind_null(int(13 + p)) : insert.bind(int(13 + p), set);
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
    const host::Json json = run ? host::Json::parse(run->result, nullptr, false) : host::Json();
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
    Statement insert = database_.prepare("INSERT INTO plannerConfigs VALUES(?, ?, ?)");
    for (std::size_t n = 0; n < data_.pipelines.size(); ++n) {
      // Planner Arena removes these words of OMPL from names, which could merge two of ours.
      std::string name = data_.pipelines[n].name;
      for (const char* word : {"geometric_", "control_"}) {
        const std::size_t at = name.find(word);
        if (at != name.npos) {
          name.replace(at + std::string_view(word).size() - 1, 1, "-");
        }
      }
      insert.bind(1, std::int64_t(n + 1)).bind(2, name);
      insert.bind(3, settings(data_.pipelines[n]) + steps_of(n)).run();
    }
  }

  void add_statuses() const {
    Statement insert = database_.prepare("INSERT INTO enums VALUES('status', ?, ?)");
    for (const ArenaStatus& status : arena_statuses()) {
      insert.bind(1, std::int64_t(status.value)).bind(2, std::string_view(status.description));
      insert.run();
    }
  }

  void add_runs() const {
    std::string sql = "INSERT INTO runs VALUES(?, ?, ?";
    for (std::size_t n = 0; n < columns_.size(); ++n) {
      sql += ", ?";
    }
    Statement insert = database_.prepare((sql + ")").c_str());
    for (std::size_t n = 0; n < data_.rows.size(); ++n) {
      const RunRow& row = data_.rows[n];
      insert.bind(1, std::int64_t(n + 1)).bind(2, std::int64_t(row.scenario + 1));
      insert.bind(3, std::int64_t(row.pipeline + 1));
      for (std::size_t c = 0; c < columns_.size(); ++c) {
        insert.bind(int(4 + c), cell(row, columns_[c]));
      }
      insert.run();
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
