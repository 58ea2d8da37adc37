// SPDX-License-Identifier: Apache-2.0
#include "host/study/store/store.hpp"

#include <nlohmann/json.hpp>

#include "altiplan/error.hpp"
#include "host/output/deflate.hpp"
#include "host/study/store/sqlite.hpp"

namespace altiplan::host {
namespace {

using Json = nlohmann::ordered_json;

// "altp": by it `file`, and this program, tell a store from other databases.
constexpr std::int64_t kApplicationId = 0x616c7470;
constexpr std::int64_t kVersion = 1;
/// A run is not kept waiting for its result to be packed; JSON shrinks to a fifth all the same.
constexpr int kLevel = 1;

constexpr const char* kSchema = R"sql(
  CREATE TABLE study(name TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
  CREATE TABLE scenarios(id INTEGER PRIMARY KEY, name TEXT NOT NULL UNIQUE, of TEXT NOT NULL,
    file TEXT NOT NULL, overrides TEXT NOT NULL);
  CREATE TABLE pipelines(id INTEGER PRIMARY KEY, name TEXT NOT NULL UNIQUE, of TEXT NOT NULL,
    file TEXT NOT NULL, overrides TEXT NOT NULL);
  CREATE TABLE sessions(id INTEGER PRIMARY KEY, started TEXT NOT NULL, command TEXT NOT NULL,
    version TEXT NOT NULL, host TEXT NOT NULL, system TEXT NOT NULL, cpu TEXT NOT NULL,
    cores INTEGER NOT NULL, memory_mb REAL NOT NULL, jobs INTEGER NOT NULL,
    reuse INTEGER NOT NULL, limits TEXT NOT NULL);
  CREATE TABLE runs(id INTEGER PRIMARY KEY, key TEXT NOT NULL UNIQUE,
    scenario INTEGER NOT NULL REFERENCES scenarios(id),
    pipeline INTEGER NOT NULL REFERENCES pipelines(id),
    repetition INTEGER NOT NULL, seed INTEGER NOT NULL, outcome TEXT NOT NULL,
    message TEXT NOT NULL, wall_time_s REAL, cpu_time_s REAL, peak_memory_mb REAL,
    place INTEGER NOT NULL, session INTEGER NOT NULL REFERENCES sessions(id));
  CREATE TABLE results(run INTEGER PRIMARY KEY REFERENCES runs(id) ON DELETE CASCADE,
    result BLOB, trace BLOB);
  CREATE TABLE quantities(id INTEGER PRIMARY KEY, name TEXT NOT NULL UNIQUE);
  CREATE TABLE run_values(run INTEGER NOT NULL REFERENCES runs(id) ON DELETE CASCADE,
    quantity INTEGER NOT NULL REFERENCES quantities(id), value REAL NOT NULL,
    PRIMARY KEY(run, quantity)) WITHOUT ROWID;
)sql";

constexpr const char* kRun =
    "SELECT runs.id, key, scenarios.name, pipelines.name, repetition, seed, outcome, message, "
    "wall_time_s, cpu_time_s, peak_memory_mb, place, session FROM runs "
    "JOIN scenarios ON scenarios.id = scenario JOIN pipelines ON pipelines.id = pipeline ";

std::int64_t pragma(const Sqlite& database, const char* sql) {
  Statement statement = database.prepare(sql);
  return statement.step() ? statement.integer(0) : 0;
}

StoredRun run_of(const Statement& row) {
  StoredRun run;
  run.id = row.integer(0);
  run.key = row.text(1);
  run.scenario = row.text(2);
  run.pipeline = row.text(3);
  run.repetition = int(row.integer(4));
  run.seed = row.integer(5);
  run.outcome = row.text(6);
  run.message = row.text(7);
  run.wall_time_s = row.number(8);
  run.cpu_time_s = row.number(9);
  run.peak_memory_mb = row.number(10);
  run.place = int(row.integer(11));
  run.session = row.integer(12);
  return run;
}
}  // namespace

struct Store::Database {
  Sqlite sqlite;

  Database(const std::filesystem::path& file, StoreMode mode)
      : sqlite(file, mode == StoreMode::read ? SQLITE_OPEN_READONLY
                                             : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE) {}

  /// A file that was cut off or is another program's is found here, and not in the middle.
  void expect_store() const {
    const std::int64_t id = pragma(sqlite, "PRAGMA application_id");
    const std::int64_t version = pragma(sqlite, "PRAGMA user_version");
    if (id != kApplicationId) {
      throw Error("'" + sqlite.file().string() + "' is a database, but not of altiplan study");
    }
    if (version != kVersion) {
      throw Error("'" + sqlite.file().string() + "' is of version " + std::to_string(version) +
                  " of the store; this program knows version " + std::to_string(kVersion));
    }
  }

