// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <sstream>

#include "host/view/picture_parts.hpp"

namespace altiplan::host::picture {
namespace {

constexpr double kLine = 20;
constexpr std::size_t kLetters = 52;  // of a line of small text
constexpr std::size_t kLines = 4;

/// The text in lines, the last with an ellipsis if it does not fit.
std::vector<std::string> wrapped(const std::string& text) {
  std::vector<std::string> lines(1);
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    std::string& last = lines.back();
    if (!last.empty() && last.size() + 1 + word.size() > kLetters) {
      if (lines.size() == kLines) {
        last += " …";
        break;
      }
      lines.push_back(word);
    } else {
      last += (last.empty() ? "" : " ") + word;
    }
  }
  return lines;
}

std::string number(const Json& value, double per, const char* unit) {
  return value.is_number()
             ? ", " + grouped(std::round(value.get<double>() / per * 100) / 100) + unit
             : "";
}

/// Draws from the top down.
class Legend {
 public:
  explicit Legend(const Area& area) : area_(area), y_(area.top) {}

  void ramp(double low, double high) {
    constexpr int kStops = 8;
    std::string stops;
    for (int stop = 0; stop <= kStops; ++stop) {
      const auto [red, green, blue] = height_color(double(stop) / kStops);
      char text[96];
      std::snprintf(text, sizeof text, "<stop offset=\"%g\" stop-color=\"#%02x%02x%02x\"/>",
                    double(stop) / kStops, red, green, blue);
      stops += text;
    }
    svg_ += "<linearGradient id=\"heights\">" + stops + "</linearGradient>\n";
    svg_ += text_at(area_.left, y_ + 12, grouped(std::round(low)), kInk, 13);
    svg_ += rectangle({area_.left + 60, y_, 180, 14}, " fill=\"url(#heights)\"");
    svg_ +=
        text_at(area_.left + 250, y_ + 12, grouped(std::round(high)) + " m above sea", kInk, 13);
    y_ += 2 * kLine;
  }

  void result(std::size_t index, const Json& result) {
    const std::string color(route_color(index));
    svg_ += line(area_.left, y_ + 7, area_.left + 34, y_ + 7, color, 4);
    svg_ += text_at(
        area_.left + 46, y_ + 12,
        result.at("name").get<std::string>() + ": " + result.at("status").get<std::string>(), kInk,
        14, Align::start, true);
    y_ += kLine;
    const Json& metrics = result.at("metrics");
    const bool has_metrics = !result.at("route").is_null() && metrics.is_object();
    if (has_metrics) {
      small("route" + number(metrics.value("length_m", Json()), 1000, " km") +
            number(metrics.value("min_clearance_m", Json()), 1, " m clearance") +
            number(metrics.value("duration_s", Json()), 1, " s"));
    }
    if (result.contains("body") && !result.at("body").at("nearest").is_null()) {
      const Json& nearest = result.at("body").at("nearest");
      small("body" + number(nearest.at("body_clearance_m"), 1, " m from ") +
            nearest.at("layer").get<std::string>());
    }
    if (!has_metrics || !result.at("judged").is_null()) {
      small(result.at("message").get<std::string>());
    }
    if (const Json& flight = result.at("flight"); !flight.is_null()) {
      svg_ +=
          kPen.path("M" + kPen.at(area_.left, y_ + 6) + "h34",
                    attribute("stroke", color) + " stroke-width=\"2\" stroke-dasharray=\"5 4\"");
      small("flown: " + flight.at("message").get<std::string>());
    }
    y_ += kLine / 2;
  }

  void role(const std::string& role, bool met) {
    static const std::map<std::string, std::string> kNames{{"obstacle", "Obstacle"},
                                                           {"keep_out", "Keep-out zone"},
                                                           {"keep_in", "Keep-in zone"},
                                                           {"threat", "Threat"}};
    const std::string color(role_color(role));
    svg_ +=
        rectangle({area_.left + 6, y_, 22, 14},
                  attribute("fill", role == "keep_in" ? "none" : color) + " fill-opacity=\"0.3\"" +
                      attribute("stroke", color) + (met ? " stroke-dasharray=\"4 3\"" : ""));
    svg_ += text_at(area_.left + 46, y_ + 12, kNames.at(role) + (met ? ", met in flight" : ""),
                    kInk, 13);
    y_ += kLine;
  }

  void small(const std::string& text) {
    for (const std::string& row : wrapped(text)) {
      svg_ += text_at(area_.left + 46, y_ + 11, row, kFaint, 12);
      y_ += 16;
    }
  }
  /// True if there is space for that many more lines.
  bool has_room(double lines) const { return y_ + lines * kLine <= area_.bottom(); }
  std::string take() { return std::move(svg_); }

 private:
  Area area_;
  double y_;
  std::string svg_;
};
}  // namespace

std::string legend(const Json& scene, const Area& area) {
  Legend legend(area);
  if (const auto range = heights_of(scene)) {
    legend.ramp((*range)[0], (*range)[1]);
  }
  std::map<std::pair<std::string, bool>, bool> roles;
  for (const char* list : {"solids", "boxes", "meshes", "moving"}) {
    for (const Json& thing : scene.at(list)) {
      const bool met = !thing.at("known").get<bool>() || !thing.at("added_by").is_null();
      if (is_drawn(thing)) {
        roles[{thing.at("role").get<std::string>(), met}] = true;
      }
    }
  }
  for (const auto& [key, there] : roles) {
    legend.role(key.first, key.second);
  }
  legend.small(" ");
  const Json& results = scene.at("results");
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (!legend.has_room(9)) {
      legend.small("and " + std::to_string(results.size() - i) + " more results");
      break;
    }
    legend.result(i, results[i]);
  }
  return legend.take();
}
}  // namespace altiplan::host::picture
