// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "altiplan/geometry.hpp"
#include "host/view/picture_parts.hpp"
#include "host/view/png.hpp"

namespace altiplan::host::picture {
namespace {

constexpr int kMaxPixels = 700;  // on a side

struct Heights {
  int nx = 0;
  int ny = 0;
  double dx = 0;
  double dy = 0;
  std::vector<float> z;

  double at(int i, int j) const {
    return z[std::size_t(std::clamp(j, 0, ny - 1)) * std::size_t(nx) +
             std::size_t(std::clamp(i, 0, nx - 1))];
  }
};

/// Every n-th post, so that the picture has no more pixels than are seen.
Heights heights_for_picture(const Json& ground) {
  const int nx = ground.at("nx").get<int>();
  const int ny = ground.at("ny").get<int>();
  const auto all = numbers<float>(ground.at("heights"));
  const int every = (std::max(nx, ny) + kMaxPixels - 1) / kMaxPixels;
  Heights heights{(nx - 1) / every + 1,
                  (ny - 1) / every + 1,
                  ground.at("dx").get<double>() * every,
                  ground.at("dy").get<double>() * every,
                  {}};
  for (int j = 0; j < heights.ny; ++j) {
    for (int i = 0; i < heights.nx; ++i) {
      heights.z.push_back(all[std::size_t(j * every) * std::size_t(nx) + std::size_t(i * every)]);
    }
  }
  return heights;
}

/// How bright the ground is in light from the north-west at 45°, 1 where it is level.
double light(const Heights& ground, int i, int j) {
  constexpr double kShadow = 0.38;
  constexpr double kBrightest = 1.12;
  const auto slope = [](double rise, double run) { return std::isnan(rise) ? 0 : rise / run; };
  const double east = slope(ground.at(i + 1, j) - ground.at(i - 1, j), 2 * ground.dx);
  const double north = slope(ground.at(i, j + 1) - ground.at(i, j - 1), 2 * ground.dy);
  const Vec3 sun(-0.5, 0.5, std::sqrt(0.5));
  const double facing = Vec3(-east, -north, 1).normalized().dot(sun);
  return std::min(kBrightest, kShadow + (1 - kShadow) * std::max(0.0, facing) / sun.z());
}
}  // namespace

std::array<std::uint8_t, 3> height_color(double share) {
  // OKLCH: lightness rises evenly with the height, and the hue goes from blue-grey to sand, an axis
  // that every kind of colour vision has. The matrices are those of Ottosson's OKLab.
  const double lightness = 0.54 + share * (0.95 - 0.54);
  const double chroma = 0.045 + share * (0.055 - 0.045);
  const double hue = radians(215 + share * (75 - 215));
  const double a = chroma * std::cos(hue);
  const double b = chroma * std::sin(hue);
  const auto cube = [](double value) { return value * value * value; };
  const double l = cube(lightness + 0.3963377774 * a + 0.2158037573 * b);
  const double m = cube(lightness - 0.1055613458 * a - 0.0638541728 * b);
  const double s = cube(lightness - 0.0894841775 * a - 1.2914855480 * b);
  const std::array linear{4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
                          -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
                          -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s};
  std::array<std::uint8_t, 3> color{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double kept = std::clamp(linear[i], 0.0, 1.0);
    color[i] = std::uint8_t(
        255 * (kept <= 0.0031308 ? 12.92 * kept : 1.055 * std::pow(kept, 1 / 2.4) - 0.055));
  }
  return color;
}

std::optional<std::array<double, 2>> heights_of(const Json& scene) {
  if (scene.at("ground").is_null()) {
    return std::nullopt;
  }
  std::array<double, 2> range{kInfinity, -kInfinity};
  for (const float z : numbers<float>(scene.at("ground").at("heights"))) {
    if (!std::isnan(z)) {
      range = {std::min(range[0], double(z)), std::max(range[1], double(z))};
    }
  }
  return range[0] <= range[1] ? std::optional(range) : std::nullopt;
}

std::string relief(const Json& scene, const Map& map) {
  const auto range = heights_of(scene);
  if (!range) {
    return "";
  }
  const Json& json = scene.at("ground");
  const Heights ground = heights_for_picture(json);
  const double span = std::max((*range)[1] - (*range)[0], 1e-9);
  std::vector<std::uint8_t> rgba;
  for (int j = ground.ny - 1; j >= 0; --j) {
    for (int i = 0; i < ground.nx; ++i) {
      const double z = ground.at(i, j);
      if (std::isnan(z)) {
        rgba.insert(rgba.end(), {0, 0, 0, 0});
        continue;
      }
      for (const std::uint8_t channel : height_color((z - (*range)[0]) / span)) {
        rgba.push_back(std::uint8_t(std::min(255.0, channel * light(ground, i, j))));
      }
      rgba.push_back(255);
    }
  }
  // A post is in the middle of its pixel.
  const double west = json.at("x0").get<double>() - ground.dx / 2;
  const double north = json.at("y0").get<double>() + (ground.ny - 0.5) * ground.dy;
  const std::string bytes = png(ground.nx, ground.ny, rgba);
  return "<image x=\"" + pixels(map.x(west)) + "\" y=\"" + pixels(map.y(north)) + "\" width=\"" +
         pixels(ground.nx * ground.dx * map.per_metre()) + "\" height=\"" +
         pixels(ground.ny * ground.dy * map.per_metre()) +
         "\" preserveAspectRatio=\"none\" href=\"data:image/png;base64," +
         base64(std::as_bytes(std::span(bytes))) + "\"/>\n";
}
}  // namespace altiplan::host::picture