  void create() const {
    Transaction transaction(sqlite);
    sqlite.run(("PRAGMA application_id = " + std::to_string(kApplicationId)).c_str());
    sqlite.run(("PRAGMA user_version = " + std::to_string(kVersion)).c_str());
    sqlite.run(kSchema);
    transaction.commit();
  }

  void add_variants(const char* table, const std::vector<StoredVariant>& variants) const {
    Statement insert = sqlite.prepare(
        (std::string("INSERT INTO ") + table +
         "(name, of, file, overrides) VALUES(?, ?, ?, ?) ON CONFLICT(name) DO UPDATE SET "
         "of = excluded.of, file = excluded.file, overrides = excluded.overrides")
            .c_str());
    for (const StoredVariant& variant : variants) {
      insert.bind(1, variant.name).bind(2, variant.of).bind(3, variant.file);
      insert.bind(4, std::string_view(Json(variant.set).dump())).run();
    }
  }

  std::vector<StoredVariant> variants(const char* table) const {
    std::vector<StoredVariant> all;
    Statement rows = sqlite.prepare(
        (std::string("SELECT name, of, file, overrides FROM ") + table + " ORDER BY id").c_str());
    while (rows.step()) {
      StoredVariant variant{rows.text(0), rows.text(1), rows.text(2), {}};
      try {
        variant.set = Json::parse(rows.blob(3)).get<std::vector<std::string>>();
      } catch (const Json::exception&) {
        throw Error("the database '" + sqlite.file().string() + "': the overrides of '" +
                    variant.name + "' are no list of texts");
      }
      all.push_back(std::move(variant));
    }
    return all;
  }

  void read_values(StoredRun& run, Statement& values) const {
    values.bind(1, run.id);
    while (values.step()) {
      run.values.emplace_back(values.text(0), values.number(1));
    }
    values.reset();
  }

  Statement values_of_run() const {
    return sqlite.prepare(
        "SELECT name, value FROM run_values JOIN quantities ON quantities.id = quantity "
        "WHERE run = ? ORDER BY name");
  }

