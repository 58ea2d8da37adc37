// SPDX-License-Identifier: Apache-2.0
#include "text_file.hpp"

#include <algorithm>
#include <vector>

#include "altiplan/error.hpp"

namespace altiplan::formats {
namespace {

using Json = nlohmann::json;
using namespace nlohmann::literals;

constexpr std::size_t kMaxDepth = 64;

/// Builds the value, and refuses what the library's own builder passes over: a key given twice, of
/// which it keeps the last, and nesting so deep that printing or freeing would overflow the stack.
class Builder final : public Json::json_sax_t {
 public:
  Builder(const std::string& file, const std::string& text, const OnItem& on_item)
      : file_(file), text_(text), on_item_(on_item) {}
  Json take() { return std::move(root_); }

  bool null() override { return put(nullptr); }
  bool boolean(bool value) override { return put(value); }
  bool number_integer(std::int64_t value) override { return put(value); }
  bool number_unsigned(std::uint64_t value) override { return put(value); }
  bool number_float(double value, const std::string& /*text*/) override { return put(value); }
  bool string(std::string& value) override { return put(std::move(value)); }
  bool binary(Json::binary_t& /*value*/) override { return false; }  // not of text
  bool start_object(std::size_t /*size*/) override { return open(Json::object()); }
  bool start_array(std::size_t /*size*/) override { return open(Json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(std::string& name) override {
    const auto [member, is_new] =
        open_.back()->get_ref<Json::object_t&>().try_emplace(std::move(name));
    if (!is_new) {
      throw Error(file_ + ": the key \"" + member->first + "\" is given twice in one object");
    }
    last_ = &member->second;
    if (open_.size() == 1) {
      key_ = member->first;
    }
    return true;
  }

  bool parse_error(std::size_t position, const std::string& /*token*/,
                   const Json::exception& error) override {
    constexpr int kOverflow = 406;
    if (error.id == kOverflow) {
      throw Error(file_ + ": contains a number that is too large (beyond 1.8e308)");
    }
    throw Error(file_ + ": is not valid JSON: it ends early or has an error in line " +
                std::to_string(line_at(text_, position)));
  }

 private:
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
      throw Error(file_ + ": lists and objects are nested more than " + std::to_string(kMaxDepth) +
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

  const std::string& file_;
  const std::string& text_;
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
  if (const auto at = text.find('\0'); at != text.npos) {  // the parser would take it for the end
    throw Error(file + ":" + std::to_string(line_at(text, at)) +
                ": expected JSON, found a byte of value 0");
  }
  Builder builder(file, text, on_item);
  Json::sax_parse(text, &builder);
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
