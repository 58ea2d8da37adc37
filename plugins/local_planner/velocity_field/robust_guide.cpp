// SPDX-License-Identifier: Apache-2.0
//
// Shortest ways among discs: they run along common tangents and along the rims between them. A*
// over the rims, each with a sense; a tangent is looked at only when its turn comes.
#include "robust_guide.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <queue>

namespace velocity_field {
namespace {
constexpr double kTurn = 2 * kPi;
constexpr double kTouch = 1e-6;  ///< metres that a tangent may be inside by rounding
/// Among more discs the way may be longer than the shortest by that factor, and is found sooner.
constexpr std::size_t kMany = 200;
constexpr double kHaste = 1.02;
/// Given up then, by which it holds 1 GB; 80 discs have fewer.
constexpr std::size_t kMaxTangents = 10'000'000;

double angle_of(const Vec2& v) { return std::atan2(v.y(), v.x()); }

double length_of_turn(double from, double to, int sense) {
  double turn = std::fmod(sense * (to - from), kTurn);
  turn = turn < 0 ? turn + kTurn : turn;
  return turn > kTurn - 1e-9 ? 0 : turn;
}

/// Where a way comes to a rim: it may follow it in that sense from there.
struct Contact {
  std::size_t disc = 0;
  int sense = 1;
  double angle = 0;  ///< of the place, seen from the centre
  double length = 0;
  Vec2 from{0, 0};  ///< where its leg left the rim before
  Vec2 at{0, 0};
  double turned = 0;  ///< along the rim before
  std::size_t before = 0;
};

class TangentSearch {
 public:
  TangentSearch(std::span<const Disc> discs, const GuideStart& start, const Vec2& goal,
                GuideEffort& effort)
      : discs_(discs.begin(), discs.end()),
        goal_(discs.size()),
        effort_(effort),
        watch_(effort.budget) {
    discs_.push_back({goal, 0});
    if (start.course) {
      add_start(start.at, start.turn_radius_m * left_of(*start.course), 1);
      add_start(start.at, -start.turn_radius_m * left_of(*start.course), -1);
    } else {
      add_start(start.at, {0, 0}, 1);
    }
    starts_ = contacts_.size();
    reached_.resize(2 * discs_.size());
    note_overlaps();
  }

  std::optional<Guide> run() {
    for (std::size_t n = 0; n < starts_; ++n) {
      expand(n);
    }
    while (!open_.empty()) {
      effort_.given_up = offered_ >= kMaxTangents || watch_.spent(0);
      if (effort_.given_up) {
        break;
      }
      const Contact next = open_.top().contact;
      open_.pop();
      if (is_behind(next) || !is_clear(next.from, next.at)) {
        continue;
      }
      contacts_.push_back(next);
      if (next.disc == goal_) {
        return way_to(contacts_.size() - 1);
      }
      reached_[rim(next)].push_back(contacts_.size() - 1);
      expand(contacts_.size() - 1);
    }
    return std::nullopt;
  }

 private:
  struct Open {
    double estimate = 0;
    Contact contact;
    bool operator<(const Open& other) const { return estimate > other.estimate; }
  };
  /// Where another disc covers a rim: around `middle`, `half` to either side.
  struct Overlap {
    double middle = 0;
    double half = 0;
  };

  /// A rim that the way may begin on; it is in the way of nothing.
  void add_start(const Vec2& at, const Vec2& to_centre, int sense) {
    contacts_.push_back({discs_.size(), sense, angle_of(-to_centre), 0, at, at});
    discs_.push_back({at + to_centre, to_centre.norm()});
  }

