// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <limits>
#include <memory>
#include <mutex>
#include <new>
#include <type_traits>
#include <vector>

namespace altiplan::kit {

/// Work memory that outlives a call: kept by the plugin's object, lent to one call at a time, any
/// number of threads. What is in it never influences a result: T must start each call as if new.
template <class T>
class ScratchPool {
 public:
  struct GiveBack {
    ScratchPool* pool;
    void operator()(T* work) const { pool->give_back(work); }
  };
  using Lease = std::unique_ptr<T, GiveBack>;

  /// The pool must outlive the lease.
  Lease take() {
    const std::lock_guard lock(mutex_);
    if (idle_.empty()) {
      return Lease(new T, GiveBack{this});
    }
    T* work = idle_.back().release();
    idle_.pop_back();
    return Lease(work, GiveBack{this});
  }

 private:
  void give_back(T* work) {
    std::unique_ptr<T> owned(work);
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(owned));
  }
  std::mutex mutex_;
  std::vector<std::unique_ptr<T>> idle_;
};

/// An array of nodes that a new generation empties at once. A Node is a plain struct with an
/// unsigned member `stamp`; pages that no search touches are never given by the system.
template <class Node>
class NodeStore {
  static_assert(std::is_trivially_copyable_v<Node> && std::is_unsigned_v<decltype(Node::stamp)>);
  using Stamp = decltype(Node::stamp);

 public:
  /// Starts anew with `count` nodes, none of them seen.
  void reset(std::size_t count) {
    if (count > count_) {
      nodes_.reset();
      count_ = 0;
      nodes_.reset(static_cast<Node*>(std::calloc(count, sizeof(Node))));
      if (!nodes_) {
        throw std::bad_alloc();
      }
      count_ = count;
      generation_ = 0;
    } else if (generation_ == std::numeric_limits<Stamp>::max()) {
      for (std::size_t i = 0; i < count_; ++i) {
        nodes_.get()[i].stamp = 0;
      }
      generation_ = 0;
    }
    ++generation_;
  }
  bool seen(std::size_t i) const { return nodes_.get()[i].stamp == generation_; }
  /// The node, made `fresh` first if this generation has not seen it.
  Node& at(std::size_t i, const Node& fresh) {
    Node& node = nodes_.get()[i];
    if (node.stamp != generation_) {
      node = fresh;
      node.stamp = generation_;
    }
    return node;
  }
  /// A node that has been seen.
  Node& operator[](std::size_t i) { return nodes_.get()[i]; }
  const Node& operator[](std::size_t i) const { return nodes_.get()[i]; }
  std::size_t bytes() const { return count_ * sizeof(Node); }

 private:
  struct Free {
    void operator()(Node* nodes) const { std::free(nodes); }
  };
  std::unique_ptr<Node, Free> nodes_;
  std::size_t count_ = 0;
  Stamp generation_ = 0;
};
}  // namespace altiplan::kit
