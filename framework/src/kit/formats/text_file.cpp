// SPDX-License-Identifier: Apache-2.0
#include "text_file.hpp"

#include <algorithm>

#include "altiplan/error.hpp"

namespace altiplan::kit {
namespace {

using Json = nlohmann::json;

constexpr int kMaxDepth = 64;
}  // namespace

std::size_t line_at(const std::string& text, std::size_t offset) {
  const auto end = text.begin() + std::ptrdiff_t(std::min(offset, text.size()));
  return 1 + std::size_t(std::count(text.begin(), end, '\n'));
}

Json parse_json(const std::string& file, const std::string& text) {
  // Printing and freeing a value recurse as deep as its nesting.
  const auto shallow = [&](int depth, Json::parse_event_t, const Json&) {
    if (depth > kMaxDepth) {
      throw Error(file + ": lists and objects are nested more than " + std::to_string(kMaxDepth) +
                  " levels deep");
    }
    return true;
  };
  try {
    return Json::parse(text, shallow);
  } catch (const Json::parse_error& error) {
    throw Error(file + ": is not valid JSON: it ends early or has an error in line " +
                std::to_string(line_at(text, error.byte)));
  } catch (const Json::out_of_range&) {
    throw Error(file + ": contains a number that is too large (beyond 1.8e308)");
  }
}

std::string short_text(const Json& value) {
  const std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  return text.size() > 40 ? text.substr(0, 40) + "…" : text;
}
}  // namespace altiplan::kit
