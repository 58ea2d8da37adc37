// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "altiplan/body_places.hpp"
#include "host/base/base64.hpp"
#include "host/view/hull.hpp"
#include "host/view/scene_parts.hpp"

namespace altiplan::host {
namespace {

/// Points of a sphere around the x axis, as capsules lie: 2 n (n - 1) + 2.
std::vector<Vec3> sphere_points(int n) {
  std::vector<Vec3> points{{1, 0, 0}, {-1, 0, 0}};
  for (int ring = 1; ring < n; ++ring) {
    const double polar = kPi * ring / n;
    for (int side = 0; side < 2 * n; ++side) {
      const double around = kPi * side / n;
      points.emplace_back(std::cos(polar), std::sin(polar) * std::cos(around),
                          std::sin(polar) * std::sin(around));
    }
  }
  return points;
}

/// Points whose hull is the part, with spheres as polyhedra.
std::vector<Vec3> points_of(const BodyPart& part) {
  if (part.rounding == 0) {
    return part.corners;
  }
  constexpr std::size_t kMaxPoints = 1500;
  const bool is_simple = part.corners.size() * 266 <= kMaxPoints;
  const std::vector<Vec3> sphere = sphere_points(is_simple ? 12 : 3);
  std::vector<Vec3> points;
  for (const Vec3& corner : part.corners) {
    for (const Vec3& out : sphere) {
      points.emplace_back(corner + part.rounding * out);
    }
  }
  return points;
}

/// x, y, z, w of a unit quaternion.
Json turned_json(const Placement& place) {
  constexpr double kParts = 1e6;
  const Eigen::Quaterniond q(place.rotation);
  Json json = Json::array();
  for (int n = 0; n < 4; ++n) {
    json.push_back(std::round(q.coeffs()[n] * kParts) / kParts + 0.0);
  }
  return json;
}

Json nearest_json(const NearestBody& nearest) {
  return {{"at", rounded(nearest.placement.at)},
          {"turned", turned_json(nearest.placement)},
          {"layer", nearest.layer},
          {"body_clearance_m", rounded(nearest.distance)},
          {"proven", nearest.proven}};
}
}  // namespace

Json body_json(const Body& body) {
  Json parts = Json::array();
  for (const BodyPart& part : body.parts) {
    const std::vector<Vec3> points = points_of(part);
    std::vector<float> corners;
    for (const auto& triangle : hull_triangles(points)) {
      for (const std::size_t corner : triangle) {
        for (const double value : points[corner]) {
          corners.push_back(float(value));
        }
      }
    }
    parts.push_back({{"triangles", base64_of(corners)}});
  }
  return parts;
}

Json body_places_json(const Route& route, const Request& request, const std::string& whose,
                      SceneNotes& notes) {
  constexpr double kPlaces = 40;
  constexpr std::size_t kMaxPlaces = 400;
  const double spacing = std::max(length(route) / kPlaces, kLengthTolerance);
  const std::vector<Placement> places = body_along(route, request, spacing);
  const std::size_t every = (places.size() + kMaxPlaces - 1) / kMaxPlaces;
  Json json{{"at", Json::array()}, {"turned", Json::array()}, {"nearest", nullptr}};
  for (std::size_t n = 0; n < places.size(); n += every) {
    json["at"].push_back(rounded(places[n].at));
    json["turned"].push_back(turned_json(places[n]));
  }
  if (every > 1) {
    notes.add(whose + ": the body is drawn at " + std::to_string(json["at"].size()) + " of " +
              std::to_string(places.size()) + " places");
  }
  if (const auto nearest = nearest_body(route, request)) {
    json["nearest"] = nearest_json(*nearest);
  }
  return json;
}
}  // namespace altiplan::host
