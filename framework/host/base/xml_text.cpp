// SPDX-License-Identifier: Apache-2.0
#include "host/base/xml_text.hpp"

#include "host/base/utf8.hpp"

namespace altiplan::host {

std::string xml_text(std::string_view text) {
  std::string out;
  for (const char letter : printable(text, true)) {
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
        out += letter;
    }
  }
  for (const char* none : {"\xEF\xBF\xBE", "\xEF\xBF\xBF"}) {  // U+FFFE and U+FFFF
    for (std::size_t at = 0; (at = out.find(none, at)) != std::string::npos;) {
      out.replace(at, 3, "?");
    }
  }
  return out;
}
}  // namespace altiplan::host
