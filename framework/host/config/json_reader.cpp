// SPDX-License-Identifier: Apache-2.0
#include "host/config/json_reader.hpp"

#include <algorithm>
#include <iterator>
#include <vector>

#include "host/base/json.hpp"

namespace altiplan::host {
namespace {

/// An iterator over the text that tells how far it was read.
struct Cursor {
  // NOLINTBEGIN(readability-identifier-naming): the standard's names
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;
  // NOLINTEND(readability-identifier-naming)

  const char* at;
  const char** read_to;

  reference operator*() const { return *at; }
  Cursor& operator++() {
    *read_to = ++at;
    return *this;
  }
  bool operator==(const Cursor& other) const { return at == other.at; }
};

/// Builds the tree from the parser's events, which have no places: a value begins after what may
/// stand between it and the value before, and lines end there alone.
class JsonReader final : public nlohmann::json_sax<Json> {
 public:
  explicit JsonReader(const YamlSource& source) : source_(source) {}

  bool read() {
    const char* begin = source_.text().data();
    return Json::sax_parse(Cursor{begin, &read_to_},
                           Cursor{begin + source_.text().size(), &read_to_}, this);
  }
  Value& tree() { return tree_; }

  bool null() override { return false; }
  bool boolean(bool value) override { return scalar(value ? "true" : "false", false); }
  bool number_integer(std::int64_t) override { return number(); }
  bool number_unsigned(std::uint64_t) override { return number(); }
  bool number_float(double, const std::string&) override { return number(); }
  bool string(std::string& text) override { return scalar(std::move(text), true); }
  bool binary(Json::binary_t&) override { return false; }
  bool start_object(std::size_t) override { return start(Value::Kind::map); }
  bool start_array(std::size_t) override { return start(Value::Kind::list); }
  bool end_array() override {
    open_.pop_back();
    return true;
  }
  bool end_object() override {
    std::vector<std::string_view> keys;
    for (const Value::Entry& entry : open_.back()->entries) {
      keys.push_back(entry.key);
    }
    std::sort(keys.begin(), keys.end());
    open_.pop_back();
    return std::adjacent_find(keys.begin(), keys.end()) == keys.end();
  }
  bool key(std::string& text) override {
    Value::Entry& entry = open_.back()->entries.emplace_back();
    entry.where = take_place();
    entry.key = std::move(text);
    return is_plain(entry.key) && ++nodes_ < kMaxNodes;
  }
  bool parse_error(std::size_t, const std::string&, const Json::exception&) override {
    return false;
  }

 private:
  static bool is_plain(const std::string& text) {
    return std::none_of(text.begin(), text.end(), is_control);
  }

  /// The place of what was read last, from which on the text is then unread.
  Location take_place() {
    const std::string_view text = source_.text();
    for (; std::string_view(" \t\r\n,:]}").find(text[begin_]) != std::string_view::npos; ++begin_) {
      if (text[begin_] == '\n') {
        ++line_;
        line_start_ = begin_ + 1;
      }
    }
    const Location place = source_.at(line_, line_start_, begin_ - line_start_);
    begin_ = std::size_t(read_to_ - text.data());
    return place;
  }

  Value& add(Value::Kind kind) {
    Value* value = &tree_;
    if (!open_.empty()) {
      Value& in = *open_.back();
      value = in.kind == Value::Kind::map ? &in.entries.back().value : &in.items.emplace_back();
    }
    value->kind = kind;
    value->where = take_place();
    return *value;
  }

  bool scalar(std::string text, bool quoted) {
    Value& value = add(Value::Kind::scalar);
    value.text = std::move(text);
    value.quoted = quoted;
    return is_plain(value.text) && ++nodes_ < kMaxNodes;
  }

  /// As it is written; it was read up to the character behind it.
  bool number() {
    --read_to_;
    Value& value = add(Value::Kind::scalar);
    const std::string_view before = source_.text().substr(0, begin_);
    value.text = before.substr(before.find_last_of(" \t\r\n,:[") + 1);
    return ++nodes_ < kMaxNodes;
  }

  bool start(Value::Kind kind) {
    open_.push_back(&add(kind));
    return open_.size() <= kMaxDepth && ++nodes_ < kMaxNodes;
  }

  const YamlSource& source_;
  const char* read_to_ = nullptr;
  std::size_t begin_ = 0;  ///< where what is read next begins, or what stands before it
  std::size_t line_ = 0;
  std::size_t line_start_ = 0;
  std::size_t nodes_ = 0;
  Value tree_;
  std::vector<Value*> open_;  ///< the lists and maps that are being read
};
}  // namespace

std::optional<Value> read_if_json(const YamlSource& source) {
  JsonReader reader(source);
  if (source.text().empty() || source.text().front() != '{' || !reader.read()) {
    return std::nullopt;
  }
  return std::move(reader.tree());
}
}  // namespace altiplan::host
