// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "field_outlook.hpp"

namespace apf {

/// A place at a time.
struct Instant {
  double time_s = 0;
  Vec3 at{0, 0, 0};
};

/// A way out among movers where no straight flight is one: a depth-first search over places and
/// times on a lattice, finer ones where that fails, each place tried for a straight way out; the
/// way found is kept and flown until it ends or something new crosses it. It may turn sharply and
/// fly slower than the vehicle can: it is what is left when nothing else is.
///
/// One step looks on from so many places at most; where they do not do, the next step goes on with
/// the next lattice, and once all have failed none is searched again before something new is seen:
/// whatever can be reached later could have been reached from here. All memory is taken at once,
/// before the flight.
class Escape {
 public:
  explicit Escape(const Request& request);

  /// Looks for a way from here to a place where no mover comes any more, else for one that is clear
  /// for the horizon; within the bound of a step. `ahead` and `aside`, level unit vectors, turn the
  /// lattice: mirrored, they mirror the way.
  bool find(const Outlook& outlook, const Instant& here, double speed, const Vec3& ahead,
            const Vec3& aside);
  /// Where the way leads within so many seconds of here, its next corner at the farthest; none
  /// where it has ended, is left, or is not clear any more.
  std::optional<Instant> next(const Outlook& outlook, const Instant& here, double max_s);
  /// Keeps the way of these two legs, found elsewhere; as `find` does, to a place as safe.
  void keep(const Instant& corner, const Instant& end, double speed);
  /// Whether a better way should be looked for: movers may come to the end of this one, and the
  /// last look was some time ago.
  bool looks_again(double time_s) const { return !ends_safe_ && time_s >= next_look_s_; }

 private:
  using Cell = std::array<int, 3>;
  /// Of the way that is being tried; its index there is how many steps of time it is away.
  struct Place {
    Vec3 at{0, 0, 0};
    Cell cell{};
    std::size_t next = 0;  ///< of neighbours_
  };
  enum class Aim { safe, lasting };
  enum class Outcome { found, none, unfinished };
  /// What one search is for, and the share of the coarsest lattice's step.
  struct Search {
    Aim aim;
    double share;
  };
  static constexpr std::array<Search, 4> kSearches{
      {{Aim::safe, 1}, {Aim::safe, 0.5}, {Aim::safe, 0.25}, {Aim::lasting, 1}}};

  /// Whether something is seen that was not when the searches began; takes it as seen.
  bool learns(const Outlook& outlook);
  Outcome search(const Search& what);
  /// The places from so many to so many steps of time away.
  Outcome look_on(Aim aim, int from, int to);
  double steepest() const {
    return request_.level_m ? 0 : std::min(request_.limits.max_climb, radians(60)) * (1 - 1e-9);
  }
  /// The end of a straight way from the place that serves the aim.
  std::optional<Instant> straight(Aim aim, std::size_t every, int speeds) const;
  std::optional<Instant> straight_along(Aim aim, const Vec3& velocity) const;
  /// Goes on to the next neighbour of the last place that can be flown to; false where there is
  /// none any more.
  bool go_on();
  bool is_new(const Cell& cell);
  void keep(const Instant& end);
  double seconds() const { return (size_tried_ - 1) * step_s_; }

  static constexpr int kCells = 4;        ///< flown in a step of time along an axis
  static constexpr int kMaxLooks = 128;  ///< places that a step looks on from
  static constexpr int kLooksHere = 8;    ///< what the first place, looked around closely, counts
  static constexpr int kMaxLegs = 64;
  static constexpr int kTableBits = 14;
  static constexpr double kRoom = 0.05;
  static constexpr double kPause = 2;            ///< seconds
  static constexpr double kSameVelocity = 0.01;  ///< of the vehicle's speed

  const Request& request_;
  const Outlook* outlook_ = nullptr;
  Instant here_;
  double speed_ = 0;
  Vec3 ahead_{1, 0, 0};
  Vec3 aside_{0, 1, 0};
  double step_s_ = 0;
  double horizon_s_ = 0;
  std::vector<Cell> neighbours_;
  std::array<std::array<double, 2>, 192> headings_{};  ///< cosines and sines
  std::array<Place, kMaxLegs> tried_{};               ///< the way so far
  int size_tried_ = 0;
  int looks_left_ = 0;
  std::size_t searched_ = 0;  ///< of kSearches, since something new was seen
  std::vector<Mover> known_;  ///< then
  std::uint64_t revision_ = 0;
  std::vector<std::uint64_t> seen_;
  std::size_t seen_count_ = 0;
  std::array<Instant, kMaxLegs> legs_{};
  int size_ = 0;
  bool ends_safe_ = false;
  double next_look_s_ = 0;
};
}  // namespace apf
