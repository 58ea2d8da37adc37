// SPDX-License-Identifier: Apache-2.0
#include "host/first_route/survey.hpp"

#include <algorithm>
#include <cmath>

#include "altiplan/error.hpp"
#include "altiplan/formats/geojson.hpp"
#include "altiplan/formats/input_file.hpp"
#include "altiplan/formats/mission_file.hpp"
#include "host/base/words.hpp"

namespace altiplan::host {

SurveyLines lines_of(const SurveyWish& wish) {
  SurveyLines lines;
  lines.above_ground_m = wish.camera.height_m(wish.gsd_m);
  lines.across_m = wish.gsd_m * wish.camera.image_px[0];
  lines.along_m = wish.gsd_m * wish.camera.image_px[1];
  lines.spacing_m = lines.across_m * (1 - wish.sidelap);
  lines.trigger_m = lines.along_m * (1 - wish.overlap);
  lines.off_m = wish.tolerance * lines.above_ground_m;
  lines.max_mps =
      wish.camera.min_interval_s > 0 ? lines.trigger_m / wish.camera.min_interval_s : kInfinity;
  // A line covers what is within half a spacing of its end, too.
  if (wish.line.empty() && lines.along_m < lines.spacing_m) {
    throw Error("--sidelap: lines " + with_digits(lines.spacing_m, 3) +
                " m apart leave gaps at their ends, where a photo shows " +
                with_digits(lines.along_m, 3) + " m along the flight: raise it to " +
                with_digits(std::ceil(100 * (1 - lines.along_m / lines.across_m)), 3));
  }
  return lines;
}

namespace {

void add_area(SurveyWish& wish, const std::string& name, const formats::Polygon& polygon,
              const std::string& problem) {
  if (!problem.empty()) {
    throw Error(wish.file.string() + ": '" + name + "': " + problem);
  }
  wish.areas.push_back({name, polygon});
}
}  // namespace

void read_places(SurveyWish& wish) {
  const std::string name = wish.file.string();
  const std::string text = formats::read_file(name);
  const std::size_t first = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  std::vector<formats::Ring> lines;
  std::vector<std::string> flat;
  if (first != text.npos && text[first] == '{') {
    const formats::GeoJson json = formats::read_geojson(name);
    for (const formats::GeoFeature& feature : json.features) {
      add_area(wish, feature.id, feature.polygon, feature.problem);
    }
    lines = json.lines;
    flat = json.flat;
  } else {
    const formats::MissionFile map = formats::read_mission(name, text);
    for (const formats::Zone& zone : map.zones) {
      if (const formats::Polygon& polygon = zone.volumes.front().polygon;
          !polygon.outline.empty()) {
        add_area(wish, zone.name, polygon, zone.problem);
      }
    }
    if (wish.areas.empty() && map.route_problem.rfind("expected one", 0) == 0) {
      throw Error(name + ": " + map.route_problem);
    }
    if (!map.items.empty()) {
      formats::Ring& line = lines.emplace_back();
      for (const formats::MissionItem& item : map.items) {
        line.push_back({item.at.lon, item.at.lat});
      }
    }
    flat = map.flat;
  }
  std::string found;
  if (!flat.empty()) {
    found = "polygons without an area, " + formats::names_text(flat);
  } else if (wish.areas.empty() && lines.size() != 1) {
    found = lines.empty() ? "none" : std::to_string(lines.size()) + " lines";
  } else if (wish.areas.empty()) {
    wish.line = formats::without_repeats(lines.front());
    found = wish.line.size() < 2 ? "a line without length" : "";
  }
  if (!found.empty()) {
    throw Error(name + ": expected polygons, which may have holes, or one line (KML, GeoJSON), " +
                "found " + found);
  }
}

std::vector<double> offsets_of(const SurveyWish& wish, const SurveyLines& lines) {
  if (wish.width_m <= 0) {
    return wish.offsets_m.empty() ? std::vector<double>{0} : wish.offsets_m;
  }
  const int count = std::max(1, int(std::ceil(wish.width_m / lines.spacing_m - 1e-9)));
  std::vector<double> offsets;
  for (int k = 0; k < count; ++k) {
    offsets.push_back(wish.width_m * ((k + 0.5) / count - 0.5));
  }
  return offsets;
}
}  // namespace altiplan::host
