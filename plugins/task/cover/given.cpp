// SPDX-License-Identifier: Apache-2.0
#include "given.hpp"

#include "altiplan/error.hpp"
#include "clearance.hpp"

namespace altiplan::cover {
namespace {

Ring2 points_of(const formats::Ring& ring) {
  Ring2 points;
  for (const formats::Point2& p : formats::without_repeats(ring)) {
    points.emplace_back(p[0], p[1]);
  }
  return points;
}
}  // namespace

std::vector<Given> given_areas(const Params& params) {
  std::vector<Given> all{{params.name, "", {params.outline_m, params.holes_m}}};
  for (const AreaParams& area : params.more_areas) {
    all.push_back({area.name, "more_areas", {area.outline_m, area.holes_m}});
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    std::string& name = all[i].name;
    name = !name.empty()     ? "the area '" + name + "'"
           : all.size() == 1 ? "the area"
                             : "area " + std::to_string(i);
  }
  return all;
}

Area area_of(const Given& given, double clearance_m) {
  const auto key = [&](const char* own) { return given.key.empty() ? own : given.key; };
  const std::string problem = formats::polygon_problem(given.polygon);
  if (!problem.empty()) {
    const bool is_outline = !formats::polygon_problem({given.polygon.outline, {}}).empty();
    throw ParameterError(key(is_outline ? "outline_m" : "holes_m"), given.name + ": " + problem);
  }
  formats::Polygon area = given.polygon;
  if (clearance_m > 0 && !area.holes.empty()) {
    const std::vector<formats::Polygon> parts = clear_of_islands(area, clearance_m);
    if (parts.size() != 1) {
      throw ParameterError(
          key("clearance_m"),
          given.name + ": " +
              (parts.empty() ? "the islands leave nothing to cover"
                             : "the islands and their clearance cut the area into " +
                                   std::to_string(parts.size()) + " parts: cover each by itself"));
    }
    area = parts.front();
  }
  std::vector<Ring2> islands;
  for (const formats::Ring& hole : area.holes) {
    islands.push_back(points_of(hole));
  }
  return {points_of(area.outline), std::move(islands)};
}

void expect_apart(const std::vector<Given>& areas) {
  constexpr double kShared = 1e-4;
  for (std::size_t i = 0; i < areas.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (shared(areas[i].polygon.outline, areas[j].polygon.outline) > kShared) {
        throw ParameterError("more_areas", areas[j].name + " and " + areas[i].name +
                                               " overlap: cut one of them, or join the two");
      }
    }
  }
}
}  // namespace altiplan::cover
