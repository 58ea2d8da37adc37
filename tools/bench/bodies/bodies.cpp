// SPDX-License-Identifier: Apache-2.0
// Time of plans with a body, compared with those of the sphere around it: through a city, where its
// attitude matters, and high above it. Both plan each problem, one after the other.
#include <algorithm>
#include <utility>

#include "altiplan/body.hpp"
#include "altiplan/check.hpp"
#include "altiplan/kit/layers/obstacle_set.hpp"
#include "measuring.hpp"
#include "subcommand.hpp"

namespace altiplan::bench {
namespace {

constexpr double kHalf = 500;
constexpr int kBuildings = 4000;

/// Blocks 6 to 12 m wide with streets of at least 3 m between them.
World city() {
  constexpr int kRow = 63;
  constexpr double kBlock = 2 * kHalf / kRow;
  RandomStream random(4000);
  std::vector<Shape> shapes;
  for (int n = 0; n < kBuildings; ++n) {
    const Vec3 corner(-kHalf + kBlock * (n % kRow), -kHalf + kBlock * (n / kRow), 0);
    const Vec3 size(random.uniform(6, 12.8), random.uniform(6, 12.8), random.uniform(20, 80));
    shapes.push_back(BoxShape{{corner, corner + size}});
  }
  return World().with({"city", "city", std::make_shared<kit::ShapeLayer>(std::move(shapes))});
}

/// A wing of 3 m, 0.4 m high.
std::shared_ptr<const Body> wing() {
  auto body = std::make_shared<Body>();
  body->parts.push_back(box_part({1, 3, 0.4}, {0, 0, 0}));
  return body;
}

Request problem(const std::shared_ptr<const World>& world, RandomStream random, double low,
                double high) {
  Request request;
  request.world = world;
  request.volume = {{-kHalf, -kHalf, low}, {kHalf, kHalf, high}};
  request.random = random;
  const auto free_place = [&] {
    while (true) {
      const Vec3 p = random.in(request.volume);
      if (!world->blocked(p, p, 4)) {
        return p;
      }
    }
  };
  request.start.position = free_place();
  request.goal.position = free_place();
  return request;
}

Json compare(const Planner& planner, const std::string& name, double low, double high,
             int problems) {
  const auto world = std::make_shared<const World>(city());
  std::vector<double> body_ms;
  std::vector<double> sphere_ms;
  std::vector<double> ratios;
  int solved = 0;
  for (int n = 0; n < problems; ++n) {
    Request request = problem(world, RandomStream(1).sub("problem", std::uint64_t(n)), low, high);
    const auto timed = [&](std::shared_ptr<const Body> body, double radius) {
      request.vehicle.body = std::move(body);
      request.vehicle.radius_m = radius;
      apply_constraints(request, {}, AppliesTo::route);
      double ms = kInfinity;
      bool has_route = false;
      for (int pass = 0; pass < 3; ++pass) {  // the first one touches memory
        const double before = thread_s();
        const PlanResult result = planner.plan(request);
        ms = std::min(ms, 1e3 * (thread_s() - before));
        has_route = std::isfinite(judged_length(result, request, name));
      }
      return std::pair<double, bool>(ms, has_route);
    };
    const auto body = timed(wing(), wing()->inner_m());
    const auto sphere = timed(nullptr, wing()->outer_m());
    body_ms.push_back(body.first);
    sphere_ms.push_back(sphere.first);
    ratios.push_back(body.first / sphere.first);
    solved += body.second && sphere.second;
  }
  return {{"planner", name},
          {"from_m", low},
          {"problems", problems},
          {"solved", solved},
          {"body_ms", median(body_ms)},
          {"sphere_ms", median(sphere_ms)},
          {"ratio", median(ratios)},
          {"ratio_p95", quantile(ratios, 0.95)}};
}
}  // namespace

void add_bodies(Subcommands& all) {
  const auto problems = std::make_shared<int>(15);
  CLI::App& command = all.add(
      "bodies", "time plans with a body against those of the sphere around it",
      [=](const Given& given) {
        Json rows = Json::array();
        for (const auto& [low, high] : {std::pair(2.0, 45.0), std::pair(100.0, 200.0)}) {
          for (const std::string name :
               {"astar {cell_m: [4, 4, 4], moves: exact}", "theta_star {cell_m: [2, 2, 2]}",
                "rrt_connect", "rrt_star {max_iterations: 5000}"}) {
            rows.push_back(compare(*planner(*given.registry, name), name, low, high, *problems));
          }
        }
        return Json{{"city_of_4000_buildings", rows}};
      });
  command.add_option("--problems", *problems, "problems of each kind")->capture_default_str();
}
}  // namespace altiplan::bench
