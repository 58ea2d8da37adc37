// SPDX-License-Identifier: Apache-2.0
#include "host/view/series_colors.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <string>
#include <vector>

#include "support/files.hpp"
#include "support/folders.hpp"

namespace altiplan::host::series_colors_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// sRGB without its gamma.
Vector3d linear(const std::string& color) {
  Vector3d rgb;
  for (int c = 0; c < 3; ++c) {
    const double v = std::stoi(color.substr(std::size_t(1 + 2 * c), 2), nullptr, 16) / 255.0;
    rgb[c] = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
  }
  return rgb;
}

/// B. Ottosson, A perceptual color space for image processing, 2020.
Vector3d oklab(const Vector3d& rgb) {
  Matrix3d to_lms;
  to_lms << 0.4122214708, 0.5363325363, 0.0514459929, 0.2119034982, 0.6806995451, 0.1073969566,
      0.0883024619, 0.2817188376, 0.6299787005;
  Matrix3d to_lab;
  to_lab << 0.2104542553, 0.7936177850, -0.0040720468, 1.9779984951, -2.4285922050, 0.4505937099,
      0.0259040371, 0.7827717662, -0.8086757660;
  const Vector3d lms = to_lms * rgb.cwiseMax(0).cwiseMin(1);
  return 100 * to_lab * lms.unaryExpr([](double v) { return std::cbrt(v); });
}

/// Full protanopia, deuteranopia and tritanopia. G. M. Machado et al., A Physiologically-based
/// Model for Simulation of Color Vision Deficiency, 2009.
std::vector<Matrix3d> kinds_of_vision() {
  std::vector<Matrix3d> all(4, Matrix3d::Identity());
  all[1] << 0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116,
      1.051998;
  all[2] << 0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.011820, 0.042940,
      0.968881;
  all[3] << 1.255528, -0.076749, -0.178779, -0.078411, 0.930809, 0.147602, 0.004733, 0.691367,
      0.303900;
  return all;
}

/// The least difference that any kind of vision sees; 2 is just noticeable.
double difference(const std::string& a, const std::string& b) {
  double least = 100;
  for (const Matrix3d& vision : kinds_of_vision()) {
    least = std::min(least, (oklab(vision * linear(a)) - oklab(vision * linear(b))).norm());
  }
  return least;
}

double contrast(const std::string& a, const std::string& b) {
  const Vector3d luminance(0.2126, 0.7152, 0.0722);
  const double first = luminance.dot(linear(a)) + 0.05;
  const double second = luminance.dot(linear(b)) + 0.05;
  return std::max(first, second) / std::min(first, second);
}

TEST(SeriesColors, DifferForEveryKindOfVision) {
  EXPECT_LT(difference("#009e73", "#cc79a7"), 8) << "as two of Okabe and Ito's";
  for (std::size_t i = 0; i < kSeriesColors.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_GT(difference(kSeriesColors[i].light, kSeriesColors[j].light), 9) << i << " " << j;
      EXPECT_GT(difference(kSeriesColors[i].dark, kSeriesColors[j].dark), 9) << i << " " << j;
    }
    // As WCAG 2.1 asks of graphics.
    EXPECT_GT(contrast(kSeriesColors[i].light, "#ffffff"), 3) << i;
    EXPECT_GT(contrast(kSeriesColors[i].dark, "#14181d"), 3) << i;
  }
}

TEST(SeriesColors, AreNotThoseOfThreatsAndZones) {
  for (const SeriesColor& color : kSeriesColors) {
    for (const std::string role : {"#d55e00", "#cc79a7"}) {
      for (const std::string own : {color.light, color.dark}) {
        EXPECT_GT((oklab(linear(own)) - oklab(linear(role))).norm(), 11) << own << " " << role;
      }
    }
  }
}

TEST(SeriesColors, AreTheSameInThePage) {
  const std::string script =
      altiplan::testing::text_of(altiplan::folders::source() / "tools/viewer/src/colors.js");
  std::string light;
  std::string dark;
  for (const SeriesColor& color : kSeriesColors) {
    light += (light.empty() ? "'" : ", '") + std::string(color.light) + "'";
    dark += (dark.empty() ? "'" : ", '") + std::string(color.dark) + "'";
  }
  EXPECT_NE(script.find("light: [" + light + "],\n  dark: [" + dark + "]"), std::string::npos);
}
}  // namespace
}  // namespace altiplan::host::series_colors_test
