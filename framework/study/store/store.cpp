// SPDX-License-Identifier: Apache-2.0
#include "study/store/store.hpp"

#include "host/base/deflate.hpp"
#include "study/store/store_database.hpp"

namespace altiplan::study {
namespace {

/// Fast compression, so that runs do not wait; JSON still shrinks to a fifth.
constexpr int kLevel = 1;

std::string packed(const std::string& text) {
  return text.empty() ? "" : host::compressed(text, kLevel);
}
}  // namespace

Store::Store(const std::filesystem::path& file, StoreMode mode)
    : database_(std::make_unique<StoreDatabase>(file, mode)) {}

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
    insert.run(name, value);
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
  insert
      .bind(session.started, session.command, session.version, session.host, session.system,
            session.cpu, session.cores, session.memory_mb, session.jobs, session.reuse,
            session.limits)
      .step();
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
                   rows.text(5), rows.text(6), rows.count(7), rows.number(8), rows.count(9),
                   rows.count(10), rows.text(11)});
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
    insert.bind(run.key, run.scenario, run.pipeline, run.repetition, run.seed, run.outcome,
                run.message, run.wall_time_s, run.cpu_time_s, run.peak_memory_mb, run.place,
                run.session);
    const bool is_new = insert.step();
    const std::int64_t id = is_new ? insert.integer(0) : 0;
    insert.reset();
    if (!is_new) {
      continue;
    }
    result.run(id, Blob{packed(run.result)}, Blob{packed(run.trace)});
    for (const auto& [name, number] : run.values) {
      quantity.run(name);
      value.run(id, name, number);
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
  Statement rows = database_->outlines("ORDER BY scenario, pipeline, repetition, key");
  while (rows.step()) {
    all.push_back(database_->outline(rows));
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
  Statement row = database_->outlines("WHERE runs.id = ?");
  row.bind(id);
  return database_->whole_run(row);
}

std::optional<StoredRun> Store::run(std::string_view key) const {
  Statement row = database_->outlines("WHERE key = ?");
  row.bind(key);
  return database_->whole_run(row);
}

std::string Store::trace(std::int64_t id) const {
  // Most stores have none: the length shows that without unpacking a result.
  Statement row = database_->sqlite.prepare("SELECT length(trace) FROM results WHERE run = ?");
  row.bind(id);
  const auto whole = row.step() && row.integer(0) > 0 ? run(id) : std::nullopt;
  return whole ? whole->trace : "";
}

void Store::remove(const std::vector<std::string>& keys) {
  Transaction transaction(database_->sqlite);
  Statement statement = database_->sqlite.prepare("DELETE FROM runs WHERE key = ?");
  for (const std::string& key : keys) {
    statement.run(key);
  }
  transaction.commit();
}

const std::filesystem::path& Store::file() const { return database_->sqlite.file(); }
}  // namespace altiplan::study
