// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <queue>
#include <unordered_set>
#include <utility>
#include <vector>

#include "reference/known_scene.hpp"

namespace altiplan::reference {

/// Times and places that a search joins. Halving the step keeps every place and, as a leg may be
/// flown in two halves, every way: a finer lattice finds no less.
struct Lattice {
  double step_s = 2;
  int cells = 4;  ///< that the vehicle flies in a step along an axis
  int headings =
      48;          ///< of the straight legs tried from each place, level; with climb the square / 8
  int speeds = 2;  ///< of those: whole, and even parts of it
  std::size_t max_places = 1'000'000;

  Lattice halved() const {
    Lattice finer = *this;
    finer.step_s /= 2;
    finer.max_places *= 16;
    return finer;
  }
};

struct Way {
  enum class Outcome { found, none, undecided };
  Outcome outcome = Outcome::none;
  std::vector<std::pair<double, Vec3>> legs;  ///< where found: its corners, from the start on
  std::size_t places = 0;                     ///< looked at

  bool found() const { return outcome == Outcome::found; }
};

/// Searches space-time for a way that keeps clear of all that a scene holds.
///
/// An escape is a way to a place where nothing known comes any more: from its end on the vehicle
/// may stay there for good (or it ends at the goal, where the flight does). To be alive at some
/// time is not enough: whoever flees before a wall is alive until the volume ends. Nor is more to
/// be asked: the volume is bounded and what moves flies straight on, so that whoever is alive for
/// good sees all of it fly by, and may stay where it is then.
class EscapeSearch {
 public:
  EscapeSearch(const KnownScene& scene, const Goal& goal, const Lattice& lattice)
      : scene_(scene), goal_(goal), lattice_(lattice) {
    const double h = scene.speed * lattice.step_s / lattice.cells;
    const int up = scene.level_m ? 0 : lattice.cells;
    for (int x = -lattice.cells; x <= lattice.cells; ++x) {
      for (int y = -lattice.cells; y <= lattice.cells; ++y) {
        for (int z = -up; z <= up; ++z) {
          const Vec3 by = h * Vec3(x, y, z);
          if (scene.min_time({0, 0, 0}, by) <= lattice.step_s * (1 + 1e-12)) {
            moves_.push_back({{x, y, z}, by});
          }
        }
      }
    }
    directions_ = directions(lattice.headings);
  }

  /// An escape whose last leg begins before then; it may take any time.
  Way escape(double time_s, const Vec3& from, double until_s) const {
    return search(time_s, from, until_s, false);
  }
  /// A way to the goal by then.
  Way to_goal(double time_s, const Vec3& from, double until_s) const {
    return search(time_s, from, until_s, true);
  }

 private:
  using Cell = std::array<int, 3>;
  struct Move {
    Cell cells;
    Vec3 by;
  };
  struct Place {
    double time;
    Vec3 at;
    Cell cell;
    int step;
    std::ptrdiff_t before;
  };

  /// Velocities of unit speed at most, as steep as may be; level ones all around.
  std::vector<Vec3> directions(int headings) const {
    std::vector<Vec3> result;
    if (scene_.level_m) {
      for (int i = 0; i < headings; ++i) {
        const double angle = 2 * kPi * i / headings;
        result.emplace_back(std::cos(angle), std::sin(angle), 0);
      }
      return result;
    }
    const int count = headings * headings / 8;  // a spiral from pole to pole
    for (int i = 0; i < count; ++i) {
      const double z = 1 - (2 * i + 1.0) / count;
      const double around = i * kPi * (3 - std::sqrt(5.0));
      const double flat = std::sqrt(1 - z * z);
      const Vec3 unit(flat * std::cos(around), flat * std::sin(around), z);
      const double climb = scene_.climb_speed / scene_.speed;
      result.push_back(std::abs(z) <= climb ? unit : Vec3(unit * (climb / std::abs(z))));
    }
    return result;
  }

  struct Frontier {
    double until_s;
    bool to_goal;
    std::vector<Place> places;
    std::priority_queue<std::pair<double, std::size_t>> open;  ///< greatest first, then newest
    std::unordered_set<std::uint64_t> seen;

