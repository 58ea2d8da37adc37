// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "host/config/overrides.hpp"

namespace altiplan::host {

/// An assignment of `--set`. Those of the scenario are every pipeline's.
struct Assignment {
  std::string text;
  std::size_t pipeline = 0;  ///< whose steps it changes

  /// The text's parts; throws as parse_set.
  SetText parts() const { return parse_set(text); }
  bool is_for(std::size_t other) const {
    return pipeline == other || parts().file == FileOfKey::scenario;
  }
};

/// What has been changed since the files were read, with undo and redo.
class Edits {
 public:
  /// The changes that go before everything: they are not undone.
  explicit Edits(std::vector<Assignment> given = {}) : given_(std::move(given)) {}

  /// One change. Changes of one gesture, such as a drag, replace each other and are undone as one;
  /// 0 is no gesture.
  void add(const std::vector<Assignment>& assignments, std::uint64_t gesture);
  bool can_undo() const { return done_ > 0; }
  bool can_redo() const { return done_ < changes_.size(); }
  /// Nothing happens where there is nothing to undo or redo.
  void undo() { done_ -= can_undo() ? 1 : 0; }
  void redo() { done_ += can_redo() ? 1 : 0; }

  /// All assignments, without those that later ones replace.
  std::vector<Assignment> all() const;
  /// The same as they were before that gesture began.
  std::vector<Assignment> before(std::uint64_t gesture) const;

 private:
  struct Change {
    std::vector<Assignment> assignments;
    std::uint64_t gesture = 0;
  };
  std::vector<Assignment> of_first(std::size_t count) const;

  std::vector<Assignment> given_;
  std::vector<Change> changes_;
  std::size_t done_ = 0;  ///< the changes after these are undone
};

/// The assignments that apply to a pipeline's files, as `--set` takes them.
std::vector<std::string> texts_for(const std::vector<Assignment>& all, std::size_t pipeline);
}  // namespace altiplan::host
