// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include "altiplan/budget.hpp"
#include "altiplan/measures.hpp"
#include "closed_boxes.hpp"
#include "pieces.hpp"

namespace altiplan::taut {

/// A lower bound of the length of all routes from start to goal around closed cells, and short
/// routes, by halving the edges where those may bend.
///
/// An arc leads from piece to piece unless a box bars all legs between them, and costs no more than
/// the shortest of these, so that the shortest path is no longer than any route. What no path below
/// the best route's length uses is dropped, the rest halved.
class Refinement {
 public:
  using Accepts = std::function<bool(const Polyline&)>;

  struct Settings {
    double gap;      ///< wanted: the best route's length over the bound, less 1
    double piece_m;  ///< length of the first pieces
    std::size_t max_bytes;
  };
  /// `best`: a route to begin with; `accepts` judges others; `expanded`: iterations of the budget
  /// that are used up. References must outlive it.
  Refinement(const std::vector<Edge>& edges, const ClosedBoxes& boxes, Polyline best,
             const Accepts& accepts, const Settings& settings, const Budget& budget,
             std::uint64_t expanded)
      : edges_(edges),
        boxes_(boxes),
        best_(std::move(best)),
        length_(length(best_)),
        cut_(length_ / (1 + settings.gap)),
        bound_((best_.back() - best_.front()).norm()),
        accepts_(accepts),
        settings_(settings),
        budget_(budget),
        watch_(budget),
        expanded_(expanded) {}

  /// Ends at the gap wanted, or before where the budget or the memory ends.
  void run() {
    bool goes_on = begin();
    while (goes_on) {
      for (int pass = 0; goes_on && pass < 2; ++pass) {  // the second with slopes of the first
        price();
        goes_on = search();
        if (goes_on) {
          const double proved = std::min(dropped_, to_[kGoal].length);
          bound_ = proved < kInfinity ? std::max(bound_, proved) : bound_;
          improve();
          prune();
        }
      }
      goes_on = goes_on && bound_ < cut_ && halve();
    }
  }

  const Polyline& best() const { return best_; }
  double bound() const { return bound_; }
  std::uint64_t expanded() const { return expanded_; }
  bool is_spent() const { return is_spent_; }

 private:
  static constexpr std::uint32_t kStart = 0;
  static constexpr std::uint32_t kGoal = 1;
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  struct Arc {
    std::uint32_t from;
    std::uint32_t to;
    double cost;
    bool is_free;  ///< the leg between the middles
  };
  /// The shortest path to a piece, or from it.
  struct Path {
    double length = kInfinity;
    std::uint32_t arc = kNone;  ///< its last; its first
  };

  bool spent() {
    is_spent_ = is_spent_ || watch_.spent(++expanded_, arcs_.size());
    return is_spent_;
  }

  /// False if no path of that length is of interest: it is remembered.
  bool keeps(double length) {
    if (length < cut_) {
      return true;
    }
    dropped_ = std::min(dropped_, length);
    return false;
  }

  /// Adds the arc if legs may lead from piece to piece.
  void link(std::uint32_t from, std::uint32_t to) {
    const Piece& s = pieces_[from];
    const Piece& t = pieces_[to];
    if (!may_follow(s, t)) {
      return;
    }
    bool is_free = true;
    const bool is_barred = boxes_.on_the_way(s.middle, t.middle, [&](const Box& box) {
      if (!bars(box, s.middle, t.middle)) {
        return false;
      }
      is_free = false;
      // Behind a convex obstacle the places that cannot be seen from another are a convex set: if
      // all ends of the pieces are hidden from each other, so are all places between.
      return bars(box, s.low(), t.low()) && bars(box, s.low(), t.high()) &&
             bars(box, s.high(), t.low()) && bars(box, s.high(), t.high());
    });
    if (!is_barred) {
      arcs_.push_back({from, to, 0, is_free});
    }
  }

