// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "altiplan/formats/qgc_survey.hpp"
#include "qgc_plane.hpp"

namespace altiplan::formats::qgc {
namespace {

using Json = nlohmann::json;

constexpr int kWaypoint = 16;

std::vector<Place> places_of(const std::vector<SurveyCommand>& commands) {
  std::vector<Place> places;
  for (const SurveyCommand& command : commands) {
    if (command.command == kWaypoint) {
      places.push_back({command.lat, command.lon});
    }
  }
  return places;
}

/// Metres of the way from the start past all places and back, each place counting more.
double way_of(const std::vector<Place>& places, const Place& start, double stop_m) {
  double metres = 0;
  Place here = start;
  for (const Place& next : places) {
    metres += distance(here, next) + stop_m;
    here = next;
  }
  return metres + distance(here, start);
}

QgcSurvey survey_of(const SurveySettings& settings) {
  QgcSurvey survey;
  survey.polygon = settings.polygon;
  survey.spacing_m = settings.spacing_m;
  survey.trigger_m = settings.trigger_m;
  survey.height_m = settings.height_m;
  return survey;
}

/// The angle, in whole degrees, and the entry with the least way.
QgcSurvey best_survey(const SurveySettings& settings) {
  constexpr int kEntries = 4;
  const Place start{settings.start[1], settings.start[0]};
  QgcSurvey best = survey_of(settings);
  double least = std::numeric_limits<double>::infinity();
  for (int angle = -89; angle <= 90; ++angle) {
    for (int entry = 0; entry < kEntries; ++entry) {
      QgcSurvey survey = survey_of(settings);
      survey.angle_deg = angle;
      survey.entry = entry;
      const double way =
          way_of(places_of(survey_commands(survey, SurveyPlane::sphere)), start, settings.stop_m);
      if (way < least) {
        least = way;
        best = survey;
      }
    }
  }
  return best;
}

Json command_json(const SurveyCommand& command, int number, const SurveySettings& settings) {
  constexpr int kAboveHome = 3;
  constexpr int kAboveGround = 10;
  constexpr int kWithoutPlace = 2;
  const bool is_waypoint = command.command == kWaypoint;
  Json json{{"type", "SimpleItem"},
            {"autoContinue", true},
            {"command", command.command},
            {"doJumpId", number},
            {"frame", !is_waypoint            ? kWithoutPlace
                      : settings.above_ground ? kAboveGround
                                              : kAboveHome}};
  json["params"] = is_waypoint ? Json{0, 0, 0, nullptr, command.lat, command.lon, settings.height_m}
                               : Json{command.value, 0, 1, 0, 0, 0, 0};
  return json;
}

Json camera_json(const SurveySettings& s) {
  constexpr int kAboveHome = 1;
  constexpr int kAboveGround = 4;
  return {{"version", 2},
          {"CameraName", "Custom Camera"},
          {"AdjustedFootprintSide", s.spacing_m},
          {"AdjustedFootprintFrontal", s.trigger_m},
          {"DistanceToSurface", s.height_m},
          {"DistanceMode", s.above_ground ? kAboveGround : kAboveHome},
          {"ValueSetIsDistance", true},
          {"ImageDensity", s.gsd_cm},
          {"FrontalOverlap", 100 * s.overlap},
          {"SideOverlap", 100 * s.sidelap},
          {"SensorWidth", s.sensor_mm[0]},
          {"SensorHeight", s.sensor_mm[1]},
          {"ImageWidth", s.image_px[0]},
          {"ImageHeight", s.image_px[1]},
          {"FocalLength", s.focal_mm},
          {"Landscape", true},
          {"FixedOrientation", false},
          {"MinTriggerInterval", s.min_interval_s}};
}
}  // namespace

SurveyItem survey_item(const SurveySettings& settings, int first_number) {
  const QgcSurvey survey = best_survey(settings);
  const std::vector<SurveyCommand> commands = survey_commands(survey, SurveyPlane::sphere);
  const std::vector<Place> places = places_of(commands);
  SurveyItem item;
  int photos = 0;
  for (std::size_t i = 0; i + 1 < places.size(); i += 2) {
    item.lines.push_back(
        {Point2{places[i].lon, places[i].lat}, Point2{places[i + 1].lon, places[i + 1].lat}});
    photos += int(std::ceil(distance(places[i], places[i + 1]) / settings.trigger_m));
  }
  Json items = Json::array();
  for (const SurveyCommand& command : commands) {
    items.push_back(command_json(command, first_number + int(items.size()), settings));
  }
  Json points = Json::array();
  for (const Place& place : places) {
    points.push_back({place.lat, place.lon});
  }
  Json polygon = Json::array();
  for (const Point2& corner : settings.polygon) {
    polygon.push_back({corner[1], corner[0]});
  }
  const Json style{{"version", 2},
                   {"CameraCalc", camera_json(settings)},
                   {"CameraShots", photos},
                   {"CameraTriggerInTurnAround", false},
                   {"HoverAndCapture", false},
                   {"Items", items},
                   {"Refly90Degrees", false},
                   {"TurnAroundDistance", 0},
                   {"VisualTransectPoints", points}};
  item.json = Json{
      {"type", "ComplexItem"},
      {"complexItemType", "survey"},
      {"version", 5},
      {"TransectStyleComplexItem", style},
      {"angle", survey.angle_deg},
      {"entryLocation", survey.entry},
      {"flyAlternateTransects", false},
      {"polygon", polygon},
      {"splitConcavePolygons",
       false}}.dump();
  item.commands = commands.size();
  return item;
}
}  // namespace altiplan::formats::qgc
