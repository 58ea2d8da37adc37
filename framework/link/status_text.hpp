// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "link/messages.hpp"

namespace altiplan::link {

/// Joins the pieces of status texts of more than 50 characters, which come one after the other.
class StatusText {
 public:
  /// The text so far, without the blanks and tabs at its end.
  std::string joined(const Statustext& piece) {
    const bool goes_on = piece.id != 0 && piece.id == id_ && piece.chunk_seq > 0;
    text_ = (goes_on ? text_ : "") + text_of(piece.text);
    id_ = piece.id;
    return text_.substr(0, text_.find_last_not_of(" \t\r\n") + 1);
  }

 private:
  std::uint16_t id_ = 0;
  std::string text_;
};
}  // namespace altiplan::link
