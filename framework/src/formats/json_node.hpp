// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "mission_parts.hpp"
#include "text_file.hpp"

namespace altiplan::formats {

/// A value of the file and its position there ("mission.items.3"), which error messages name.
class JsonNode {
 public:
  JsonNode(const nlohmann::json& json, std::string place)
      : json_(&json), place_(std::move(place)) {}

  const std::string& place() const { return place_; }
  const nlohmann::json& json() const { return *json_; }
  [[noreturn]] void wrong(const std::string& expected) const {
    throw Error((place_.empty() ? "" : place_ + ": ") + "expected " + expected + ", found " +
                short_text(*json_));
  }
  bool has(const char* key) const { return json_->is_object() && json_->contains(key); }
  JsonNode at(const char* key) const {
    if (!json_->is_object()) {
      wrong("an object");
    }
    const auto value = json_->find(key);
    if (value == json_->end()) {
      throw Error((place_.empty() ? "" : place_ + ": ") + "the key '" + key + "' is missing");
    }
    return {*value, place_.empty() ? key : place_ + "." + key};
  }
  JsonNode at(std::size_t n) const { return {(*json_)[n], place_ + "." + std::to_string(n)}; }
  std::size_t size() const {
    if (!json_->is_array()) {
      wrong("a list");
    }
    return json_->size();
  }
  double number() const {
    if (!json_->is_number()) {
      wrong("a number");
    }
    return json_->get<double>();
  }
  /// QGroundControl writes NaN as null.
  double number_or_nan() const {
    return json_->is_null() ? std::numeric_limits<double>::quiet_NaN() : number();
  }
  int whole(int maximum) const {
    if (!json_->is_number_integer() || number() < 0 || number() > maximum) {
      wrong("a whole number from 0 to " + std::to_string(maximum));
    }
    return json_->get<int>();
  }
  bool boolean() const {
    if (!json_->is_boolean()) {
      wrong("true or false");
    }
    return json_->get<bool>();
  }
  std::string text() const {
    if (!json_->is_string()) {
      wrong("text");
    }
    return json_->get<std::string>();
  }
  void expect_version(int minimum, int maximum) const {
    const int version = whole(1'000'000);
    if (version < minimum || version > maximum) {
      wrong("version " + std::to_string(maximum));
    }
  }
  /// [latitude, longitude]
  Point2 place_on_earth() const {
    if (size() < 2) {
      wrong("[latitude, longitude]");
    }
    const Point2 p{at(1).number(), at(std::size_t{0}).number()};
    told([&] { expect_position(p[0], p[1]); });
    return p;
  }
  /// Runs a check that does not know the position.
  template <class Check>
  void told(const Check& check) const {
    try {
      check();
    } catch (const Error& error) {
      throw Error(place_ + ": " + error.what());
    }
  }

 private:
  const nlohmann::json* json_;
  std::string place_;
};
}  // namespace altiplan::formats
