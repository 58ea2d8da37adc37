// SPDX-License-Identifier: Apache-2.0
#include "host/edit/edits.hpp"

#include <algorithm>

namespace altiplan::host {
namespace {

/// True if setting `key` replaces everything that `other` sets.
bool covers(const std::string& key, const std::string& other) {
  return other == key || other.starts_with(key + '.');
}

/// Adds an assignment in place of those that it replaces. What stands before a removal stays: list
/// items have other numbers after it.
void put(std::vector<Assignment>& all, const Assignment& next) {
  const SetText set = next.parts();
  if (set.value) {
    const auto last_removal = std::find_if(
        all.rbegin(), all.rend(), [](const Assignment& one) { return !one.parts().value; });
    all.erase(std::remove_if(last_removal.base(), all.end(),
                             [&](const Assignment& one) {
                               const SetText other = one.parts();
                               return other.file == set.file && one.is_for(next.pipeline) &&
                                      covers(set.path, other.path);
                             }),
              all.end());
  }
  all.push_back(next);
}
}  // namespace

void Edits::add(const std::vector<Assignment>& assignments, std::uint64_t gesture) {
  changes_.resize(done_);
  if (gesture != 0 && !changes_.empty() && changes_.back().gesture == gesture) {
    changes_.pop_back();
  }
  changes_.push_back({assignments, gesture});
  done_ = changes_.size();
}

std::vector<Assignment> Edits::of_first(std::size_t count) const {
  std::vector<Assignment> all = given_;
  for (std::size_t n = 0; n < count; ++n) {
    for (const Assignment& one : changes_[n].assignments) {
      put(all, one);
    }
  }
  return all;
}

std::vector<Assignment> Edits::all() const { return of_first(done_); }

std::vector<Assignment> Edits::before(std::uint64_t gesture) const {
  const bool is_on = gesture != 0 && done_ > 0 && changes_[done_ - 1].gesture == gesture;
  return of_first(is_on ? done_ - 1 : done_);
}

std::vector<std::string> texts_for(const std::vector<Assignment>& all, std::size_t pipeline) {
  std::vector<std::string> texts;
  for (const Assignment& one : all) {
    if (one.is_for(pipeline)) {
      texts.push_back(one.text);
    }
  }
  return texts;
}
}  // namespace altiplan::host
