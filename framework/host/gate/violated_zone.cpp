// SPDX-License-Identifier: Apache-2.0
#include "host/gate/violated_zone.hpp"

#include <algorithm>
#include <cmath>

#include "altiplan/ground.hpp"

namespace altiplan::host {
namespace {

/// True if a zone of that name keeps the vehicle in, and no other has its name.
bool is_fence(const Drawing& drawing, const std::string& name) {
  return std::all_of(drawing.shapes.begin(), drawing.shapes.end(), [&](const Drawn& drawn) {
    return drawn.name != name || drawn.role == Drawn::Role::keep_in;
  });
}
}  // namespace

void ZoneNames::add_to(Finding& finding) {
  const Layer* layer = world_.find(finding.violation.layer);
  if (layer != nullptr && finding.at) {
    auto drawing = drawings_.find(layer->id);
    if (drawing == drawings_.end()) {
      drawing = drawings_.emplace(layer->id, layer->environment->drawing()).first;
    }
    finding.zone = drawing->second ? name_at(*drawing->second, *finding.at) : "";
    if (!finding.zone.empty()) {  // what is outside a fence lies in no zone
      const char* what = !is_fence(*drawing->second, finding.zone) ? ": '"
                         : finding.violation.value < 0             ? ": outside the fence '"
                                                                   : ": the fence '";
      finding.violation.message += what + finding.zone + "' of '" + layer->id + "'";
    }
  }
}

void ZoneNames::add_worst(const std::vector<FlownPart>& parts, const BandJudge& judge,
                          Finding& finding) {
  const auto off = [](const Violation& v) { return std::abs(v.value - v.limit); };
  for (const FlownPart& part : parts) {
    for (const BandJudge::Found& found : judge.violations(part)) {
      if (!finding.at || off(found.violation) > off(finding.violation)) {
        finding.violation = found.violation;
        finding.at = found.at;
        finding.what = part.what;
      }
    }
  }
  add_to(finding);
  name_void(finding, world_);
}

bool is_ground_layer(const std::string& id, const World& world) {
  const Layer* layer = world.find(id);
  return layer != nullptr && layer->environment->ground() != nullptr;
}

void name_void(Finding& finding, const World& world) {
  const std::optional<double> ground =
      finding.at ? world.ground(finding.at->x(), finding.at->y()) : std::nullopt;
  const std::string& rule = finding.violation.constraint;
  const bool is_of_ground = rule == "ground_clearance" || rule == "altitude" ||
                            rule == "ground_distance" || rule == "ground" ||
                            is_ground_layer(finding.violation.layer, world);
  if (is_of_ground && ground && *ground >= kUnknownGround) {
    finding.is_over_void = true;
    finding.violation.message =
        "passes over a void of the elevation model, where the ground is unknown: give its tile, or "
        "--fill-voids";
  }
}
}  // namespace altiplan::host
