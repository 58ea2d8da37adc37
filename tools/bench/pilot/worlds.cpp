// SPDX-License-Identifier: Apache-2.0
#include "worlds.hpp"

#include <memory>
#include <sstream>
#include <string>

#include "altiplan/kit/layers/obstacle_set.hpp"
#include "altiplan/random.hpp"
#include "measuring.hpp"

namespace altiplan::bench {
namespace {

constexpr int kPosts = 10;
constexpr double kLength = 16e3;
constexpr double kHeight = 1500;

/// The tops reach the height of the path, so that the ground affects every decision.
Layer hills(const Box& volume, RandomStream& random, host::Registry& registry) {
  std::ostringstream text;
  text << std::fixed << "hills {base_m: 0, cap_m: " << kHeight - 60 << ", peaks: [";
  for (int i = 0; i < 16; ++i) {
    const double x = random.uniform(0, volume.max.x());
    const double y = random.uniform(volume.min.y(), volume.max.y());
    const double height = random.uniform(300, 1500);
    const double north = random.uniform(600, 2500);
    const double east = random.uniform(600, 2500);
    text << (i == 0 ? "" : ", ") << "{at_m: [" << x << ", " << y << "], height_m: " << height
         << ", sigma_m: [" << east << ", " << north << "]}";
  }
  text << "]}";
  Site site;
  site.volume = volume;
  return {"hills", "hills", environment(registry, text.str(), site)};
}

Layer post(int i, RandomStream& random) {
  const double x = random.uniform(0.1, 0.9) * kLength;
  const Cylinder shape{x, random.uniform(-1200, 1200), random.uniform(100, 400)};
  return {"post" + std::to_string(i), "shape",
          std::make_shared<kit::ShapeLayer>(std::vector<Shape>{shape}), false};
}

/// Aimed at a point of the path, which it reaches together with the vehicle.
MovingObstacle mover(std::size_t i, double speed, RandomStream& random) {
  while (true) {
    const double at_s = random.uniform(30, kLength / speed);
    const double angle = random.uniform(0, 2 * kPi);
    const double climb = random.uniform(-0.3, 0.3);
    const Vec3 velocity =
        speed * random.uniform(0.2, 1) *
        Vec3(std::cos(angle) * std::cos(climb), std::sin(angle) * std::cos(climb), std::sin(climb));
    const Vec3 meet(speed * at_s, random.uniform(-200, 200), kHeight);
    const Sphere shape{meet - velocity * at_s, random.uniform(50, 400)};
    if (shape.centre.norm() > shape.radius + 3000) {
      return {"mover" + std::to_string(i), shape, velocity, 0, false};
    }
  }
}
}  // namespace

host::FlightSetup crowded_flight(std::uint64_t seed, bool over_hills, host::Registry& registry) {
  RandomStream random = RandomStream(seed).sub("crowded flight");
  host::FlightSetup setup;
  Request& request = setup.request;
  request.volume = {{-2000, -6000, 0}, {kLength + 2000, 6000, 3000}};
  request.start.position = {0, 0, kHeight};
  request.goal = {{kLength, 0, kHeight}, 10};
  request.vehicle.radius_m = 2;
  request.vehicle.speed_mps = random.uniform(20, 60);
  request.vehicle.sensing_m = 2 * kLength;
  request.limits.min_clearance = 2;
  request.limits.max_climb = radians(15);
  World known;
  if (over_hills) {
    request.limits.min_ground_clearance = 10;
    known = known.with(hills(request.volume, random, registry));
  }
  World truth = known;
  for (int i = 0; i < kPosts; ++i) {
    truth = truth.with(post(i, random));
  }
  std::vector<MovingObstacle> movers;
  for (std::size_t i = 0; i < kMovers; ++i) {
    movers.push_back(mover(i, request.vehicle.speed_mps, random));
  }
  request.world = std::make_shared<const World>(known);
  setup.truth = truth.with_moving(std::move(movers));
  setup.route_request = request;
  setup.route = {request.start.position, request.goal.position};
  setup.always = true;
  return setup;
}
}  // namespace altiplan::bench
