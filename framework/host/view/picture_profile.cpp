// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "altiplan/geometry.hpp"
#include "host/view/picture_parts.hpp"

namespace altiplan::host::picture {
namespace {

/// The role of a layer; that of a zone where the scene does not say.
std::string role_of(const std::string& layer, const Json& scene) {
  for (const char* list : {"solids", "boxes", "meshes"}) {
    for (const Json& thing : scene.contains(list) ? scene.at(list) : Json::array()) {
      if (thing.at("layer") == layer) {
        return thing.at("role").get<std::string>();
      }
    }
  }
  return "keep_out";
}

/// Distance along the route to the right, height or clearance upward.
class Chart {
 public:
  Chart(const Json& results, const Area& area, std::initializer_list<const char*> keys)
      : area_(area) {
    for (const Json& result : results) {
      const Json& profile = result.at("profile");
      if (profile.is_null()) {
        continue;
      }
      longest_ = std::max(longest_, profile.at("s").back().get<double>());
      for (const char* key : keys) {
        include(profile.at(key));
      }
    }
    longest_ = std::max(longest_, 1e-3);
    add_margin();
  }
  /// Shows the obstacles of a profile from their feet to their tops, as far as these are stored.
  void include_obstacles(const Json& profile, const Json& scene) {
    for (const auto& [layer, spans] : profile.at("beside").items()) {
      for (const Json& span : role_of(layer, scene) == "obstacle" ? spans : Json::array()) {
        for (const Json& heights : span) {
          include(heights);
        }
      }
    }
    add_margin();
  }

  LengthUnit along() const { return length_unit(longest_); }
  LengthUnit up() const { return length_unit(std::max(std::abs(low_), std::abs(high_))); }
  double x(double s) const { return area_.left + s / longest_ * area_.width; }
  double y(double z) const { return area_.bottom() - (z - low_) / (high_ - low_) * area_.height; }

  std::string axes() const {
    std::string svg;
    const double dz = round_step(high_ - low_, 4);
    for (double z = std::ceil(low_ / dz) * dz + 0.0; z <= high_; z += dz) {
      svg += line(area_.left, y(z), area_.right(), y(z), "#d8dde2");
      svg += text_at(area_.left - 8, y(z) + 4, grouped(z / up().metres), kFaint, 12, Align::end);
    }
    const double ds = round_step(longest_, 10);
    for (double s = 0; s <= longest_ * (1 + 1e-9); s += ds) {
      svg += line(x(s), area_.bottom(), x(s), area_.bottom() + 5, kFaint);
      svg += text_at(x(s), area_.bottom() + 19, grouped(s / along().metres), kFaint, 12,
                     Align::middle);
    }
    return svg + line(area_.left, area_.bottom(), area_.right(), area_.bottom(), kFaint);
  }

  /// A curve, interrupted where the profile has no value.
  std::string curve(const Json& profile, const char* key) const {
    std::string path;
    bool pen_down = false;
    for (std::size_t i = 0; i < profile.at("s").size(); ++i) {
      const Json& z = profile.at(key)[i];
      if (z.is_number()) {
        path += (pen_down ? "L" : "M") +
                kPen.at(x(profile.at("s")[i].get<double>()), y(z.get<double>()));
      }
      pen_down = z.is_number();
    }
    return path;
  }

  /// The heights that layers fill, "solid" or "beside", as upright strokes in the colours of their
  /// roles.
  std::string filled(const Json& profile, const char* key, double opacity,
                     const Json& scene) const {
    std::string svg;
    for (const auto& [layer, spans] : profile.at(key).items()) {
      std::string path;
      double widest = 0;
      const Json& s = profile.at("s");
      for (std::size_t i = 0; i < spans.size(); ++i) {
        for (const Json& span : spans[i]) {
          const double low = std::max(span[0].get<double>(), low_);
          const double high = std::min(span[1].get<double>(), high_);
          if (low < high) {
            path += "M" + kPen.at(x(s[i].get<double>()), y(low)) + "V" + pixels(y(high));
            widest = std::max(widest, gap(s, i));
          }
        }
      }
      if (!path.empty()) {
        svg +=
            kPen.path(path, attribute("stroke", role_color(role_of(layer, scene))) +
                                attribute("stroke-opacity", grouped(opacity)) +
                                attribute("stroke-width", pixels(widest / longest_ * area_.width)));
      }
    }
    return svg;
  }

