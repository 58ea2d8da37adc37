// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <set>

#include "host/view/picture_parts.hpp"

namespace altiplan::host::picture {
namespace {

std::string point(const Map& map, const Json& p) {
  return kPen.at(map.x(p.at(0).get<double>()), map.y(p.at(1).get<double>()));
}

std::string ring(const Map& map, const Json& points) {
  std::string path;
  for (const Json& p : points) {
    path += (path.empty() ? "M" : "L") + point(map, p);
  }
  return path + "Z";
}

std::string box_path(const Map& map, double west, double south, double east, double north) {
  return "M" + kPen.at(map.x(west), map.y(south)) + "H" + pixels(map.x(east)) + "V" +
         pixels(map.y(north)) + "H" + pixels(map.x(west)) + "Z";
}

std::string circle(const Map& map, const Json& at, double radius, const std::string& paint) {
  return kPen.circle(map.x(at.at(0).get<double>()), map.y(at.at(1).get<double>()), radius, paint);
}

/// Colour by role; dashed if the planner did not know of it at the start.
std::string look(const Json& thing) {
  const std::string role = thing.at("role");
  const std::string color(role_color(role));
  const bool met = !thing.at("known").get<bool>() || !thing.at("added_by").is_null();
  // The vehicle must stay inside a keep-in zone: only its outline matters.
  return attribute("fill", role == "keep_in" ? "none" : color) + " fill-opacity=\"0.3\"" +
         attribute("stroke", color) + " stroke-width=\"1.5\"" +
         (met ? " stroke-dasharray=\"6 4\"" : "");
}

std::string solid(const Json& thing, const Map& map) {
  const std::string shape = thing.at("shape");
  if (shape == "sphere" || shape == "cylinder") {
    return circle(map, thing.at("at"), thing.at("radius").get<double>() * map.per_metre(),
                  look(thing));
  }
  std::string path;
  if (shape == "box") {
    const auto at = [&](const char* corner, int axis) {
      return thing.at(corner).at(axis).get<double>();
    };
    path = box_path(map, at("min", 0), at("min", 1), at("max", 0), at("max", 1));
  } else {
    path = ring(map, thing.at("outline"));
    for (const Json& hole : thing.at("holes")) {
      path += ring(map, hole);
    }
  }
  return kPen.path(path, " fill-rule=\"evenodd\"" + look(thing));
}

/// Many parts in one path; those identical from above only once.
std::string path_of(const std::set<std::string>& parts, const Json& thing) {
  std::string path;
  for (const std::string& part : parts) {
    path += part;
  }
  return kPen.path(path, attribute("fill", role_color(thing.at("role").get<std::string>())) +
                             " fill-opacity=\"0.75\"");
}

std::string boxes(const Json& thing, const Map& map) {
  const auto corners = numbers<float>(thing.at("data"));
  std::set<std::string> parts;
  for (std::size_t i = 0; i + 6 <= corners.size(); i += 6) {
    parts.insert(box_path(map, corners[i], corners[i + 1], corners[i + 3], corners[i + 4]));
  }
  return path_of(parts, thing);
}

std::string mesh(const Json& thing, const Map& map) {
  const auto corners = numbers<float>(thing.at("triangles"));
  std::set<std::string> parts;
  for (std::size_t i = 0; i + 9 <= corners.size(); i += 9) {
    std::string part;
    for (std::size_t corner = i; corner < i + 9; corner += 3) {
      part += kPen.corner(part, map.x(corners[corner]), map.y(corners[corner + 1]));
    }
    parts.insert(part + "Z");
  }
  return path_of(parts, thing);
}

/// The obstacle's position when the flight begins, and its motion in one minute.
std::string moving(const Json& thing, const Map& map) {
  constexpr double kMinute = 60;
  const Json& at = thing.contains("at")    ? thing.at("at")
                   : thing.contains("min") ? thing.at("min")
                                           : thing.at("outline").at(0);
  const double x = at.at(0).get<double>();
  const double y = at.at(1).get<double>();
  const Json& velocity = thing.at("velocity");
  return solid(thing, map) + line(map.x(x), map.y(y),
                                  map.x(x + kMinute * velocity.at(0).get<double>()),
                                  map.y(y + kMinute * velocity.at(1).get<double>()),
                                  role_color(thing.at("role").get<std::string>()), 1.5);
}

/// A line through points whose coordinates begin at `first`, with a light edge.
std::string polyline(const Map& map, const Json& points, std::size_t first, std::string_view color,
                     const std::string& paint) {
  std::string path;
  std::string before;
  for (const Json& p : points) {
    const std::string at =
        kPen.at(map.x(p.at(first).get<double>()), map.y(p.at(first + 1).get<double>()));
    if (at != before) {
      path += (path.empty() ? "M" : "L") + at;
    }
    before = at;
  }
  const std::string round = " stroke-linejoin=\"round\"";
  return kPen.path(path, round + " stroke=\"#ffffff\" stroke-width=\"5\" stroke-opacity=\"0.8\"") +
         kPen.path(path, round + attribute("stroke", color) + paint);
}

/// The names of marks, none cut by the map's edge or over another.
class Names {
 public:
  explicit Names(const Area& map) : map_(map) {}

