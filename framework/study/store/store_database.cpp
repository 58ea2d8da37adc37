// SPDX-License-Identifier: Apache-2.0
#include "study/store/store_database.hpp"

#include "altiplan/error.hpp"
#include "host/base/deflate.hpp"
#include "host/base/json.hpp"
#include "host/base/machine_fault.hpp"
#include "study/store/place.hpp"

namespace altiplan::study {
namespace {

namespace fs = std::filesystem;
using host::Json;

constexpr std::int64_t kVersion = 2;
/// Limit of an unpacked result or trace (bytes), since a few kB of zeros expand to a gigabyte.
constexpr std::size_t kMaxBytes = std::size_t(1) << 30;
/// Limit of a result's nesting, since comparison is recursive.
constexpr int kMaxLevels = 500;

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
    "LEFT JOIN scenarios ON scenarios.id = scenario "
    "LEFT JOIN pipelines ON pipelines.id = pipeline ";

std::int64_t pragma(const Sqlite& database, const char* sql) {
  Statement statement = database.prepare(sql);
  return statement.step() ? statement.integer(0) : 0;
}

/// True if lists and objects are nested deeper than kMaxLevels.
bool is_too_deep(std::string_view json) {
  int level = 0;
  bool is_text = false;
  for (std::size_t n = 0; n < json.size(); ++n) {
    const char letter = json[n];
    if (letter == '"') {
      is_text = !is_text;
    } else if (is_text) {
      n += letter == '\\' ? 1 : 0;
    } else if (letter == '[' || letter == '{') {
      if (++level > kMaxLevels) {
        return true;
      }
    } else if (letter == ']' || letter == '}') {
      --level;
    }
  }
  return false;
}

StoredRun run_of(const Statement& row) {
  StoredRun run;
  run.id = row.integer(0);
  run.key = row.text(1);
  run.scenario = row.text(2);
  run.pipeline = row.text(3);
  run.repetition = row.count(4);
  run.seed = row.integer(5);
  run.outcome = row.text(6);
  run.message = row.text(7);
  run.wall_time_s = row.number(8);
  run.cpu_time_s = row.number(9);
  run.peak_memory_mb = row.number(10);
  run.place = row.count(11);
  run.session = row.integer(12);
  return run;
}

/// A process killed while writing leaves a journal, with which SQLite rolls back; a read-only
/// process must not.
void undo_half_a_write(const fs::path& file) {
  if (host::is_there(place_of(file).string() + "-journal") && host::is_there(file)) {
    pragma(Sqlite(file, SQLITE_OPEN_READWRITE), "PRAGMA schema_version");
  }
}

Sqlite opened(const fs::path& file, StoreMode mode) {
  if (mode == StoreMode::read) {
    undo_half_a_write(file);
    return {file, SQLITE_OPEN_READONLY};
  }
  if (!host::is_there(file) ||
      fs::is_empty(file)) {  // otherwise its journal may be needed to restore it
    remove_journal(file);
  }
  return {file, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE};
}
}  // namespace

StoreDatabase::StoreDatabase(const fs::path& file, StoreMode mode)
    : sqlite(opened(file, mode)),
      lock_(mode == StoreMode::write ? std::make_unique<StoreLock>(file) : nullptr) {
  if (mode == StoreMode::write && is_new()) {
    try {
      create();
    } catch (...) {  // disk full: leave no empty file
      std::error_code ignored;
      if (fs::file_size(file, ignored) == 0) {
        fs::remove(place_of(file), ignored);
      }
      throw;
    }
  }
  expect_store();
  sqlite.run("PRAGMA foreign_keys = ON");
}

bool StoreDatabase::is_new() const {
  const std::int64_t version =
      pragma(sqlite, "PRAGMA schema_version");  // rolls back an incomplete write
  return version == 0 && fs::file_size(sqlite.file()) == 0;
}

void StoreDatabase::fail_damaged(const std::string& why) const {
  throw Error("'" + sqlite.file().string() + "' is damaged: " + why);
}

void StoreDatabase::expect_store() const {
  if (is_new()) {
    throw Error("'" + sqlite.file().string() + "' is empty: no results have been stored yet");
  }
  const std::int64_t id = pragma(sqlite, "PRAGMA application_id");
  const std::int64_t version = pragma(sqlite, "PRAGMA user_version");
  if (pragma(sqlite, "PRAGMA page_count") == 0) {
    throw Error("the database '" + sqlite.file().string() + "': it is not a database");
  }
  if (id != kApplicationId) {
    throw Error("'" + sqlite.file().string() + "' is a database, but not of altiplan study");
  }
  if (version != kVersion) {
    throw Error("'" + sqlite.file().string() + "' is of version " + std::to_string(version) +
                " of the store; this program supports version " + std::to_string(kVersion) +
                ": run the study again with another --out, or use the program of that version");
  }
  expect_tables();
}

void StoreDatabase::expect_tables() const {
  Statement strange = sqlite.prepare(
      "SELECT type, name FROM sqlite_master WHERE type = 'trigger' OR (type = 'view' AND name IN "
      "('study', 'scenarios', 'pipelines', 'sessions', 'runs', 'results', 'quantities', "
      "'run_values'))");
  if (strange.step()) {
    fail_damaged("it has a " + strange.text(0) + " " + excerpt(strange.text(1)) +
                 ", which altiplan study never creates");
  }
}

void StoreDatabase::create() const {
  Transaction transaction(sqlite);
  sqlite.run("PRAGMA application_id = " + std::to_string(kApplicationId));
  sqlite.run("PRAGMA user_version = " + std::to_string(kVersion));
  sqlite.run(kSchema);
  transaction.commit();
}

void StoreDatabase::add_variants(const char* table,
                                 const std::vector<StoredVariant>& variants) const {
  Statement insert = sqlite.prepare(
      std::string("INSERT INTO ") + table +
      "(name, of, file, overrides) VALUES(?, ?, ?, ?) ON CONFLICT(name) DO UPDATE SET "
      "of = excluded.of, file = excluded.file, overrides = excluded.overrides");
  for (const StoredVariant& variant : variants) {
    insert.run(variant.name, variant.of, variant.file, host::exact_json_text(variant.set));
  }
}

std::vector<StoredVariant> StoreDatabase::variants(const char* table) const {
  std::vector<StoredVariant> all;
  Statement rows = sqlite.prepare(std::string("SELECT name, of, file, overrides FROM ") + table +
                                  " ORDER BY id");
  while (rows.step()) {
    StoredVariant variant{rows.text(0), rows.text(1), rows.text(2), {}};
    try {
      variant.set = host::parse_json(rows.blob(3)).get<std::vector<std::string>>();
    } catch (const Json::exception&) {
      throw Error("the database '" + sqlite.file().string() + "': the overrides of '" +
                  variant.name + "' are not a list of strings");
    }
    all.push_back(std::move(variant));
  }
  return all;
}

void StoreDatabase::read_values(StoredRun& run, Statement& values) const {
  values.bind(run.id);
  while (values.step()) {
    if (values.is_null(0)) {
      fail_damaged("a value of the run " + run.key + " has no name");
    }
    run.values.emplace_back(values.text(0), values.number(1));
  }
  values.reset();
}

Statement StoreDatabase::values_of_run() const {
  return sqlite.prepare(
      "SELECT name, value FROM run_values LEFT JOIN quantities ON quantities.id = quantity "
      "WHERE run = ? ORDER BY name");
}

Statement StoreDatabase::outlines(const std::string& rest) const {
  return sqlite.prepare(kRun + rest);
}

StoredRun StoreDatabase::outline(const Statement& row) const {
  if (row.is_null(2) || row.is_null(3)) {
    fail_damaged("the " + std::string(row.is_null(2) ? "scenario" : "pipeline") + " of the run " +
                 row.text(1) + " is not stored");
  }
  return run_of(row);
}

std::string StoreDatabase::unpacked(const StoredRun& run, const char* what,
                                    std::string_view bytes) const {
  if (bytes.empty()) {
    return "";
  }
  const std::string name = std::string("the ") + what + " of '" + run_name(run) + "' ";
  std::optional<std::string> text;
  try {
    text = host::decompressed(bytes, kMaxBytes);
  } catch (const Error&) {
    fail_damaged(name + "cannot be unpacked");
  }
  if (!text) {
    fail_damaged(name + "is larger than 1 GB unpacked, the limit");
  }
  if (is_too_deep(*text)) {
    fail_damaged(name + "is nested deeper than " + std::to_string(kMaxLevels) + " levels");
  }
  return *std::move(text);
}

std::optional<StoredRun> StoreDatabase::whole_run(Statement& row) const {
  if (!row.step()) {
    return std::nullopt;
  }
  StoredRun run = outline(row);
  Statement values = values_of_run();
  read_values(run, values);
  Statement result = sqlite.prepare("SELECT result, trace FROM results WHERE run = ?");
  result.bind(run.id);
  if (result.step()) {
    run.result = unpacked(run, "result", result.blob(0));
    run.trace = unpacked(run, "trace", result.blob(1));
  }
  return run;
}
}  // namespace altiplan::study
