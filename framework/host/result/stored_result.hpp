// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host/config/config.hpp"
#include "host/flight/track_judge.hpp"
#include "host/result/result_json.hpp"

namespace altiplan::host {

/// A result.json read back: what was planned and flown, and what it takes to build its world again
/// (`load_config(pipeline, overrides)`).
struct StoredResult {
  std::string file;
  Json json;
  std::filesystem::path pipeline;
  Overrides overrides;  ///< of the run
  std::optional<Route> route;
  std::optional<Track> track;
  std::vector<std::string> changed;  ///< files that are not those that the result was made from
};

/// Throws Error naming what is wrong; `overrides` may add plugin paths.
StoredResult read_result(const std::string& file, const Overrides& overrides);
/// The same of a result that a study keeps; `file` is its name in messages.
StoredResult stored_result(const std::string& file, Json content, const Overrides& overrides);

/// Throws Error with the line where the file is not JSON; `expected` says what it should hold.
Json read_json(const std::string& file, const std::string& expected);

/// Throws Error for a place farther away than anything that flies: queries of the world would take
/// for ever.
void expect_reachable(const Route& route, const std::string& file);

/// A list of [x, y, z]; `file` is for messages. Throws Error, for an empty list too.
Route route_of(const Json& json, const std::string& file);
}  // namespace altiplan::host
