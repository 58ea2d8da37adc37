// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

namespace altiplan::formats {

/// What was read last by a reader of files, for commands that ask for a file's properties before a
/// plugin asks for its zones. Safe to call from several threads.
template <class T>
class LastRead {
 public:
  /// `parse(file, text)`, unless that is what was read last.
  template <class Parse>
  std::shared_ptr<const T> get(const std::string& file, const std::string& text,
                               const Parse& parse) {
    constexpr std::size_t kMaxKept = 16 << 20;
    const std::lock_guard lock(mutex_);
    if (!last_ || last_->file != file || last_->text != text) {
      auto value = std::make_shared<const T>(parse(file, text));
      if (text.size() > kMaxKept) {
        return value;
      }
      last_ = Last{file, text, std::move(value)};
    }
    return last_->value;
  }

 private:
  struct Last {
    std::string file;
    std::string text;
    std::shared_ptr<const T> value;
  };
  std::mutex mutex_;
  std::optional<Last> last_;
};
}  // namespace altiplan::formats
