// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>

#include "host/view/picture_parts.hpp"

namespace altiplan::host::picture {
namespace {

/// The sides of a convex part that are seen from above: together its outline.
std::string seen_from_above(const std::vector<float>& corners, const Eigen::Isometry3d& place,
                            const Map& map) {
  std::string path;
  for (std::size_t i = 0; i + 9 <= corners.size(); i += 9) {
    std::array<Vec3, 3> p;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t at = i + 3 * k;
      p[k] = place * Vec3(corners[at], corners[at + 1], corners[at + 2]);
    }
    if ((p[1] - p[0]).cross(p[2] - p[0]).z() > 0) {
      for (std::size_t k = 0; k < 3; ++k) {
        path += (k == 0 ? "M" : "L") + kPen.at(map.x(p[k].x()), map.y(p[k].y()));
      }
      path += "Z";
    }
  }
  return path;
}
}  // namespace

std::string closest_body(const Json& scene, const Json& result, std::string_view color,
                         const Map& map) {
  if (!result.contains("body") || result.at("body").at("nearest").is_null()) {
    return "";
  }
  const Json& nearest = result.at("body").at("nearest");
  const auto number = [&](const char* key, int n) { return nearest.at(key).at(n).get<double>(); };
  Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
  place.translate(Vec3(number("at", 0), number("at", 1), number("at", 2)));
  place.rotate(Eigen::Quaterniond(number("turned", 3), number("turned", 0), number("turned", 1),
                                  number("turned", 2)));
  std::string path;
  for (const Json& part : scene.at("body")) {
    path += seen_from_above(numbers<float>(part.at("triangles")), place, map);
  }
  return kPen.path(path, attribute("fill", color));
}
}  // namespace altiplan::host::picture
