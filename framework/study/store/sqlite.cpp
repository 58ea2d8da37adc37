// SPDX-License-Identifier: Apache-2.0
#include "study/store/sqlite.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <limits>

#include "altiplan/error.hpp"
#include "altiplan/formats/descriptor.hpp"
#include "host/base/machine_fault.hpp"
#include "study/store/place.hpp"

namespace altiplan::study {
namespace {

/// SQLite does not keep the system's error of a COMMIT; a full disk it reports itself.
int system_error(int code, sqlite3* database) {
  const int error = sqlite3_system_errno(database);
  rlimit limit{};
  const bool is_limited = ::getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
  return error == 0 && code == SQLITE_IOERR_WRITE && is_limited ? EFBIG : error;
}

/// The system's error message, or else SQLite's.
std::string cause(int error, const char* words) {
  return error != 0 ? std::strerror(error) : words;
}

/// The error of writing to the file, 0 if it is writable. Checked without opening the file, since
/// closing it would release this process's locks.
int write_error(const std::filesystem::path& file) {
  const std::filesystem::path folder = place_of(file).parent_path();
  return ::access(file.c_str(), W_OK) != 0 || ::access(folder.c_str(), W_OK) != 0 ? errno : 0;
}

/// When the system refuses write access, SQLite silently continues read-only and keeps no error.
std::string why_read_only(const std::filesystem::path& file) {
  const int error = write_error(file);
  return std::strerror(error != 0 ? error : EACCES);
}

/// Explains SQLite's errors, whose own messages say little. `error` is the system's.
std::string meaning(const std::filesystem::path& file, int code, int error, const char* words) {
  if (code == SQLITE_READONLY_ROLLBACK) {
    return "a program was killed while writing it, and SQLite needs write access to the file and "
           "its folder to roll back: have their owner open it, or copy the file together with its "
           "-journal";
  }
  if (code == SQLITE_READONLY_DBMOVED) {
    // SQLite treats an inaccessible file as a missing one, and keeps no reason.
    return "it was removed or renamed while this program wrote to it, or the system did not show "
           "it";
  }
  switch (code & 0xff) {
    case SQLITE_FULL:
      return "the disk is full; what was written before is intact";
    case SQLITE_READONLY:
      return "it cannot be written to: " + why_read_only(file);
    case SQLITE_CANTOPEN:
      if (error == ENOENT && host::is_there(file)) {
        return "its journal cannot be created";  // the reason is lost: SQLite then tries to read it
      }
      return "it cannot be opened: " + (error == 0 ? "is its path longer than 500 bytes?"
                                                   : std::string(std::strerror(error)));
    case SQLITE_NOTADB:
      return "it is not a database";
    case SQLITE_CORRUPT:
      // SQLite reports the same for a file that the system refuses to read.
      return std::string("it is damaged, or cannot be read (") + words + ")";
    case SQLITE_BUSY:
      return "another program is writing to it";
    case SQLITE_IOERR:
      return "it cannot be read or written (" + cause(error, words) +
             (error == EFBIG ? "): see ulimit -f" : "): is the disk full?");
    default:
      return words;
  }
}

[[noreturn]] void fail(const std::filesystem::path& file, int code, sqlite3* database) {
  const int error = database == nullptr ? 0 : system_error(code, database);
  const char* words = database == nullptr ? "out of memory" : sqlite3_errmsg(database);
  throw Error("the database '" + file.string() + "': " + meaning(file, code, error, words));
}
}  // namespace

Statement::Statement(sqlite3* database, const std::filesystem::path& file, const std::string& sql)
    : database_(database), file_(file) {
  sqlite3_stmt* statement = nullptr;
  expect(sqlite3_prepare_v2(database, sql.c_str(), -1, &statement, nullptr));
  statement_.reset(statement);
}

void Statement::expect(int code) const {
  if (code != SQLITE_OK && code != SQLITE_ROW && code != SQLITE_DONE) {
    fail(file_, code, database_);
  }
}

void Statement::set(int index, std::string_view text) {
  expect(
      sqlite3_bind_text(statement_.get(), index, text.data(), int(text.size()), SQLITE_TRANSIENT));
}

void Statement::set(int index, std::int64_t value) {
  expect(sqlite3_bind_int64(statement_.get(), index, value));
}

void Statement::set(int index, double value) {
  expect(std::isnan(value) ? sqlite3_bind_null(statement_.get(), index)
                           : sqlite3_bind_double(statement_.get(), index, value));
}

void Statement::set(int index, Blob blob) {
  const auto& [bytes] = blob;
  expect(
      sqlite3_bind_blob64(statement_.get(), index, bytes.data(), bytes.size(), SQLITE_TRANSIENT));
}

bool Statement::step() {
  const int code = sqlite3_step(statement_.get());
  expect(code);
  return code == SQLITE_ROW;
}

std::string Statement::text(int column) const { return std::string(blob(column)); }

std::string_view Statement::blob(int column) const {
  const void* bytes = sqlite3_column_blob(statement_.get(), column);
  const int size = sqlite3_column_bytes(statement_.get(), column);
  return bytes == nullptr ? std::string_view()
                          : std::string_view(static_cast<const char*>(bytes), std::size_t(size));
}

std::int64_t Statement::integer(int column) const {
  if (sqlite3_column_type(statement_.get(), column) != SQLITE_INTEGER) {
    fail_type(column, "a whole number");
  }
  return sqlite3_column_int64(statement_.get(), column);
}

int Statement::count(int column) const {
  const std::int64_t value = integer(column);
  if (value < 0 || value > std::numeric_limits<int>::max()) {
    fail_type(column, "a number from 0 to 2147483647");
  }
  return int(value);
}

double Statement::number(int column) const {
  const int type = sqlite3_column_type(statement_.get(), column);
  if (type == SQLITE_TEXT || type == SQLITE_BLOB) {
    fail_type(column, "a number");
  }
  return sqlite3_column_double(statement_.get(), column);
}

bool Statement::is_null(int column) const {
  return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL;
}

void Statement::fail_type(int column, const char* expected) const {
  throw Error("the database '" + file_.string() + "': it is damaged: '" +
              sqlite3_column_name(statement_.get(), column) + "' is " + excerpt(text(column)) +
              ", expected " + expected);
}

Sqlite::Sqlite(const std::filesystem::path& file, int flags) : file_(file) {
  expect_regular_or_absent(file);
  open(flags);
  const bool refused =
      (flags & SQLITE_OPEN_READWRITE) != 0 && sqlite3_db_readonly(database_.get(), "main") == 1;
  if (refused && write_error(file) == 0) {
    open(flags);  // the cause in the system has passed
  }
  sqlite3_extended_result_codes(database_.get(), 1);
  sqlite3_busy_timeout(database_.get(), 10000);  // a report that reads while a study writes
}

void Sqlite::open(int flags) {
  sqlite3* database = nullptr;
  const int code =
      sqlite3_open_v2(std::filesystem::absolute(file_).c_str(), &database, flags, nullptr);
  database_.reset(database);
  if (code != SQLITE_OK) {
    fail(file_, code, database);
  }
}

void Sqlite::run(const std::string& sql) const {
  const int code = sqlite3_exec(database_.get(), sql.c_str(), nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) {
    fail(file_, code, database_.get());
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
      // SQLite has rolled back itself, or does so when the file is next opened.
    }
  }
}

void Transaction::commit() {
  database_.run("COMMIT");
  open_ = false;
}
}  // namespace altiplan::study
