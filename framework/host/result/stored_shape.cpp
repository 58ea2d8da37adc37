// SPDX-License-Identifier: Apache-2.0
#include "host/result/stored_shape.hpp"

#include <array>
#include <limits>
#include <span>

#include "altiplan/error.hpp"
#include "host/base/run_status.hpp"

namespace altiplan::host {
namespace {

constexpr unsigned kText = 1;
constexpr unsigned kNumber = 2;
constexpr unsigned kTruth = 4;
constexpr unsigned kList = 8;
constexpr unsigned kObject = 16;
constexpr unsigned kNull = 32;
constexpr unsigned kStatus = 64;
constexpr unsigned kSeed = 128;

struct Key {
  const char* name;
  unsigned kinds;  ///< the kinds allowed
};

constexpr Key kResult[] = {
    {"pipeline", kText},
    {"scenario", kText},
    {"files", kList},
    {"overrides", kObject},
    {"seed", kSeed},
    {"status", kStatus},
    {"message", kText},
    {"steps", kList},
    {"route", kList | kNull},
    {"legs", kList | kNull},
    {"metrics", kObject},
    {"check", kObject | kNull},
    {"flight", kObject | kNull},
    {"trace", kText | kNull},
    {"folder", kText},
    {"cost", kNumber | kNull},
    {"bound", kNumber | kNull},
    {"reference", kNumber},
    {"task", kObject},
};
constexpr Key kFile[] = {{"path", kText}, {"sha256", kText}};
constexpr Key kStep[] = {
    {"id", kText},
    {"verb", kText},
    {"plugin", kText},
    {"instead_of", kText | kNull},
    {"accepted", kTruth},
    {"status", kStatus},
    {"message", kText},
    {"first_route_s", kNumber},
    {"route", kList | kNull},
    {"legs", kList | kNull},
    {"metrics", kObject | kNull},
    {"check", kObject | kNull},
    {"cost", kNumber | kNull},
    {"bound", kNumber | kNull},
    {"returns", kObject | kNull},
};
constexpr Key kFlight[] = {
    {"status", kStatus},
    {"message", kText},
    {"link", kText | kNull},
    {"metrics", kObject},
    {"check", kObject},
    {"collisions", kNumber},
    {"min_separation_m", kNumber | kNull},
    {"reached", kTruth},
    {"handovers", kList},
    {"replans", kList},
    {"track", kList},
    {"cross_track_max_m", kNumber | kNull},
    {"cross_track_p999_m", kNumber | kNull},
    {"height_error_max_m", kNumber | kNull},
};

std::string status_words() {
  std::string words;
  for (int status = 0; status <= int(RunStatus::not_reached); ++status) {
    words += (words.empty() ? "" : ", ") + std::string(name(RunStatus(status)));
  }
  return words;
}

bool is_status(const Json& value) {
  for (int status = 0; status <= int(RunStatus::not_reached); ++status) {
    if (value == name(RunStatus(status))) {
      return true;
    }
  }
  return false;
}

bool is_seed(const Json& value) {
  return value.is_number_unsigned()
             ? value.get<std::uint64_t>() <= std::uint64_t(std::numeric_limits<std::int64_t>::max())
             : value.is_number_integer() && value.get<std::int64_t>() >= 0;
}

struct KindOf {
  unsigned kind;
  bool (*is)(const Json&);
  std::string words;
};

/// The kinds in words: "a list or null".
const std::array<KindOf, 8>& all_kinds() {
  static const std::array<KindOf, 8> kAll{{
      {kText, [](const Json& v) { return v.is_string(); }, "text"},
      {kNumber, [](const Json& v) { return v.is_number(); }, "a number"},
      {kTruth, [](const Json& v) { return v.is_boolean(); }, "true or false"},
      {kList, [](const Json& v) { return v.is_array(); }, "a list"},
      {kObject, [](const Json& v) { return v.is_object(); }, "an object"},
      {kStatus, &is_status, "one of " + status_words()},
      {kSeed, &is_seed, "a whole number from 0 to 9223372036854775807"},
      {kNull, [](const Json& v) { return v.is_null(); }, "null"},
  }};
  return kAll;
}

void expect_kinds(const Json& value, unsigned kinds, const std::string& place) {
  std::string expected;
  for (const KindOf& kind : all_kinds()) {
    if ((kinds & kind.kind) != 0) {
      if (kind.is(value)) {
        return;
      }
      expected += (expected.empty() ? "" : " or ") + kind.words;
    }
  }
  throw Error(place + ": expected " + expected + ", found " + found_text(value));
}

void expect_keys(const Json& object, std::span<const Key> keys, const std::string& place) {
  expect_kinds(object, kObject, place);
  for (const Key& key : keys) {
    if (const auto found = object.find(key.name); found != object.end()) {
      expect_kinds(*found, key.kinds, place + (place.ends_with(": ") ? "" : ".") + key.name);
    }
  }
}

void expect_each(const Json& result, const char* list, std::span<const Key> keys,
                 const std::string& file) {
  if (!result.contains(list)) {
    return;
  }
  std::size_t n = 0;
  for (const Json& item : result.at(list)) {
    if (item.is_object() && item.contains("stands")) {
      throw Error(file + ": " + list + "." + std::to_string(n) +
                  ".stands: is now 'accepted': an earlier version wrote this, run it again");
    }
    expect_keys(item, keys, file + ": " + list + "." + std::to_string(n++));
  }
}
}  // namespace

std::string found_text(const Json& value) {
  if (value.is_structured()) {  // which may be nested too deeply to print
    return value.is_array() ? "a list of " + std::to_string(value.size()) : "an object";
  }
  return excerpt(json_text(value));
}

void expect_shape(const Json& result, const std::string& file) {
  expect_keys(result, kResult, file + ": ");
  if (result.contains("overrides") && result.at("overrides").contains("set")) {
    const Json& set = result.at("overrides").at("set");
    expect_kinds(set, kObject | kList, file + ": overrides.set");
    for (const auto& [key, value] : set.items()) {
      expect_kinds(value, kText, file + ": overrides.set." + key);
    }
  }
  expect_each(result, "files", kFile, file);
  expect_each(result, "steps", kStep, file);
  if (result.contains("flight") && !result.at("flight").is_null()) {
    expect_keys(result.at("flight"), kFlight, file + ": flight");
  }
}
}  // namespace altiplan::host
