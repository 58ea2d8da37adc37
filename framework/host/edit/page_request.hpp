// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <string>

#include "altiplan/geometry.hpp"
#include "host/base/json.hpp"

namespace altiplan::host {

/// A request of the page, and what it gets.
struct PageRequest {
  std::string method;  ///< GET or POST
  std::string path;    ///< after the token: "/edit"
  std::string body;    ///< JSON
};
struct PageAnswer {
  int status = 200;
  std::string type = "application/json";
  std::string body;
};

/// The answers to wishes, JSON objects that may be empty, by method and path: "POST /edit".
using PageWork = std::map<std::string, std::function<PageAnswer(const Json& wish)>>;

/// The work's answer; 404 where there is none at that address, 400 with {"error": one line} for a
/// wish that is not as expected, or that fails.
PageAnswer answered(const PageRequest& request, const PageWork& work);
PageAnswer json_answer(const Json& json);
/// A scene with what can be edited, as the page that its own server answers.
PageAnswer edited_page(const Json& scene);

/// {"error": the text}, as every failed answer.
std::string error_answer(const std::string& text);

/// [east, north, up] in finite metres. Throws Error.
Vec3 moved_by(const Json& json);
/// A word for the name of a new file, which must not lead out of the folder. Throws Error.
std::string file_word(const std::string& word);
}  // namespace altiplan::host
