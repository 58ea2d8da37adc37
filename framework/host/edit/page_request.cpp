// SPDX-License-Identifier: Apache-2.0
#include "host/edit/page_request.hpp"

#include <algorithm>
#include <cctype>

#include "altiplan/error.hpp"
#include "host/result/result_json.hpp"
#include "host/view/viewer_page.hpp"

namespace altiplan::host {
namespace {

/// The page may talk to its own server and to nobody else.
constexpr std::string_view kNoNetwork = "default-src 'none';";
constexpr std::string_view kOwnServer = "default-src 'none'; connect-src 'self';";

constexpr std::size_t kMaxName = 64;

/// A problem of the wish in one line.
std::string sentence_of(const std::exception& error) {
  if (const auto* config = dynamic_cast<const ConfigError*>(&error)) {
    const auto& problem = config->problems().front();
    return problem.key.empty() ? problem.message : problem.key + ": " + problem.message;
  }
  if (dynamic_cast<const Json::exception*>(&error) != nullptr) {
    const std::string why = error.what();
    return "the request is not as expected: " + why.substr(why.find("] ") + 2);
  }
  return error.what();
}
}  // namespace

std::string error_answer(const std::string& text) { return json_text(Json{{"error", text}}); }

PageAnswer json_answer(const Json& json) { return {200, "application/json", json_text(json)}; }

PageAnswer answered(const PageRequest& request, const PageWork& work) {
  const auto found = work.find(request.method + " " + request.path);
  if (found == work.end()) {
    return {404, "application/json", error_answer("there is nothing at this address")};
  }
  try {
    const Json wish = request.body.empty() ? Json::object() : parse_json(request.body);
    if (!wish.is_object()) {
      throw Error("expected a JSON object");
    }
    return found->second(wish);
  } catch (const std::exception& error) {
    return {400, "application/json", error_answer(sentence_of(error))};
  }
}

PageAnswer edited_page(const Json& scene) {
  std::string page = viewer_page(scene);
  page.replace(page.find(kNoNetwork), kNoNetwork.size(), kOwnServer);
  return {200, "text/html; charset=utf-8", std::move(page)};
}

Vec3 moved_by(const Json& json) {
  if (!json.is_array() || json.size() != 3) {
    throw Error("expected [east, north, up] in metres");
  }
  const Vec3 by(json[0].get<double>(), json[1].get<double>(), json[2].get<double>());
  if (!by.allFinite()) {
    throw Error("expected finite metres");
  }
  return by;
}

std::string file_word(const std::string& word) {
  const bool is_plain = !word.empty() && word.size() <= kMaxName &&
                        std::all_of(word.begin(), word.end(), [](unsigned char c) {
                          return std::isalnum(c) != 0 || c == '_' || c == '-';
                        });
  if (!is_plain) {
    throw Error("'" + word.substr(0, kMaxName) +
                "': expected a name of at most 64 letters, digits, '-' and '_'");
  }
  return word;
}
}  // namespace altiplan::host
