// SPDX-License-Identifier: Apache-2.0
#include "host/yaml.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <map>
#include <memory>
#include <sstream>
#include <vector>

#include "altiplan/error.hpp"

namespace altiplan::host {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{16} << 20;
constexpr std::size_t kMaxDepth = 64;
constexpr std::size_t kMaxNodes = 1'000'000;
constexpr std::size_t kMaxProblems = 100;
// yaml-cpp queues the tokens of a whole [...] or {...} (about 200 bytes each) before the first
// event shows how deep or how large it is. Unlike the depth and node caps, these two count
// characters of comments and text too, so they stay far above the caps.
constexpr std::ptrdiff_t kMaxOpenBrackets = 10'000;
constexpr std::size_t kMaxMarksInBrackets = 4 * kMaxNodes;

/// A text and how places in it are named.
class Source {
 public:
  Source(std::string_view text, std::string name, std::string override_text)
      : text_(text), name_(std::move(name)), override_text_(std::move(override_text)) {}

  std::string_view text() const { return text_; }

  /// `column_bytes` counts from 0 in bytes, `line` from 0; an override has no lines.
  Location at(std::size_t line, std::size_t line_start, std::size_t column_bytes) const {
    if (!override_text_.empty()) {
      return {"", 0, 0, override_text_};
    }
    if (line_start != last_.line_start || column_bytes < last_.bytes) {
      last_ = {line_start, 0, 1};
    }
    for (; last_.bytes < column_bytes && line_start + last_.bytes < text_.size(); ++last_.bytes) {
      const auto byte = static_cast<unsigned char>(text_[line_start + last_.bytes]);
      last_.column += (byte & 0xC0) != 0x80 ? 1 : 0;
    }
    return {name_, static_cast<int>(line) + 1, last_.column, ""};
  }
  Location at(const YAML::Mark& mark) const {
    if (mark.is_null()) {
      return override_text_.empty() ? Location{name_, 0, 0, ""}
                                    : Location{"", 0, 0, override_text_};
    }
    const auto column = static_cast<std::size_t>(mark.column);
    return at(static_cast<std::size_t>(mark.line), static_cast<std::size_t>(mark.pos) - column,
              column);
  }
  /// The text from a mark on.
  std::string_view from(const YAML::Mark& mark) const {
    return text_.substr(std::min(text_.size(), static_cast<std::size_t>(mark.pos)));
  }

 private:
  /// The last place asked for: places mostly come in order, so a line is counted once.
  struct Column {
    std::size_t line_start = 0;
    std::size_t bytes = 0;
    int column = 1;
  };
  std::string_view text_;
  mutable Column last_;
  std::string name_;
  std::string override_text_;
};

bool is_control(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return (byte < 0x20 && c != '\t' && c != '\n' && c != '\r') || byte == 0x7F;
}

/// Bytes of the UTF-8 character at the front of `text`; 0 where it is none.
std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  if (byte(0) < 0x80) {
    return 1;
  }
  const std::size_t length = byte(0) >= 0xF0 ? 4 : byte(0) >= 0xE0 ? 3 : 2;
  if (byte(0) < 0xC2 || byte(0) > 0xF4 || text.size() < length) {
    return 0;
  }
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) {
      return 0;
    }
  }
  const bool overlong = (byte(0) == 0xE0 && byte(1) < 0xA0) || (byte(0) == 0xF0 && byte(1) < 0x90);
  const bool surrogate = byte(0) == 0xED && byte(1) > 0x9F;
  const bool too_large = byte(0) == 0xF4 && byte(1) > 0x8F;
  return overlong || surrogate || too_large ? 0 : length;
}

std::string hexadecimal(unsigned char byte) {
  constexpr const char* kDigits = "0123456789abcdef";
  return std::string("0x") + kDigits[byte >> 4] + kDigits[byte & 15];
}

