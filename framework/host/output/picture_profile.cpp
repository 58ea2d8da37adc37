// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "altiplan/geometry.hpp"
#include "host/output/picture_parts.hpp"

namespace altiplan::host::picture {
namespace {

/// Distance along the route to the right, height upward.
class Chart {
 public:
  Chart(const Json& results, const Area& area) : area_(area) {
    for (const Json& result : results) {
      const Json& profile = result.at("profile");
      if (profile.is_null()) {
        continue;
      }
      longest_ = std::max(longest_, profile.at("s").back().get<double>());
      for (const char* key : {"altitude", "ground"}) {
        for (const Json& z : profile.at(key)) {
          if (z.is_number()) {
            low_ = std::min(low_, z.get<double>());
            high_ = std::max(high_, z.get<double>());
          }
        }
      }
    }
    const double margin = std::max(1.0, (high_ - low_) * 0.06);
    low_ -= margin;
    high_ += margin;
    longest_ = std::max(longest_, 1e-3);
  }

  double x(double s) const { return area_.left + s / longest_ * area_.width; }
  double y(double z) const { return area_.bottom() - (z - low_) / (high_ - low_) * area_.height; }

  std::string axes() const {
    std::string svg;
    const double dz = round_step(high_ - low_, 4);
    for (double z = std::ceil(low_ / dz) * dz; z <= high_; z += dz) {
      svg += line(area_.left, y(z), area_.right(), y(z), "#d8dde2");
      svg += text_at(area_.left - 8, y(z) + 4, grouped(z), kFaint, 12, Align::end);
    }
    const double ds = round_step(longest_, 10);
    for (double s = 0; s <= longest_ * (1 + 1e-9); s += ds) {
      svg += line(x(s), area_.bottom(), x(s), area_.bottom() + 5, kFaint);
      svg += text_at(x(s), area_.bottom() + 19, grouped(s), kFaint, 12, Align::middle);
    }
    return svg + line(area_.left, area_.bottom(), area_.right(), area_.bottom(), kFaint);
  }

  /// A curve; where the profile has no number it is interrupted.
  std::string curve(const Json& profile, const char* key) const {
    std::string path;
    bool pen_down = false;
    for (std::size_t i = 0; i < profile.at("s").size(); ++i) {
      const Json& z = profile.at(key)[i];
      if (z.is_number()) {
        path += (pen_down ? "L" : "M") + pixels(x(profile.at("s")[i].get<double>())) + " " +
                pixels(y(z.get<double>()));
      }
      pen_down = z.is_number();
    }
    return path;
  }

 private:
  Area area_;
  double longest_ = 0;
  double low_ = kInfinity;
  double high_ = -kInfinity;
};
}  // namespace

std::string profiles(const Json& scene, const Area& area) {
  const Json& results = scene.at("results");
  const Area inner{area.left + 56, area.top + 22, area.width - 64, area.height - 46};
  const Chart chart(results, inner);
  std::string caption = "Height above the sea over the distance flown, m";
  if (!scene.at("ground").is_null()) {
    caption +=
        "; the ground below: grey below the first route, thin and in its colour below others";
  }
  std::string svg = text_at(area.left, area.top + 8, caption, kFaint, 12);
  svg += chart.axes();
  for (std::size_t i = 0; i < results.size(); ++i) {
    const Json& profile = results[i].at("profile");
    if (profile.is_null()) {
      continue;
    }
    const std::string color(route_color(i));
    const std::string ground = chart.curve(profile, "ground");
    if (!ground.empty()) {
      svg += "<path d=\"" + ground + "\" stroke=\"" + (i == 0 ? "#8a8378" : color) +
             "\" stroke-width=\"" + (i == 0 ? "1.5" : "0.8") + "\"/>\n";
    }
    svg += "<path d=\"" + chart.curve(profile, "altitude") + "\" stroke=\"" + color +
           "\" stroke-width=\"2.5\" stroke-linejoin=\"round\"/>\n";
  }
  return svg;
}
}  // namespace altiplan::host::picture
