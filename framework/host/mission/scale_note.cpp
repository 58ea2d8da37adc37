// SPDX-License-Identifier: Apache-2.0
#include "host/mission/scale_note.hpp"

#include <cstdio>

namespace altiplan::host {
namespace {

std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f %%", share * 100);
  return text;
}

/// The volume, as far as there is ground, far from which a map projection may be undefined.
Box flown_area(const Mission& mission) {
  Box ground = mission.truth.has_ground() ? Box::empty() : mission.site.volume;
  for (const Layer& layer : mission.truth.layers()) {
    if (layer.environment->ground() != nullptr) {
      ground = ground.united(layer.environment->bounds());
    }
  }
  return ground.intersected(mission.site.volume);
}
}  // namespace

void note_scale(Mission& mission, const NoteSink& on_note) {
  const Frame& frame = mission.truth.frame();
  const double error = frame.scale_error(flown_area(mission));
  if (error > 0) {
    mission.notes.push_back("frame: " + frame.crs() + ", maximum scale error " + percent(error));
    on_note(mission.notes.back());
  }
  if (error > 0.005) {
    mission.warnings.push_back(
        "lengths in the local frame are off by up to " + percent(error) +
        (mission.truth.has_ground()
             ? "; use a projected coordinate system: frame: {crs: …}"
             : "; use an origin near the flight: frame: {origin_lonlat: [lon, lat]}"));
  }
}
}  // namespace altiplan::host
