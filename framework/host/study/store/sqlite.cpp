// SPDX-License-Identifier: Apache-2.0
#include "host/study/store/sqlite.hpp"

#include <cmath>

#include "altiplan/error.hpp"

namespace altiplan::host {
namespace {

/// SQLite's own words for what users meet say little.
std::string meaning(int code, const char* words) {
  switch (code & 0xff) {
    case SQLITE_FULL:
      return "the disk is full; what was written before is intact";
    case SQLITE_READONLY:
      return "it is read-only";
    case SQLITE_CANTOPEN:
      return "it cannot be opened: is there such a file, and may it be read?";
    case SQLITE_NOTADB:
      return "it is no database";
    case SQLITE_CORRUPT:
      return std::string("it is damaged (") + words + ")";
    case SQLITE_BUSY:
      return "another program is writing to it";
    case SQLITE_IOERR:
      return std::string("it cannot be read or written (") + words + "): is the disk full?";
    default:
      return words;
  }
}

[[noreturn]] void fail(const std::filesystem::path& file, int code, const char* words) {
  throw Error("the database '" + file.string() + "': " + meaning(code, words));
}
}  // namespace

Statement::Statement(sqlite3* database, const std::filesystem::path& file, const char* sql)
    : database_(database), file_(file) {
  sqlite3_stmt* statement = nullptr;
  expect(sqlite3_prepare_v2(database, sql, -1, &statement, nullptr));
  statement_.reset(statement);
}

void Statement::expect(int code) const {
  if (code != SQLITE_OK && code != SQLITE_ROW && code != SQLITE_DONE) {
    fail(file_, code, sqlite3_errmsg(database_));
  }
}

Statement& Statement::bind(int index, std::string_view text) {
  expect(
      sqlite3_bind_text(statement_.get(), index, text.data(), int(text.size()), SQLITE_TRANSIENT));
  return *this;
}

Statement& Statement::bind(int index, std::int64_t value) {
  expect(sqlite3_bind_int64(statement_.get(), index, value));
  return *this;
}

Statement& Statement::bind(int index, double value) {
  expect(std::isnan(value) ? sqlite3_bind_null(statement_.get(), index)
                           : sqlite3_bind_double(statement_.get(), index, value));
  return *this;
}

Statement& Statement::bind_blob(int index, std::string_view bytes) {
  expect(
      sqlite3_bind_blob64(statement_.get(), index, bytes.data(), bytes.size(), SQLITE_TRANSIENT));
  return *this;
}

Statement& Statement::bind_null(int index) {
  expect(sqlite3_bind_null(statement_.get(), index));
  return *this;
}

bool Statement::step() {
  const int code = sqlite3_step(statement_.get());
  expect(code);
  return code == SQLITE_ROW;
}

void Statement::run() {
  step();
  reset();
}

std::string Statement::text(int column) const { return std::string(blob(column)); }

std::string_view Statement::blob(int column) const {
  const void* bytes = sqlite3_column_blob(statement_.get(), column);
  const int size = sqlite3_column_bytes(statement_.get(), column);
  return bytes == nullptr ? std::string_view()
                          : std::string_view(static_cast<const char*>(bytes), std::size_t(size));
}

Sqlite::Sqlite(const std::filesystem::path& file, int flags) : file_(file) {
  sqlite3* database = nullptr;
  const int code = sqlite3_open_v2(file.c_str(), &database, flags, nullptr);
  database_.reset(database);
  if (code != SQLITE_OK) {
    fail(file, code, database == nullptr ? "out of memory" : sqlite3_errmsg(database));
  }
  sqlite3_busy_timeout(database, 10000);  // a report that reads while a study writes
}

void Sqlite::run(const char* sql) const {
  const int code = sqlite3_exec(database_.get(), sql, nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) {
    fail(file_, code, sqlite3_errmsg(database_.get()));
  }
}

Transaction::Transaction(const Sqlite& database) : database_(database) {
  database_.run("BEGIN IMMEDIATE");
}

Transaction::~Transaction() {
  if (open_) {
    try {
      database_.run("ROLLBACK");
    } catch (const Error&) {
      // SQLite has rolled back by itself, or does when the file is opened next.
    }
  }
}

void Transaction::commit() {
  database_.run("COMMIT");
  open_ = false;
}
}  // namespace altiplan::host
