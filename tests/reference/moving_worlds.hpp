// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "altiplan/kit/layers/obstacle_set.hpp"
#include "host/flight/flight.hpp"
#include "support/support.hpp"

namespace altiplan::reference {

/// A seeded flight among obstacles that are not known: 1 to 20 spheres in straight flight, no
/// faster than the vehicle; in one world of four hidden posts too, and hills below one in four.
/// Half of the worlds are level.
struct MovingWorld {
  host::FlightSetup setup;
  std::unique_ptr<LocalPlanner> pilot;
  std::string tells;  ///< in a line, for whoever reads of a failure
};

class MovingWorldDraw {
 public:
  explicit MovingWorldDraw(std::uint64_t seed)
      : random_(RandomStream(seed).sub("moving world")), level_(seed % 2 == 1) {}

  MovingWorld draw() {
    MovingWorld world;
    Request& request = world.setup.request;
    draw_vehicle(request);
    draw_way(request);
    World known = with_hills(request);
    world.setup.truth = with_posts(known, request);
    request.world = std::make_shared<const World>(known);
    const std::vector<MovingObstacle> movers = draw_movers(request);
    world.setup.truth = world.setup.truth.with_moving(movers);
    world.setup.route_request = request;
    world.setup.route = {request.start.position, request.goal.position};
    world.pilot = testing::make_local_planner(
        "apf", "{influence_m: " + std::to_string(request.vehicle.sensing_m) + "}");
    world.setup.pilot = world.pilot.get();
    world.setup.pilot_name = "apf";
    world.tells = std::string(level_ ? "level" : "3-D") + ", " + std::to_string(movers.size()) +
                  " movers " + kNames[std::size_t(meeting_)] + ", " +
                  std::to_string(world.setup.truth.layers().size()) + " layers, speed " +
                  std::to_string(request.vehicle.speed_mps) + ", sensing " +
                  std::to_string(request.vehicle.sensing_m);
    return world;
  }

 private:
  bool one_of(int n) { return random_.integer(1, n) == 1; }

  void draw_vehicle(Request& request) {
    request.vehicle.radius_m = random_.uniform(1, 5);
    request.vehicle.speed_mps = random_.uniform(20, 60);
    request.vehicle.sensing_m = random_.uniform(200, 1200);
    request.limits.min_clearance = request.vehicle.radius_m;
  }

  /// East through the middle of a box that leaves room for a wide berth.
  void draw_way(Request& request) {
    const double length = random_.uniform(1500, 4000);
    const double side = 2000;
    request.volume = {{-side, -side, 0}, {length + side, side, 2500}};
    const double z = level_ ? 1000 : random_.uniform(700, 1500);
    request.start.position = {0, 0, z};
    request.goal = {{length, 0, level_ ? z : z + random_.uniform(-200, 200)}, 50};
    if (level_) {
      request.level_m = z;
    } else {
      request.limits.max_climb = radians(random_.uniform(15, 60));
    }
  }

  /// Their tops are below the way.
  World with_hills(Request& request) {
    if (level_ || !one_of(2)) {
      return {};
    }
    const double cap = std::min(request.start.position.z(), request.goal.position.z()) - 100;
    std::string yaml = "{base_m: 100, cap_m: " + std::to_string(cap) + ", peaks: [";
    for (int i = 0; i < 6; ++i) {
      const auto number = [&](double low, double high) {
        return std::to_string(random_.uniform(low, high));
      };
      yaml += "{at_m: [" + number(0, request.volume.max.x()) + ", " + number(-1500, 1500) +
              "], height_m: " + number(100, cap) + ", sigma_m: [" + number(200, 600) + ", " +
              number(200, 600) + "]},";
    }
    request.limits.min_ground_clearance = 20;
    const World nothing;
    Site site;
    site.volume = request.volume;
    site.before = &nothing;
    return testing::world_of(testing::make_environment("hills", yaml + "]}", site), "hills");
  }

  World with_posts(World world, const Request& request) {
    const std::int64_t count = one_of(4) ? random_.integer(1, 3) : 0;
    for (int i = 0; i < count; ++i) {
      const double radius = random_.uniform(50, 200);
      const double room = radius + 250;
      const double x = random_.uniform(room, request.goal.position.x() - room);
      const Cylinder post{x, random_.uniform(-300, 300), radius, -kInfinity,
                          random_.uniform(800, 2500)};
      world = world.with({"post" + std::to_string(i), "shape",
                          std::make_shared<kit::ShapeLayer>(std::vector<Shape>{post}), false});
    }
    return world;
  }

  /// A unit vector; level in a level world, and flatter than even in others.
  Vec3 direction() {
    const double angle = random_.uniform(0, 2 * kPi);
    const double up = level_ ? 0 : random_.uniform(-0.5, 0.5);
    const double flat = std::sqrt(1 - up * up);
    return {flat * std::cos(angle), flat * std::sin(angle), up};
  }

  /// How they meet the vehicle. scattered: each aimed at another place of the way, or anywhere.
  /// ring: from all around, closing on a place, the vehicle within. wall: abreast, toward the
  /// vehicle, with gaps. escort: from behind and the sides, hardly slower. crowd: anywhere near.
  enum class Meeting { scattered, ring, wall, escort, crowd };
  static constexpr const char* kNames[] = {"scattered", "in a ring", "in a wall", "as an escort",
                                           "as a crowd"};

