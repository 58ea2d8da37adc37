// SPDX-License-Identifier: Apache-2.0
#include "host/config/yaml_reader.hpp"

#include <algorithm>

namespace altiplan::host {
namespace {

constexpr std::size_t kMaxProblems = 100;

/// A hint on what a key without a value may have been meant as; `next` is where the text continues.
std::string hint_for_key(const std::string& key, const Location& key_at, const Location& next) {
  if (key.find(':') != key.npos) {
    return ": a space is missing after its ':'";
  }
  const bool digits = !key.empty() && key.find_first_not_of("0123456789") == key.npos;
  if (digits) {
    return ": decimals are written with a point, not a comma";
  }
  const bool unindented = next.line > key_at.line && next.column == key_at.column;
  return unindented ? ": write it after the ': ', or below, indented further than the key" : "";
}
}  // namespace

Value YamlReader::tree() const {
  std::size_t at = 0;
  return build(at);
}

void YamlReader::OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) {
  if (expects_key()) {
    problem(source_.at(mark), path(), "a value without a key before its ':'");
    push(mark, Node::Kind::scalar, "");
    open_.back().expects_key = false;
    return;
  }
  const bool root = open_.empty();
  const std::string word = source_.null_word(mark);
  if (!word.empty()) {
    problem(source_.at(mark), path(),
            "'" + word + "' is not a value: omit the key, or quote it if it is text");
  } else if (!root) {
    const Open& in = open_.back();
    problem(in.is_map ? in.key_at : empty_item(mark), path(),
            "has no value" + (in.is_map ? hint_for_key(in.key, in.key_at, source_.at(mark)) : ""));
  }
  if (!root || !word.empty()) {
    push(mark, Node::Kind::scalar, "");
    finish(nodes_.size() - 1, 1, 1, anchor);
  }
}

void YamlReader::OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) {
  if (expects_key()) {
    refuse(mark, "an alias cannot be a key: write the key out");
  }
  const auto target = anchors_.find(anchor);
  if (target == anchors_.end()) {
    refuse(mark, "an alias to a list or map that contains it");
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

void YamlReader::OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                          const std::string& text) {
  check_tag(mark, tag);
  if (std::any_of(text.begin(), text.end(), is_control)) {
    problem(source_.at(mark), path(), "a control character in a text");
  }
  if (tag == "!" && !is_closed(source_.value_from(mark))) {
    refuse(mark, "the closing quote is missing");
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

void YamlReader::OnSequenceStart(const YAML::Mark& mark, const std::string& tag,
                                 YAML::anchor_t anchor, YAML::EmitterStyle::value) {
  start(mark, tag, anchor, Node::Kind::list);
}

void YamlReader::OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                            YAML::EmitterStyle::value) {
  start(mark, tag, anchor, Node::Kind::map);
}

std::string YamlReader::path() const {
  std::string text;
  for (const Open& open : open_) {
    if (!open.is_map || !open.expects_key) {
      text += (text.empty() ? "" : ".") + (open.is_map ? open.key : std::to_string(open.index));
    }
  }
  return text;
}

void YamlReader::problem(Location where, std::string key, std::string message) {
  problems_.push_back({std::move(where), std::move(key), std::move(message)});
  if (problems_.size() >= kMaxProblems) {
    throw ConfigError(std::move(problems_));
  }
}

void YamlReader::refuse(const YAML::Mark& mark, std::string message) {
  problems_.push_back({source_.at(mark), path(), std::move(message)});
  throw ConfigError(std::move(problems_));
}

void YamlReader::refuse_depth(const YAML::Mark& mark) {
  problems_.push_back(
      {source_.at(mark), "", "nested more than " + std::to_string(kMaxDepth) + " levels deep"});
  throw ConfigError(std::move(problems_));
}

void YamlReader::count(const YAML::Mark& mark, std::size_t nodes) {
  counted_ += nodes;
  if (counted_ > kMaxNodes) {
    refuse(mark, "more than " + std::to_string(kMaxNodes) +
                     " values in one file (every use of an alias counts)");
  }
}

void YamlReader::check_tag(const YAML::Mark& mark, const std::string& tag) {
  const std::string_view text = source_.value_from(mark);
  if ((tag != "?" && tag != "!") || (!text.empty() && text.front() == '!')) {
    problem(source_.at(mark), path(), "tags ('!…') are not supported: remove the tag");
  }
}

Location YamlReader::empty_item(const YAML::Mark& mark) const {
  const std::string_view before = source_.text().substr(0, static_cast<std::size_t>(mark.pos));
  const std::size_t dash = before.find_last_not_of(" \r\n");
  if (dash == before.npos || before[dash] != '-') {
    return place(nodes_[open_.back().node]);
  }
  const auto lines = std::count(before.begin() + dash, before.end(), '\n');
  const std::size_t line_start = before.rfind('\n', dash) + 1;
  return source_.at(static_cast<std::size_t>(mark.line - lines), line_start, dash - line_start);
}

YamlReader::Node& YamlReader::push(const YAML::Mark& mark, Node::Kind kind,
                                   const std::string& text) {
  const Location where = source_.at(mark);
  Node& node = nodes_.emplace_back();
  node.kind = kind;
  node.line = where.line;
  node.column = where.column;
  node.text = text;
  return node;
}

void YamlReader::take_key(const Node& node) {
  Open& map = open_.back();
  map.key_at = place(node);
  const auto [known, is_new] = map.lines_of_keys.emplace(node.text, node.line);
  map.expects_key = false;
  map.key = node.text;
  if (!is_new) {
    problem(map.key_at, path(),
            "this key occurs twice in one map" +
                (known->second > 0 ? ", first on line " + std::to_string(known->second) : ""));
  }
  if (node.text == "<<" && !node.quoted) {
    problem(map.key_at, path(), "merge keys ('<<') are not supported: write the keys out");
  }
  if (node.text.size() > 1 && node.text.front() == '-' && !node.quoted) {
    problem(map.key_at, path(),
            "a key cannot start with '-': each item of a list starts with '- '");
  }
}

void YamlReader::start(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
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

void YamlReader::end() {
  const Open ended = std::move(open_.back());
  open_.pop_back();
  nodes_[ended.node].target = nodes_.size();
  finish(ended.node, counted_ - ended.counted_before, ended.height, ended.anchor);
}

void YamlReader::finish(std::size_t node, std::size_t nodes, std::size_t height,
                        YAML::anchor_t anchor) {
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

Location YamlReader::place(const Node& node) const {
  Location where = source_.at(YAML::Mark::null_mark());
  where.line = node.line;
  where.column = node.column;
  return where;
}

Value YamlReader::build(std::size_t& at) const {
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
}  // namespace altiplan::host
