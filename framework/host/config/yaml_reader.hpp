// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <yaml-cpp/eventhandler.h>

#include <map>
#include <vector>

#include "altiplan/value.hpp"
#include "host/config/yaml_source.hpp"

namespace altiplan::host {

/// Collects a document's events as a flat list, so that an alias costs one entry whatever its size;
/// the tree is built at the end.
class YamlReader final : public YAML::EventHandler {
 public:
  explicit YamlReader(const YamlSource& source) : source_(source) {}

  std::vector<Problem>& problems() { return problems_; }
  bool empty() const { return nodes_.empty(); }
  Value tree() const;

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override;
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override;
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& text) override;
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override;
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override;
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
    std::size_t height = 2;  ///< levels from here down, including scalars
    bool is_map = false;
    bool expects_key = false;
    std::size_t index = 0;
    std::string key;
    Location key_at;
    std::map<std::string, int> lines_of_keys;
  };
  /// A finished node that aliases may refer to; nodes and height include its expanded aliases.
  struct Anchor {
    std::size_t node = 0;
    std::size_t nodes = 0;
    std::size_t height = 0;
  };

  bool expects_key() const { return !open_.empty() && open_.back().expects_key; }
  std::string path() const;
  void problem(Location where, std::string key, std::string message);
  /// Ends the reading: what follows cannot be interpreted.
  [[noreturn]] void refuse(const YAML::Mark& mark, std::string message);
  [[noreturn]] void refuse_depth(const YAML::Mark& mark);
  void count(const YAML::Mark& mark, std::size_t nodes);
  /// yaml-cpp reports "?" for a plain node, "!" for a quoted one, and anything else for a tag; a
  /// bare '!' shows only in the text.
  void check_tag(const YAML::Mark& mark, const std::string& tag);
  /// Location of the '-' of a list item without a value: its event has the mark of whatever
  /// follows.
  Location empty_item(const YAML::Mark& mark) const;
  Node& push(const YAML::Mark& mark, Node::Kind kind, const std::string& text);
  void take_key(const Node& node);
  void start(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
             Node::Kind kind);
  void end();
  /// Completes a value: registers its anchor and advances its parent.
  void finish(std::size_t node, std::size_t nodes, std::size_t height, YAML::anchor_t anchor);
  Location place(const Node& node) const;
  /// Builds the value at nodes_[at]; moves `at` past it.
  Value build(std::size_t& at) const;

  const YamlSource& source_;
  std::vector<Node> nodes_;
  std::vector<Open> open_;
  std::map<YAML::anchor_t, Anchor> anchors_;
  std::size_t counted_ = 0;
  std::vector<Problem> problems_;
};
}  // namespace altiplan::host
