// SPDX-License-Identifier: Apache-2.0
// RRT* with turns compared with OMPL's in its Dubins state space, in equal time.
#include <chrono>

#include "altiplan/check.hpp"
#include "altiplan/kit/layers/obstacle_set.hpp"
#include "altiplan/random.hpp"
#include "altiplan/shape.hpp"
#include "ompl_star.hpp"
#include "rows.hpp"

namespace altiplan::bench {
namespace {

constexpr double kRadius = 50;
constexpr double kHalfEdge = 20 * kRadius;
constexpr double kRange = 6 * kRadius;
constexpr double kGoalBias = 0.05;
constexpr double kSeconds = 0.5;
constexpr int kProblems = 12;

DiscProblem random_problem(RandomStream& random) {
  const Vec3 start(-0.9 * kHalfEdge, -0.9 * kHalfEdge, 0);
  DiscProblem problem{kHalfEdge, kRadius, {}, {start, random.uniform(-kPi, kPi)}, {-start, 0}};
  problem.goal.heading = random.uniform(-kPi, kPi);
  while (problem.discs.size() < 40) {
    const Disc disc{random.uniform(-kHalfEdge, kHalfEdge), random.uniform(-kHalfEdge, kHalfEdge),
                    random.uniform(kRadius, 3 * kRadius)};
    const Vec3 middle(disc.x, disc.y, 0);
    const double apart = std::min((middle - start).norm(), (middle + start).norm());
    if (apart > disc.radius + 2.5 * kRadius) {
      problem.discs.push_back(disc);
    }
  }
  return problem;
}

Request request_of(const DiscProblem& problem) {
  std::vector<Shape> shapes;
  for (const Disc& disc : problem.discs) {
    shapes.push_back(Cylinder{disc.x, disc.y, disc.radius, -1, 1});
  }
  Request request;
  request.world = std::make_shared<const World>(
      World().with({"discs", "discs", std::make_shared<kit::ShapeLayer>(shapes), true}));
  request.volume = {{-kHalfEdge, -kHalfEdge, 0}, {kHalfEdge, kHalfEdge, 0}};
  request.level_m = 0;
  request.limits.min_turn_radius = kRadius;
  request.start.position = problem.start.position;
  request.start.velocity = request.vehicle.speed_mps * unit_heading(problem.start.heading);
  request.goal.position = problem.goal.position;
  request.goal.heading = problem.goal.heading;
  return request;
}

/// Plans every problem by both; medians over the problems.
void compare(benchmark::State& state, const Planner& ours) {
  RandomStream random(1);
  std::vector<double> nodes;
  std::vector<double> ompl_nodes;
  std::vector<double> more_nodes;
  std::vector<double> over_ompl;
  int solved = 0;
  int ompl_solved = 0;
  for (auto _ : state) {
    for (int n = 0; n < kProblems; ++n) {
      const DiscProblem problem = random_problem(random);
      Request request = request_of(problem);
      using Clock = Budget::Clock;
      request.budget.deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                                   std::chrono::duration<double>(kSeconds));
      const PlanResult result = ours.plan(request);
      const OmplStarResult its = ompl_dubins_star(problem, kRange, kGoalBias, kSeconds);
      const double length = judged_length(result, request, "star");
      nodes.push_back(counter(result, "nodes"));
      ompl_nodes.push_back(double(its.nodes));
      more_nodes.push_back(nodes.back() / std::max(1.0, ompl_nodes.back()));
      solved += length < kInfinity;
      ompl_solved += its.solved;
      if (length < kInfinity && its.solved) {
        over_ompl.push_back(length / its.length);
      }
    }
  }
  state.counters["nodes_per_s"] = median(nodes) / kSeconds;
  state.counters["ompl_nodes_per_s"] = median(ompl_nodes) / kSeconds;
  state.counters["more_nodes"] = median(more_nodes);
  state.counters["over_ompl"] = median(over_ompl);
  state.counters["solved"] = double(solved) / kProblems;
  state.counters["ompl_solved"] = double(ompl_solved) / kProblems;
}
}  // namespace

void add_dubins_star_rows(host::Registry& registry) {
  const std::string common = "steering: dubins, range_m: 300, max_iterations: 2000000000";
  for (const auto& [name, text] :
       {std::pair("star/as_ompl", "rrt_star {bound: false, "),
        std::pair("star/bound", "rrt_star {"), std::pair("star/informed", "informed_rrt_star {")}) {
    const std::shared_ptr<const Planner> ours = planner(registry, text + common + "}");
    benchmark::RegisterBenchmark(name, [ours](benchmark::State& state) { compare(state, *ours); })
        ->Iterations(1)
        ->Unit(benchmark::kMillisecond);
  }
}
}  // namespace altiplan::bench
