// SPDX-License-Identifier: Apache-2.0
#include "host/first_route/survey.hpp"

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
  if (lines.along_m < lines.spacing_m) {
    throw Error("--sidelap: lines " + with_digits(lines.spacing_m, 3) +
                " m apart leave gaps at their ends, where a photo shows " +
                with_digits(lines.along_m, 3) + " m along the flight: raise it to " +
                with_digits(std::ceil(100 * (1 - lines.along_m / lines.across_m)), 3));
  }
  return lines;
}

formats::Polygon read_area(const std::filesystem::path& file) {
  const std::string name = file.string();
  const std::string text = formats::read_file(name);
  const std::size_t first = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  std::vector<formats::Polygon> found;
  std::vector<std::string> flat;
  if (first != text.npos && text[first] == '{') {
    const formats::GeoJson json = formats::read_geojson(name);
    for (const formats::GeoFeature& feature : json.features) {
      found.push_back(feature.polygon);
    }
    flat = json.flat;
  } else {
    const formats::MissionFile map = formats::read_mission(name, text);
    for (const formats::Zone& zone : map.zones) {
      if (const formats::Polygon& polygon = zone.volumes.front().polygon;
          !polygon.outline.empty()) {
        found.push_back(polygon);
      }
    }
    flat = map.flat;
  }
  if (found.size() != 1) {
    throw Error(name + ": expected one polygon (KML, GeoJSON), which may have holes, found " +
                (flat.empty() ? counted(found.size(), "polygon")
                              : "one without an area, " + formats::names_text(flat)));
  }
  return found.front();
}
}  // namespace altiplan::host
