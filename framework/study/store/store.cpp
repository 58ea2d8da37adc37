// SPDX-License-Identifier: Apache-2.0
#include "study/store/store.hpp"

#include "host/base/deflate.hpp"
#include "study/store/store_database.hpp"

namespace altiplan::study {
namespace {

/// Fast compression, so that runs do not wait; JSON still shrinks to a fifth.
constexpr int kLevel = 1;
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
    result.bind(1, id).bind_blob(2, run.result.empty() ? "" : host::compressed(run.result, kLevel));
    result.bind_blob(3, run.trace.empty() ? "" : host::compressed(run.trace, kLevel)).run();
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
  row.bind(1, id);
  return database_->whole_run(row);
}

std::optional<StoredRun> Store::run(std::string_view key) const {
  Statement row = database_->outlines("WHERE key = ?");
  row.bind(1, key);
  return database_->whole_run(row);
}

std::string Store::trace(std::int64_t id) const {
  // Most stores have none: the length shows that without unpacking a result.
  Statement row = database_->sqlite.prepare("SELECT length(trace) FROM results WHERE run = ?");
  row.bind(1, id);
  const auto whole = row.step() && row.integer(0) > 0 ? run(id) : std::nullopt;
  return whole ? whole->trace : "";
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
}  // namespace altiplan::study