/// Refuses what yaml-cpp would accept silently, misread or choke on.
void check_characters(const Source& source) {
  const std::string_view text = source.text();
  std::size_t line = 0;
  std::size_t line_start = 0;
  std::size_t marks = 0;
  std::ptrdiff_t open = 0;
  const auto refuse = [&](std::size_t at, const std::string& message) {
    throw ConfigError(source.at(line, line_start, at - line_start), "", message);
  };
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    const std::size_t length = utf8_length(text.substr(i));
    if (length == 0) {
      refuse(i, "the byte " + hexadecimal(static_cast<unsigned char>(c)) +
                    " is not UTF-8 text: save the file as UTF-8");
    }
    if (is_control(c)) {
      refuse(i, "the control character " + hexadecimal(static_cast<unsigned char>(c)) +
                    " does not belong in a text file");
    }
    if (i == line_start && c == '%') {
      refuse(i, "lines that start with '%' (YAML directives) are not taken: leave the line out");
    }
    if (i == line_start && (c == ' ' || c == '\t')) {
      const std::string_view rest = text.substr(i);
      const std::string_view indent = rest.substr(0, rest.find_first_not_of(" \t"));
      const bool blank = indent.size() == rest.size() || rest[indent.size()] == '\n' ||
                         rest[indent.size()] == '\r';
      if (!blank && indent.find('\t') != indent.npos) {
        refuse(i + indent.find('\t'), "a tab indents this line: indent with spaces");
      }
    }
    open += c == '[' || c == '{' ? 1 : c == ']' || c == '}' ? -1 : 0;
    open = std::max<std::ptrdiff_t>(open, 0);
    marks = open == 0 ? 0 : marks + (std::strchr(",:?\"'&*![{", c) != nullptr ? 1 : 0);
    if (open > kMaxOpenBrackets) {
      refuse(i, "nested more than " + std::to_string(kMaxDepth) + " levels deep");
    }
    if (marks > kMaxMarksInBrackets) {
      refuse(i, "more than " + std::to_string(kMaxNodes) + " values in one file");
    }
    i += length;
    if (c == '\n') {
      ++line;
      line_start = i;
    }
  }
}

/// yaml-cpp's message in words that tell a user what to change.
std::string plain_words(const std::string& message) {
  using namespace YAML::ErrorMsg;
  static const std::map<std::string, std::string> kWords = {
      {END_OF_MAP,
       "this does not fit the map around it: check the indentation, and that each key is followed "
       "by ': '"},
      {END_OF_MAP_FLOW, "the map that starts with '{' is not well closed: expected ',' or '}'"},
      {END_OF_SEQ,
       "this does not fit the list around it: check the indentation, and that each item starts "
       "with '- '"},
      {END_OF_SEQ_FLOW, "the list that starts with '[' is not well closed: expected ',' or ']'"},
      {EOF_IN_SCALAR, "the text that starts with a quote is not closed"},
      {DOC_IN_SCALAR, "the text that starts with a quote is not closed before '---' or '...'"},
      {MAP_VALUE,
       "a ':' with no key that it could belong to: quote the text if the ':' is part "
       "of it, else check the indentation"},
      {MAP_KEY, "a key cannot stand here: check the indentation"},
      {BLOCK_ENTRY, "a list item ('- ') cannot stand here: check the indentation"},
      {FLOW_END, "a closing bracket that does not match the opening one"},
      {UNKNOWN_TOKEN, "a character that cannot start a value: quote the text"},
      {UNKNOWN_ANCHOR, "an alias ('*name') whose anchor ('&name') does not stand before it"},
      {TAG_WITH_NO_SUFFIX, "tags ('!…') are not taken: leave the tag out"},
      {TAB_IN_INDENTATION, "a tab indents this line: indent with spaces"},
  };
  const auto found = kWords.find(message);
  return found != kWords.end() ? found->second : "not well-formed YAML: " + message;
}

/// Collects a document's events as a flat list, so that an alias costs one entry however much it
/// stands for; the tree is built at the end.
class Reader final : public YAML::EventHandler {
 public:
  explicit Reader(const Source& source) : source_(source) {}

