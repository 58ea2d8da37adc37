// SPDX-License-Identifier: Apache-2.0
#include "study/store/place.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "altiplan/error.hpp"
#include "altiplan/formats/input_file.hpp"
#include "host/base/machine_fault.hpp"

namespace altiplan::study {
namespace {

namespace fs = std::filesystem;

enum class Kind { absent, empty, store, database, other };

/// The first bytes, fewer if the file is shorter.
std::string head_of(const fs::path& file) {
  constexpr std::size_t kHeader = 100;  // of a database, by SQLite's file format
  formats::InputFile in(file.string());
  std::string head(kHeader, '\0');
  in.read(head.data(), std::streamsize(kHeader));
  head.resize(std::size_t(in.gcount()));
  return head;
}

/// Four bytes, big-endian.
std::uint32_t word_at(const std::string& head, std::size_t at) {
  std::uint32_t word = 0;
  for (std::size_t n = 0; n < 4 && at + n < head.size(); ++n) {
    word = word << 8 | std::uint8_t(head[at + n]);
  }
  return word;
}

Kind kind_of(const fs::path& file) {
  expect_regular_or_absent(file);
  if (!host::is_there(file)) {
    return Kind::absent;
  }
  constexpr std::size_t kIdAt = 68;
  const std::string head = head_of(file);
  if (head.empty()) {
    return Kind::empty;
  }
  if (!head.starts_with(std::string("SQLite format 3\0", 16))) {
    return Kind::other;
  }
  return word_at(head, kIdAt) == kApplicationId ? Kind::store : Kind::database;
}

/// By its first word: a rollback journal (zeros if finished) or a write-ahead log.
bool is_of_sqlite(const fs::path& journal) {
  if (!fs::is_regular_file(host::link_status_of(journal))) {
    return false;
  }
  const std::string head = head_of(journal);
  const std::uint32_t word = word_at(head, 0);
  return head.empty() || (head.size() >= 4 && (word == 0 || word == 0xd9d505f9U ||
                                               word == 0x377f0682U || word == 0x377f0683U));
}

void remove_file(const fs::path& file) {
  std::error_code error;
  fs::remove(file, error);
  if (error) {
    throw Error("cannot remove '" + file.string() + "': " + error.message());
  }
}

/// Creates an empty file that did not exist.
fs::path new_file_in(const fs::path& folder) {
  constexpr int kTries = 1000;
  for (int n = 0; n < kTries; ++n) {
    const fs::path file =
        folder / (".altiplan-new-" + std::to_string(::getpid()) + "-" + std::to_string(n));
    const int opened = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (opened >= 0) {
      ::close(opened);
      return file;
    }
    if (errno != EEXIST) {
      break;
    }
  }
  throw Error("cannot write into the folder '" + folder.string() + "': " + std::strerror(errno));
}
}  // namespace

fs::path place_of(const fs::path& file) {
  constexpr int kMaxLinks = 40;
  std::error_code error;
  fs::path place = fs::absolute(file);
  for (int n = 0; n < kMaxLinks && fs::is_symlink(host::link_status_of(place)); ++n) {
    const fs::path target = fs::read_symlink(place, error);
    place = place.parent_path() / target;  // only the target if it is absolute
  }
  const fs::path canonical = fs::weakly_canonical(place, error);
  return error ? place : canonical;
}

fs::path work_folder_of(const fs::path& store) { return place_of(store).string() + ".work"; }

void expect_regular_or_absent(const fs::path& file) {
  const fs::file_status status = host::status_of(file);
  if (fs::is_directory(status)) {
    throw Error("'" + file.string() + "' is a folder, expected a database");
  }
  if (fs::is_other(status)) {
    throw Error("'" + file.string() + "' is a pipe or a device, expected a database");
  }
}

void remove_store(const fs::path& file) {
  const Kind kind = kind_of(file);
  if (kind == Kind::database || kind == Kind::other) {
    throw Error(
        "'" + file.string() + "' is not removed: it is " +
        (kind == Kind::database ? "a database, but not of altiplan study" : "not a database"));
  }
  const fs::path place = place_of(file);
  remove_journal(place);
  remove_file(place);
}

void expect_replaceable(const fs::path& file) {
  const Kind kind = kind_of(file);
  if (kind == Kind::store || kind == Kind::other) {
    throw Error("'" + file.string() + "' is not replaced: it is " +
                (kind == Kind::store ? "a database of altiplan study" : "not a database"));
  }
}

void remove_journal(const fs::path& database) {
  for (const char* suffix : {"-journal", "-wal"}) {
    const fs::path journal = place_of(database).string() + suffix;
    if (!fs::exists(host::link_status_of(journal))) {
      continue;
    }
    if (!is_of_sqlite(journal)) {
      throw Error("'" + journal.string() + "' would be read by SQLite as the journal of '" +
                  database.string() + "', but is not a journal: move it away");
    }
    remove_file(journal);
  }
}

NewDatabase::NewDatabase(const fs::path& place) : place_(place_of(place)) {
  const auto lock = host::uninterrupted();
  file_ = new_file_in(place_.parent_path());
  unfinished_.emplace([file = file_.string()] {
    for (const char* suffix : {"", "-journal"}) {
      std::error_code ignored;
      fs::remove(file + suffix, ignored);
    }
  });
  std::error_code ignored;
  const fs::file_status status = host::status_of(place_);
  if (fs::exists(status)) {
    fs::permissions(file_, status.permissions(), ignored);
  }
}

void NewDatabase::put_in_place() {
  const auto lock = host::uninterrupted();
  remove_journal(place_);
  std::error_code error;
  fs::rename(file_, place_, error);
  if (error) {
    throw Error("cannot write '" + place_.string() + "': " + error.message());
  }
}
}  // namespace altiplan::study
