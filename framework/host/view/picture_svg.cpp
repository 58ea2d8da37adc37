// SPDX-License-Identifier: Apache-2.0
#include "host/view/picture_svg.hpp"

#include <algorithm>
#include <cmath>

#include "host/base/words.hpp"
#include "host/view/picture_parts.hpp"
#include "host/view/scene_parts.hpp"

namespace altiplan::host {
namespace picture {

std::string open_svg(double width, double height, const std::string& more) {
  return "<svg xmlns=\"http://www.w3.org/2000/svg\"" + more +
         attribute("viewBox", "0 0 " + kPen.at(width, height)) +
         " fill=\"none\" font-family=\"'DejaVu Sans', Verdana, sans-serif\">\n";
}

std::string text_at(double x, double y, std::string_view text, std::string_view color, int size,
                    Align align, bool bold) {
  std::string paint = attribute("fill", color) + attribute("font-size", std::to_string(size));
  paint += align == Align::middle ? attribute("text-anchor", "middle")
           : align == Align::end  ? attribute("text-anchor", "end")
                                  : "";
  return kPen.text(x, y, xml_text(text), paint + (bold ? attribute("font-weight", "600") : ""));
}

std::string line(double x0, double y0, double x1, double y1, std::string_view color, double width) {
  return kPen.line(x0, y0, x1, y1,
                   attribute("stroke", color) + attribute("stroke-width", pixels(width)));
}

std::string over_all(const std::string& text) {
  return "<g paint-order=\"stroke\" stroke=\"#ffffff\" stroke-width=\"4\" "
         "stroke-linejoin=\"round\">" +
         text + "</g>\n";
}

double round_step(double length, double steps) {
  const double wanted = length / steps;
  const double power = std::pow(10, std::floor(std::log10(wanted)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (wanted <= factor * power) {
      return factor * power;
    }
  }
  return 10 * power;
}

std::string grouped(double value) {
  char text[64];
  if (std::abs(value) >= 1e6) {
    std::snprintf(text, sizeof text, "%.0f", value);
  } else {
    std::snprintf(text, sizeof text, "%.6g", std::round(value * 1e6) / 1e6);
  }
  return with_commas(text);
}

Map::Map(const Json& box, const Area& room) {
  const auto at = [&](int corner, int axis) { return box.at(corner).at(axis).get<double>(); };
  west_ = at(0, 0);
  south_ = at(0, 1);
  const double width = at(1, 0) - west_;
  const double height = at(1, 1) - south_;
  scale_ = std::min(room.width / width, room.height / height);
  area_ = {room.left, room.top, width * scale_, height * scale_};
}
}  // namespace picture

namespace {

constexpr double kWidth = 1600;
constexpr double kMaxHeight = 1000;
constexpr double kMinMap = 300;  // leaves space for the legend
constexpr double kMargin = 24;
constexpr double kTitle = 36;
constexpr double kLegend = 380;
constexpr double kProfile = 210;

bool has_profile(const Json& scene) {
  const Json& results = scene.at("results");
  return std::any_of(results.begin(), results.end(),
                     [](const Json& result) { return !result.at("profile").is_null(); });
}

std::string attribution(const Json& scene) {
  std::string text;
  for (const Json& line : scene.at("attribution")) {
    text += (text.empty() ? "" : " · ") + line.get<std::string>();
  }
  return text;
}
}  // namespace

std::string picture_svg(const Json& scene) {
  using namespace picture;
  const double below = has_profile(scene) ? kProfile : 0;
  const Area room{kMargin, kMargin + kTitle, kWidth - 3 * kMargin - kLegend,
                  kMaxHeight - 2 * kMargin - kTitle - below};
  const Map map(scene.at("box"), room);
  const double bottom = std::max(map.area().bottom(), room.top + kMinMap);
  const double height = bottom + below + kMargin;
  const std::string title = scene.at("title").get<std::string>();
  std::string svg = open_svg(
      kWidth, height, attribute("width", pixels(kWidth)) + attribute("height", pixels(height)));
  svg += "<title>" + xml_text(title) + "</title>\n";
  svg += rectangle({0, 0, kWidth, height}, attribute("fill", kPaper));
  svg += text_at(kMargin, kMargin + 16, title, kInk, 20, Align::start, true);
  svg += "<clipPath id=\"map\">" + rectangle(map.area(), " ") + "</clipPath>\n";
  svg += rectangle(map.area(), " fill=\"#eef1f4\"");
  svg += "<g clip-path=\"url(#map)\">\n";
  svg += relief(scene, map) + solids(scene, map) + routes(scene, map);
  svg += "</g>\n" + rectangle(map.area(), " stroke=\"#5b6672\"") + scale_and_north(scene, map);
  svg += legend(scene, {map.area().right() + kMargin, room.top, kLegend, bottom - room.top});
  if (below > 0) {
    svg += profiles(scene, {kMargin, bottom + 12, kWidth - 2 * kMargin, below - 12});
  }
  svg += text_at(kWidth - kMargin, height - 8, attribution(scene), kFaint, 11, Align::end);
  return svg + "</svg>\n";
}

std::string profile_svg(const Route& route, const Request& request) {
  using namespace picture;
  constexpr std::size_t kSamples = 400;
  const Json ground = request.world->has_ground() ? Json(true) : Json(nullptr);
  const Json scene{{"results", {{{"profile", route_profile(route, request, {kSamples})}}}},
                   {"ground", ground}};
  const double height = kProfile + kMargin;
  return open_svg(kWidth, height) + profiles(scene, {0, kMargin, kWidth, kProfile}) + "</svg>\n";
}
}  // namespace altiplan::host
