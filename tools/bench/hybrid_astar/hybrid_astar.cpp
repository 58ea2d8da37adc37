// SPDX-License-Identifier: Apache-2.0
// Time of hybrid_astar in level flight among towers, compared with a plain implementation with the
// same cells, headings, pieces and weight. Both plan each problem, one after the other.
#include <cmath>

#include "altiplan/check.hpp"
#include "altiplan/kit/layers/obstacle_set.hpp"
#include "altiplan/random.hpp"
#include "measuring.hpp"
#include "reference/plain_hybrid_astar.hpp"
#include "subcommand.hpp"

namespace altiplan::bench {
namespace {

constexpr double kRadius = 80;
constexpr double kHalf = 2000;
constexpr double kLevel = 100;

World towers(RandomStream& random, int count) {
  std::vector<Shape> shapes;
  for (int n = 0; n < count; ++n) {
    const Vec3 p = random.in({{-1600, -1600, 0}, {1600, 1600, 0}});
    shapes.push_back(Cylinder{p.x(), p.y(), random.uniform(30, 150), 0, 500});
  }
  return World().with({"towers", "towers", std::make_shared<kit::ShapeLayer>(std::move(shapes))});
}

Request problem(RandomStream random, int count, Pose& from, Pose& to) {
  Request request;
  request.world = std::make_shared<const World>(towers(random, count));
  request.volume = {{-kHalf, -kHalf, kLevel}, {kHalf, kHalf, kLevel}};
  request.level_m = kLevel;
  request.vehicle.speed_mps = 20;
  request.vehicle.wing = Wing{20, std::atan(400 / (9.80665 * kRadius)), 0, 0};
  request.vehicle.radius_m = 5;
  apply_constraints(request, {}, AppliesTo::route);
  const auto end = [&](double x) {
    return Pose{{x, random.uniform(-1800, 1800), kLevel}, random.uniform(-kPi, kPi)};
  };
  from = end(-1800);
  to = end(1800);
  request.start.position = from.position;
  request.start.velocity = 20 * unit_heading(from.heading);
  request.goal = {to.position, 0, to.heading};
  return request;
}

template <class Work>
double ms_of(const Work& work) {
  const double before = thread_s();
  work();
  return 1e3 * (thread_s() - before);
}

Json compare(host::Registry& registry, int count, int problems) {
  testing::PlainHybridAstar::Settings settings;
  settings.radius = kRadius * (1 + 1e-12);
  const auto ours = planner(registry, "hybrid_astar {cell_m: 40}");
  std::vector<double> our_ms;
  std::vector<double> plain_ms;
  std::vector<double> ratios;
  std::vector<double> lengths;
  int solved = 0;
  int plain_solved = 0;
  for (int n = 0; n < problems; ++n) {
    Pose from;
    Pose to;
    const Request request = problem(
        RandomStream(std::uint64_t(count)).sub("problem", std::uint64_t(n)), count, from, to);
    PlanResult result;
    const double our = ms_of([&] { result = ours->plan(request); });
    if (result.status == PlanStatus::invalid_problem) {
      continue;
    }
    testing::PlainHybridAstar plain(request, settings);
    std::optional<double> length;
    const double its = ms_of([&] { length = plain.run(from, to); });
    const double own = judged_length(result, request, "hybrid_astar");
    solved += std::isfinite(own);
    plain_solved += length.has_value();
    our_ms.push_back(our);
    plain_ms.push_back(its);
    ratios.push_back(its / our);
    if (length && std::isfinite(own)) {
      lengths.push_back(own / *length);
    }
  }
  return {{"towers", count},
          {"problems", ratios.size()},
          {"solved", solved},
          {"plain_solved", plain_solved},
          {"ms", median(our_ms)},
          {"plain_ms", median(plain_ms)},
          {"ratio", median(ratios)},
          {"ratio_p05", quantile(ratios, 0.05)},
          {"length_ratio", median(lengths)}};
}
}  // namespace

void add_hybrid_astar(Subcommands& all) {
  const auto problems = std::make_shared<int>(40);
  CLI::App& command = all.add("hybrid-astar", "time hybrid_astar against a plain implementation",
                              [=](const Given& given) {
                                Json rows = Json::array();
                                for (const int count : {0, 20, 60, 100}) {
                                  rows.push_back(compare(*given.registry, count, *problems));
                                }
                                return Json{{"level_flight", rows}};
                              });
  command.add_option("--problems", *problems, "problems of each kind")->capture_default_str();
}
}  // namespace altiplan::bench