  std::vector<Problem>& problems() { return problems_; }
  bool empty() const { return nodes_.empty(); }
  Value tree() const {
    std::size_t at = 0;
    return build(at);
  }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    if (expects_key()) {
      problem(source_.at(mark), path(), "a value without a key before its ':'");
      push(mark, Node::Kind::scalar, "");
      open_.back().expects_key = false;
      return;
    }
    const bool root = open_.empty();
    const std::string word = null_word(mark);
    if (!word.empty()) {
      problem(source_.at(mark), path(),
              "'" + word +
                  "' is not a value: leave the key out where nothing is meant, quote it "
                  "where the text is meant");
    } else if (!root) {
      problem(open_.back().is_map ? open_.back().key_at : empty_item(mark), path(), "has no value");
    }
    if (!root || !word.empty()) {
      push(mark, Node::Kind::scalar, "");
      finish(nodes_.size() - 1, 1, 1, anchor);
    }
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    if (expects_key()) {
      refuse(mark, "an alias cannot be a key: write the key out");
    }
    const auto target = anchors_.find(anchor);
    if (target == anchors_.end()) {
      refuse(mark, "an alias to a list or map that it is itself a part of");
    }
    const Anchor& anchored = target->second;
    if (open_.size() + anchored.height > kMaxDepth + 1) {
      refuse_depth(mark);
    }
    count(mark, anchored.nodes);
    Node& node = push(mark, Node::Kind::alias, "");
    node.target = anchored.node;
    finish(nodes_.size() - 1, anchored.nodes, anchored.height, 0);
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& text) override {
    check_tag(mark, tag);
    if (std::any_of(text.begin(), text.end(), is_control)) {
      problem(source_.at(mark), path(), "a control character in a text");
    }
    if (tag == "!" && !closed(without_anchor(mark))) {
      refuse(mark, "the text that starts with a quote is not closed");
    }
    count(mark, 1);
    Node& node = push(mark, Node::Kind::scalar, text);
    node.quoted = tag == "!";
    if (expects_key()) {
      take_key(node);
      if (anchor != 0) {
        anchors_[anchor] = {nodes_.size() - 1, 1, 1};
      }
    } else {
      finish(nodes_.size() - 1, 1, 1, anchor);
    }
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    start(mark, tag, anchor, Node::Kind::list);
  }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    start(mark, tag, anchor, Node::Kind::map);
  }
  void OnSequenceEnd() override { end(); }
  void OnMapEnd() override { end(); }

 private:
  struct Node {
    enum class Kind { scalar, list, map, alias };
    Kind kind = Kind::scalar;
    bool quoted = false;
    int line = 0;
    int column = 0;
    std::size_t target = 0;  ///< alias: the node meant; list, map: one past its last descendant
    std::string text;
  };
  /// A list or map that is being read.
  struct Open {
    std::size_t node = 0;
    YAML::anchor_t anchor = 0;
    std::size_t counted_before = 0;
    std::size_t height = 2;  ///< levels from here down, a scalar in it counted
    bool is_map = false;
    bool expects_key = false;
    std::size_t index = 0;
    std::string key;
    Location key_at;
    std::map<std::string, int> lines_of_keys;
  };
  /// A finished node that aliases may name; nodes and height with its aliases counted in.
  struct Anchor {
    std::size_t node = 0;
    std::size_t nodes = 0;
    std::size_t height = 0;
  };

  bool expects_key() const { return !open_.empty() && open_.back().expects_key; }

  std::string path() const {
    std::string text;
    for (const Open& open : open_) {
      if (!open.is_map || !open.expects_key) {
        text += (text.empty() ? "" : ".") + (open.is_map ? open.key : std::to_string(open.index));
      }
    }
    return text;
  }

  void problem(Location where, std::string key, std::string message) {
    problems_.push_back({std::move(where), std::move(key), std::move(message)});
    if (problems_.size() >= kMaxProblems) {
      throw ConfigError(std::move(problems_));
    }
  }
  /// Ends the reading: what follows could not be understood.
  [[noreturn]] void refuse(const YAML::Mark& mark, std::string message) {
    problems_.push_back({source_.at(mark), path(), std::move(message)});
    throw ConfigError(std::move(problems_));
  }
  [[noreturn]] void refuse_depth(const YAML::Mark& mark) {
    problems_.push_back(
        {source_.at(mark), "", "nested more than " + std::to_string(kMaxDepth) + " levels deep"});
    throw ConfigError(std::move(problems_));
  }

  void count(const YAML::Mark& mark, std::size_t nodes) {
    counted_ += nodes;
    if (counted_ > kMaxNodes) {
      refuse(mark, "more than " + std::to_string(kMaxNodes) +
                       " values in one file (aliases count as often as they are used)");
    }
  }

  std::string_view without_anchor(const YAML::Mark& mark) const {
    std::string_view text = source_.from(mark);
    if (!text.empty() && text.front() == '&') {
      text.remove_prefix(std::min(text.size(), text.find_first_of(" \t\r\n")));
      text.remove_prefix(std::min(text.size(), text.find_first_not_of(" \t\r\n")));
    }
    return text;
  }

  /// yaml-cpp gives "?" for a plain node, "!" for a quoted one, and anything for a tag; a bare '!'
  /// shows in the text only.
  void check_tag(const YAML::Mark& mark, const std::string& tag) {
    const std::string_view text = without_anchor(mark);
    if ((tag != "?" && tag != "!") || (!text.empty() && text.front() == '!')) {
      problem(source_.at(mark), path(), "tags ('!…') are not taken: leave the tag out");
    }
  }

  /// "null", "~" … where one is written at the mark; "" where nothing is (the mark is then that of
  /// whatever follows).
  std::string null_word(const YAML::Mark& mark) const {
    const std::string_view text = source_.from(mark);
    for (const std::string_view word : {"~", "null", "Null", "NULL"}) {
      if (text.substr(0, word.size()) == word &&
          (text.size() == word.size() ||
           std::strchr(" \t\r\n,]}#", text[word.size()]) != nullptr)) {
        return std::string(word);
      }
    }
    return "";
  }

  /// The '-' of a list item without a value: its event carries the mark of whatever follows.
  Location empty_item(const YAML::Mark& mark) const {
    const std::string_view before = source_.text().substr(0, static_cast<std::size_t>(mark.pos));
    const std::size_t dash = before.find_last_not_of(" \r\n");
    if (dash == before.npos || before[dash] != '-') {
      return place(nodes_[open_.back().node]);
    }
    const auto lines = std::count(before.begin() + dash, before.end(), '\n');
    const std::size_t line_start = before.rfind('\n', dash) + 1;
    return source_.at(static_cast<std::size_t>(mark.line - lines), line_start, dash - line_start);
  }

  /// yaml-cpp lets the end of the file close a quoted text.
  static bool closed(std::string_view text) {
    const char quote = text.empty() ? '\0' : text.front();
    if (quote != '"' && quote != '\'') {
      return true;
    }
    std::size_t i = 1;
    for (; i < text.size(); ++i) {
      const bool doubled = quote == '\'' && text.substr(i, 2) == "''";
      if (doubled || (quote == '"' && text[i] == '\\')) {
        ++i;
      } else if (text[i] == quote) {
        break;
      }
    }
    return i < text.size();
  }

  Node& push(const YAML::Mark& mark, Node::Kind kind, const std::string& text) {
    const Location where = source_.at(mark);
    Node& node = nodes_.emplace_back();
    node.kind = kind;
    node.line = where.line;
    node.column = where.column;
    node.text = text;
    return node;
  }

  void take_key(const Node& node) {
    Open& map = open_.back();
    map.key_at = place(node);
    const auto [known, is_new] = map.lines_of_keys.emplace(node.text, node.line);
    map.expects_key = false;
    map.key = node.text;
    if (!is_new) {
      problem(map.key_at, path(),
              "this key stands twice in one map" +
                  (known->second > 0 ? ", first in line " + std::to_string(known->second) : ""));
    }
    if (node.text == "<<" && !node.quoted) {
      problem(map.key_at, path(), "merge keys ('<<') are not taken: write the keys out");
    }
  }

  void start(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
             Node::Kind kind) {
    if (expects_key()) {
      refuse(mark, kind == Node::Kind::map
                       ? "a map cannot be a key: a key is a word (is a bracket left open?)"
                       : "a list cannot be a key: a key is a word (is a bracket left open?)");
    }
    if (open_.size() >= kMaxDepth) {
      refuse_depth(mark);
    }
    check_tag(mark, tag);
    Open open;
    open.node = nodes_.size();
    open.anchor = anchor;
    open.counted_before = counted_;
    open.is_map = open.expects_key = kind == Node::Kind::map;
    count(mark, 1);
    push(mark, kind, "");
    open_.push_back(std::move(open));
  }

  void end() {
    const Open ended = std::move(open_.back());
    open_.pop_back();
    nodes_[ended.node].target = nodes_.size();
    finish(ended.node, counted_ - ended.counted_before, ended.height, ended.anchor);
  }

  /// A value is whole: names it for aliases, and moves its parent on.
  void finish(std::size_t node, std::size_t nodes, std::size_t height, YAML::anchor_t anchor) {
    if (anchor != 0) {
      anchors_[anchor] = {node, nodes, height};
    }
    if (!open_.empty()) {
      Open& parent = open_.back();
      parent.height = std::max(parent.height, height + 1);
      parent.expects_key = parent.is_map;
      ++parent.index;
    }
  }

  Location place(const Node& node) const {
    Location where = source_.at(YAML::Mark::null_mark());
    where.line = node.line;
    where.column = node.column;
    return where;
  }

  /// The value at nodes_[at]; moves `at` past it.
  Value build(std::size_t& at) const {
    const Node& node = nodes_[at++];
    Value value;
    if (node.kind == Node::Kind::alias) {
      std::size_t target = node.target;
      value = build(target);
    } else if (node.kind == Node::Kind::list) {
      value.kind = Value::Kind::list;
      while (at < node.target) {
        value.items.push_back(build(at));
      }
    } else if (node.kind == Node::Kind::map) {
      value.kind = Value::Kind::map;
      while (at < node.target) {
        const Node& key = nodes_[at++];
        value.entries.push_back({key.text, place(key), build(at)});
      }
    } else {
      value.text = node.text;
      value.quoted = node.quoted;
    }
    value.where = place(node);
    return value;
  }

  const Source& source_;
  std::vector<Node> nodes_;
  std::vector<Open> open_;
  std::map<YAML::anchor_t, Anchor> anchors_;
  std::size_t counted_ = 0;
  std::vector<Problem> problems_;
};

