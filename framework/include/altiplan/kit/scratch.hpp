// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <type_traits>
#include <vector>

#include "altiplan/kit/zero_memory.hpp"

namespace altiplan::kit {

/// Work memory that outlives a call: owned by the plugin's object, leased to one call at a time,
/// thread-safe. Its content never influences a result: T must reset itself at each call.
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

/// An array of nodes that a new generation empties in O(1). A Node is a plain struct with an
/// unsigned member `stamp`; the system never allocates pages that no search touches.
template <class Node>
class NodeStore {
  static_assert(std::is_trivially_copyable_v<Node> && std::is_unsigned_v<decltype(Node::stamp)>);
  using Stamp = decltype(Node::stamp);

 public:
  /// Starts a generation of `count` nodes, all unseen.
  void reset(std::size_t count) {
    if (count > count_) {
      count_ = 0;
      memory_ = {};
      memory_ = ZeroMemory(count * sizeof(Node));
      nodes_ = static_cast<Node*>(memory_.data());
      count_ = count;
      generation_ = 0;
    } else if (generation_ == std::numeric_limits<Stamp>::max()) {
      for (std::size_t i = 0; i < count_; ++i) {
        nodes_[i].stamp = 0;
      }
      generation_ = 0;
    }
    ++generation_;
  }
  bool seen(std::size_t i) const { return nodes_[i].stamp == generation_; }
  /// The node, first set to `fresh` if this generation has not seen it.
  Node& at(std::size_t i, const Node& fresh) {
    Node& node = nodes_[i];
    if (node.stamp != generation_) {
      node = fresh;
      node.stamp = generation_;
    }
    return node;
  }
  /// A node that this generation has seen.
  Node& operator[](std::size_t i) { return nodes_[i]; }
  const Node& operator[](std::size_t i) const { return nodes_[i]; }
  std::size_t bytes() const { return count_ * sizeof(Node); }
  /// Begins to fetch a node, if there is one of that number, into the processor's cache.
  void prefetch(std::size_t i) const { __builtin_prefetch(nodes_ + std::min(i, count_ - 1)); }

 private:
  ZeroMemory memory_;
  Node* nodes_ = nullptr;
  std::size_t count_ = 0;
  Stamp generation_ = 0;
};

/// An array of integers that are 0 until written; emptying it costs what was written since, in
/// blocks (small ones where the writes are scattered), and the system never allocates pages that no
/// search touches.
template <class T, std::size_t kBlockBytes = 1024>
class ScratchArray {
  static_assert(std::is_unsigned_v<T>);

 public:
  /// Resets to `count` zeros.
  void reset(std::size_t count) {
    if (count > count_) {
      count_ = 0;
      memory_ = {};
      const std::size_t blocks = count / kBlock + 1;
      memory_ = ZeroMemory(blocks * kBlockBytes);
      values_ = static_cast<T*>(memory_.data());
      is_written_.assign(blocks, 0);
      written_ = {};
      written_.reserve(blocks);  // growing on demand would take twice the memory
      count_ = count;
    } else {
      for (const std::uint32_t block : written_) {
        // In pieces that compilers clear by plain stores: longer ones take several times as long.
        T* const first = values_ + block * kBlock;
        for (T* piece = first; piece != first + kBlock; piece += kPiece) {
          std::fill_n(piece, kPiece, T{0});
        }
        is_written_[block] = 0;
      }
    }
    written_.clear();
  }
  T operator[](std::size_t i) const { return values_[i]; }
  const T* data() const { return values_; }
  /// For writing.
  T& at(std::size_t i) {
    if (is_written_[i / kBlock] == 0) {
      note(i / kBlock);
    }
    return values_[i];
  }
  std::size_t bytes() const { return count_ * sizeof(T) + count_ / kBlock; }
  /// Bytes in the blocks written since the last reset.
  std::size_t written_bytes() const { return written_.size() * kBlockBytes; }

 private:
  [[gnu::noinline]] void note(std::size_t block) {
    is_written_[block] = 1;
    written_.push_back(std::uint32_t(block));
  }

  static constexpr std::size_t kPiece = 64 / sizeof(T);
  static constexpr std::size_t kBlock = kBlockBytes / sizeof(T);
  ZeroMemory memory_;
  T* values_ = nullptr;
  std::vector<std::uint8_t> is_written_;  // by block
  std::vector<std::uint32_t> written_;    // blocks
  std::size_t count_ = 0;
};
}  // namespace altiplan::kit
