// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace altiplan::host {

/// Escaped for the text and the attributes of XML and HTML, without control characters, which XML
/// cannot hold.
std::string xml_text(std::string_view text);
}  // namespace altiplan::host