/// Notes where a second document starts, and stops there.
class Rest final : public YAML::EventHandler {
 public:
  explicit Rest(const Source& source) : source_(source) {}
  void OnDocumentStart(const YAML::Mark& mark) override {
    const bool marked = source_.from(mark).substr(0, 3) == "---";
    throw ConfigError(source_.at(mark), "",
                      marked ? "a second document ('---'): one file holds one document"
                             : "text after the end of the document: check the indentation, and "
                               "that each key is followed by ': '");
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t,
                const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}

 private:
  const Source& source_;
};

Value parse(const Source& source, const char* when_empty) {
  check_characters(source);
  Reader reader(source);
  try {
    std::istringstream stream{std::string(source.text())};
    YAML::Parser parser(stream);
    parser.HandleNextDocument(reader);
    Rest rest(source);
    parser.HandleNextDocument(rest);
  } catch (const YAML::Exception& error) {
    reader.problems().push_back({source.at(error.mark), "", plain_words(error.msg)});
  }
  if (!reader.problems().empty()) {
    throw ConfigError(std::move(reader.problems()));
  }
  if (reader.empty()) {
    throw ConfigError(source.at(YAML::Mark::null_mark()), "", when_empty);
  }
  return reader.tree();
}

std::string read_file(const std::filesystem::path& file) {
  const auto refuse = [&](const std::string& message) {
    throw ConfigError({file.string(), 0, 0, ""}, "", message);
  };
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) {
    refuse("this is a folder, expected a YAML file");
  }
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(file.c_str(), "rb"),
                                                               &std::fclose);
  if (!stream) {
    refuse(errno == ENOENT ? "there is no such file"
                           : std::string("cannot be opened: ") + std::strerror(errno));
  }
  std::string text;
  std::array<char, 65536> buffer;
  while (const std::size_t got = std::fread(buffer.data(), 1, buffer.size(), stream.get())) {
    text.append(buffer.data(), got);
    if (text.size() > kMaxBytes) {
      refuse("larger than 16 MiB, the most that a YAML file may have");
    }
  }
  if (std::ferror(stream.get()) != 0) {
    refuse(std::string("cannot be read: ") + std::strerror(errno));
  }
  return text;
}
}  // namespace

Value load_yaml(const std::filesystem::path& file) {
  return parse_yaml(read_file(file), file.string());
}

Value parse_yaml(std::string_view text, const std::string& name) {
  if (text.size() > kMaxBytes) {
    throw ConfigError({name, 0, 0, ""}, "",
                      "larger than 16 MiB, the most that a YAML file may have");
  }
  if (text.substr(0, 3) == "\xEF\xBB\xBF") {
    text.remove_prefix(3);
  }
  return parse(Source(text, name, ""), "the file is empty");
}

Value parse_override(std::string_view text, const std::string& assignment) {
  if (text.find('\n') != text.npos || text.size() > kMaxBytes) {
    throw ConfigError({"", 0, 0, assignment}, "", "expected a value on one line");
  }
  return parse(Source(text, "", assignment), "has no value");
}
}  // namespace altiplan::host
