// SPDX-License-Identifier: Apache-2.0
// Shortest paths around discs run along their edges and common tangents (the tangent visibility
// graph: M. Pocchiola, G. Vegter: The visibility complex. International Journal of Computational
// Geometry & Applications 6(3), 1996). Every deviation makes the answer smaller, never larger: arcs
// may lead through other discs, and a tangent counts as open unless it enters a disc by more than
// rounding.
#include "altiplan/kit/penalty/disc_detour.hpp"

#include <algorithm>
#include <cmath>
#include <queue>

namespace altiplan::kit {
namespace {

constexpr double kEnters = 1e-9;  // metres; more than rounding of coordinates below 1e5 m

/// Where a tangent meets a disc's edge, or an end of the path.
struct Contact {
  Vec3 at;
  int disc;      ///< -1: an end of the path
  double angle;  ///< of the contact, seen from the disc's centre
  int sense;     ///< 1: the path follows the edge counter-clockwise, -1: clockwise
  double g = kInfinity;
  int from = -1;
  bool is_closed = false;
};

class TangentGraph {
 public:
  /// Around the discs that are `known`.
  TangentGraph(const Vec3& from, const Vec3& to, std::span<const Threat> discs,
               const std::vector<bool>& known)
      : discs_(discs) {
    for (int k = 0; k < int(discs.size()); ++k) {
      if (known[std::size_t(k)]) {
        known_.push_back(k);
      }
    }
    for (const Vec3& end : {from, to}) {
      add({{end.x(), end.y(), 0}, -1, 0, 0});
    }
    if (is_open(contacts_[kStart], contacts_[kGoal])) {
      tangents_[kStart].push_back(kGoal);
    }
    for (const int k : known_) {
      for (const int sense : {1, -1}) {
        join_end(kStart, k, sense);
        join_end(kGoal, k, sense);
        for (const int j : known_) {
          for (const int other : {1, -1}) {
            if (j != k) {
              join_discs(j, other, k, sense);
            }
          }
        }
      }
    }
  }

  /// Dijkstra's algorithm from the first contact to the second: the length.
  double shortest() {
    contacts_[kStart].g = 0;
    for (int at = kStart; at >= 0 && at != kGoal; at = nearest()) {
      contacts_[at].is_closed = true;
      expand(at);
    }
    return contacts_[kGoal].g;
  }

  /// Least distance of the shortest path to the centre of disc k.
  double distance(int k) const {
    double minimum = kInfinity;
    for (int at = kGoal; contacts_[at].from >= 0; at = contacts_[at].from) {
      const Contact& a = contacts_[contacts_[at].from];
      const Contact& b = contacts_[at];
      minimum = std::min(minimum, is_arc(a, b)
                                      ? arc_distance(a, b, k)
                                      : plane_distance(discs_[std::size_t(k)].centre, a.at, b.at));
    }
    return minimum;
  }

  /// Adds the discs that the shortest path's tangents enter; true if there are any.
  bool add_entered(std::vector<bool>& known) const {
    bool added = false;
    for (int at = kGoal; contacts_[at].from >= 0; at = contacts_[at].from) {
      const Contact& before = contacts_[contacts_[at].from];
      for (int k = 0; k < int(discs_.size()); ++k) {
        if (!is_arc(before, contacts_[at]) && !known[std::size_t(k)] &&
            enters(before, contacts_[at], k)) {
          known[std::size_t(k)] = added = true;
        }
      }
    }
    return added;
  }

