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
/// fly slower than the vehicle can: it is what is left when nothing else is. All memory is taken at
/// once, before the flight.
class Escape {
 public:
  explicit Escape(const Request& request);

  /// Looks for a way from here to a place where no mover comes any more, else for one that is clear
  /// for the horizon. `ahead` and `aside`, level unit vectors, turn the lattice: mirrored, they
  /// mirror the way.
  bool find(const Outlook& outlook, const Instant& here, double speed, const Vec3& ahead,
            const Vec3& aside);
  /// Where the way leads within so many seconds of here, its next corner at the farthest; none
  /// where it has ended, is left, or is not clear any more.
  std::optional<Instant> next(const Outlook& outlook, const Instant& here, double most_s);
  /// Keeps the way of these two legs, found elsewhere; as `find` does, to a place as safe.
  void keep(const Instant& corner, const Instant& end, double speed);
  /// Whether a better way should be looked for: movers may come to the end of this one, and the
  /// last look was some time ago.
  bool looks_again(double time_s) const { return !ends_safe_ && time_s >= next_look_s_; }

 private:
  struct Place {
    Vec3 at{0, 0, 0};
    std::array<std::int16_t, 3> cell{};
    std::int16_t step = 0;
    int before = -1;
  };
  enum class Aim { safe, lasting };

  bool search(Aim aim);
  double steepest() const {
    return request_.level_m ? 0 : std::min(request_.limits.max_climb, radians(60)) * (1 - 1e-9);
  }
  /// The end of a straight way from the place that serves the aim.
  std::optional<Instant> straight(const Place& place, Aim aim, int headings, int speeds) const;
  std::optional<Instant> straight_along(const Place& place, Aim aim, const Vec3& velocity) const;
  void push_neighbours(int index);
  bool is_new(const Place& place);
  void keep(int index, const Instant& end);
  double seconds_to(const Place& place) const { return place.step * step_s_; }

  static constexpr int kCells = 4;  ///< flown in a step of time along an axis
  static constexpr int kMostPlaces = 2048;
  static constexpr int kMostLegs = 64;
  static constexpr std::size_t kTable = 8192;
  static constexpr double kRoom = 0.05;
  static constexpr double kPause = 2;  ///< seconds

  const Request& request_;
  const Outlook* outlook_ = nullptr;
  Instant here_;
  double speed_ = 0;
  Vec3 ahead_{1, 0, 0};
  Vec3 aside_{0, 1, 0};
  double step_s_ = 0;
  double horizon_s_ = 0;
  std::vector<Place> places_;
  std::vector<int> open_;
  std::vector<std::uint64_t> seen_;
  std::size_t seen_count_ = 0;
  std::array<Instant, kMostLegs> legs_{};
  int size_ = 0;
  bool ends_safe_ = false;
  double next_look_s_ = 0;
};
}  // namespace apf
