// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "field_outlook.hpp"

namespace apf {

/// A position at a time.
struct Instant {
  double time_s = 0;
  Vec3 at{0, 0, 0};
};

/// An escape among movers where no straight flight is one: a depth-first search over positions and
/// times on a lattice, finer ones if that fails, with a straight escape tried from each position;
/// the path found is kept and flown until it ends or something new crosses it. It may turn sharply
/// and fly slower than the vehicle can: it is the last resort.
///
/// One step expands a bounded number of positions; if they do not suffice, the next step continues
/// with the next lattice, and once all have failed none is searched again until something new is
/// seen: whatever can be reached later could have been reached from here. All memory is allocated
/// at once, before the flight.
class Escape {
 public:
  explicit Escape(const Request& request);

  /// Searches for a path from here to a position where no mover comes any more, else for one that
  /// is clear for the horizon; within the bound of a step. `ahead` and `aside`, level unit vectors,
  /// orient the lattice: mirroring them mirrors the path.
  bool find(const Outlook& outlook, const Instant& here, double speed, const Vec3& ahead,
            const Vec3& aside);
  /// Position on the path within `max_s` seconds from here, at most up to its next corner; empty if
  /// the path has ended, has been left, or is no longer clear.
  std::optional<Instant> next(const Outlook& outlook, const Instant& here, double max_s);
  /// Keeps the path of these two legs, found elsewhere, to a position as safe as `find` requires.
  void keep(const Instant& corner, const Instant& end, double speed);
  /// True if a better path should be searched for: movers may come to the end of this one, and the
  /// last search was some time ago.
  bool looks_again(double time_s) const { return !ends_safe_ && time_s >= next_look_s_; }

 private:
  using Cell = std::array<int, 3>;
  /// A position on the path being tried; its index there is its number of time steps.
  struct Place {
    Vec3 at{0, 0, 0};
    Cell cell{};
    std::size_t next = 0;  ///< index into neighbours_
  };
  enum class Aim { safe, lasting };
  enum class Outcome { found, none, unfinished };
  /// Purpose of one search, and its step as a fraction of the coarsest lattice's.
  struct Search {
    Aim aim;
    double share;
  };
  static constexpr std::array<Search, 4> kSearches{
      {{Aim::safe, 1}, {Aim::safe, 0.5}, {Aim::safe, 0.25}, {Aim::lasting, 1}}};

  /// True if something is visible that was not when the searches began; marks it as seen.
  bool learns(const Outlook& outlook);
  Outcome search(const Search& what);
  /// Expands the positions from `from` to `to` time steps away.
  Outcome look_on(Aim aim, int from, int to);
  double steepest() const {
    return request_.level_m ? 0 : std::min(request_.limits.max_slope(), radians(60)) * (1 - 1e-9);
  }
  /// The end of a straight path from the position that serves the aim.
  std::optional<Instant> straight(Aim aim, std::size_t every, int speeds) const;
  std::optional<Instant> straight_along(Aim aim, const Vec3& velocity) const;
  /// Advances to the next reachable neighbour of the last position; false if there is none left.
  bool go_on();
  bool is_new(const Cell& cell);
  void keep(const Instant& end);
  double seconds() const { return (size_tried_ - 1) * step_s_; }

  static constexpr int kCells = 4;       ///< flown in a step of time along an axis
  static constexpr int kMaxLooks = 128;  ///< positions that a step expands
  static constexpr int kLooksHere = 8;   ///< weight of the first position, examined closely
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
  std::array<Place, kMaxLegs> tried_{};                ///< the path so far
  int size_tried_ = 0;
  int looks_left_ = 0;
  std::size_t searched_ = 0;  ///< index into kSearches, since something new was seen
  std::vector<Mover> known_;  ///< at that time
  std::uint64_t revision_ = 0;
  std::vector<std::uint64_t> seen_;
  std::size_t seen_count_ = 0;
  std::array<Instant, kMaxLegs> legs_{};
  int size_ = 0;
  bool ends_safe_ = false;
  double next_look_s_ = 0;
};
}  // namespace apf
