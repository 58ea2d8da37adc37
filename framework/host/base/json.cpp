// SPDX-License-Identifier: Apache-2.0
#include "host/base/json.hpp"

#include <istream>

namespace altiplan::host {

Json parse_json(std::string_view text) { return Json::parse(text); }

Json parse_json(std::istream& in, const Json::parser_callback_t& on_event) {
  return Json::parse(in, on_event);
}

Json json_or_discarded(std::string_view text) { return Json::parse(text, nullptr, false); }

std::string json_text(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

std::string exact_json_text(const Json& json) { return json.dump(); }
}  // namespace altiplan::host