    void add(const Place& place, double rank) {
      seen.insert(key(place));
      open.emplace(rank, places.size());
      places.push_back(place);
    }
  };

  Way search(double time_s, const Vec3& from, double until_s, bool to_goal) const {
    Frontier frontier{until_s, to_goal, {}, {}, {}};
    frontier.add({time_s, from, {0, 0, 0}, 0, -1}, 0);
    Way way;
    // The place that it is in deserves a closer look than others.
    const std::vector<Vec3> closer = directions(to_goal ? 1 : 8 * lattice_.headings);
    const std::vector<Vec3>* around = &closer;
    int speeds = 2 * lattice_.speeds;
    while (!way.found() && !frontier.open.empty()) {
      if (frontier.places.size() > lattice_.max_places) {
        way.outcome = Way::Outcome::undecided;
        break;
      }
      const std::size_t best = frontier.open.top().second;
      frontier.open.pop();
      if (const auto end = straight(frontier, frontier.places[best], *around, speeds)) {
        way.outcome = Way::Outcome::found;
        way.legs = legs_to(frontier.places, best);
        way.legs.push_back(*end);
      } else {
        expand(frontier, best);
      }
      around = &directions_;
      speeds = lattice_.speeds;
    }
    way.places = frontier.places.size();
    return way;
  }

  void expand(Frontier& frontier, std::size_t best) const {
    const Place here = frontier.places[best];
    const double then = here.time + lattice_.step_s;
    for (const Move& move : moves_) {
      Place next{then, here.at + move.by, here.cell, here.step + 1, std::ptrdiff_t(best)};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        next.cell[axis] += move.cells[axis];
      }
      if (then < frontier.until_s && !frontier.seen.contains(key(next)) &&
          scene_.is_free(here.at, here.time, next.at, then)) {
        // Out of danger late is out of danger; to the goal soon.
        frontier.add(
            next, frontier.to_goal ? -then - 1.5 * scene_.min_time(next.at, goal_.position) : then);
      }
    }
  }

  /// The end of one last leg that is all that is left to fly, where there is one.
  std::optional<std::pair<double, Vec3>> straight(const Frontier& frontier, const Place& here,
                                                  const std::vector<Vec3>& around,
                                                  int speeds) const {
    const double until_s = frontier.until_s;
    const double there = here.time + scene_.min_time(here.at, goal_.position);
    if (there <= until_s && scene_.is_free(here.at, here.time, goal_.position, there)) {
      return std::pair(there, goal_.position);
    }
    if (frontier.to_goal) {
      return std::nullopt;
    }
    for (int part = speeds; part >= 0; --part) {
      for (const Vec3& direction : around) {
        const Vec3 velocity = direction * scene_.speed * part / speeds;
        const double lasts = scene_.clear_after(here.at, here.time, velocity);
        if (lasts < kInfinity) {
          const Vec3 end = here.at + velocity * lasts;
          if (scene_.is_free(here.at, here.time, end, here.time + lasts)) {
            return std::pair(here.time + lasts, end);
          }
        }
        if (part == 0) {
          break;  // no direction is like another
        }
      }
    }
    return std::nullopt;
  }

  static std::uint64_t key(const Place& place) {
    std::uint64_t key = std::uint64_t(place.step);
    for (const int cell : place.cell) {
      key = key << 16 | std::uint64_t(cell + 0x8000);
    }
    return key;
  }
  static std::vector<std::pair<double, Vec3>> legs_to(const std::vector<Place>& places,
                                                      std::size_t last) {
    std::vector<std::pair<double, Vec3>> legs;
    for (auto i = std::ptrdiff_t(last); i >= 0; i = places[std::size_t(i)].before) {
      legs.emplace_back(places[std::size_t(i)].time, places[std::size_t(i)].at);
    }
    std::reverse(legs.begin(), legs.end());
    return legs;
  }

  const KnownScene& scene_;
  Goal goal_;
  Lattice lattice_;
  std::vector<Move> moves_;
  std::vector<Vec3> directions_;
};
}  // namespace altiplan::reference
