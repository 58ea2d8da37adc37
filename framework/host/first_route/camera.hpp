// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

#include "altiplan/params.hpp"

namespace altiplan::host {

/// A camera that looks straight down, its width across the flight.
struct Camera {
  std::string name;
  std::array<double, 2> sensor_mm{0, 0};  ///< width and height
  std::array<double, 2> image_px{0, 0};
  double focal_mm = 0;
  double min_interval_s = 0;  ///< between two photos; 0: not known

  /// What a pixel shows from a height above the ground, metres.
  double gsd_m(double above_ground_m) const {
    return above_ground_m * sensor_mm[0] / (image_px[0] * focal_mm);
  }
  /// The height at which a pixel shows so much, metres.
  double height_m(double gsd_m) const { return gsd_m * image_px[0] * focal_mm / sensor_mm[0]; }
  void describe(Fields& f);
};

/// One of those that are known by name, in any case and with any punctuation, or by a part of the
/// name that no other has; or of a file (`.yaml`). Throws Error, listing the names, or ConfigError
/// for the file's keys.
Camera camera_of(const std::string& name_or_file);
}  // namespace altiplan::host