 private:
  void include(const Json& values) {
    for (const Json& z : values) {
      if (z.is_number()) {
        lowest_ = std::min(lowest_, z.get<double>());
        highest_ = std::max(highest_, z.get<double>());
      }
    }
  }
  void add_margin() {
    const double margin = std::max(1.0, (highest_ - lowest_) * 0.06);
    low_ = lowest_ - margin;
    high_ = highest_ + margin;
  }
  /// From a sample to the next.
  static double gap(const Json& s, std::size_t i) {
    if (s.size() < 2) {
      return 0;
    }
    const std::size_t next = std::min(i + 1, s.size() - 1);
    return s[next].get<double>() - s[next == i ? i - 1 : i].get<double>();
  }

  Area area_;
  double longest_ = 0;
  double lowest_ = kInfinity;  ///< of what is shown
  double highest_ = -kInfinity;
  double low_ = 0;  ///< of the axis
  double high_ = 0;
};

/// The frame of a chart in an area.
Area within(const Area& area) {
  return {area.left + 56, area.top + 22, area.width - 64, area.height - 46};
}

std::string heights(const Json& scene, const Area& area) {
  const Json& results = scene.at("results");
  Chart chart(results, within(area), {"altitude", "ground", "lowest", "highest"});
  if (const Json& first = results.front().at("profile");
      scene.at("ground").is_null() && !first.is_null()) {
    chart.include_obstacles(first, scene);  // else the ground is the lowest
  }
  std::string caption = std::string("Height above sea, ") + chart.up().name + ", over distance, " +
                        chart.along().name;
  if (!scene.at("ground").is_null()) {
    caption += results.size() > 1 ? "; ground, thin: of the others" : "; ground below";
  }
  std::string svg = chart.axes();
  if (const Json& first = results.front().at("profile"); !first.is_null()) {
    const std::string beside = chart.filled(first, "beside", 0.16, scene);
    const std::string solids = chart.filled(first, "solid", 0.45, scene);
    const std::string limits = chart.curve(first, "lowest") + chart.curve(first, "highest");
    caption += limits.empty() ? "" : "; dashed: allowed";
    caption += solids.empty() ? "" : "; filled: obstacles, zones";
    caption +=
        beside.empty()
            ? ""
            : "; pale: ≤ " + grouped(std::round(first.at("beside_m").get<double>())) + " m beside";
    svg += beside + solids +
           (limits.empty()
                ? ""
                : kPen.path(limits, attribute("stroke", kFaint) + " stroke-dasharray=\"5 4\""));
  }
  svg += text_at(area.left, area.top + 8, caption, kFaint, 12);
  for (std::size_t i = 0; i < results.size(); ++i) {
    const Json& profile = results[i].at("profile");
    if (profile.is_null()) {
      continue;
    }
    const std::string color(route_color(i));
    const std::string ground = chart.curve(profile, "ground");
    if (!ground.empty()) {
      svg += kPen.path(ground, attribute("stroke", i == 0 ? "#8a8378" : color) +
                                   attribute("stroke-width", i == 0 ? "1.5" : "0.8"));
    }
    svg +=
        kPen.path(chart.curve(profile, "altitude"),
                  attribute("stroke", color) + " stroke-width=\"2.5\" stroke-linejoin=\"round\"");
  }
  return svg;
}

std::string clearances(const Json& results, const Area& area) {
  const Chart chart(results, within(area), {"clearance"});
  std::string svg =
      text_at(area.left, area.top + 8,
              std::string("Clearance from all obstacles and the ground, ") + chart.up().name,
              kFaint, 12) +
      chart.axes();
  for (std::size_t i = 0; i < results.size(); ++i) {
    const Json& profile = results[i].at("profile");
    if (!profile.is_null()) {
      svg += kPen.path(
          chart.curve(profile, "clearance"),
          attribute("stroke", route_color(i)) + " stroke-width=\"2\" stroke-linejoin=\"round\"");
    }
  }
  return svg;
}

bool has_clearance(const Json& results) {
  for (const Json& result : results) {
    const Json& profile = result.at("profile");
    for (const Json& clearance : profile.is_null() ? Json::array() : profile.at("clearance")) {
      if (clearance.is_number()) {
        return true;
      }
    }
  }
  return false;
}
}  // namespace

std::string profiles(const Json& scene, const Area& area) {
  constexpr double kHeights = 0.6;  // of the width
  const Json& results = scene.at("results");
  if (!has_clearance(results)) {
    return heights(scene, area);
  }
  const double width = kHeights * area.width;
  return heights(scene, {area.left, area.top, width, area.height}) +
         clearances(results, {area.left + width, area.top, area.width - width, area.height});
}
}  // namespace altiplan::host::picture
