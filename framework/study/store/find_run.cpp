// SPDX-License-Identifier: Apache-2.0
#include "study/store/find_run.hpp"

#include <charconv>

#include "altiplan/error.hpp"

namespace altiplan::study {
namespace {

constexpr std::size_t kShortestKey = 4;

std::optional<std::int64_t> id_of(const std::string& text) {
  std::int64_t id = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), id);
  const bool whole = error == std::errc() && stop == text.data() + text.size();
  return whole ? std::optional(id) : std::nullopt;
}

[[noreturn]] void fail_none(const Store& store, const std::vector<StoredRun>& runs,
                            const std::string& named) {
  if (runs.empty()) {
    throw Error("'" + store.file().string() + "' contains no runs yet");
  }
  std::vector<std::string> names;
  for (const StoredRun& run : runs) {
    names.push_back(run_name(run));
  }
  const std::string nearest = nearest_name(named, names);
  throw Error("'" + store.file().string() + "' has no run " + excerpt(named) +
              ": expected its id, its key or a prefix of it (" + std::to_string(kShortestKey) +
              " characters or more), or its name, such as '" +
              (nearest.empty() ? names.front() : nearest) + "'");
}

[[noreturn]] void fail_many(const Store& store, const std::vector<StoredRun>& found,
                            const std::string& named) {
  std::string keys;
  for (const StoredRun& run : found) {
    keys += (keys.empty() ? "" : ", ") + run.key.substr(0, 12);
  }
  throw Error("'" + store.file().string() + "' has " + std::to_string(found.size()) + " runs " +
              excerpt(named) + ": name one by its key: " + keys);
}
}  // namespace

StoredRun find_run(const Store& store, const std::string& named) {
  if (const auto id = id_of(named)) {
    if (auto run = store.run(*id)) {
      return *run;
    }
  }
  const std::vector<StoredRun> runs = store.runs();
  std::vector<StoredRun> found;
  for (const StoredRun& run : runs) {
    const bool by_key = named.size() >= kShortestKey && run.key.starts_with(named);
    if (by_key || run_name(run) == named) {
      found.push_back(run);
    }
  }
  if (found.empty()) {
    fail_none(store, runs, named);
  }
  if (found.size() > 1) {
    fail_many(store, found, named);
  }
  return *store.run(found.front().id);
}
}  // namespace altiplan::study
