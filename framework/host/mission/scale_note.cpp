// SPDX-License-Identifier: Apache-2.0
#include "host/mission/scale_note.hpp"

#include <cstdio>

#include "altiplan/kit/layers/utm.hpp"
#include "host/mission/coverage.hpp"

namespace altiplan::host {
namespace {

std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f %%", share * 100);
  return text;
}

/// The volume, as far as there is ground, far from which a map projection may be undefined.
Box flown_area(const Mission& mission) {
  const Box ground = mission.truth.has_ground() ? ground_area(mission.truth) : mission.site.volume;
  return ground.intersected(mission.site.volume);
}
}  // namespace

void note_scale(Mission& mission, const NoteSink& on_note) {
  const Frame& frame = mission.truth.frame();
  const Box area = flown_area(mission);
  const double error = frame.scale_error(area);
  if (error > 0) {
    mission.notes.push_back("frame: " + frame.crs() + ", maximum scale error " + percent(error));
    on_note(mission.notes.back());
  }
  if (error > 0.005) {
    const Vec3 middle = (area.min + area.max) / 2;
    const auto [lon, lat] = frame.to_lonlat(middle.x(), middle.y());
    char origin[64];
    std::snprintf(origin, sizeof origin, "{origin_lonlat: [%.3f, %.3f]}", lon, lat);
    mission.warnings.push_back(
        "lengths in the local frame are off by up to " + percent(error) +
        (mission.truth.has_ground()
             ? "; use a projected coordinate system: frame: {crs: '" + kit::utm_crs(lon, lat) + "'}"
             : "; use an origin near the flight: frame: " + std::string(origin)));
  }
}
}  // namespace altiplan::host
