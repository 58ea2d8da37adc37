// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sqlite3.h>

#include <concepts>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace altiplan::study {

/// Bytes that are no text.
struct Blob {
  std::string_view bytes;
};

/// A prepared statement. Bind, then step; call `reset` before reuse.
class Statement {
 public:
  Statement(sqlite3* database, const std::filesystem::path& file, const std::string& sql);

  /// Sets the parameters from the first on, each to a text, a number or a Blob.
  template <class... Values>
  Statement& bind(const Values&... values) {
    int index = 0;
    (set(++index, values), ...);
    return *this;
  }
  void set(int index, std::string_view text);
  void set(int index, std::int64_t value);
  void set(int index, std::integral auto value) { set(index, std::int64_t(value)); }
  void set(int index, double value);  ///< NaN becomes NULL
  void set(int index, Blob blob);

  /// True if there is a row. Throws Error naming the file.
  bool step();
  /// Executes a statement without rows, with these parameters if there are any, and resets it.
  template <class... Values>
  void run(const Values&... values) {
    bind(values...).step();
    reset();
  }
  void reset() { sqlite3_reset(statement_.get()); }

  std::string text(int column) const;
  std::string_view blob(int column) const;  ///< valid until the next step
  // SQLite accepts any type in any column, and reads text as 0: these throw Error instead.
  std::int64_t integer(int column) const;
  int count(int column) const;      ///< 0 to 2147483647
  double number(int column) const;  ///< 0 for NULL
  bool is_null(int column) const;

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
  };
  void expect(int code) const;
  [[noreturn]] void fail_type(int column, const char* expected) const;

  sqlite3* database_;
  std::filesystem::path file_;
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

/// A database file. Throws Error naming the file.
class Sqlite {
 public:
  /// `flags` as for sqlite3_open_v2. The name is always a file, even if it looks like `:memory:`.
  Sqlite(const std::filesystem::path& file, int flags);

  Statement prepare(const std::string& sql) const { return {database_.get(), file_, sql}; }
  /// One or several statements without rows.
  void run(const std::string& sql) const;
  const std::filesystem::path& file() const { return file_; }

 private:
  struct Close {
    void operator()(sqlite3* database) const { sqlite3_close(database); }
  };
  void open(int flags);
  std::filesystem::path file_;
  std::unique_ptr<sqlite3, Close> database_;
};

/// A transaction, rolled back unless `commit` is called.
class Transaction {
 public:
  explicit Transaction(const Sqlite& database);
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit();

 private:
  const Sqlite& database_;
  bool open_ = true;
};
}  // namespace altiplan::study
