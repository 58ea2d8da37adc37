// SPDX-License-Identifier: Apache-2.0
//
// Random maps for planners in 2-D: threats over a square, after the 80 of paper 001 (Li Chuntao, Yi
// Xiaoqin, Hu Mu, "Real-time path planning of UAV based on velocity vector field", 2012, section
// 5.1), which are not published.
#include <array>
#include <random>

#include "altiplan/environment.hpp"
#include "altiplan/kit/layers/obstacle_set.hpp"
#include "altiplan/plugin.hpp"

namespace {
using namespace altiplan;

enum class Radii { of_table, wide, narrow };

struct Params {
  Radii kind = Radii::of_table;
  int count = 80;
  double extent_m = 90000;
  std::optional<std::int64_t> seed;

  void describe(Fields& f) {
    f("kind", kind, {{"A", Radii::of_table}, {"B", Radii::wide}, {"C", Radii::narrow}})
        .doc(
            "distribution of the radii: A, one of the twelve of table 1; B, 1 to 9 km; C, 1 to "
            "5 km");
    f("count", count).range(1, 100000).doc("number of threats");
    f("extent_m", extent_m)
        .unit("m")
        .range(1, 1e9)
        .doc("side of the square, from the origin, that contains the threats' centres");
    f("seed", seed).at_least(0).doc("random seed of the threats; default: the run's seed");
  }
};

constexpr std::array<double, 12> kTable{1013, 4399, 4599, 8801, 2150, 2398,
                                        8925, 6700, 5197, 1376, 4932, 4901};

double radius(Radii kind, double u) {
  switch (kind) {
    case Radii::wide:
      return 1000 + 8000 * u;
    case Radii::narrow:
      return 1000 + 4000 * u;
    case Radii::of_table:
      break;
  }
  return kTable[std::size_t(12 * u)];
}

/// Part of the maps' definition: x, y and radius of each threat in turn, from 53 bits each.
std::vector<Cylinder> draw(const Params& params, const Site& site) {
  RandomStream of_run = site.random;
  std::mt19937_64 random(params.seed ? std::uint64_t(*params.seed) : of_run());
  const auto u = [&] { return double(random() >> 11) * 0x1p-53; };
  std::vector<Cylinder> threats(std::size_t(params.count));
  for (Cylinder& threat : threats) {
    threat.x = params.extent_m * u();
    threat.y = params.extent_m * u();
    threat.radius = radius(params.kind, u());
  }
  return threats;
}

class RandomThreats final : public kit::ShapeLayer {
 public:
  RandomThreats(const Params& params, const Site& site) : RandomThreats(draw(params, site)) {}

 private:
  explicit RandomThreats(const std::vector<Cylinder>& cylinders)
      : ShapeLayer({cylinders.begin(), cylinders.end()}, {{}, {}, threats_of(cylinders), {}}) {}

  static std::vector<Threat> threats_of(const std::vector<Cylinder>& cylinders) {
    std::vector<Threat> threats;
    for (const Cylinder& cylinder : cylinders) {
      threats.push_back({{cylinder.x, cylinder.y, 0},
                         cylinder.radius,
                         "threat",
                         std::to_string(threats.size() + 1)});
    }
    return threats;
  }
};
}  // namespace

ALTIPLAN_PLUGIN(Environment, "random_threats", RandomThreats, Params,
                "random discs of unlimited height over a square, for planners in 2-D (paper 001)")
