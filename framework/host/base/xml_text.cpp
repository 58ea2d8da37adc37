// SPDX-License-Identifier: Apache-2.0
#include "host/base/xml_text.hpp"

namespace altiplan::host {

std::string xml_text(std::string_view text) {
  std::string out;
  for (const char letter : text) {
    switch (letter) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        if (static_cast<unsigned char>(letter) >= ' ') {
          out += letter;
        }
    }
  }
  return out;
}
}  // namespace altiplan::host
