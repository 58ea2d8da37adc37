// SPDX-License-Identifier: Apache-2.0
#include "text_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <string_view>

#include "altiplan/error.hpp"

namespace altiplan::formats {
namespace {

using Json = nlohmann::json;
using namespace nlohmann::literals;

constexpr std::size_t kMaxDepth = 64;

/// The library's own reader takes three times as long, and passes over a key given twice, of which
/// it keeps the last, and nesting so deep that printing or freeing would overflow the stack.
class Reader {
 public:
  /// The text ends with a byte of value 0, and has no other.
  Reader(const std::string& file, const std::string& text, const OnItem& on_item)
      : file_(file), text_(text), on_item_(on_item) {}

  Json document() {
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    at_ += text_.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0;
    Json value;
    read(value);
    if (next() != '\0') {
      fail();
    }
    return value;
  }

 private:
  [[noreturn]] void fail() const {
    throw Error(file_ + ": is not valid JSON: it ends early or has an error in line " +
                std::to_string(line_at(text_, std::size_t(at_ - text_.c_str()))));
  }

  char next() {
    while (*at_ == ' ' || *at_ == '\n' || *at_ == '\t' || *at_ == '\r') {
      ++at_;
    }
    return *at_;
  }

  void take(std::string_view word) {
    for (const char letter : word) {
      if (*at_ != letter) {
        fail();
      }
      ++at_;
    }
  }

  void read(Json& value) {
    switch (next()) {
      case '{':
        value = Json::object();
        return read_list('}', [&] { read_member(value); });
      case '[':
        value = Json::array();
        return read_list(']', [&] { read_item(value); });
      case '"':
        value = read_string();
        return;
      case 't':
        value = true;
        return take("true");
      case 'f':
        value = false;
        return take("false");
      case 'n':
        return take("null");
      default:
        read_number(value);
    }
  }

  template <class ReadOne>
  void read_list(char end, const ReadOne& read_one) {
    if (depth_ == kMaxDepth) {
      throw Error(file_ + ": lists and objects are nested more than " + std::to_string(kMaxDepth) +
                  " levels deep");
    }
    ++depth_;
    ++at_;
    if (next() != end) {
      for (read_one(); next() == ','; read_one()) {
        ++at_;
      }
    }
    take({&end, 1});
    --depth_;
  }

  void read_member(Json& object) {
    if (next() != '"') {
      fail();
    }
    const auto [member, is_new] = object.get_ref<Json::object_t&>().try_emplace(read_string());
    if (!is_new) {
      throw Error(file_ + ": the key \"" + member->first + "\" is given twice in one object");
    }
    if (depth_ == 1) {
      key_ = &member->first;
    }
    next();
    take(":");
    read(member->second);
  }

  void read_item(Json& list) {
    Json& item = list.get_ref<Json::array_t&>().emplace_back();
    read(item);
    if (on_item_ && depth_ == 2 && key_ != nullptr && item.is_structured()) {
      on_item_(*key_, item);
    }
  }

  std::string read_string() {
    const char* const start = at_++;
    const auto is_plain = [](char c) { return c >= ' ' && c <= '~' && c != '"' && c != '\\'; };
    while (is_plain(*at_)) {
      ++at_;
    }
    if (*at_ == '"') {
      return {start + 1, at_++};
    }
    for (; *at_ != '"'; ++at_) {
      at_ += *at_ == '\\' ? 1 : 0;
      if (static_cast<unsigned char>(*at_) < ' ') {
        fail();
      }
    }
    ++at_;
    Json text = Json::parse(start, at_, nullptr, false);  // escapes, and letters beyond ASCII
    if (text.is_discarded()) {
      fail();
    }
    return std::move(text.get_ref<std::string&>());
  }

  void take_digits() {
    const auto is_digit = [&] { return *at_ >= '0' && *at_ <= '9'; };
    if (!is_digit()) {
      fail();
    }
    while (is_digit()) {
      ++at_;
    }
  }

  void read_number(Json& value) {
    const char* const start = at_;
    at_ += *at_ == '-' ? 1 : 0;
    if (*at_ == '0') {
      ++at_;
    } else {
      take_digits();
    }
    const char* const end_of_whole = at_;
    if (*at_ == '.') {
      ++at_;
      take_digits();
    }
    if (*at_ == 'e' || *at_ == 'E') {
      ++at_;
      at_ += *at_ == '+' || *at_ == '-' ? 1 : 0;
      take_digits();
    }
    const auto is_read_as = [&](auto number) {
      const bool fits = std::from_chars(start, at_, number).ec == std::errc();
      if (fits) {
        value = number;
      }
      return fits;
    };
    const bool is_whole = at_ == end_of_whole;
    if ((is_whole && (*start == '-' ? is_read_as(std::int64_t{}) : is_read_as(std::uint64_t{}))) ||
        is_read_as(double{})) {
      return;
    }
    const double number = std::strtod(start, nullptr);  // too small, or too large
    if (!std::isfinite(number)) {
      throw Error(file_ + ": contains a number that is too large (beyond 1.8e308)");
    }
    value = number;
  }

  const std::string& file_;
  const std::string& text_;
  const OnItem& on_item_;
  const char* at_ = text_.c_str();
  std::size_t depth_ = 0;             ///< of lists and objects
  const std::string* key_ = nullptr;  ///< of the document's member that is read
};
}  // namespace

std::size_t line_at(const std::string& text, std::size_t offset) {
  const auto end = text.begin() + std::ptrdiff_t(std::min(offset, text.size()));
  return 1 + std::size_t(std::count(text.begin(), end, '\n'));
}

Json parse_json(const std::string& file, const std::string& text, const OnItem& on_item) {
  if (const auto at = text.find('\0'); at != text.npos) {  // the parser would take it for the end
    throw Error(file + ":" + std::to_string(line_at(text, at)) +
                ": expected JSON, found a byte of value 0");
  }
  return Reader(file, text, on_item).document();
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