  std::optional<StoredRun> whole_run(Statement& row) const {
    if (!row.step()) {
      return std::nullopt;
    }
    StoredRun run = run_of(row);
    Statement values = values_of_run();
    read_values(run, values);
    Statement result = sqlite.prepare("SELECT result, trace FROM results WHERE run = ?");
    result.bind(1, run.id);
    if (result.step()) {
      run.result = result.blob(0).empty() ? "" : decompressed(result.blob(0));
      run.trace = result.blob(1).empty() ? "" : decompressed(result.blob(1));
    }
    return run;
  }
};

Store::Store(const std::filesystem::path& file, StoreMode mode)
    : database_(std::make_unique<Database>(file, mode)) {
  const Sqlite& sqlite = database_->sqlite;
  const bool is_new = mode == StoreMode::write && pragma(sqlite, "PRAGMA schema_version") == 0 &&
                      pragma(sqlite, "PRAGMA page_count") == 0;
  if (is_new) {
    database_->create();
  }
  database_->expect_store();
  sqlite.run("PRAGMA foreign_keys = ON");
}

Store::~Store() = default;

std::map<std::string, std::string> Store::study() const {
  std::map<std::string, std::string> all;
  Statement rows = database_->sqlite.prepare("SELECT name, value FROM study");
  while (rows.step()) {
    all[rows.text(0)] = rows.text(1);
  }
  return all;
}

void Store::set_study(const std::map<std::string, std::string>& study) {
  Transaction transaction(database_->sqlite);
  Statement insert = database_->sqlite.prepare("INSERT OR REPLACE INTO study VALUES(?, ?)");
  for (const auto& [name, value] : study) {
    insert.bind(1, name).bind(2, value).run();
  }
  transaction.commit();
}

void Store::add_variants(const std::vector<StoredVariant>& scenarios,
                         const std::vector<StoredVariant>& pipelines) {
  Transaction transaction(database_->sqlite);
  database_->add_variants("scenarios", scenarios);
  database_->add_variants("pipelines", pipelines);
  transaction.commit();
}

std::vector<StoredVariant> Store::scenarios() const { return database_->variants("scenarios"); }

std::vector<StoredVariant> Store::pipelines() const { return database_->variants("pipelines"); }

std::int64_t Store::add_session(const StoredSession& session) {
  Transaction transaction(database_->sqlite);
  Statement insert = database_->sqlite.prepare(
      "INSERT INTO sessions(started, command, version, host, system, cpu, cores, memory_mb, jobs, "
      "reuse, limits) VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?) RETURNING id");
  insert.bind(1, session.started).bind(2, session.command).bind(3, session.version);
  insert.bind(4, session.host).bind(5, session.system).bind(6, session.cpu);
  insert.bind(7, std::int64_t(session.cores)).bind(8, session.memory_mb);
  insert.bind(9, std::int64_t(session.jobs)).bind(10, std::int64_t(session.reuse));
  insert.bind(11, session.limits).step();
  const std::int64_t id = insert.integer(0);
  insert.reset();
  transaction.commit();
  return id;
}

std::vector<StoredSession> Store::sessions() const {
  std::vector<StoredSession> all;
  Statement rows = database_->sqlite.prepare(
      "SELECT id, started, command, version, host, system, cpu, cores, memory_mb, jobs, reuse, "
      "limits FROM sessions ORDER BY id");
  while (rows.step()) {
    all.push_back({rows.integer(0), rows.text(1), rows.text(2), rows.text(3), rows.text(4),
                   rows.text(5), rows.text(6), int(rows.integer(7)), rows.number(8),
                   int(rows.integer(9)), int(rows.integer(10)), rows.text(11)});
  }
  return all;
}

void Store::add(const std::vector<StoredRun>& runs) {
  const Sqlite& sqlite = database_->sqlite;
  Transaction transaction(sqlite);
  Statement insert = sqlite.prepare(
      "INSERT INTO runs(key, scenario, pipeline, repetition, seed, outcome, message, wall_time_s, "
      "cpu_time_s, peak_memory_mb, place, session) VALUES(?, (SELECT id FROM scenarios WHERE name "
      "= ?), (SELECT id FROM pipelines WHERE name = ?), ?, ?, ?, ?, ?, ?, ?, ?, ?) "
      "ON CONFLICT(key) DO NOTHING RETURNING id");
  Statement result = sqlite.prepare("INSERT INTO results VALUES(?, ?, ?)");
  Statement quantity = sqlite.prepare("INSERT OR IGNORE INTO quantities(name) VALUES(?)");
  Statement value = sqlite.prepare(
      "INSERT INTO run_values VALUES(?, (SELECT id FROM quantities WHERE name = ?), ?)");
  for (const StoredRun& run : runs) {
    insert.bind(1, run.key).bind(2, run.scenario).bind(3, run.pipeline);
    insert.bind(4, std::int64_t(run.repetition)).bind(5, run.seed).bind(6, run.outcome);
    insert.bind(7, run.message).bind(8, run.wall_time_s).bind(9, run.cpu_time_s);
    insert.bind(10, run.peak_memory_mb).bind(11, std::int64_t(run.place)).bind(12, run.session);
    const bool is_new = insert.step();
    const std::int64_t id = is_new ? insert.integer(0) : 0;
    insert.reset();
    if (!is_new) {
      continue;
    }
    result.bind(1, id).bind_blob(2, run.result.empty() ? "" : compressed(run.result, kLevel));
    result.bind_blob(3, run.trace.empty() ? "" : compressed(run.trace, kLevel)).run();
    for (const auto& [name, number] : run.values) {
      quantity.bind(1, name).run();
      value.bind(1, id).bind(2, name).bind(3, number).run();
    }
  }
  transaction.commit();
}

std::vector<std::string> Store::keys() const {
  std::vector<std::string> all;
  Statement rows = database_->sqlite.prepare("SELECT key FROM runs");
  while (rows.step()) {
    all.push_back(rows.text(0));
  }
  return all;
}

std::vector<StoredRun> Store::outlines() const {
  std::vector<StoredRun> all;
  Statement rows = database_->sqlite.prepare(
      (std::string(kRun) + "ORDER BY scenario, pipeline, repetition, key").c_str());
  while (rows.step()) {
    all.push_back(run_of(rows));
  }
  return all;
}

std::vector<StoredRun> Store::runs() const {
  std::vector<StoredRun> all = outlines();
  Statement values = database_->values_of_run();
  for (StoredRun& run : all) {
    database_->read_values(run, values);
  }
  return all;
}

std::optional<StoredRun> Store::run(std::int64_t id) const {
  Statement row = database_->sqlite.prepare((std::string(kRun) + "WHERE runs.id = ?").c_str());
  row.bind(1, id);
  return database_->whole_run(row);
}

std::optional<StoredRun> Store::run(std::string_view key) const {
  Statement row = database_->sqlite.prepare((std::string(kRun) + "WHERE key = ?").c_str());
  row.bind(1, key);
  return database_->whole_run(row);
}

void Store::remove(const std::vector<std::string>& keys) {
  Transaction transaction(database_->sqlite);
  Statement statement = database_->sqlite.prepare("DELETE FROM runs WHERE key = ?");
  for (const std::string& key : keys) {
    statement.bind(1, key).run();
  }
  transaction.commit();
}

const std::filesystem::path& Store::file() const { return database_->sqlite.file(); }
}  // namespace altiplan::host
