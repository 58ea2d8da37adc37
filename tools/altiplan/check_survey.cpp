// SPDX-License-Identifier: Apache-2.0
#include "check_survey.hpp"

#include <algorithm>
#include <cstdio>
#include <iostream>

#include "altiplan/error.hpp"
#include "altiplan/formats/input_file.hpp"
#include "altiplan/formats/qgc_survey.hpp"
#include "commands.hpp"
#include "host/import_export/plan.hpp"
#include "host/result/result_json.hpp"

namespace altiplan::cli {
namespace {

using host::Json;

/// How far a copter may be off its lines, metres (WP_RADIUS_M, and a metre for stored numbers).
constexpr double kOffLines = 3;
/// An aeroplane, once it has lined up.
constexpr double kWingOffLines = 10;
/// Of the ends of an aeroplane's lines, what does not count: its plan has items so near to them.
constexpr double kWingEarly = 15;

double off_lines(const host::FirstRoute& first) {
  return first.beyond_m() > 0 ? kWingOffLines : kOffLines;
}

double unsure_m(const host::FirstRoute& first) { return first.beyond_m() > 0 ? kWingEarly : 0; }

/// A line without so much at both ends; nothing where none is left.
Polyline shortened(Polyline line, double metres) {
  for (int end = 0; end < 2 && metres > 0; ++end) {
    double left = metres;
    while (line.size() > 1 && left > 0) {
      const Vec3 way = line[line.size() - 2] - line.back();
      const double length = way.head<2>().norm();
      if (length > left) {
        line.back() += left / length * way;
        break;
      }
      left -= length;
      line.pop_back();
    }
    std::reverse(line.begin(), line.end());
  }
  return line;
}

/// Takes off the ends of lines where the camera may be off; the first photo is taken where it is
/// switched on.
void leave_out_ends(host::PhotoLines& photos, double unsure_m) {
  for (Polyline& line : photos.lines) {
    line = shortened(std::move(line), unsure_m);
  }
  std::erase_if(photos.lines, [](const Polyline& line) { return line.size() < 2; });
  photos.early_m = 2 * unsure_m;
}

/// Makes a plan's surveys again and compares them with its items.
int check_made_again(const std::string& file, bool as_json) {
  host::Json surveys = host::Json::array();
  double differ_m = 0;
  double coverage = 1;
  bool are_equal = true;
  for (const formats::qgc::SurveyMatch& match : formats::qgc::match_surveys(file)) {
    const bool is_equal = match.problem.empty();
    are_equal = are_equal && is_equal;
    differ_m = std::max(differ_m, match.differ_m);
    coverage = std::min(coverage, match.coverage);
    surveys.push_back({{"item", match.place},
                       {"items", match.commands},
                       {"items_differ_m", is_equal ? host::Json(match.differ_m) : host::Json()},
                       {"coverage", match.coverage},
                       {"plane", match.plane},
                       {"problem", match.problem}});
    if (!as_json) {
      std::printf("%s: %zu items, %s; lines cover %s %% of the area\n", match.place.c_str(),
                  match.commands,
                  is_equal ? ("as made again, to " + fixed(match.differ_m, 3) + " m").c_str()
                           : match.problem.c_str(),
                  fixed(100 * match.coverage, 2).c_str());
    }
  }
  if (as_json) {
    std::cout << host::file_text(
        {{"surveys", surveys},
         {"items_differ_m", are_equal ? host::Json(differ_m) : host::Json()},
         {"coverage", coverage}});
  }
  constexpr double kAsMade = 0.1;  // metres
  return are_equal && differ_m <= kAsMade ? kDone : kNoRoute;
}

/// The areas and the camera of a survey, without lines and their photos' distance.
struct Written {
  std::vector<formats::Polygon> areas;  ///< in the frame
  host::PhotoLines photos;
  double unsure_m = 0;  ///< of the ends of its lines, what does not count
};

formats::Ring ring_in(const Json& lonlat, const Frame& frame) {
  formats::Ring ring;
  for (const Json& corner : lonlat) {
    const auto [x, y] = frame.to_local(corner.at(0).get<double>(), corner.at(1).get<double>());
    ring.push_back({x, y});
  }
  return formats::without_repeats(ring);
}

/// Of a survey item of QGroundControl: its area, and its camera, by what it shows of flat ground
/// from a metre above. Throws Error where the item does not tell, or photos are not taken at
/// distances.
void add_survey_item(const Json& item, const std::string& place, const Frame& frame,
                     Written& written) {
  const Json& style = item.at("TransectStyleComplexItem");
  const Json& camera = style.at("CameraCalc");
  if (!camera.contains("SensorWidth")) {
    throw Error(place +
                ".CameraCalc: expected a camera with SensorWidth, SensorHeight and "
                "FocalLength: without it nobody knows what photos show");
  }
  if (style.at("HoverAndCapture").get<bool>()) {
    throw Error(place + ": photos at stops (HoverAndCapture) are not counted");
  }
  const bool is_landscape = camera.at("Landscape").get<bool>();
  const double width = camera.at("SensorWidth").get<double>();
  const double height = camera.at("SensorHeight").get<double>();
  const double twice_focal = 2 * camera.at("FocalLength").get<double>();
  if (!(width > 0 && height > 0 && twice_focal > 0)) {
    throw Error(place + ".CameraCalc: expected positive SensorWidth, SensorHeight and FocalLength");
  }
  const host::PhotoLines photos{{},
                                0,
                                (is_landscape ? width : height) / twice_focal,
                                (is_landscape ? height : width) / twice_focal,
                                kOffLines};
  if (!written.areas.empty() && (photos.half_across != written.photos.half_across ||
                                 photos.half_along != written.photos.half_along)) {
    throw Error(place + ".CameraCalc: expected the camera of the survey before it");
  }
  written.photos = photos;
  Json lonlat = Json::array();
  for (const Json& corner : item.at("polygon")) {
    lonlat.push_back({corner.at(1), corner.at(0)});
  }
  written.areas.push_back({ring_in(lonlat, frame), {}});
  if (const std::string problem = formats::polygon_problem(written.areas.back());
      !problem.empty()) {
    throw Error(place + ".polygon: " + problem);
  }
}

/// Of a plan with surveys of QGroundControl; no areas: it has none.
Written survey_items_in(const std::string& file, const Json& plan, const Frame& frame) {
  Written written;
  const Json items =
      plan.is_object() ? plan.value("/mission/items"_json_pointer, Json::array()) : Json::array();
  for (std::size_t n = 0; n < items.size(); ++n) {
    if (!items[n].is_object() || items[n].value("complexItemType", Json()) != "survey") {
      continue;
    }
    const std::string place = file + ": mission.items." + std::to_string(n);
    try {
      add_survey_item(items[n], place, frame, written);
    } catch (const Json::exception&) {
      throw Error(place +
                  ": expected a survey of QGroundControl, version 4 or 5, with a camera: polygon, "
                  "and TransectStyleComplexItem with HoverAndCapture and CameraCalc (SensorWidth, "
                  "SensorHeight, FocalLength, Landscape)");
    }
  }
  return written;
}

/// Throws Error for a plan without one, or a damaged one.
Written written_in(const std::string& file, const Frame& frame) {
  const Json plan = Json::parse(formats::read_file(file), nullptr, false);
  if (!plan.is_object() || !plan.contains("altiplan") || !plan["altiplan"].contains("survey")) {
    if (Written items = survey_items_in(file, plan, frame); !items.areas.empty()) {
      return items;
    }
    throw Error(file +
                ": expected a survey that altiplan survey has written (altiplan.survey), or one of "
                "QGroundControl");
  }
  const std::string place = file + ": altiplan.survey: ";
  const Json& survey = plan["altiplan"]["survey"];
  Written written;
  try {
    for (const Json& area : survey.at("areas")) {
      formats::Polygon& polygon = written.areas.emplace_back();
      polygon.outline = ring_in(area.at("outline"), frame);
      for (const Json& hole : area.at("holes")) {
        polygon.holes.push_back(ring_in(hole, frame));
      }
      if (const std::string problem = formats::polygon_problem(polygon); !problem.empty()) {
        throw Error(place + "areas: " + problem);
      }
    }
    const auto positive = [&](const char* key) {
      const double value = survey.at(key).get<double>();
      if (!(value > 0 && value < 1e6)) {
        throw Error(place + key + ": expected a positive number");
      }
      return value;
    };
    written.photos = {{},
                      0,
                      positive("across_m") / positive("from_m") / 2,
                      positive("along_m") / positive("from_m") / 2,
                      survey.value("off_m", kOffLines)};
    written.unsure_m = survey.value("unsure_m", 0.0);
    if (!(written.photos.off_m >= 0 && written.photos.off_m < 1e6 && written.unsure_m >= 0 &&
          written.unsure_m < 1e6)) {
      throw Error(place + "off_m, unsure_m: expected lengths");
    }
  } catch (const Json::exception&) {
    throw Error(place +
                "expected areas with outline and holes in longitude and latitude, and "
                "trigger_m, across_m, along_m and from_m");
  }
  if (written.areas.empty()) {
    throw Error(place + "areas: expected one or more");
  }
  return written;
}

/// Lines along which the camera takes photos, a first one at once, and the greatest distance of
/// these.
void find_lines(const JudgedPlan& judged, host::PhotoLines& photos) {
  const host::ImportedRoute& flown = judged.report.imported;
  bool is_on = false;
  std::size_t at = 0;
  std::optional<Vec3> here;
  for (const formats::MissionCommand& command : judged.mission.commands) {
    if (command.number == host::Command::kCameraTrigger) {
      is_on = command.params[0] > 0 && command.params[2] == 1 && here;
      if (is_on) {
        photos.lines.push_back({*here});
        photos.trigger_m = std::max(photos.trigger_m, command.params[0]);
      }
    }
    const auto found =
        std::find_if(flown.items.begin() + std::ptrdiff_t(at), flown.items.end(),
                     [&](const formats::MissionItem& item) { return item.place == command.place; });
    if (found != flown.items.end()) {
      at = std::size_t(found - flown.items.begin()) + 1;
      here = flown.route[at - 1];
      if (is_on) {
        photos.lines.back().push_back(*here);
      }
    }
  }
}

int check_shown(const std::string& file, const PlanCheck& options,
                const host::Overrides& overrides) {
  const JudgedPlan judged = judged_plan(options, overrides);
  const World& world = judged.world.truth;
  Written written = written_in(file, world.frame());
  const auto& autopilots = judged.report.autopilots;
  if (!std::all_of(autopilots.begin(), autopilots.end(),
                   [](const formats::Autopilot& one) { return one.is_copter(); })) {
    written.photos.off_m = std::max(written.photos.off_m, kWingOffLines);
    written.unsure_m = std::max(written.unsure_m, kWingEarly);
  }
  find_lines(judged, written.photos);
  const std::size_t stretches = written.photos.lines.size();
  leave_out_ends(written.photos, written.unsure_m);
  const double shown = host::share_shown(written.areas, written.photos, world);
  if (options.json) {
    std::cout << host::file_text({{"lines", stretches}, {"coverage", shown}});
  } else {
    std::printf("%s: %zu stretches with the camera on, %s %% of the area shown for certain\n",
                file.c_str(), stretches, fixed(100 * shown, 2).c_str());
  }
  return kDone;
}
}  // namespace

std::string with_survey(const std::string& plan, const host::FirstRoute& first,
                        const Frame& frame) {
  const auto lonlat = [&](const formats::Ring& ring) {
    Json corners = Json::array();
    for (const auto& [x, y] : ring) {
      const auto [lon, lat] = frame.to_lonlat(x, y);
      corners.push_back({lon, lat});
    }
    return corners;
  };
  Json areas = Json::array();
  for (const formats::Polygon& area : first.areas()) {
    Json holes = Json::array();
    for (const formats::Ring& hole : area.holes) {
      holes.push_back(lonlat(hole));
    }
    areas.push_back({{"outline", lonlat(area.outline)}, {"holes", holes}});
  }
  const host::SurveyLines& lines = first.lines();
  Json json = Json::parse(plan);
  json["altiplan"]["survey"] = {{"areas", areas},
                                {"across_m", lines.across_m},
                                {"along_m", lines.along_m},
                                {"from_m", lines.above_ground_m},
                                {"off_m", off_lines(first)},
                                {"unsure_m", unsure_m(first)}};
  return json.dump(4, ' ', false, Json::error_handler_t::replace) + "\n";
}

host::PhotoLines photo_lines(const host::FirstRoute& first, std::vector<Polyline> along) {
  const host::SurveyLines& lines = first.lines();
  const double per_m = 0.5 / lines.above_ground_m;
  host::PhotoLines photos{std::move(along), lines.trigger_m, per_m * lines.across_m,
                          per_m * lines.along_m, off_lines(first)};
  leave_out_ends(photos, unsure_m(first));
  return photos;
}

int check_survey(const std::string& file, const PlanCheck& options,
                 const host::Overrides& overrides) {
  return options.terrain.empty() ? check_made_again(file, options.json)
                                 : check_shown(file, options, overrides);
}
}  // namespace altiplan::cli
