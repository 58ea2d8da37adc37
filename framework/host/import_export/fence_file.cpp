// SPDX-License-Identifier: Apache-2.0
#include "host/import_export/export.hpp"
#include "host/import_export/fence.hpp"
#include "host/import_export/plan.hpp"

namespace altiplan::host {

Exported export_fence(const Mission& mission, const Route& route) {
  Fence fence = flat_fence_of(mission.known, route.chords(kChordTolerance), mission.vehicle_type);
  Exported exported;
  exported.messages = std::move(fence.notes);
  if (fence.zones.empty()) {
    exported.messages.emplace_back("not written: the world has no zones that a fence can hold");
    return exported;
  }
  exported.mission.mission.zones = std::move(fence.zones);
  exported.text = fence_text(plan_of(exported.mission));
  return exported;
}
}  // namespace altiplan::host