  /// Of each rim with those threats that are not too far east or west.
  void note_overlaps() {
    overlaps_.resize(discs_.size());
    std::vector<std::size_t> eastward(goal_);
    std::iota(eastward.begin(), eastward.end(), 0);
    std::ranges::sort(eastward, {}, [&](std::size_t n) { return discs_[n].centre.x(); });
    double largest = 0;
    for (std::size_t n = 0; n < goal_; ++n) {
      largest = std::max(largest, discs_[n].radius);
    }
    for (std::size_t a = 0; a < discs_.size(); ++a) {
      const double reach = discs_[a].radius + largest;
      const double x = discs_[a].centre.x();
      auto b = std::ranges::lower_bound(eastward, x - reach, {},
                                        [&](std::size_t n) { return discs_[n].centre.x(); });
      for (; b != eastward.end() && discs_[*b].centre.x() <= x + reach; ++b) {
        if (a != *b && a != goal_) {
          note_overlap(a, *b);
        }
      }
    }
  }

  void note_overlap(std::size_t a, std::size_t b) {
    const Vec2 way = discs_[b].centre - discs_[a].centre;
    const double distance = way.norm();
    const double ra = discs_[a].radius;
    const double rb = discs_[b].radius;
    if (distance >= ra + rb || distance + rb <= ra) {
      return;
    }
    const double cosine = (ra * ra + distance * distance - rb * rb) / (2 * ra * distance);
    overlaps_[a].push_back({angle_of(way), std::acos(std::clamp(cosine, -1.0, 1.0)) - 1e-9});
  }

  std::size_t rim(const Contact& contact) const {
    return 2 * contact.disc + (contact.sense > 0 ? 1 : 0);
  }

  /// How far the rim can be followed before another disc covers it.
  double free_turn(const Contact& contact) const {
    double free = kTurn;
    for (const Overlap& overlap : overlaps_[contact.disc]) {
      const double edge = overlap.middle - contact.sense * overlap.half;
      free = std::min(free, length_of_turn(contact.angle, edge, contact.sense));
    }
    return free;
  }

  /// Whether a shorter way to that rim leads past the place.
  bool is_behind(const Contact& contact) const {
    return std::any_of(
        reached_[rim(contact)].begin(), reached_[rim(contact)].end(), [&](std::size_t n) {
          const Contact& other = contacts_[n];
          const double turn = length_of_turn(other.angle, contact.angle, contact.sense);
          return turn <= free_[n] &&
                 other.length + discs_[contact.disc].radius * turn <= contact.length + kTouch;
        });
  }

  bool is_clear(const Vec2& a, const Vec2& b) const {
    return std::none_of(discs_.begin(), discs_.begin() + std::ptrdiff_t(goal_),
                        [&](const Disc& disc) {
                          const double inside = disc.radius - kTouch;
                          return inside > 0 && square_to_leg(disc.centre, a, b) < inside * inside;
                        });
  }

  void expand(std::size_t n) {
    const Contact from = contacts_[n];
    free_.resize(contacts_.size());
    free_[n] = free_turn(from);
    for (std::size_t disc = 0; disc <= goal_; ++disc) {
      if (disc != from.disc) {
        for (const int sense : {1, -1}) {
          if (sense > 0 || disc != goal_) {
            offer(from, n, disc, sense);
          }
        }
      }
    }
  }

  /// The common tangent of the two rims: with u its direction and n = left_of(u), the contacts are
  /// c - sense r n, so that way · n = sense_b r_b - sense_a r_a.
  void offer(const Contact& from, std::size_t n, std::size_t disc, int sense) {
    ++offered_;
    const Disc& a = discs_[from.disc];
    const Disc& b = discs_[disc];
    const Vec2 way = b.centre - a.centre;
    const double across = sense * b.radius - from.sense * a.radius;
    const double square = way.squaredNorm() - across * across;
    // By rounding an end that lies on a rim may seem inside.
    if (square < -kTouch * way.norm() || way.isZero(0)) {
      return;
    }
    const double length = std::sqrt(std::max(square, 0.0));
    const Vec2 u = (length * way - across * left_of(way)) / way.squaredNorm();
    const Vec2 side = left_of(u);
    double turn = 0;
    if (a.radius > 0) {
      turn = length_of_turn(from.angle, angle_of(-from.sense * side), from.sense);
      if (turn > free_[n]) {
        return;
      }
    }
    const Contact next = {disc,
                          sense,
                          angle_of(-sense * side),
                          from.length + a.radius * turn + length,
                          a.centre - from.sense * a.radius * side,
                          b.centre - sense * b.radius * side,
                          turn,
                          n};
    const double weight = goal_ > kMany ? kHaste : 1;
    open_.push({next.length + weight * (next.at - discs_[goal_].centre).norm(), next});
  }