  bool begin() {
    pieces_ = {{best_.front()}, {best_.back()}};
    for (const Edge& edge : edges_) {
      const double whole = (edge.high - edge.low).norm();
      const int count = std::max(1, int(std::ceil(whole / settings_.piece_m)));
      for (int n = 0; n < count; ++n) {
        Piece piece;
        piece.middle = edge.low + (edge.high - edge.low) * ((2 * n + 1.0) / (2 * count));
        piece.half = whole / (2 * count);
        piece.edge = edge.is_corner() ? nullptr : &edge;
        if (keeps(apart(pieces_[kStart], piece) + apart(piece, pieces_[kGoal]))) {
          pieces_.push_back(piece);
          piece.turns_back = true;
          if (!edge.is_corner()) {
            pieces_.push_back(piece);
          }
        }
      }
    }
    std::vector<double> to_goal;
    for (const Piece& piece : pieces_) {
      to_goal.push_back(apart(piece, pieces_[kGoal]));
    }
    for (std::uint32_t s = 0; s < pieces_.size(); ++s) {
      const double from_start = apart(pieces_[kStart], pieces_[s]);
      for (std::uint32_t t = 0; t < pieces_.size(); ++t) {
        if (s != t && s != kGoal && t != kStart &&
            keeps(from_start + apart(pieces_[s], pieces_[t]) + to_goal[t])) {
          link(s, t);
        }
      }
      if (spent() || memory_full()) {
        return false;
      }
    }
    return true;
  }

  /// Prices all arcs. Where one would cost less than nothing, its pieces have no slopes.
  void price() {
    for (Arc& arc : arcs_) {
      arc.cost = leg_cost(pieces_[arc.from], pieces_[arc.to]).cost;
    }
    std::vector<bool> is_level(pieces_.size());
    for (bool again = true; again;) {
      again = false;
      for (Arc& arc : arcs_) {
        Piece& s = pieces_[arc.from];
        Piece& t = pieces_[arc.to];
        if (is_level[arc.from] || is_level[arc.to]) {
          arc.cost = leg_cost(s, t).cost;
        }
        if (arc.cost < 0) {
          s.slope = t.slope = 0;
          is_level[arc.from] = is_level[arc.to] = true;
          arc.cost = apart(s, t);
          again = true;
        }
      }
    }
  }

  /// Shortest paths from a piece over arcs, or against them.
  template <class CostOf>
  std::vector<Path> paths(std::uint32_t origin, bool against, const CostOf& cost_of) {
    const auto from = against ? &Arc::to : &Arc::from;
    const auto to = against ? &Arc::from : &Arc::to;
    std::vector<std::uint32_t> first(pieces_.size() + 2);  // by piece, shifted by 2
    for (const Arc& arc : arcs_) {
      ++first[arc.*from + 2];
    }
    for (std::size_t n = 2; n < first.size(); ++n) {
      first[n] += first[n - 1];
    }
    std::vector<std::uint32_t> out(arcs_.size());
    for (std::uint32_t a = 0; a < arcs_.size(); ++a) {
      out[first[arcs_[a].*from + 1]++] = a;
    }
    std::vector<Path> found(pieces_.size());
    using Entry = std::pair<double, std::uint32_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    found[origin].length = 0;
    open.emplace(0, origin);
    while (!open.empty() && !spent()) {
      const auto [length, n] = open.top();
      open.pop();
      if (length > found[n].length) {
        continue;
      }
      for (std::uint32_t k = first[n]; k < first[n + 1]; ++k) {
        const Arc& arc = arcs_[out[k]];
        if (const double through = length + cost_of(arc); through < found[arc.*to].length) {
          found[arc.*to] = {through, out[k]};
          open.emplace(through, arc.*to);
        }
      }
    }
    return found;
  }

  bool search() {
    const auto cost = [](const Arc& arc) { return arc.cost; };
    to_ = paths(kStart, false, cost);
    from_ = paths(kGoal, true, cost);
    return !is_spent_;
  }

  /// Looks for shorter routes: over the pieces of the bound's path, and over free legs between
  /// middles.
  void improve() {
    offer(to_);
    offer(paths(kStart, false, [&](const Arc& arc) {
      return arc.is_free ? (pieces_[arc.to].middle - pieces_[arc.from].middle).norm() : kInfinity;
    }));
    cut_ = length_ / (1 + settings_.gap);
  }