  struct Aim {
    double radius = 0;
    Vec3 velocity{0, 0, 0};
    Vec3 at{0, 0, 0};  ///< centre
    double at_s = 0;   ///< then
  };

  std::vector<MovingObstacle> draw_movers(const Request& request) {
    constexpr Meeting kOf[] = {Meeting::scattered, Meeting::scattered, Meeting::ring,
                               Meeting::wall,      Meeting::escort,    Meeting::crowd};
    meeting_ = kOf[random_.integer(0, 5)];
    const bool loose = meeting_ == Meeting::scattered || meeting_ == Meeting::escort;
    count_ = int(random_.integer(loose ? 1 : 6, 20));
    const double v = request.vehicle.speed_mps;
    start_ = request.start.position;
    way_ = request.goal.position - start_;
    ahead_ = way_.normalized();
    side_ = Vec3(-ahead_.y(), ahead_.x(), 0).normalized();
    share_ = random_.uniform(0.1, 0.7);
    pace_ = v * random_.uniform(0.5, 1);
    large_ = random_.uniform(60, 300);
    gap_ = random_.uniform(0.8, 1.6);
    far_ = share_ * way_.norm() + 10 * v + large_ * random_.uniform(1.5, 5);
    tilt_ = direction() * 0.3;
    std::vector<MovingObstacle> movers;
    for (int i = 0; std::ssize(movers) < count_; ++i) {
      const Aim aim = i < 100 ? draw_aim(i, v) : scattered(v);
      const Vec3 from = aim.at - aim.velocity * aim.at_s;
      // None is so near at first that it could not be passed.
      if ((from - start_).norm() - aim.radius > 10 * v) {
        movers.push_back({"mover" + std::to_string(movers.size()), Sphere{from, aim.radius},
                          aim.velocity, 0, false});
      }
    }
    return movers;
  }

  Aim draw_aim(int i, double v) {
    switch (meeting_) {
      case Meeting::ring: {
        const Vec3 from = around(i);
        const Vec3 centre = start_ + way_ * share_ + direction() * random_.uniform(0, large_);
        return {large_, -from * pace_, centre + from * far_, 0};
      }
      case Meeting::wall: {
        const Vec3 off = 2 * gap_ * large_ * wall_place(i % count_) +
                         direction() * random_.uniform(0, 0.3 * large_);
        return {large_, (tilt_ - ahead_).normalized() * pace_, start_ + way_ * share_ + off,
                share_ * way_.norm() / v};
      }
      case Meeting::escort: {
        const double angle = random_.uniform(-1.5, 1.5);
        const double at = random_.uniform(0.2, 1);
        return {random_.uniform(50, 200),
                (ahead_ * std::cos(angle) + side_ * std::sin(angle)) * v * random_.uniform(0.8, 1),
                start_ + way_ * at + direction() * 100, at * way_.norm() / v};
      }
      case Meeting::crowd: {
        const double at = random_.uniform(0.1, 1);
        return {std::max(50.0, random_.uniform(0.5, 1) * large_),
                direction() * v * random_.uniform(0.2, 1),
                start_ + way_ * at + direction() * random_.uniform(0, 600), at * way_.norm() / v};
      }
      case Meeting::scattered:
        break;
    }
    return scattered(v);
  }

  Aim scattered(double v) {
    const double radius = random_.uniform(50, one_of(4) ? 400 : 150);
    const double at = random_.uniform(0.1, 1);
    const Vec3 off = direction() * random_.uniform(0, one_of(4) ? 1000 : radius);
    return {radius, direction() * (v * random_.uniform(0.2, 1)), start_ + way_ * at + off,
            at * way_.norm() / v};
  }

  /// One of count_ directions about evenly around, level or of a sphere.
  Vec3 around(int i) {
    const double turn = i + random_.uniform(-0.2, 0.2);
    if (level_) {
      const double angle = 2 * kPi * turn / count_;
      return ahead_ * std::cos(angle) + side_ * std::sin(angle);
    }
    const double z = 1 - (2 * (i % count_) + 1.0) / count_;
    const double angle = turn * kPi * (3 - std::sqrt(5.0));
    const double flat = std::sqrt(1 - z * z);
    return {flat * std::cos(angle), flat * std::sin(angle), z};
  }

  /// Across the way, in widths: one row in a level world, a square else.
  Vec3 wall_place(int i) const {
    const int columns = level_ ? count_ : int(std::ceil(std::sqrt(double(count_))));
    const int rows = level_ ? 1 : columns;
    const int column = i % columns;
    const int row = i / columns;
    return (column - (columns - 1) / 2.0) * side_ + (row - (rows - 1) / 2.0) * Vec3(0, 0, 1);
  }

  RandomStream random_;
  bool level_;
  Meeting meeting_ = Meeting::scattered;
  int count_ = 0;
  Vec3 start_{0, 0, 0};
  Vec3 way_{0, 0, 0};
  Vec3 ahead_{0, 0, 0};
  Vec3 side_{0, 0, 0};
  // Shared by those of a ring or a wall.
  double share_ = 0;  ///< of the way, where they meet
  double pace_ = 0;
  double large_ = 0;
  double gap_ = 0;
  double far_ = 0;
  Vec3 tilt_{0, 0, 0};
};

inline MovingWorld moving_world(std::uint64_t seed) { return MovingWorldDraw(seed).draw(); }
}  // namespace altiplan::reference
