// SPDX-License-Identifier: Apache-2.0
#include "text_file.hpp"

#include <rapidjson/memorystream.h>
#include <rapidjson/reader.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "altiplan/error.hpp"

namespace altiplan::formats {
namespace {

using Json = nlohmann::json;
using namespace nlohmann::literals;

constexpr std::size_t kMaxDepth = 64;

/// Builds the value from what RapidJSON reads, which takes half as long as the value's own library,
/// and refuses what that passes over: a key given twice, of which it keeps the last, and nesting so
/// deep that printing or freeing would overflow the stack.
class Builder : public rapidjson::BaseReaderHandler<rapidjson::UTF8<>, Builder> {
 public:
  using Where = std::function<std::string()>;
  /// `where` begins messages: "file:LINE:COLUMN: " of what is read.
  Builder(Where where, const OnItem& on_item) : where_(std::move(where)), on_item_(on_item) {}
  Json take() { return std::move(root_); }

  bool Null() { return put(nullptr); }
  bool Bool(bool value) { return put(value); }
  bool String(const char* text, std::size_t length, bool /*copy*/) {
    return is_unicode({text, length}) && put(std::string(text, length));
  }
  bool StartObject() { return open(Json::object()); }
  bool StartArray() { return open(Json::array()); }
  bool EndObject(std::size_t /*size*/) { return close(); }
  bool EndArray(std::size_t /*size*/) { return close(); }

  bool Key(const char* text, std::size_t length, bool /*copy*/) {
    if (!is_unicode({text, length})) {
      return false;
    }
    const auto [member, is_new] =
        open_.back()->get_ref<Json::object_t&>().try_emplace(std::string(text, length));
    if (!is_new) {
      throw Error(where_() + "the key \"" + member->first + "\" is given twice in one object");
    }
    last_ = &member->second;
    if (open_.size() == 1) {
      key_ = member->first;
    }
    return true;
  }

  /// Whole where it is written so and fits, else the nearest double.
  bool RawNumber(const char* text, std::size_t length, bool /*copy*/) {
    const char* const end = text + length;
    const auto is_read_as = [&](auto number) {
      const auto [last, problem] = std::from_chars(text, end, number);
      const bool fits = problem == std::errc() && last == end;
      return fits && put(number);
    };
    if ((*text == '-' ? is_read_as(std::int64_t{}) : is_read_as(std::uint64_t{})) ||
        is_read_as(double{})) {
      return true;
    }
    const double number = std::strtod(text, nullptr);  // too small, or too large
    return std::isfinite(number) ? put(number) : refuse_large();
  }
  bool refuse_large() const {
    throw Error(where_() + "contains a number that is too large (beyond 1.8e308)");
  }

 private:
  /// False if it holds half of a surrogate pair, which RapidJSON accepts as an escape.
  static bool is_unicode(std::string_view text) {
    for (auto at = text.find('\xED'); at != text.npos; at = text.find('\xED', at + 1)) {
      if (at + 1 < text.size() && static_cast<unsigned char>(text[at + 1]) >= 0xA0) {
        return false;
      }
    }
    return true;
  }

  template <class Value>
  bool put(Value&& value) {
    if (!open_.empty() && open_.back()->is_array()) {
      auto& list = open_.back()->get_ref<Json::array_t&>();
      last_ = &list.emplace_back(std::forward<Value>(value));
    } else {
      *last_ = std::forward<Value>(value);  // a member, or the whole
    }
    return true;
  }
  bool open(Json&& value) {
    if (open_.size() == kMaxDepth) {
      throw Error(where_() + "lists and objects are nested more than " + std::to_string(kMaxDepth) +
                  " levels deep");
    }
    put(std::move(value));
    open_.push_back(last_);
    return true;
  }
  bool close() {
    open_.pop_back();
    if (on_item_ && open_.size() == 2 && open_[0]->is_object() && open_[1]->is_array()) {
      on_item_(key_, open_[1]->back());
    }
    return true;
  }

  const Where where_;
  const OnItem& on_item_;
  std::string key_;  ///< of the document's member that is read
  Json root_;
  Json* last_ = &root_;      ///< where the next value goes, outside of lists
  std::vector<Json*> open_;  ///< lists and objects, the innermost last
};
}  // namespace

std::size_t line_at(const std::string& text, std::size_t offset) {
  const auto end = text.begin() + std::ptrdiff_t(std::min(offset, text.size()));
  return 1 + std::size_t(std::count(text.begin(), end, '\n'));
}

Json parse_json(const std::string& file, const std::string& text, const OnItem& on_item) {
  const auto where = [&](std::size_t offset) {
    const std::size_t begin = offset == 0 ? 0 : text.rfind('\n', offset - 1) + 1;
    const auto is_character = [](char byte) {
      return (byte & 0xC0) != 0x80;
    };  // its first of UTF-8
    const auto column = std::count_if(text.begin() + std::ptrdiff_t(begin),
                                      text.begin() + std::ptrdiff_t(offset), is_character);
    return file + ":" + std::to_string(line_at(text, offset)) + ":" + std::to_string(column + 1) +
           ": ";
  };
  if (const auto at = text.find('\0'); at != text.npos) {  // the parser would take it for the end
    throw Error(where(at) + "expected JSON, found a byte of value 0");
  }
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  const std::size_t begin = text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0;
  rapidjson::MemoryStream stream(text.data() + begin, text.size() - begin);
  Builder builder([&] { return where(begin + stream.Tell()); }, on_item);
  rapidjson::Reader reader;
  if (reader
          .Parse<rapidjson::kParseIterativeFlag | rapidjson::kParseNumbersAsStringsFlag |
                 rapidjson::kParseValidateEncodingFlag>(stream, builder)
          .IsError()) {
    if (reader.GetParseErrorCode() == rapidjson::kParseErrorNumberTooBig) {
      builder.refuse_large();
    }
    throw Error(where(begin + reader.GetErrorOffset()) +
                "is not valid JSON: it ends early or has an error here");
  }
  return builder.take();
}

void expect_wgs84(const Json& document) {
  if (!document.is_object() || !document.contains("crs") || document["crs"].is_null()) {
    return;
  }
  const Json& given = document["crs"];
  const auto name = "/properties/name"_json_pointer;
  const std::string crs = short_text(given.contains(name) ? given.at(name) : given);
  if (crs.find("CRS84") == std::string::npos && crs.find("4326") == std::string::npos) {
    throw Error("crs: expected longitude and latitude of WGS 84 (CRS84), found " + crs);
  }
}

std::string short_text(const Json& value) {
  const std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  return text.size() > 40 ? text.substr(0, 40) + "…" : text;
}
}  // namespace altiplan::formats
