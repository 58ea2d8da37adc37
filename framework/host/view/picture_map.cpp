// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <set>

#include "host/view/picture_parts.hpp"

namespace altiplan::host::picture {
namespace {

using namespace std::string_literals;

std::string point(const Map& map, const Json& p) {
  return pixels(map.x(p.at(0).get<double>())) + " " + pixels(map.y(p.at(1).get<double>()));
}

std::string ring(const Map& map, const Json& points) {
  std::string path;
  for (const Json& p : points) {
    path += (path.empty() ? "M" : "L") + point(map, p);
  }
  return path + "Z";
}

std::string box_path(const Map& map, double west, double south, double east, double north) {
  return "M" + pixels(map.x(west)) + " " + pixels(map.y(south)) + "H" + pixels(map.x(east)) + "V" +
         pixels(map.y(north)) + "H" + pixels(map.x(west)) + "Z";
}

std::string circle(const Map& map, const Json& at, double radius, const std::string& more) {
  return "<circle cx=\"" + pixels(map.x(at.at(0).get<double>())) + "\" cy=\"" +
         pixels(map.y(at.at(1).get<double>())) + "\" r=\"" + pixels(radius) + "\" " + more + "/>\n";
}

/// Colour by role; dashed if the planner did not know of it at the start.
std::string look(const Json& thing) {
  const std::string role = thing.at("role");
  const std::string color(role_color(role));
  const bool met = !thing.at("known").get<bool>() || !thing.at("added_by").is_null();
  // The vehicle must stay inside a keep-in zone: only its outline matters.
  return "fill=\"" + (role == "keep_in" ? "none" : color) + "\" fill-opacity=\"0.3\" stroke=\"" +
         color + "\" stroke-width=\"1.5\"" + (met ? " stroke-dasharray=\"6 4\"" : "");
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
  return "<path d=\"" + path + "\" fill-rule=\"evenodd\" " + look(thing) + "/>\n";
}

/// Many parts in one path; those identical from above only once.
std::string path_of(const std::set<std::string>& parts, const Json& thing) {
  std::string path;
  for (const std::string& part : parts) {
    path += part;
  }
  const std::string color(role_color(thing.at("role").get<std::string>()));
  return "<path d=\"" + path + "\" fill=\"" + color + "\" fill-opacity=\"0.75\"/>\n";
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
      part += (part.empty() ? "M" : "L") + pixels(map.x(corners[corner])) + " " +
              pixels(map.y(corners[corner + 1]));
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
                     const std::string& more) {
  std::string path;
  std::string before;
  for (const Json& p : points) {
    const std::string at = pixels(map.x(p.at(first).get<double>())) + " " +
                           pixels(map.y(p.at(first + 1).get<double>()));
    if (at != before) {
      path += (path.empty() ? "M" : "L") + at;
    }
    before = at;
  }
  const std::string shape = "<path d=\"" + path + "\" stroke-linejoin=\"round\" stroke=\"";
  return shape + "#ffffff\" stroke-width=\"5\" stroke-opacity=\"0.8\"/>\n" + shape +
         std::string(color) + "\" " + more + "/>\n";
}

std::string ends(const Json& scene, const Map& map) {
  const std::string ink = "stroke=\""s + std::string(kInk) + "\" stroke-width=\"2\"";
  std::string svg;
  const auto goal_like = [&](const Json& goal, const std::string& fill) {
    const double tolerance = goal.at("tolerance").get<double>() * map.per_metre();
    svg += circle(map, goal.at("at"), tolerance, ink + " stroke-dasharray=\"2 3\"");
    const double x = map.x(goal.at("at").at(0).get<double>());
    const double y = map.y(goal.at("at").at(1).get<double>());
    svg += rectangle({x - 6, y - 6, 12, 12}, ink + " fill=\"" + fill + "\"");
    return std::array{x, y};
  };
  for (const Json& via : scene.at("via")) {
    goal_like(via, "#ffffff");
  }
  for (const Json& loiter : scene.at("loiters")) {
    svg += circle(map, loiter.at("at"), loiter.at("radius").get<double>() * map.per_metre(),
                  ink + " fill=\"none\"");
  }
  const auto name = [&](double x, double y, const char* text) {
    const std::string halo = text_at(x + 12, y + 5, text, kInk, 14, Align::start, true);
    svg +=
        "<g paint-order=\"stroke\" stroke=\"#ffffff\" stroke-width=\"4\" "
        "stroke-linejoin=\"round\">" +
        halo + "</g>\n";
  };
  if (!scene.at("goal").is_null()) {
    const auto [x, y] = goal_like(scene.at("goal"), "#1a2027");
    name(x, y, "Goal");
  }
  if (const Json& start = scene.at("start"); !start.is_null()) {
    svg += circle(map, start, 6.5, ink + " fill=\"#ffffff\"");
    name(map.x(start.at(0).get<double>()), map.y(start.at(1).get<double>()), "Start");
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
                      "stroke-width=\"2\" stroke-dasharray=\"5 4\"");
    }
    if (const Json& route = results[i].at("route"); !route.is_null()) {
      svg += polyline(map, route, 0, route_color(i), "stroke-width=\"3\"");
    }
    svg += closest_body(scene, results[i], route_color(i), map);
  }
  return svg + ends(scene, map);
}

std::string scale_and_north(const Map& map) {
  const Area& area = map.area();
  const double metres = round_step(area.width / map.per_metre(), 6);
  const double length = metres * map.per_metre();
  const double left = area.left + 16;
  const double y = area.bottom() - 18;
  std::string svg = rectangle({left - 8, y - 26, length + 16, 36},
                              "fill=\"#ffffff\" fill-opacity=\"0.85\" rx=\"4\"");
  svg += "<path d=\"M" + pixels(left) + " " + pixels(y - 6) + "v6h" + pixels(length) +
         "v-6\" stroke=\"#1a2027\" stroke-width=\"1.5\"/>\n";
  svg += text_at(left + length / 2, y - 9,
                 metres >= 1000 ? grouped(metres / 1000) + " km" : grouped(metres) + " m", kInk, 12,
                 Align::middle);
  const double x = area.right() - 26;
  const double top = area.top + 14;
  svg += "<circle cx=\"" + pixels(x) + "\" cy=\"" + pixels(top + 16) +
         "\" r=\"20\" fill=\"#ffffff\" fill-opacity=\"0.85\"/>\n<path d=\"M" + pixels(x) + " " +
         pixels(top) + "l6 16h-12z\" fill=\"#d55e00\"/>\n";
  return svg + text_at(x, top + 30, "N", kInk, 13, Align::middle, true);
}
}  // namespace altiplan::host::picture