 private:
  static bool is_arc(const Contact& a, const Contact& b) { return a.disc >= 0 && a.disc == b.disc; }
  static double turn_between(const Contact& a, const Contact& b) {
    double turn = std::fmod(a.sense * (b.angle - a.angle), 2 * kPi);
    turn += turn < 0 ? 2 * kPi : 0;
    return turn > 2 * kPi - kEnters ? 0 : turn;  // rounding of no turn at all
  }
  double arc_distance(const Contact& a, const Contact& b, int k) const {
    const Threat& around = discs_[std::size_t(a.disc)];
    const Threat& disc = discs_[std::size_t(k)];
    const double dx = disc.centre.x() - around.centre.x();
    const double dy = disc.centre.y() - around.centre.y();
    Contact towards = a;
    towards.angle = std::atan2(dy, dx);
    return turn_between(a, towards) <= turn_between(a, b)
               ? std::abs(std::hypot(dx, dy) - around.radius)
               : std::min(plane_distance(disc.centre, a.at, a.at),
                          plane_distance(disc.centre, b.at, b.at));
  }
  int nearest() const {
    int best = -1;
    for (int n = 0; n < int(contacts_.size()); ++n) {
      if (!contacts_[n].is_closed && contacts_[n].g < (best < 0 ? kInfinity : contacts_[best].g)) {
        best = n;
      }
    }
    return best;
  }

  void expand(int at) {
    const Contact here = contacts_[at];
    for (const int to : tangents_[at]) {
      relax(at, to, (contacts_[to].at - here.at).norm());
    }
    for (int to = 0; to < int(contacts_.size()) && here.disc >= 0; ++to) {
      const Contact& there = contacts_[to];
      if (there.disc == here.disc && there.sense == here.sense && to != at) {
        relax(at, to, turn_between(here, there) * discs_[std::size_t(here.disc)].radius);
      }
    }
  }
  void relax(int from, int to, double length) {
    if (contacts_[from].g + length < contacts_[to].g) {
      contacts_[to].g = contacts_[from].g + length;
      contacts_[to].from = from;
    }
  }

  Contact contact(int disc, double angle, int sense) const {
    const Threat& of = discs_[std::size_t(disc)];
    const Vec3 at(of.centre.x() + of.radius * std::cos(angle),
                  of.centre.y() + of.radius * std::sin(angle), 0);
    return {at, disc, angle, sense};
  }
  int add(const Contact& contact) {
    contacts_.push_back(contact);
    tangents_.emplace_back();
    return int(contacts_.size()) - 1;
  }
  bool is_open(const Contact& a, const Contact& b) const {
    return std::none_of(known_.begin(), known_.end(),
                        [&](int k) { return k != a.disc && k != b.disc && enters(a, b, k); });
  }
  bool enters(const Contact& a, const Contact& b, int k) const {
    const Threat& disc = discs_[std::size_t(k)];
    return plane_distance(disc.centre, a.at, b.at) < disc.radius - kEnters;
  }

  /// The tangent between an end of the path and a disc whose edge is followed in a sense.
  void join_end(int end, int disc, int sense) {
    const Threat& of = discs_[std::size_t(disc)];
    const Vec3 off = contacts_[end].at - Vec3(of.centre.x(), of.centre.y(), 0);
    const double half = std::acos(std::min(1.0, of.radius / off.norm()));
    const double towards = std::atan2(off.y(), off.x());
    const Contact on = contact(disc, towards + (end == kStart ? sense : -sense) * half, sense);
    if (is_open(contacts_[end], on)) {
      const int at = add(on);
      tangents_[end == kStart ? kStart : at].push_back(end == kStart ? at : kGoal);
    }
  }

  /// The tangent that leads from one disc to another, whose edges are followed in these senses.
  void join_discs(int j, int sense_j, int k, int sense_k) {
    const Threat& a = discs_[std::size_t(j)];
    const Threat& b = discs_[std::size_t(k)];
    const double dx = b.centre.x() - a.centre.x();
    const double dy = b.centre.y() - a.centre.y();
    const double distance = std::hypot(dx, dy);
    // With n the normal of the tangent to its right, a contact is centre + sense radius n.
    const double across = sense_j * a.radius - sense_k * b.radius;
    if (std::abs(across) > distance) {
      return;  // one lies within the other, or they overlap
    }
    const double normal = std::atan2(dy, dx) - std::acos(across / distance);
    const auto angle = [&](int sense) { return sense > 0 ? normal : normal + kPi; };
    const Contact leave = contact(j, angle(sense_j), sense_j);
    const Contact reach = contact(k, angle(sense_k), sense_k);
    if (is_open(leave, reach)) {
      const int from = add(leave);
      const int to = add(reach);
      tangents_[from].push_back(to);
    }
  }

