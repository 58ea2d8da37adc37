// SPDX-License-Identifier: Apache-2.0
#include "altiplan/formats/airspace_index.hpp"

#include <algorithm>
#include <cmath>

#include "altiplan/geometry.hpp"

#include "../shape/edge_tree.hpp"

namespace altiplan::formats {
namespace {

using Datum = ZoneLimit::Datum;

struct Bounds {
  Point2 min{kInfinity, kInfinity};
  Point2 max{-kInfinity, -kInfinity};

  void add(const Point2& p) {
    min = {std::min(min[0], p[0]), std::min(min[1], p[1])};
    max = {std::max(max[0], p[0]), std::max(max[1], p[1])};
  }
  bool holds(const Point2& p) const {
    return p[0] >= min[0] && p[0] <= max[0] && p[1] >= min[1] && p[1] <= max[1];
  }
};

/// A limit as heights above the sea, or above the ground; infinite where there is none.
struct Height {
  double sea;
  double ground;
};

Height height_of(const ZoneLimit& limit, double none, double qnh_hpa) {
  switch (limit.datum) {
    case Datum::ground:
      return {none, limit.metres};
    case Datum::sea:
      return {limit.metres, none};
    case Datum::standard:
      return {standard_to_sea(limit.metres, qnh_hpa), none};
    case Datum::none:
      break;
  }
  return {none, none};
}

struct Volume {
  std::size_t zone;
  Height lower;
  Height upper;
  Bounds bounds;
  EdgeTree edges;

  bool holds_height(const AirspaceIndex::Place& place) const {
    if (place.z_m < lower.sea || place.z_m > upper.sea) {
      return false;
    }
    const double above = place.ground_m ? place.z_m - *place.ground_m : 0;
    return !place.ground_m || (above >= lower.ground && above <= upper.ground);
  }
};
}  // namespace

/// Volumes by the cells of a grid over all of them that their bounds touch.
struct AirspaceIndex::Impl {
  static constexpr int kCells = 256;

  std::vector<Volume> volumes;
  Bounds bounds;
  std::vector<std::vector<std::uint32_t>> cells;

  int cell(double value, std::size_t axis) const {
    const double width = bounds.max[axis] - bounds.min[axis];
    const double share = width > 0 ? (value - bounds.min[axis]) / width : 0;
    return std::clamp(int(share * kCells), 0, kCells - 1);
  }
  void add(const ZoneVolume& from, std::size_t zone, double qnh_hpa) {
    Volume volume{zone,
                  height_of(from.lower, -kInfinity, qnh_hpa),
                  height_of(from.upper, kInfinity, qnh_hpa),
                  {},
                  {}};
    std::vector<const Ring*> rings{&from.polygon.outline};
    for (const Ring& hole : from.polygon.holes) {
      rings.push_back(&hole);
    }
    volume.edges = EdgeTree(rings);
    for (const Point2& p : from.polygon.outline) {
      volume.bounds.add(p);
      bounds.add(p);
    }
    volumes.push_back(std::move(volume));
  }
  void fill() {
    cells.resize(std::size_t(kCells) * kCells);
    for (std::size_t n = 0; n < volumes.size(); ++n) {
      const Bounds& of = volumes[n].bounds;
      for (int j = cell(of.min[1], 1); j <= cell(of.max[1], 1); ++j) {
        for (int i = cell(of.min[0], 0); i <= cell(of.max[0], 0); ++i) {
          cells[std::size_t(j) * kCells + std::size_t(i)].push_back(std::uint32_t(n));
        }
      }
    }
  }
};

AirspaceIndex::AirspaceIndex(std::vector<Zone> zones, double qnh_hpa)
    : zones_(std::move(zones)), impl_(std::make_unique<Impl>()) {
  for (std::size_t n = 0; n < zones_.size(); ++n) {
    for (const ZoneVolume& volume : zones_[n].volumes) {
      impl_->add(volume, n, qnh_hpa);
    }
  }
  impl_->fill();
}

AirspaceIndex::~AirspaceIndex() = default;
AirspaceIndex::AirspaceIndex(AirspaceIndex&&) noexcept = default;
AirspaceIndex& AirspaceIndex::operator=(AirspaceIndex&&) noexcept = default;

void AirspaceIndex::visit(const Place& place, double from, double until,
                          const std::function<bool(const Zone&)>& visit) const {
  std::size_t last = zones_.size();
  // Zones across the antimeridian have longitudes beyond 180 degrees.
  for (const double turn : {0.0, 360.0, -360.0}) {
    const Point2 p{place.lon + turn, place.lat};
    if (!impl_->bounds.holds(p)) {
      continue;
    }
    const int cell = impl_->cell(p[1], 1) * Impl::kCells + impl_->cell(p[0], 0);
    for (const std::uint32_t n : impl_->cells[std::size_t(cell)]) {
      const Volume& volume = impl_->volumes[n];
      if (volume.zone == last || !volume.bounds.holds(p) || !volume.holds_height(place) ||
          !volume.edges.covers(p[0], p[1])) {
        continue;
      }
      last = volume.zone;
      const Zone& zone = zones_[volume.zone];
      if (zone.is_active(from, until) && !visit(zone)) {
        return;
      }
    }
  }
}

const Zone* AirspaceIndex::find(const Place& place, double time, Restriction strict) const {
  const Zone* found = nullptr;
  visit(place, time, time, [&](const Zone& zone) {
    found = zone.restriction <= strict ? &zone : nullptr;
    return found == nullptr;
  });
  return found;
}
}  // namespace altiplan::formats
