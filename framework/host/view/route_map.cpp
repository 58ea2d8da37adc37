// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "host/view/picture_parts.hpp"
#include "host/view/picture_svg.hpp"
#include "host/view/scene_parts.hpp"

namespace altiplan::host {
namespace {

bool is_beside(const Json& outline, const Box& box) {
  const auto all = [&](int axis, const auto& is_off) {
    return std::all_of(outline.begin(), outline.end(),
                       [&](const Json& p) { return is_off(p.at(axis).get<double>()); });
  };
  for (int axis = 0; axis < 2; ++axis) {
    if (all(axis, [&](double v) { return v < box.min[axis]; }) ||
        all(axis, [&](double v) { return v > box.max[axis]; })) {
      return true;
    }
  }
  return false;
}

/// A dot at each waypoint, and its label where it is not on another.
std::string labelled(const Route& route, const std::vector<std::string>& labels,
                     const picture::Map& map) {
  using namespace picture;
  constexpr double kWidth = 26;
  constexpr double kHeight = 16;
  std::string svg;
  std::vector<std::array<double, 2>> placed;
  for (std::size_t i = 0; i < route.size(); ++i) {
    const double x = map.x(route[i].x());
    const double y = map.y(route[i].y());
    svg += "<circle cx=\"" + pixels(x) + "\" cy=\"" + pixels(y) +
           "\" r=\"3.5\" fill=\"#1a2027\" stroke=\"#ffffff\"/>\n";
    const bool is_free = std::none_of(placed.begin(), placed.end(), [&](const auto& other) {
      return std::abs(other[0] - x) < kWidth && std::abs(other[1] - y) < kHeight;
    });
    if (is_free && i < labels.size()) {
      placed.push_back({x, y});
      svg += over_all(text_at(x + 6, y - 6, labels[i], kInk, 14, Align::start, true));
    }
  }
  return svg;
}

Json points_json(const Route& route) {
  Json points = Json::array();
  for (std::size_t i = 0; i < route.leg_count(); ++i) {
    for (const Vec3& p : route.leg(i).chords(1)) {
      points.push_back(rounded(p));
    }
  }
  return points;
}
}  // namespace

Box box_about(const Route& route) {
  constexpr double kMinMargin = 300;  // metres
  Box box = Box::empty();
  for (std::size_t i = 0; i < route.leg_count(); ++i) {
    for (const Vec3& p : route.leg(i).chords(1)) {
      box = box.united(Box{p, p});
    }
  }
  box = box.united(Box{route.front(), route.front()});
  return box.grown(std::max(kMinMargin, (box.max - box.min).norm() * 0.1));
}

void drop_what_is_beside(Json& scene, const Box& box) {
  auto& solids = scene["solids"].get_ref<Json::array_t&>();
  solids.erase(std::remove_if(solids.begin(), solids.end(),
                              [&](const Json& solid) {
                                return solid.contains("outline") &&
                                       is_beside(solid.at("outline"), box);
                              }),
               solids.end());
}

std::string map_svg(const Route& route, const std::vector<std::string>& labels,
                    const Mission& world) {
  using namespace picture;
  constexpr double kWidth = 1600;
  constexpr double kMaxHeight = 900;
  const Box box = box_about(route);
  SceneNotes notes;
  Json scene{{"box", {rounded(box.min), rounded(box.max)}},
             {"ground", ground_json(world.truth, box, notes)},
             {"results", {{{"route", points_json(route)}, {"flight", nullptr}}}},
             {"start", nullptr},
             {"goal", nullptr}};
  for (const char* key : {"solids", "boxes", "meshes", "moving", "events", "via", "loiters"}) {
    scene[key] = Json::array();
  }
  add_solids(scene, world, {}, box, notes);
  drop_what_is_beside(scene, box);
  const Map map(scene.at("box"), {0, 0, kWidth, kMaxHeight});
  const Area& area = map.area();
  return open_svg(area.width, area.height) + rectangle(area, " fill=\"#eef1f4\"") +
         relief(scene, map) + solids(scene, map) + picture::routes(scene, map) +
         labelled(route, labels, map) + scale_and_north(scene, map) + "</svg>\n";
}
}  // namespace altiplan::host
