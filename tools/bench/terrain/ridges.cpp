// SPDX-License-Identifier: Apache-2.0
#include "ridges.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>
#include <vector>

#include "altiplan/ground.hpp"
#include "altiplan/random.hpp"
#include "measuring.hpp"
#include "support/posts.hpp"

namespace altiplan::bench {
namespace {

Relief relief(HeightField field) {
  const auto layer = std::make_shared<const testing::Posts>(std::move(field));
  return {layer, layer->ground()->height_field()};
}

Vec3 place(const HeightField& field, int i, int j) {
  return {field.origin()[0] + i * field.spacing()[0], field.origin()[1] + j * field.spacing()[1],
          field.post(i, j)};
}
/// The sum of sharp ridges of all sizes and directions.
class Waves {
 public:
  explicit Waves(RandomStream random) {
    constexpr double kLongest = 9000;    // metres between the largest ridges
    constexpr double kShorter = 0.8;     // each wave than the last, down to 130 m
    constexpr double kSteepness = 0.05;  // height of a wave over its length
    for (int n = 0; n < 20; ++n) {
      const double length = kLongest * std::pow(kShorter, n);
      const double course = random.uniform(0, 2 * kPi);
      waves_.push_back({kPi * std::cos(course) / length, kPi * std::sin(course) / length,
                        random.uniform(0, kPi), kSteepness * length});
    }
  }
  double height(double x, double y) const {
    double sum = 0;
    for (const Wave& wave : waves_) {
      sum += wave.height * (1 - std::abs(std::sin(wave.east * x + wave.north * y + wave.phase)));
    }
    return sum;
  }

 private:
  struct Wave {
    double east, north, phase, height;
  };
  std::vector<Wave> waves_;
};

/// Height of a mountain range from south to north, at a place east of its crest and north of its
/// one pass.
double barrier(double east, double north, double side_m) {
  const auto bell = [](double x) { return std::exp(-x * x); };
  return 1500 * bell(east / (0.02 * side_m)) * (1 - bell(north / (0.05 * side_m)));
}
}  // namespace

Relief ridges(double side_m, std::uint64_t seed, int barriers) {
  constexpr double kSpacing = 25;  // metres
  const Waves waves(RandomStream(seed).sub("ridges"));
  const int posts = std::max(2, int(std::lround(side_m / kSpacing)) + 1);
  std::vector<float> heights;
  for (int j = 0; j < posts; ++j) {
    for (int i = 0; i < posts; ++i) {
      const double x = kSpacing * i;
      const double y = kSpacing * j;
      double height = waves.height(x, y);
      for (int n = 1; n <= barriers; ++n) {
        const double pass = side_m * (n % 2 == 1 ? 0.9 : 0.1);
        height += barrier(x - side_m * n / (barriers + 1), y - pass, side_m);
      }
      heights.push_back(float(height));
    }
  }
  return relief(HeightField({0, 0}, {kSpacing, kSpacing}, posts, posts, std::move(heights)));
}

Relief relief_of(host::Registry& registry, const std::string& file) {
  const std::shared_ptr<const Environment> layer =
      environment(registry, "terrain {file: '" + std::filesystem::absolute(file).string() +
                                "', voids: neighbours}");
  return {layer, layer->ground()->height_field()};
}

Relief with_cliffs(const HeightField& field, const Vec3& middle, double radius_m, double top_m) {
  // A cell that the circle crosses has its posts at most a diagonal from it.
  const double half = 1.01 * std::hypot(field.spacing()[0], field.spacing()[1]);
  std::vector<float> heights;
  for (int j = 0; j < field.rows(); ++j) {
    for (int i = 0; i < field.columns(); ++i) {
      const double away = (place(field, i, j) - middle).head<2>().norm();
      const bool is_cliff = std::abs(away - radius_m) <= half;
      heights.push_back(is_cliff ? float(top_m) : field.post(i, j));
    }
  }
  return relief(HeightField(field.origin(), field.spacing(), field.columns(), field.rows(),
                            std::move(heights)));
}

double height_quantile(const HeightField& field, double share) {
  std::vector<double> heights;
  for (int j = 0; j < field.rows(); ++j) {
    for (int i = 0; i < field.columns(); ++i) {
      if (!std::isnan(field.post(i, j))) {
        heights.push_back(field.post(i, j));
      }
    }
  }
  return quantile(std::move(heights), share);
}

Vec3 lowest_post(const HeightField& field, const Vec3& about, double reach_m) {
  Vec3 lowest(0, 0, kInfinity);
  for (int j = 0; j < field.rows(); ++j) {
    for (int i = 0; i < field.columns(); ++i) {
      const Vec3 post = place(field, i, j);
      const Vec3 apart = (post - about).cwiseAbs();
      if (std::max(apart.x(), apart.y()) <= reach_m && post.z() < lowest.z()) {
        lowest = post;
      }
    }
  }
  return lowest;
}
}  // namespace altiplan::bench
