// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>

#include "altiplan/local_planner.hpp"
#include "altiplan/world.hpp"

namespace apf {
using namespace altiplan;

/// A moving obstacle: a sphere that is assumed to keep its velocity.
struct Mover {
  Vec3 position{0, 0, 0};
  Vec3 velocity{0, 0, 0};
  double radius = 0;  ///< including the vehicle's distance from obstacles
  std::size_t id = 0;
  double pace = 0;       ///< of the velocity,
  Vec3 onward{0, 0, 0};  ///< and its direction
};

/// The observations of one step, and their consequences for a straight flight.
class Outlook {
 public:
  static constexpr std::size_t kMaxMovers = 256;  ///< the nearest, if there are more

  /// `margin`: distance in metres from movers, beyond the required clearance.
  Outlook(const Request& request, double required, double margin, double reaction_s)
      : request_(request),
        required_(required),
        reach_(request.vehicle.reach_m()),
        margin_(margin),
        reaction_s_(reaction_s) {}

  /// First the static world, then, at the speed that follows from it, the movers.
  void see_world(const World& world, const Vec3& here);
  void see_movers(const Observation& seen, double speed);

  std::span<const Mover> movers() const { return {movers_.data(), count_}; }
  /// Of the static world.
  std::uint64_t revision() const { return world_->revision(); }
  /// Minimum clearance from the static world, here.
  double clearance() const { return clearance_; }
  double margin() const { return margin_; }
  double reaction_s() const { return reaction_s_; }

  /// Seconds that a straight flight, begun `after_s` seconds from now, takes until it comes within
  /// `room` of a mover from which it does not move away; infinite if it never does. May return any
  /// time of at most `enough` once one is known.
  double seconds_to_contact(const Vec3& from, double after_s, const Vec3& velocity, double room,
                            double enough = 0) const;
  /// True if a static obstacle is nearer to the leg than `room`; for ground, nearer than required:
  /// the ground clearance keeps the flight off it, and a path along a valley or below a ceiling may
  /// be narrower than any room. Layers too far away are not queried.
  bool is_blocked(const Vec3& a, const Vec3& b, double room) const;
  /// True if no static obstacle is nearer than `room` to the leg, and no part of the leg is too
  /// near to the ground.
  bool is_open(const Vec3& a, const Vec3& b, double room) const;
  bool is_open(const Vec3& a, const Vec3& b) const { return is_open(a, b, required_); }
  /// Seconds, at least `min_s`, that such a flight takes to a safe position: where no mover comes
  /// any more if all keep their velocities. Empty if it leads to none, or hits something first.
  std::optional<double> seconds_to_safety(const Vec3& from, double after_s, const Vec3& velocity,
                                          double room, double min_s) const;

 private:
  /// If the velocity is not observed: from the last seen position.
  Vec3 velocity_of(const SensedObstacle& moving, std::size_t id) const;
  struct Span {
    double begins;
    double ends;
  };
  static constexpr Span kNever{kInfinity, kInfinity};
  /// Time span, in seconds of the flight, during which the vehicle is where the mover will come
  /// later.
  Span seconds_in_the_way(const Mover& mover, const Vec3& from, double after_s,
                          const Vec3& velocity, double room) const;

  const Request& request_;
  double required_;
  double reach_;  ///< of the vehicle's body, for moving obstacles
  double margin_;
  double reaction_s_;
  /// A layer, and the distance from here within which it blocks nothing.
  struct Near {
    const Layer* layer;
    double free_m;
  };
  static constexpr std::size_t kMaxLayers = 256;  ///< of further ones, none is known to be far

  const World* world_ = nullptr;
  Vec3 here_{0, 0, 0};
  double clearance_ = kInfinity;
  std::array<Near, kMaxLayers> layers_{};
  std::size_t layers_size_ = 0;
  double speed_ = 0;
  double time_s_ = 0;
  double before_s_ = 0;
  std::size_t count_ = 0;
  std::size_t count_before_ = 0;
  std::array<Mover, kMaxMovers> movers_{};
  std::array<Mover, kMaxMovers> movers_before_{};
};
}  // namespace apf
