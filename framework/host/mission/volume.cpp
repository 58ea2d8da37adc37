// SPDX-License-Identifier: Apache-2.0
#include "host/mission/volume.hpp"

#include <cmath>
#include <cstdio>
#include <tuple>

#include "host/config/config_check.hpp"
#include "host/mission/coverage.hpp"

namespace altiplan::host {
namespace {

constexpr const char* kAxes[] = {"x", "y", "z"};

/// Beyond the ground no route is valid.
void cut_beyond_ground(Box& box, Mission& mission, const NoteSink& on_note) {
  if (!mission.truth.has_ground()) {
    return;
  }
  const Box area = ground_area(mission.truth);
  const Box whole = box;
  for (int axis = 0; axis < 2; ++axis) {
    box.min[axis] = std::max(box.min[axis], area.min[axis]);
    box.max[axis] = std::min(box.max[axis], area.max[axis]);
    if (box.min[axis] > box.max[axis]) {
      box = whole;  // layers elsewhere are warned of
      return;
    }
  }
  if (box.min == whole.min && box.max == whole.max) {
    return;
  }
  char text[160];
  std::snprintf(text, sizeof text, "volume: cut to the ground at x %.0f to %.0f, y %.0f to %.0f m",
                box.min.x(), box.max.x(), box.min.y(), box.max.y());
  mission.notes.emplace_back(text);
  on_note(mission.notes.back());
}

void expect_bounded(const Config& config, const Box& box) {
  const Location where = place_of(config.scenario_tree, "volume");
  std::vector<Problem> problems;
  for (const auto& [key, height, side, corner] :
       {std::tuple("volume.min_m", "volume.floor_m", "below", box.min),
        std::tuple("volume.max_m", "volume.ceiling_m", "above", box.max)}) {
    std::string axes;
    for (int axis = 0; axis < 3; ++axis) {
      if (!std::isfinite(corner[axis])) {
        axes += (axes.empty() ? "" : ", ") + std::string(kAxes[axis]);
      }
    }
    if (!axes.empty()) {
      problems.push_back({where, axes == "z" ? height : key,
                          std::string("no layer bounds the volume from ") + side + " on " + axes +
                              ": give " + (axes == "z" ? height : key)});
    }
  }
  if (!problems.empty()) {
    throw ConfigError(std::move(problems));
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (box.min[axis] > box.max[axis]) {
      throw ConfigError(where, "volume",
                        std::string("the volume is empty on the ") + kAxes[axis] + " axis");
    }
  }
}
}  // namespace

Box asked_volume(const ScenarioFile& file, const std::vector<Vec3>& points) {
  const VolumeEntry& entry = file.volume;
  Box box;
  if (entry.corridor_m && !points.empty()) {
    Box around = Box::empty();
    for (const Vec3& p : points) {
      around = around.with(p);
    }
    around = around.grown(*entry.corridor_m);
    box.min.head<2>() = around.min.head<2>();
    box.max.head<2>() = around.max.head<2>();
  }
  box.min = entry.min_m.value_or(box.min);
  box.max = entry.max_m.value_or(box.max);
  box.min.z() = entry.floor_m.value_or(box.min.z());
  box.max.z() = entry.ceiling_m.value_or(box.max.z());
  return box;
}

Box volume_of(const Config& config, Mission& mission, const std::vector<Vec3>& points,
              const NoteSink& on_note) {
  const ScenarioFile& file = config.scenario;
  Box layers = mission.truth.bounds();
  if (mission.task != nullptr) {
    Box passed = mission.task->bounds();
    for (const Vec3& p : points) {
      passed = passed.with(p);
    }
    for (int axis = 0; axis < 3; ++axis) {
      layers.min[axis] = std::min(std::isfinite(layers.min[axis]) ? layers.min[axis] : kInfinity,
                                  passed.min[axis]);
      layers.max[axis] = std::max(std::isfinite(layers.max[axis]) ? layers.max[axis] : -kInfinity,
                                  passed.max[axis]);
    }
  }
  Box box = asked_volume(file, points);
  for (int axis = 0; axis < 3; ++axis) {
    box.min[axis] = std::isfinite(box.min[axis]) ? box.min[axis] : layers.min[axis];
    box.max[axis] = std::isfinite(box.max[axis]) ? box.max[axis] : layers.max[axis];
  }
  if (file.level_flight_at_m) {
    box.min.z() = box.max.z() = *file.level_flight_at_m;
  }
  expect_bounded(config, box);
  if (!config.is_only_judged) {
    cut_beyond_ground(box, mission, on_note);
  }
  return box;
}
}  // namespace altiplan::host
