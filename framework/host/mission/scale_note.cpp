// SPDX-License-Identifier: Apache-2.0
#include "host/mission/scale_note.hpp"

#include <cstdio>

#include "host/mission/coverage.hpp"

namespace altiplan::host {
namespace {

std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f %%", share * 100);
  return text;
}

/// About a mission; else the volume, as far as there is ground, far from which a map projection may
/// be undefined.
Box flown_area(const Mission& mission) {
  if (!mission.site.about.empty()) {
    constexpr double kMargin = 1000;  // metres
    Box area = Box::empty();
    for (const auto& [lon, lat] : mission.site.about) {
      const auto [x, y] = mission.truth.frame().to_local(lon, lat);
      area = area.with({x, y, 0});
    }
    return area.grown(kMargin);
  }
  const Box ground = mission.truth.has_ground() ? ground_area(mission.truth) : mission.site.volume;
  return ground.intersected(mission.site.volume);
}
}  // namespace

std::string frame_about(const LonLat& origin) {
  char line[96];
  std::snprintf(line, sizeof line, "frame: {crs: local, origin_lonlat: [%.3f, %.3f]}", origin[0],
                origin[1]);
  return line;
}

double note_scale(Mission& mission, const NoteSink& on_note) {
  const Frame& frame = mission.truth.frame();
  if (!frame.has_position()) {
    return 0;
  }
  const Box area = flown_area(mission);
  const double error = frame.scale_error(area);
  if (error > 0) {
    mission.notes.push_back("frame: " + frame.crs() + ", maximum scale error " + percent(error));
    on_note(mission.notes.back());
  }
  if (error > 0.005) {
    const Vec3 middle = (area.min + area.max) / 2;
    mission.warnings.push_back(
        "lengths in the local frame are off by up to " + percent(error) +
        "; use one about the flight: " + frame_about(frame.to_lonlat(middle.x(), middle.y())));
  }
  return error;
}
}  // namespace altiplan::host
