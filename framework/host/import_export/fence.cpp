// SPDX-License-Identifier: Apache-2.0
#include "host/import_export/fence.hpp"

#include <algorithm>
#include <cmath>

#include "altiplan/shape.hpp"
#include "host/import_export/fence_fit.hpp"

namespace altiplan::host {
namespace {

/// A zone of one volume.
struct WorldZone {
  formats::Zone zone;
  Shape flat;              ///< without vertical limits, and without a keep-out zone's holes
  bool is_choice = false;  ///< a keep-in zone beside others, one of which must hold the vehicle
};

formats::ZoneLimit limit(double z) {
  return std::isfinite(z) ? formats::ZoneLimit::sea(z) : formats::ZoneLimit{};
}

formats::Ring lonlat(const Frame& frame, const formats::Ring& ring) {
  formats::Ring result;
  for (const formats::Point2& p : ring) {
    result.push_back(frame.to_lonlat(p[0], p[1]));
  }
  return result;
}

/// The true circle around the local one, or inside it for a keep-in zone: away from its origin the
/// world's frame has a scale error.
WorldZone circle_of(const Frame& frame, double x, double y, double radius, bool keep_in) {
  constexpr int kDirections = 64;
  const auto [lon, lat] = frame.to_lonlat(x, y);
  double low = kInfinity;
  double high = 0;
  for (int n = 0; n < kDirections; ++n) {
    const double angle = 2 * kPi * n / kDirections;
    const auto at = frame.to_lonlat(x + radius * std::cos(angle), y + radius * std::sin(angle));
    const double metres = geodesic_course({lon, lat}, at).metres;
    low = std::min(low, metres);
    high = std::max(high, metres);
  }
  WorldZone result;
  result.zone.volumes = {{{}, {}, {}, {lon, lat}, keep_in ? low : high}};
  result.flat = Cylinder{x, y, radius};
  return result;
}

WorldZone prism_of(const Frame& frame, Prism prism, bool keep_in) {
  formats::Polygon polygon{lonlat(frame, prism.outline), {}};
  for (const formats::Ring& hole : prism.holes) {
    polygon.holes.push_back(lonlat(frame, hole));
  }
  WorldZone result;
  result.zone.volumes = {{std::move(polygon), {}, {}}};
  if (!keep_in) {
    prism.holes.clear();
  }
  result.flat = Prism{prism.outline, prism.holes};
  return result;
}

/// A box becomes a prism; a sphere, the cylinder around it.
WorldZone zone_of(const Frame& frame, const Drawn& drawn) {
  const bool keep_in = drawn.role == Drawn::Role::keep_in;
  WorldZone result;
  const Box box = bounds(drawn.shape);
  if (const auto* cylinder = std::get_if<Cylinder>(&drawn.shape)) {
    result = circle_of(frame, cylinder->x, cylinder->y, cylinder->radius, keep_in);
  } else if (const auto* sphere = std::get_if<Sphere>(&drawn.shape)) {
    result = circle_of(frame, sphere->centre.x(), sphere->centre.y(), sphere->radius, keep_in);
  } else if (const auto* prism = std::get_if<Prism>(&drawn.shape)) {
    result = prism_of(frame, *prism, keep_in);
  } else {
    result = prism_of(frame,
                      {{{box.min.x(), box.min.y()},
                        {box.max.x(), box.min.y()},
                        {box.max.x(), box.max.y()},
                        {box.min.x(), box.max.y()}},
                       {}},
                      keep_in);
  }
  result.zone.name = drawn.name;
  result.zone.restriction =
      keep_in ? formats::Restriction::keep_in : formats::Restriction::keep_out;
  result.zone.volumes.front().lower = limit(box.min.z());
  result.zone.volumes.front().upper = limit(box.max.z());
  return result;
}

std::vector<WorldZone> all_zones(const World& world) {
  std::vector<WorldZone> zones;
  for (const Layer& layer : world.layers()) {
    const std::optional<Drawing> drawing = layer.environment->drawing();
    if (!drawing) {
      continue;
    }
    const auto keeps_in = [](const Drawn& drawn) { return drawn.role == Drawn::Role::keep_in; };
    const bool is_choice =
        !drawing->keeps_in_all &&
        std::count_if(drawing->shapes.begin(), drawing->shapes.end(), keeps_in) > 1;
    for (const Drawn& drawn : drawing->shapes) {
      if (drawn.role == Drawn::Role::keep_out || drawn.role == Drawn::Role::keep_in) {
        WorldZone zone = zone_of(world.frame(), drawn);
        if (zone.zone.name.empty()) {
          zone.zone.name = layer.id + "_" + std::to_string(zones.size() + 1);
        }
        zone.is_choice = is_choice && keeps_in(drawn);
        zones.push_back(std::move(zone));
      }
    }
  }
  return zones;
}

/// The circle around a prism's outline, or within that of a keep-in zone, if they are as good as
/// the same: airspace of other programs says circles by their chords.
std::optional<WorldZone> circle_from(const Frame& frame, const WorldZone& zone) {
  constexpr std::size_t kFewest = 8;  // corners
  constexpr double kMetres = 1.5;     // the outline may be off the circle, or a share of its radius
  constexpr double kShare = 0.0005;
  const auto* prism = std::get_if<Prism>(&zone.flat);
  if (prism == nullptr || prism->outline.size() < kFewest || !prism->holes.empty()) {
    return std::nullopt;
  }
  const formats::Ring& ring = prism->outline;
  double x = 0;
  double y = 0;
  for (const formats::Point2& p : ring) {
    x += p[0] / double(ring.size());
    y += p[1] / double(ring.size());
  }
  const formats::Point2 centre = frame.to_lonlat(x, y);
  const auto distance = [&](double px, double py) {
    return geodesic_course(centre, frame.to_lonlat(px, py)).metres;
  };
  double inner = kInfinity;
  double outer = 0;
  for (std::size_t n = 0; n < ring.size(); ++n) {
    const formats::Point2& p = ring[n];
    const formats::Point2& q = ring[(n + 1) % ring.size()];
    const double dx = q[0] - p[0];
    const double dy = q[1] - p[1];
    const double length2 = dx * dx + dy * dy;
    const double along = std::clamp(((x - p[0]) * dx + (y - p[1]) * dy) / length2, 0.0, 1.0);
    inner = std::min(inner, distance(p[0] + along * dx, p[1] + along * dy));
    outer = std::max(outer, distance(p[0], p[1]));
  }
  if (outer - inner > std::max(kMetres, kShare * outer)) {
    return std::nullopt;
  }
  const double local = std::hypot(ring[0][0] - x, ring[0][1] - y);
  const double scale = local / distance(ring[0][0], ring[0][1]);
  WorldZone circle = zone;
  circle.zone.volumes.front().polygon = {};
  circle.zone.volumes.front().centre = centre;
  circle.zone.volumes.front().radius_m = zone.zone.keeps_in() ? inner : outer;
  circle.flat = Cylinder{x, y, outer * scale * (1 + kShare)};
  return circle;
}

/// The ring with further corners on its long edges, which are straight in the world's frame: an
/// autopilot's are straight in longitude and latitude.
formats::Ring dense(const formats::Ring& ring) {
  constexpr double kStep = 1500;  // metres, between which both are within 5 cm
  formats::Ring result;
  for (std::size_t n = 0; n < ring.size(); ++n) {
    const formats::Point2& p = ring[n];
    const formats::Point2& q = ring[(n + 1) % ring.size()];
    const int steps = std::max(1, int(std::ceil(std::hypot(q[0] - p[0], q[1] - p[1]) / kStep)));
    for (int k = 0; k < steps; ++k) {
      const double share = double(k) / steps;
      result.push_back({p[0] + share * (q[0] - p[0]), p[1] + share * (q[1] - p[1])});
    }
  }
  return result;
}

bool crosses(const Shape& flat, const Polyline& route) {
  for (std::size_t n = 0; n + 1 < route.size(); ++n) {
    if (leg_depth(flat, route[n], route[n + 1]) > 0) {
      return true;
    }
  }
  return false;
}

/// True if all of the route is inside the circle.
bool holds(const WorldZone& circle, const Frame& frame, const Polyline& route) {
  const formats::ZoneVolume& volume = circle.zone.volumes.front();
  return std::all_of(route.begin(), route.end(), [&](const Vec3& p) {
    return geodesic_course(volume.centre, frame.to_lonlat(p.x(), p.y())).metres < volume.radius_m;
  });
}
}  // namespace

Fence zones_of(const World& world) {
  Fence fence;
  for (WorldZone& zone : all_zones(world)) {
    fence.zones.push_back(std::move(zone.zone));
  }
  return fence;
}

Fence flat_fence_of(const World& world, const Polyline& route, VehicleType vehicle) {
  Fence fence;
  std::size_t choices = 0;
  for (const WorldZone& zone : all_zones(world)) {
    choices += zone.is_choice;
    const formats::ZoneVolume& volume = zone.zone.volumes.front();
    const bool keeps_in = zone.zone.keeps_in();
    const bool has_limits =
        volume.lower != formats::ZoneLimit{} || volume.upper != formats::ZoneLimit{};
    const std::string name = "zone '" + zone.zone.name + "'";
    if (!keeps_in && crosses(zone.flat, route)) {
      fence.notes.push_back(name + " is left out of the fence: the route passes " +
                            (has_limits ? "above or below it" : "through its hole") +
                            ", which a fence cannot express");
      continue;
    }
    if (has_limits) {
      fence.notes.push_back(name +
                            " is in the fence at every height: a fence has no vertical limits");
    }
    if (!keeps_in && !volume.polygon.holes.empty()) {
      fence.notes.push_back(name + " is in the fence without its holes");
    }
    const std::optional<WorldZone> circle = circle_from(world.frame(), zone);
    if (circle &&
        (keeps_in ? holds(*circle, world.frame(), route) : !crosses(circle->flat, route))) {
      fence.zones.push_back(circle->zone);
      continue;
    }
    fence.zones.push_back(zone.zone);
    if (const auto* prism = std::get_if<Prism>(&zone.flat)) {
      formats::Polygon& polygon = fence.zones.back().volumes.front().polygon;
      polygon.outline = lonlat(world.frame(), dense(prism->outline));
      polygon.holes.clear();
      for (const formats::Ring& hole : prism->holes) {
        polygon.holes.push_back(lonlat(world.frame(), dense(hole)));
      }
    }
  }
  formats::Ring points;
  for (const Vec3& p : route) {
    points.push_back(world.frame().to_lonlat(p.x(), p.y()));
  }
  for (std::string& note : fit_fence(fence.zones, points, fence_limits(vehicle))) {
    fence.notes.push_back(std::move(note));
  }
  if (choices > 0) {
    fence.notes.push_back("an autopilot keeps in all of the fence's " + std::to_string(choices) +
                          " keep-in zones at once, where the scenario asks for one of them");
  }
  return fence;
}
}  // namespace altiplan::host