  Guide way_to(std::size_t last) const {
    std::vector<std::size_t> way;
    for (std::size_t n = last; n >= starts_; n = contacts_[n].before) {
      way.push_back(n);
    }
    Guide guide;
    for (auto n = way.rbegin(); n != way.rend(); ++n) {
      const Contact& contact = contacts_[*n];
      const Contact& before = contacts_[contact.before];
      if (contact.turned > 0) {
        guide.add_arc(before.at, contact.from, discs_[before.disc].centre, before.sense,
                      contact.turned);
      }
      guide.add_leg(contact.from, contact.at);
    }
    return guide;
  }

  std::vector<Disc> discs_;
  std::size_t goal_;        ///< after the threats, before the rims that the way may begin on
  std::size_t starts_ = 0;  ///< the first contacts
  std::vector<std::vector<Overlap>> overlaps_;     ///< of each disc
  std::vector<std::vector<std::size_t>> reached_;  ///< contacts of each rim and sense
  std::vector<Contact> contacts_;
  std::vector<double> free_;
  std::priority_queue<Open> open_;
  std::size_t offered_ = 0;  ///< tangents
  GuideEffort& effort_;
  altiplan::BudgetWatch watch_;
};
}  // namespace

void Guide::add_leg(const Vec2& from, const Vec2& to) {
  pieces_.push_back({from, to, {0, 0}, 0, 0, length_m(), (to - from).norm()});
}

void Guide::add_arc(const Vec2& from, const Vec2& to, const Vec2& centre, int sense, double angle) {
  const double radius = (from - centre).norm();
  pieces_.push_back({from, to, centre, radius, sense, length_m(), radius * angle});
}

double Guide::length_m() const {
  return pieces_.empty() ? 0 : pieces_.back().begins_m + pieces_.back().length_m;
}

std::size_t Guide::piece_at(double metres) const {
  const auto after =
      std::upper_bound(pieces_.begin() + 1, pieces_.end(), metres,
                       [](double at, const GuidePiece& piece) { return at < piece.begins_m; });
  return static_cast<std::size_t>(after - pieces_.begin()) - 1;
}

Vec2 Guide::at(double metres) const {
  const GuidePiece& piece = pieces_[piece_at(metres)];
  const double along = metres - piece.begins_m;
  if (along <= 0 || along >= piece.length_m) {
    return along <= 0 ? piece.from : piece.to;
  }
  if (piece.sense == 0) {
    return piece.from + along / piece.length_m * (piece.to - piece.from);
  }
  const double turn = piece.sense * along / piece.radius;
  const Vec2 spoke = piece.from - piece.centre;
  return piece.centre + std::cos(turn) * spoke + std::sin(turn) * left_of(spoke);
}

double Guide::beside(const Vec2& p, double metres) const {
  std::size_t n = piece_at(metres);
  for (;; ++n) {
    const GuidePiece& piece = pieces_[n];
    const Vec2 here = at(metres);
    double ahead = 0;
    if (piece.sense == 0) {
      ahead = piece.length_m > 0 ? (p - here).dot(piece.to - piece.from) / piece.length_m : 0;
    } else {
      const Vec2 a = here - piece.centre;
      const Vec2 b = p - piece.centre;
      ahead = piece.radius * piece.sense * std::atan2(cross(a, b), a.dot(b));
    }
    const double end = piece.begins_m + piece.length_m;
    metres += std::max(0.0, ahead);
    if (metres < end || n + 1 == pieces_.size()) {
      return std::min(metres, end);
    }
    metres = end;
  }
}

std::optional<Guide> shortest_guide(std::span<const Disc> discs, const GuideStart& start,
                                    const Vec2& goal, GuideEffort* effort) {
  GuideEffort own;
  return TangentSearch(discs, start, goal, effort != nullptr ? *effort : own).run();
}
}  // namespace velocity_field
