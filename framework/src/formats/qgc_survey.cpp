// SPDX-License-Identifier: Apache-2.0
#include "altiplan/formats/qgc_survey.hpp"

#include <cmath>
#include <limits>

#include "altiplan/error.hpp"
#include "altiplan/formats/input_file.hpp"
#include "json_node.hpp"
#include "qgc_plane.hpp"

namespace altiplan::formats::qgc {
namespace {

/// A command of the plan.
struct Given {
  int command = 0;
  std::array<double, 7> params{};
};

QgcSurvey settings_of(const JsonNode& item) {
  item.at("version").expect_version(4, 5);
  const JsonNode style = item.at("TransectStyleComplexItem");
  const JsonNode camera = style.at("CameraCalc");
  const JsonNode corners = item.at("polygon");
  QgcSurvey survey;
  for (std::size_t n = 0; n < corners.size(); ++n) {
    survey.polygon.push_back(corners.at(n).place_on_earth());
  }
  if (survey.polygon.size() < 3) {
    corners.wrong("three corners or more");
  }
  survey.angle_deg = item.at("angle").number();
  survey.entry = item.at("entryLocation").whole(3);
  survey.flies_alternate = item.at("flyAlternateTransects").boolean();
  survey.spacing_m = camera.at("AdjustedFootprintSide").number();
  survey.trigger_m = camera.at("AdjustedFootprintFrontal").number();
  survey.height_m = camera.at("DistanceToSurface").number();
  if (!(survey.spacing_m > 0 && survey.spacing_m < 1e6)) {
    camera.at("AdjustedFootprintSide").wrong("a distance of lines above 0 m");
  }
  survey.turnaround_m = style.at("TurnAroundDistance").number();
  survey.triggers_in_turnaround = style.at("CameraTriggerInTurnAround").boolean();
  survey.hovers = style.at("HoverAndCapture").boolean();
  survey.reflies = style.at("Refly90Degrees").boolean();
  survey.follows_terrain =
      (style.has("FollowTerrain") && style.at("FollowTerrain").boolean()) ||
      (camera.has("DistanceMode") && camera.at("DistanceMode").whole(100) == 3);
  return survey;
}

std::vector<Given> commands_of(const JsonNode& items) {
  std::vector<Given> all;
  for (std::size_t n = 0; n < items.size(); ++n) {
    Given& given = all.emplace_back();
    given.command = items.at(n).at("command").whole(65535);
    const JsonNode params = items.at(n).at("params");
    if (params.size() != given.params.size()) {
      params.wrong("a list of 7 numbers");
    }
    for (std::size_t k = 0; k < given.params.size(); ++k) {
      given.params[k] = params.at(k).number_or_nan();
    }
  }
  return all;
}

/// Why the commands differ, or the greatest distance of waypoints.
void compare(const QgcSurvey& survey, const std::vector<SurveyCommand>& made,
             const std::vector<Given>& given, SurveyMatch& match) {
  match.problem.clear();
  match.differ_m = 0;
  for (std::size_t i = 0; i < std::max(made.size(), given.size()); ++i) {
    const auto word = [&](bool has, int command) {
      return has ? std::to_string(command) : std::string("none");
    };
    // An autopilot that knows 4501 gets it where the camera is told.
    const int theirs = i < given.size() ? (given[i].command == 4501 ? 16 : given[i].command) : 0;
    if (i >= made.size() || i >= given.size() || made[i].command != theirs) {
      match.problem = "command " + std::to_string(i) + ": expected " +
                      word(i < made.size(), i < made.size() ? made[i].command : 0) + ", found " +
                      word(i < given.size(), theirs);
      return;
    }
    if (theirs == 206 && !(std::abs(given[i].params[0] - made[i].value) < 1e-3)) {
      match.problem = "command " + std::to_string(i) + ": another trigger distance";
      return;
    }
    if (theirs == 16) {
      const Place at{given[i].params[4], given[i].params[5]};
      const double off = std::hypot(distance({made[i].lat, made[i].lon}, at),
                                    given[i].params[6] - survey.height_m);
      match.differ_m = std::max(match.differ_m, std::isnan(off) ? 1e9 : off);
    }
  }
}

SurveyMatch match_of(const JsonNode& item) {
  SurveyMatch best;
  const QgcSurvey settings = settings_of(item);
  const JsonNode style = item.at("TransectStyleComplexItem");
  const std::vector<Given> given =
      style.has("Items") ? commands_of(style.at("Items")) : std::vector<Given>{};
  bool is_first = true;
  for (const SurveyPlane plane : {SurveyPlane::sphere, SurveyPlane::ellipsoid}) {
    for (const double moved_m : {0.0, kOntoEdge, -kOntoEdge}) {
      for (const bool starts_once : {false, true}) {
        QgcSurvey survey = settings;
        survey.moved_m = moved_m;
        survey.starts_once = starts_once;
        SurveyMatch match;
        compare(survey, survey_commands(survey, plane), given, match);
        const bool is_better =
            match.problem.empty() && (!best.problem.empty() || match.differ_m < best.differ_m);
        if (is_first || is_better) {
          match.plane = plane == SurveyPlane::sphere ? "sphere" : "ellipsoid";
          match.coverage = survey_coverage(survey, plane);
          best = match;
          is_first = false;
        }
      }
    }
  }
  best.place = item.place();
  best.commands = given.size();
  if (given.empty()) {
    best.problem = "the plan has no items of it: the ground station has not made them yet";
  } else if (settings.follows_terrain) {
    best.problem = "its heights follow the terrain, which is not made again";
  }
  return best;
}
}  // namespace

std::vector<SurveyMatch> match_surveys(const std::string& file) {
  const nlohmann::json json = parse_json(file, read_file(file));
  std::vector<SurveyMatch> all;
  try {
    const JsonNode items = JsonNode(json, "").at("mission").at("items");
    for (std::size_t n = 0; n < items.size(); ++n) {
      const JsonNode item = items.at(n);
      if (item.has("complexItemType") && item.at("complexItemType").text() == "survey") {
        all.push_back(match_of(item));
      }
    }
  } catch (const Error& error) {
    throw Error(file + ": " + error.what());
  }
  if (all.empty()) {
    throw Error(file + ": expected a survey (complexItemType), found none");
  }
  return all;
}
}  // namespace altiplan::formats::qgc