  std::string beside(double x, double y, const char* text) {
    for (const double down : {0.0, -18.0, 18.0}) {
      for (const double right : {12.0, -12.0 - kWide}) {
        const Area area{x + right, y - kHigh / 2 + down, kWide, kHigh};
        if (is_free(area)) {
          taken_.push_back(area);
          return over_all(text_at(right > 0 ? area.left : area.right(), area.top + 13, text, kInk,
                                  14, right > 0 ? Align::start : Align::end, true));
        }
      }
    }
    return "";
  }

 private:
  static constexpr double kWide = 46;  // of the longest name
  static constexpr double kHigh = 16;

  bool is_free(const Area& area) const {
    return area.left >= map_.left && area.right() <= map_.right() && area.top >= map_.top &&
           area.bottom() <= map_.bottom() &&
           std::none_of(taken_.begin(), taken_.end(), [&](const Area& other) {
             return area.left < other.right() && other.left < area.right() &&
                    area.top < other.bottom() && other.top < area.bottom();
           });
  }
  Area map_;
  std::vector<Area> taken_;
};

/// The first of some areas that covers neither the start nor the goal nor their names; else the
/// first of all.
Area free_corner(const std::vector<Area>& areas, const Json& scene, const Map& map) {
  constexpr double kAround = 66;  // a mark and its name
  const auto is_free = [&](const Area& area) {
    const auto holds = [&](const Json& at) {
      const double x = map.x(at.at(0).get<double>());
      const double y = map.y(at.at(1).get<double>());
      return x > area.left - kAround && x < area.right() + kAround && y > area.top - kAround / 2 &&
             y < area.bottom() + kAround / 2;
    };
    return (scene.at("start").is_null() || !holds(scene.at("start"))) &&
           (scene.at("goal").is_null() || !holds(scene.at("goal").at("at")));
  };
  const auto found = std::find_if(areas.begin(), areas.end(), is_free);
  return found == areas.end() ? areas.front() : *found;
}

std::string ends(const Json& scene, const Map& map) {
  const std::string ink = attribute("stroke", kInk) + " stroke-width=\"2\"";
  std::string svg;
  const auto goal_like = [&](const Json& goal, const std::string& fill) {
    const double tolerance = goal.at("tolerance").get<double>() * map.per_metre();
    svg += circle(map, goal.at("at"), tolerance, ink + " stroke-dasharray=\"2 3\"");
    const double x = map.x(goal.at("at").at(0).get<double>());
    const double y = map.y(goal.at("at").at(1).get<double>());
    svg += rectangle({x - 6, y - 6, 12, 12}, ink + attribute("fill", fill));
    return std::array{x, y};
  };
  for (const Json& via : scene.at("via")) {
    goal_like(via, "#ffffff");
  }
  for (const Json& loiter : scene.at("loiters")) {
    svg += circle(map, loiter.at("at"), loiter.at("radius").get<double>() * map.per_metre(),
                  ink + " fill=\"none\"");
  }
  Names names(map.area());
  if (!scene.at("goal").is_null()) {
    const auto [x, y] = goal_like(scene.at("goal"), "#1a2027");
    svg += names.beside(x, y, "Goal");
  }
  if (const Json& start = scene.at("start"); !start.is_null()) {
    svg += circle(map, start, 6.5, ink + " fill=\"#ffffff\"");
    svg +=
        names.beside(map.x(start.at(0).get<double>()), map.y(start.at(1).get<double>()), "Start");
  }
  return svg;
}
}  // namespace

std::string solids(const Json& scene, const Map& map) {
  std::string svg;
  for (const Json& thing : scene.at("boxes")) {
    svg += is_drawn(thing) ? boxes(thing, map) : "";
  }
  for (const Json& thing : scene.at("meshes")) {
    svg += mesh(thing, map);
  }
  for (const Json& thing : scene.at("solids")) {
    svg += is_drawn(thing) ? solid(thing, map) : "";
  }
  for (const Json& thing : scene.at("moving")) {
    svg += moving(thing, map);
  }
  return svg;
}

std::string routes(const Json& scene, const Map& map) {
  std::string svg;
  const Json& results = scene.at("results");
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (const Json& flight = results[i].at("flight"); !flight.is_null()) {
      svg += polyline(map, flight.at("track"), 1, route_color(i),
                      " stroke-width=\"2\" stroke-dasharray=\"5 4\"");
    }
    if (const Json& route = results[i].at("route"); !route.is_null()) {
      svg += polyline(map, route, 0, route_color(i), " stroke-width=\"3\"");
    }
    svg += closest_body(scene, results[i], route_color(i), map);
  }
  return svg + ends(scene, map);
}

