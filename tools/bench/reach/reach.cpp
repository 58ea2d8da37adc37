// SPDX-License-Identifier: Apache-2.0
// Processor time of the search backward from home (kit/lattice/home_field.hpp) over generated
// ridges, in wind, and of asking it.
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "altiplan/kit/lattice/home_field.hpp"
#include "altiplan/measures.hpp"
#include "altiplan/random.hpp"
#include "measuring.hpp"
#include "subcommand.hpp"
#include "terrain/ridges.hpp"

namespace altiplan::bench {
namespace {

Request over(const Relief& relief) {
  const Box ground = relief.layer->bounds();
  Request request;
  request.world = std::make_shared<const World>(World().with({"ground", "terrain", relief.layer}));
  request.volume = {{ground.min.x(), ground.min.y(), relief.field->min_height()},
                    {ground.max.x(), ground.max.y(), relief.field->max_height() + 500}};
  request.vehicle.speed_mps = 15;
  request.vehicle.climb_mps = 3;
  request.vehicle.sink_mps = 2;
  request.limits.min_ground_clearance = 50;
  request.wind.layers = {{-kInfinity, {5, 2, 0}}};
  const Vec3 home = lowest_post(*relief.field, (ground.min + ground.max) / 2, 1000);
  request.start.position = home + Vec3(0, 0, 100);
  return request;
}

Json time_fields(double millions, int passes) {
  constexpr double kSide = 30e3;
  constexpr double kFlatness = 0.25;
  constexpr int kAsked = 10'000;
  const Request request = over(ridges(kSide, 1, 2));
  const double height = request.volume.max.z() - request.volume.min.z();
  const double edge = std::cbrt(kSide * kSide * height / (kFlatness * 1e6 * millions));
  std::vector<double> seconds;
  std::vector<double> asked_us;
  std::size_t cells = 0;
  for (int pass = 0; pass < passes; ++pass) {
    const double began = thread_s();
    const kit::HomeField field(
        request, {request.start.position}, {edge, edge, kFlatness * edge},
        [&](const Vec3& a, const Vec3& b) { return leg_duration(Leg::straight(a, b), request); });
    seconds.push_back(thread_s() - began);
    cells = field.lattice().size();
    RandomStream random(1);
    const double asks = thread_s();
    for (int n = 0; n < kAsked; ++n) {
      field.from(random.in(request.volume));
    }
    asked_us.push_back(1e6 * (thread_s() - asks) / kAsked);
  }
  return {{"cells", cells},
          {"fastest_s", *std::min_element(seconds.begin(), seconds.end())},
          {"p50_s", median(seconds)},
          {"asked_us", median(asked_us)}};
}
}  // namespace

void add_reach(Subcommands& all) {
  struct Arguments {
    double millions = 5;
    int passes = 5;
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App& command =
      all.add("reach", "time the search backward from home over terrain",
              [=](const Given&) { return time_fields(arguments->millions, arguments->passes); });
  command.add_option("--millions", arguments->millions, "cells, in millions")
      ->check(CLI::Range(0.01, 500.0));
  command.add_option("--passes", arguments->passes, "number of searches")
      ->check(CLI::Range(1, 1000));
}
}  // namespace altiplan::bench