  void offer(const std::vector<Path>& paths) {
    if (paths[kGoal].arc == kNone) {
      return;
    }
    Polyline middles;
    std::vector<const Edge*> edges;
    for (std::uint32_t n = kGoal;; n = arcs_[paths[n].arc].from) {
      middles.push_back(pieces_[n].middle);
      edges.push_back(pieces_[n].edge);
      if (n == kStart) {
        break;
      }
    }
    std::reverse(middles.begin(), middles.end());
    std::reverse(edges.begin(), edges.end());
    Polyline taut = middles;
    pull(taut, edges);
    for (const Polyline& route : {taut, middles}) {
      if (length(route) < length_ && accepts_(route)) {
        best_ = route;
        length_ = length(route);
        budget_.show_best(length_);
        return;
      }
    }
  }
  /// Moves each bend in turn to the best place on its edge.
  void pull(Polyline& route, const std::vector<const Edge*>& edges) const {
    double moved = kInfinity;
    for (int pass = 0; pass < 100 && moved > 1e-9 * length_; ++pass) {
      moved = 0;
      for (std::size_t i = 1; i + 1 < route.size(); ++i) {
        if (edges[i] == nullptr) {
          continue;
        }
        const int axis = edges[i]->axis;
        const auto across = [&](const Vec3& p) {
          Vec3 d = p - route[i];
          d[axis] = 0;
          return d.norm();
        };
        const double before = across(route[i - 1]);
        const double after = across(route[i + 1]);
        if (before + after > 0) {
          const double a = route[i - 1][axis];
          const double b = route[i + 1][axis];
          const double place = std::clamp(a + (b - a) * (before / (before + after)),
                                          edges[i]->low[axis], edges[i]->high[axis]);
          moved = std::max(moved, std::abs(place - route[i][axis]));
          route[i][axis] = place;
        }
      }
    }
  }

  /// Estimates slopes anew, and drops arcs that no path of interest uses.
  void prune() {
    std::vector<double> slopes(pieces_.size());
    for (std::uint32_t n = 0; n < pieces_.size(); ++n) {
      if (pieces_[n].half > 0 && to_[n].arc != kNone && from_[n].arc != kNone) {
        const Arc& in = arcs_[to_[n].arc];
        const Arc& out = arcs_[from_[n].arc];
        const double mean = (leg_cost(pieces_[in.from], pieces_[n]).arrives +
                             leg_cost(pieces_[n], pieces_[out.to]).leaves) /
                            2;
        slopes[n] = std::clamp(mean, -0.99, 0.99);
      }
    }
    for (std::uint32_t n = 0; n < pieces_.size(); ++n) {
      pieces_[n].slope = slopes[n];
    }
    arcs_.erase(
        std::remove_if(arcs_.begin(), arcs_.end(),
                       [&](const Arc& arc) {
                         return !keeps(to_[arc.from].length + arc.cost + from_[arc.to].length);
                       }),
        arcs_.end());
  }

  /// Halves all pieces that are in use. False if that cannot be done.
  bool halve() {
    constexpr double kShortest = 1e-5;  // metres
    bool is_halved = false;
    std::vector<std::array<std::uint32_t, 2>> parts(pieces_.size(), {kNone, kNone});
    std::vector<Piece> pieces{pieces_[kStart], pieces_[kGoal]};
    parts[kStart][0] = kStart;
    parts[kGoal][0] = kGoal;
    const auto divide = [&](std::uint32_t n) {
      if (parts[n][0] != kNone) {
        return;
      }
      Piece part = pieces_[n];
      parts[n][0] = std::uint32_t(pieces.size());
      if (part.half < kShortest) {
        pieces.push_back(part);
        return;
      }
      is_halved = true;
      parts[n][1] = parts[n][0] + 1;
      part.half /= 2;
      for (const double along : {-part.half, part.half}) {
        part.middle = pieces_[n].at(along);
        pieces.push_back(part);
      }
    };
    for (const Arc& arc : arcs_) {
      divide(arc.from);
      divide(arc.to);
    }
    pieces_ = std::move(pieces);
    const std::vector<Arc> arcs = std::exchange(arcs_, {});
    for (const Arc& arc : arcs) {
      for (const std::uint32_t from : parts[arc.from]) {
        for (const std::uint32_t to : parts[arc.to]) {
          if (from != kNone && to != kNone) {
            link(from, to);
          }
        }
      }
      if (spent() || memory_full()) {
        return false;
      }
    }
    return is_halved;
  }

  /// What an arc takes, in its list twice over and in those of a search.
  bool memory_full() const { return 3 * arcs_.size() * sizeof(Arc) > settings_.max_bytes; }

  const std::vector<Edge>& edges_;
  const ClosedBoxes& boxes_;
  Polyline best_;
  double length_;
  double cut_;                  ///< longer paths are of no interest
  double dropped_ = kInfinity;  ///< the shortest of them
  double bound_;
  const Accepts& accepts_;
  Settings settings_;
  const Budget& budget_;
  BudgetWatch watch_;
  std::uint64_t expanded_;
  bool is_spent_ = false;
  std::vector<Piece> pieces_;
  std::vector<Arc> arcs_;
  std::vector<Path> to_;    ///< from the start, by piece
  std::vector<Path> from_;  ///< to the goal
};
}  // namespace altiplan::taut