std::string scale_and_north(const Json& scene, const Map& map) {
  constexpr double kMargin = 8;
  const Area& area = map.area();
  const double metres = round_step(area.width / map.per_metre(), 6);
  const double length = metres * map.per_metre();
  const double right = area.right() - kMargin;
  const double bottom = area.bottom() - kMargin;
  const Area bar = free_corner({{area.left + kMargin, bottom - 36, length + 16, 36},
                                {right - length - 16, bottom - 36, length + 16, 36},
                                {area.left + kMargin, area.top + kMargin, length + 16, 36}},
                               scene, map);
  std::string svg = rectangle(bar, " fill=\"#ffffff\" fill-opacity=\"0.85\" rx=\"4\"");
  svg += kPen.path("M" + kPen.at(bar.left + 8, bar.bottom() - 16) + "v6h" + pixels(length) + "v-6",
                   attribute("stroke", kInk) + " stroke-width=\"1.5\"");
  svg += text_at(bar.left + bar.width / 2, bar.bottom() - 19,
                 metres >= 1000 ? grouped(metres / 1000) + " km" : grouped(metres) + " m", kInk, 12,
                 Align::middle);
  const Area rose = free_corner({{right - 40, area.top + kMargin, 40, 40},
                                 {area.left + kMargin, area.top + kMargin, 40, 40},
                                 {right - 40, bottom - 40, 40, 40}},
                                scene, map);
  const double x = rose.left + 20;
  const double top = rose.top + 4;
  svg += "<circle cx=\"" + pixels(x) + "\" cy=\"" + pixels(rose.top + 20) +
         "\" r=\"20\" fill=\"#ffffff\" fill-opacity=\"0.85\"/>\n" +
         kPen.path("M" + kPen.at(x, top + 11) + "l6 19h-12z", " fill=\"#d55e00\"");
  return svg + text_at(x, top + 8, "N", kInk, 13, Align::middle, true);
}
}  // namespace altiplan::host::picture
