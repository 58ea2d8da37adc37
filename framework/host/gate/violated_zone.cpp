// SPDX-License-Identifier: Apache-2.0
#include "host/gate/violated_zone.hpp"

#include <algorithm>

#include "altiplan/ground.hpp"

namespace altiplan::host {
namespace {

/// The name of the layer's part that holds the place or is nearest to it, if it has names. Of
/// keep-in zones one of which must hold the place it is the one that the place is deepest in, as
/// far as its border; where all must, the one whose border is nearest, or that it is farthest out
/// of.
std::string part_at(const std::optional<Drawing>& drawing, const Vec3& p) {
  const Drawn* in_the_way = nullptr;
  const Drawn* around = nullptr;
  double nearest = kInfinity;
  double from_border = kInfinity;  // of `around`; negative outside of it
  if (!drawing) {
    return "";
  }
  const auto is_beyond = [&](const Shape& shape) {  // farther than the nearest, by its box alone
    const Box box = bounds(shape);
    const Vec3 off = (box.min - p).cwiseMax(p - box.max).cwiseMax(0.0);
    return off.norm() > std::max(nearest, 0.0);
  };
  for (const Drawn& drawn : drawing->shapes) {
    if (drawn.role != Drawn::Role::keep_in && nearest < kInfinity && is_beyond(drawn.shape)) {
      continue;
    }
    const double distance = signed_distance(drawn.shape, p);
    if (drawn.role != Drawn::Role::keep_in) {
      in_the_way = distance < nearest ? &drawn : in_the_way;
      nearest = std::min(nearest, distance);
    } else if (around == nullptr ||
               (drawing->keeps_in_all ? -distance < from_border : -distance > from_border)) {
      around = &drawn;
      from_border = -distance;
    }
  }
  const Drawn* part = nearest <= from_border ? in_the_way : around;
  return part == nullptr ? "" : part->name;
}
}  // namespace

void ZoneNames::add_to(Finding& finding) {
  const Layer* layer = world_.find(finding.violation.layer);
  if (layer != nullptr && finding.at) {
    auto drawing = drawings_.find(layer->id);
    if (drawing == drawings_.end()) {
      drawing = drawings_.emplace(layer->id, layer->environment->drawing()).first;
    }
    finding.zone = part_at(drawing->second, *finding.at);
    if (!finding.zone.empty()) {
      finding.violation.message += ": '" + finding.zone + "' of '" + layer->id + "'";
    }
  }
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
        "passes over a void of the elevation model, where the ground is unknown (--fill-voids)";
  }
}
}  // namespace altiplan::host
