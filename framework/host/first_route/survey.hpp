// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "altiplan/formats/polygon.hpp"
#include "host/first_route/camera.hpp"

namespace altiplan::host {

/// An area to be photographed from above.
struct SurveyWish {
  std::filesystem::path file;  ///< of the area
  formats::Polygon area;       ///< in longitude and latitude; holes are islands to keep out of
  Camera camera;
  double gsd_m = 0.02;      ///< what a pixel shows
  double overlap = 0.75;    ///< shares of a photo that the next one shows too, along
  double sidelap = 0.7;     ///< and across the flight
  double tolerance = 0.05;  ///< share by which the scale of photos may be off
  double drawn = 0.6;       ///< share of that for the drawn route; the rest is for how it is flown
  bool has_start = false;   ///< the first of the wish's points, else the area's corners alone
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

/// The polygon of a file of one (KML, GeoJSON). Throws Error naming the file.
formats::Polygon read_area(const std::filesystem::path& file);
}  // namespace altiplan::host
