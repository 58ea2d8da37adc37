// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>

#include "altiplan/local_planner.hpp"
#include "altiplan/world.hpp"

namespace apf {
using namespace altiplan;

/// A moving obstacle: a sphere that is taken to fly on as it does.
struct Mover {
  Vec3 position{0, 0, 0};
  Vec3 velocity{0, 0, 0};
  double radius = 0;  ///< with what the vehicle keeps off anything
  std::size_t id = 0;
  double pace = 0;       ///< of the velocity,
  Vec3 onward{0, 0, 0};  ///< and its direction
};

/// What is seen in one step, and what it means for a straight flight.
class Outlook {
 public:
  static constexpr std::size_t kMaxMovers = 256;  ///< the nearest of more

  /// `margin`: metres kept off what moves, beyond the clearance required.
  Outlook(const Request& request, double required, double margin, double reaction_s)
      : request_(request), required_(required), margin_(margin), reaction_s_(reaction_s) {}

  /// First what stands still, then, at the speed that follows of it, what moves.
  void see_world(const World& world, const Vec3& here);
  void see_movers(const Observation& seen, double speed);

  std::span<const Mover> movers() const { return {movers_.data(), count_}; }
  /// Of what stands still.
  std::uint64_t revision() const { return world_->revision(); }
  /// Least clearance of what stands still, here.
  double clearance() const { return clearance_; }
  double margin() const { return margin_; }
  double reaction_s() const { return reaction_s_; }

  /// Seconds that a straight flight, begun `after_s` seconds from now, takes until it comes within
  /// `room` of a mover that it does not part from; infinite where it never does. Any time of at
  /// most `enough` will do once one is known.
  double seconds_to_contact(const Vec3& from, double after_s, const Vec3& velocity, double room,
                            double enough = 0) const;
  /// Whether something that stands still is nearer to the leg than `room`; ground, nearer than what
  /// is required: the ground clearance keeps the flight off that, and a way along a valley or below
  /// a ceiling may be narrower than any room. A layer too far from here is not asked.
  bool is_blocked(const Vec3& a, const Vec3& b, double room) const;
  /// Whether nothing that stands still is nearer than `room` to the leg, and none of it too near to
  /// the ground.
  bool is_open(const Vec3& a, const Vec3& b, double room) const;
  bool is_open(const Vec3& a, const Vec3& b) const { return is_open(a, b, required_); }
  /// Seconds, no fewer than `min_s`, that such a flight takes to a safe place: where no mover
  /// comes any more, as long as all fly on as they do. None where it leads to none, or meets
  /// something before.
  std::optional<double> seconds_to_safety(const Vec3& from, double after_s, const Vec3& velocity,
                                          double room, double min_s) const;

 private:
  /// Where it is not observed: from where it was seen last.
  Vec3 velocity_of(const SensedObstacle& moving, std::size_t id) const;
  struct Span {
    double begins;
    double ends;
  };
  static constexpr Span kNever{kInfinity, kInfinity};
  /// From when to when, in seconds of the flight, it is where the mover will come later.
  Span seconds_in_the_way(const Mover& mover, const Vec3& from, double after_s,
                          const Vec3& velocity, double room) const;

  const Request& request_;
  double required_;
  double margin_;
  double reaction_s_;
  /// A layer, and so far from here it blocks nothing.
  struct Near {
    const Layer* layer;
    double free_m;
  };
  static constexpr std::size_t kMaxLayers = 256;  ///< of more, none is known to be far

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
