// SPDX-License-Identifier: Apache-2.0
#include "octree.hpp"

#include <charconv>
#include <cmath>
#include <cstring>

#include "altiplan/error.hpp"
#include "altiplan/formats/input_file.hpp"

namespace altiplan::octomap {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{1} << 30;

}  // namespace

Octree::Octree(const std::string& file) : file_(file), bytes_(formats::read_file(file, kMaxBytes)) {
  std::string id;
  int number = 0;
  const auto refuse = [&](const std::string& why) {
    throw Error(file_ + ":" + std::to_string(number) + ": " + why);
  };
  while (true) {
    const std::size_t end = bytes_.find('\n', data_);
    ++number;
    if (end == bytes_.npos || end - data_ > 1000) {
      refuse("expected a line of an OctoMap header (id, size, res, data)");
    }
    std::string line = bytes_.substr(data_, end - data_);
    data_ = end + 1;
    if (line.ends_with('\r')) {
      line.pop_back();
    }
    if (number == 1) {
      binary_ = line.starts_with("# Octomap OcTree binary file");
      if (!binary_ && !line.starts_with("# Octomap OcTree file")) {
        refuse("expected '# Octomap OcTree file', or '… binary file', found " + excerpt(line));
      }
    } else if (line == "data") {
      break;
    } else if (line.starts_with("id ")) {
      id = line.substr(3);
    } else if (line.starts_with("res ")) {
      const char* end_of = line.data() + line.size();
      const auto [stop, error] = std::from_chars(line.data() + 4, end_of, resolution_);
      if (error != std::errc() || stop != end_of || !(resolution_ >= 1e-6) ||
          !(resolution_ <= 1e6)) {
        refuse("expected 'res' and metres from 1e-6 to 1e6, found " + excerpt(line));
      }
    } else if (!line.empty() && line[0] != '#' && !line.starts_with("size ")) {
      refuse("expected id, size, res or data, found " + excerpt(line));
    }
  }
  if (resolution_ == 0) {
    refuse("the header has no resolution (res)");
  }
  if (id != "OcTree" && id != "ColorOcTree") {
    refuse("expected the id OcTree or ColorOcTree, found " + excerpt(id));
  }
  node_bytes_ = id == "ColorOcTree" ? 7 : 4;  // log-odds; red, green and blue
}

/// A depth-first traversal of the nodes.
struct Octree::Walk {
  const Octree& tree;
  double occupied_from;  ///< log-odds
  const std::function<void(const Leaf&)>& leaf;
  std::size_t at;

  const char* take(std::size_t count) {
    if (tree.bytes_.size() - at < count) {
      throw Error(tree.file_ + ": the nodes end early at byte " + std::to_string(at));
    }
    at += count;
    return tree.bytes_.data() + at - count;
  }

  void expect_depth(int edge) const {
    if (edge == 1) {
      throw Error(tree.file_ + ": at byte " + std::to_string(at) +
                  " a node has children below the finest level");
    }
  }

  static Leaf child(const Leaf& parent, int n) {
    Leaf child{parent.key, parent.edge / 2, false};
    for (int axis = 0; axis < 3; ++axis) {
      child.key[std::size_t(axis)] += (n >> axis & 1) * child.edge;
    }
    return child;
  }

  /// Two bits per child: 00 unknown, 01 free, 10 occupied, 11 an inner node, which follows.
  void binary(const Leaf& node) {
    expect_depth(node.edge);
    std::uint16_t children = 0;
    std::memcpy(&children, take(2), 2);
    for (int n = 0; n < 8; ++n) {
      const int kind = children >> (2 * n) & 3;
      if (kind == 1 || kind == 2) {
        Leaf known = child(node, n);
        known.occupied = kind == 2;
        leaf(known);
      }
    }
    for (int n = 0; n < 8; ++n) {
      if ((children >> (2 * n) & 3) == 3) {
        binary(child(node, n));
      }
    }
  }

  /// Log-odds, possibly a colour, a mask of the children, and the children.
  void full(Leaf node) {
    float log_odds = 0;
    std::memcpy(&log_odds, take(tree.node_bytes_), sizeof log_odds);
    const auto children = static_cast<unsigned char>(*take(1));
    if (std::isnan(log_odds)) {
      throw Error(tree.file_ + ": at byte " + std::to_string(at) +
                  " a node's occupancy is not a number");
    }
    if (children == 0) {
      node.occupied = double(log_odds) >= occupied_from;
      leaf(node);
      return;
    }
    expect_depth(node.edge);
    for (int n = 0; n < 8; ++n) {
      if ((children >> n & 1) != 0) {
        full(child(node, n));
      }
    }
  }
};

void Octree::leaves(double occupied_from, const std::function<void(const Leaf&)>& leaf) const {
  Walk walk{*this, std::log(occupied_from / (1 - occupied_from)), leaf, data_};
  const Leaf root{{0, 0, 0}, 1 << kDepth, false};
  binary_ ? walk.binary(root) : walk.full(root);
  if (walk.at != bytes_.size()) {
    throw Error(file_ + ": " + std::to_string(bytes_.size() - walk.at) +
                " bytes follow the tree's nodes");
  }
}
}  // namespace altiplan::octomap