  static constexpr int kStart = 0;
  static constexpr int kGoal = 1;
  std::span<const Threat> discs_;
  std::vector<int> known_;
  std::vector<Contact> contacts_;
  std::vector<std::vector<int>> tangents_;  ///< from each contact
};

/// Least distances to the discs, from below and above.
struct Box {
  std::vector<double> low;
  std::vector<double> high;
  std::vector<double> at{};  ///< those of the shortest path that keeps the lower ones
  double bound = 0;

  bool operator<(const Box& other) const { return bound > other.bound; }  // the least first
};

/// The discs that count begin with those of `known`; each that the shortest path around them enters
/// is added. A path that is shortest around some discs, and enters no other, is shortest around
/// all.
Detour detour_around(const Vec3& from, const Vec3& to, std::span<const Threat> discs,
                     std::vector<bool> known) {
  for (;;) {
    TangentGraph graph(from, to, discs, known);
    Detour detour{graph.shortest(), {}};
    if (!graph.add_entered(known)) {
      for (int k = 0; k < int(discs.size()); ++k) {
        detour.distances.push_back(graph.distance(k));
      }
      return detour;
    }
  }
}
}  // namespace

Detour shortest_detour(const Vec3& from, const Vec3& to, std::span<const Threat> discs) {
  return detour_around(from, to, discs, std::vector<bool>(discs.size(), false));
}

double least_with_fees(const Vec3& from, const Vec3& to, const DiscFees& fees, double weight,
                       const std::function<double(double)>& price, double precision,
                       int max_boxes) {
  const std::size_t count = fees.discs.size();
  const auto bounded = [&](Box box) {
    std::vector<Threat> discs = fees.discs;
    std::vector<bool> known(count, false);
    double owed = 0;
    for (std::size_t k = 0; k < count; ++k) {
      discs[k].radius = box.low[k];
      known[k] = !box.at.empty() && box.at[k] < box.low[k] + kEnters;
      owed += weight * (fees.free(fees.discs[k]) - box.high[k]);
    }
    Detour detour = detour_around(from, to, discs, known);
    constexpr double kRounding = 1e-10;  // of a length
    box.bound = price(detour.length * (1 - kRounding)) + owed;
    box.at = std::move(detour.distances);
    return box;
  };
  Box all;
  for (const Threat& disc : fees.discs) {
    // A path is no farther from a disc than its ends are.
    const double ends =
        std::min(plane_distance(disc.centre, from, from), plane_distance(disc.centre, to, to));
    all.low.push_back(std::min(fees.collision(disc), ends));
    all.high.push_back(fees.free(disc));
  }
  std::priority_queue<Box> boxes;
  boxes.push(bounded(all));
  for (int n = 0; n < max_boxes; ++n) {
    // The path of the lower distances pays what the box is bounded by, but where it comes nearer to
    // a disc than the upper one: there the box is divided.
    const Box lowest = boxes.top();
    std::size_t worst = count;
    double maximum = 0;
    double unpaid = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const double its = std::max(0.0, lowest.high[k] - lowest.at[k]);
      unpaid += weight * its;
      if (its > maximum) {
        maximum = its;
        worst = k;
      }
    }
    if (unpaid <= precision) {
      break;
    }
    boxes.pop();
    const double middle = lowest.high[worst] - maximum / 2;
    Box near = lowest;
    near.high[worst] = middle;
    boxes.push(bounded(std::move(near)));
    Box far = lowest;
    far.low[worst] = middle;
    boxes.push(bounded(std::move(far)));
  }
  return boxes.top().bound;
}
}  // namespace altiplan::kit
