// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "altiplan/formats/polygon.hpp"
#include "host/first_route/camera.hpp"

namespace altiplan::host {

struct SurveyArea {
  std::string name;          ///< as the file has it
  formats::Polygon polygon;  ///< in longitude and latitude; holes are islands to keep out of
};

/// Areas, or a line, to be photographed from above.
struct SurveyWish {
  std::filesystem::path file;
  std::vector<SurveyArea> areas;
  formats::Ring line;             ///< without areas: its corners, in longitude and latitude
  std::vector<double> offsets_m;  ///< along lines so far to its left; negative: to its right
  double width_m = 0;             ///< or along all lines that its surroundings take
  Camera camera;
  double gsd_m = 0.02;      ///< what a pixel shows
  double overlap = 0.75;    ///< shares of a photo that the next one shows too, along
  double sidelap = 0.7;     ///< and across the flight
  double tolerance = 0.05;  ///< share by which the scale of photos may be off
  double drawn = 0.6;       ///< share of that for the drawn route; the rest is for how it is flown
  bool has_start = false;   ///< the first of the wish's points, else corners alone
  std::optional<double> flight_s{};  ///< of areas: several flights, by estimate none longer
};

/// Heights and distances that give the photos, by the formulas of photogrammetry: metres and m/s.
struct SurveyLines {
  double above_ground_m = 0;
  double across_m = 0;  ///< what a photo shows of flat ground
  double along_m = 0;
  double spacing_m = 0;  ///< of the lines
  double trigger_m = 0;  ///< between photos
  double off_m = 0;      ///< by which the height may be off in flight
  double max_mps = 0;    ///< at which the camera keeps up; infinite: not known

  double drawn_off_m(const SurveyWish& wish) const { return wish.drawn * off_m; }
};
/// Throws Error, naming the option, where the photos at the ends of lines would leave gaps.
SurveyLines lines_of(const SurveyWish& wish);

/// The polygons, or the one line, of its file (KML, GeoJSON). Throws Error naming the file.
void read_places(SurveyWish& wish);

/// Of lines along the wish's line.
std::vector<double> offsets_of(const SurveyWish& wish, const SurveyLines& lines);
}  // namespace altiplan::host
