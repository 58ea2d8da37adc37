// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/tour.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace altiplan::kit {
namespace {

constexpr double kTourGain = 1e-9;
constexpr std::size_t kNearEnds = 10;

/// SplitMix64.
struct TourDice {
  std::uint64_t state;
  std::uint64_t next() {
    std::uint64_t z = (state += 0x9e3779b97f4a7c15ULL);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }
  int below(int n) { return int(next() % std::uint64_t(n)); }
};
}  // namespace

Tour::Tour(std::size_t pieces, std::vector<double> cost)
    : ends_(2 * pieces), cost_of_(std::move(cost)), near_(ends_) {
  // Rounded otherwise one way than the other, a move and its reverse could both gain, for ever.
  for (std::size_t a = 0; a < ends_; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      double& one = cost_of_[a * ends_ + b];
      double& other = cost_of_[b * ends_ + a];
      one = other = std::max(one, other);
    }
  }
  for (std::size_t end = 0; end < ends_; ++end) {
    std::vector<int>& near = near_[end];
    for (std::size_t other = 0; other < ends_; ++other) {
      if (other / 2 != end / 2) {
        near.push_back(int(other));
      }
    }
    const std::size_t kept = std::min(kNearEnds, near.size());
    std::partial_sort(near.begin(), near.begin() + std::ptrdiff_t(kept), near.end(),
                      [&](int a, int b) {
                        const double ca = join(int(end), a);
                        const double cb = join(int(end), b);
                        return ca < cb || (ca == cb && a < b);
                      });
    near.resize(kept);
  }
  queued_.assign(pieces, 0);
}

void Tour::set_entries(std::vector<int> entries) {
  entry_ = std::move(entries);
  position_.assign(ends_ / 2, 0);
  cost_ = 0;
  for (int k = 0; k < n(); ++k) {
    position_[std::size_t(in(k) / 2)] = k;
    cost_ += n() > 1 ? join(out(k), in(after(k))) : 0;
  }
}

void Tour::construct() {
  std::vector<int> entries{0};
  std::vector<char> used(ends_ / 2);
  used[0] = 1;
  while (entries.size() < ends_ / 2) {
    const int from = entries.back() ^ 1;
    int best = -1;
    for (int end = 0; end < int(ends_); ++end) {
      if (!used[std::size_t(end / 2)] && (best < 0 || join(from, end) < join(from, best))) {
        best = end;
      }
    }
    used[std::size_t(best / 2)] = 1;
    entries.push_back(best);
  }
  set_entries(std::move(entries));
  for (int k = 0; k < n(); ++k) {
    touch(k);
  }
  settle();
}

void Tour::touch(int position) {
  const int piece = in(position) / 2;
  if (!queued_[std::size_t(piece)]) {
    queued_[std::size_t(piece)] = 1;
    queue_.push_back(piece);
  }
}

void Tour::settle() {
  while (!queue_.empty()) {
    const int piece = queue_.back();
    queue_.pop_back();
    queued_[std::size_t(piece)] = 0;
    while (n() > 3 && improve_at(piece)) {
    }
  }
}

/// Reverses the positions from..to, going around the end; or the rest, if that is shorter.
void Tour::reverse(int from, int to) {
  int inside = to - from;
  inside += inside < 0 ? n() : 0;
  ++inside;
  if (2 * inside > n()) {
    const int other_from = after(to);
    const int other_to = before(from);
    inside = n() - inside;
    from = other_from;
    to = other_to;
  }
  for (int i = 0; i < inside / 2; ++i) {
    std::swap(entry_[std::size_t(from)], entry_[std::size_t(to)]);
    entry_[std::size_t(from)] ^= 1;
    entry_[std::size_t(to)] ^= 1;
    position_[std::size_t(in(from) / 2)] = from;
    position_[std::size_t(in(to) / 2)] = to;
    from = after(from);
    to = before(to);
  }
  if (inside % 2 == 1) {
    entry_[std::size_t(from)] ^= 1;
  }
}

bool Tour::improve_at(int piece) { return try_two_opt(piece) || try_or_opt(piece); }

bool Tour::try_two_opt(int piece) {
  const int k = position_[std::size_t(piece)];
  // Forward: out(k)–in(k+1) is replaced by out(k)–out(j), and in(k+1)–in(j+1).
  {
    const int a = out(k);
    const double old = join(a, in(after(k)));
    for (const int c : near_[std::size_t(a)]) {
      const double first = join(a, c);
      if (first >= old - kTourGain) {
        break;
      }
      const int j = position_[std::size_t(c / 2)];
      if (out(j) != c) {
        continue;
      }
      const double gain = old + join(c, in(after(j))) - first - join(in(after(k)), in(after(j)));
      if (gain > kTourGain) {
        touch(after(k)), touch(j), touch(after(j)), touch(k);
        reverse(after(k), j);
        cost_ -= gain;
        return true;
      }
    }
  }
  // Backward: out(k-1)–in(k) is replaced by in(k)–in(j), and out(k-1)–out(j-1).
  const int a = in(k);
  const double old = join(out(before(k)), a);
  for (const int c : near_[std::size_t(a)]) {
    const double first = join(a, c);
    if (first >= old - kTourGain) {
      break;
    }
    const int j = position_[std::size_t(c / 2)];
    if (in(j) != c) {
      continue;
    }
    const double gain =
        old + join(out(before(j)), c) - first - join(out(before(k)), out(before(j)));
    if (gain > kTourGain) {
      touch(before(k)), touch(j), touch(before(j)), touch(k);
      reverse(k, before(j));
      cost_ -= gain;
      return true;
    }
  }
  return false;
}

/// Moves one to three pieces that begin or end at `piece` beside a near end, either way round.
bool Tour::try_or_opt(int piece) {
  const int at = position_[std::size_t(piece)];
  for (int length = 1; length <= 3 && length + 2 <= n(); ++length) {
    for (const bool ends_here : {false, true}) {
      if (ends_here && length == 1) {
        continue;
      }
      int from = at;
      int to = at;
      for (int i = 1; i < length; ++i) {
        (ends_here ? from : to) = ends_here ? before(from) : after(to);
      }
      const int left = out(before(from));
      const int right = in(after(to));
      const double removed = join(left, in(from)) + join(out(to), right) - join(left, right);
      if (removed <= kTourGain) {
        continue;
      }
      for (const int side : {0, 1}) {
        const int mine = side == 0 ? in(from) : out(to);
        const int other = side == 0 ? out(to) : in(from);
        for (const int c : near_[std::size_t(mine)]) {
          const double first = join(mine, c);
          if (first >= removed - kTourGain) {
            break;
          }
          const int j = position_[std::size_t(c / 2)];
          int offset = j - from;
          offset += offset < 0 ? n() : 0;
          if (offset < length) {
            continue;  // within the moved part
          }
          // Between c and its neighbour along the tour.
          const bool leaves = out(j) == c;
          const int next = leaves ? (after(j) == from ? right : in(after(j)))
                                  : (before(j) == to ? left : out(before(j)));
          if (next == c) {
            continue;
          }
          const double gain = removed + join(c, next) - first - join(other, next);
          if (gain <= kTourGain) {
            continue;
          }
          // Rebuild: the part is taken out and put in again.
          std::vector<int> part;
          for (int i = 0, p = from; i < length; ++i, p = after(p)) {
            part.push_back(in(p));
          }
          std::vector<int> rest;
          rest.reserve(std::size_t(n()));
          for (int i = 0, p = after(to); i < n() - length; ++i, p = after(p)) {
            rest.push_back(in(p));
          }
          // In `rest`, c is followed by `next` if it leaves there, else preceded.
          const bool mine_first = mine == part.front();
          const bool keep = leaves == mine_first;
          if (!keep) {
            std::reverse(part.begin(), part.end());
            for (int& entry : part) {
              entry ^= 1;
            }
          }
          const int c_entry = leaves ? c ^ 1 : c;
          auto where = std::find(rest.begin(), rest.end(), c_entry);
          where += leaves ? 1 : 0;
          rest.insert(where, part.begin(), part.end());
          entry_ = std::move(rest);
          for (int p = 0; p < n(); ++p) {
            position_[std::size_t(in(p) / 2)] = p;
          }
          cost_ -= gain;
          for (const int end : {left, right, c, next, mine, other}) {
            touch(position_[std::size_t(end / 2)]);
          }
          return true;
        }
      }
    }
  }
  return false;
}

void Tour::improve(std::uint64_t seed, const std::function<bool()>& spent) {
  if (n() < 4) {
    return;
  }
  TourDice dice{seed};
  std::vector<int> best = entry_;
  std::vector<int> best_position = position_;
  double best_cost = cost_;
  while (!spent()) {
    // A double bridge of three cuts within a short stretch.
    const int window = std::min(n() - 1, 30);
    const int begin = dice.below(n());
    int cuts[3] = {dice.below(window), dice.below(window), dice.below(window)};
    std::sort(cuts, cuts + 3);
    if (cuts[0] == cuts[1] || cuts[1] == cuts[2]) {
      continue;
    }
    std::vector<int> turned(entry_.begin() + begin, entry_.end());
    turned.insert(turned.end(), entry_.begin(), entry_.begin() + begin);
    std::rotate(turned.begin() + cuts[0] + 1, turned.begin() + cuts[1] + 1,
                turned.begin() + cuts[2] + 1);
    set_entries(std::move(turned));
    const int middle = cuts[0] + (cuts[2] - cuts[1]);
    for (const int k : {cuts[0], cuts[0] + 1, middle, middle + 1, cuts[2], (cuts[2] + 1) % n()}) {
      touch(k);
    }
    settle();
    if (cost_ < best_cost - kTourGain) {
      best = entry_;
      best_position = position_;
      best_cost = cost_;
    } else if (cost_ > best_cost + kTourGain) {
      entry_ = best;
      position_ = best_position;
      cost_ = best_cost;
    }
  }
  set_entries(std::move(best));
}

double tour_bound(std::size_t pieces, const std::vector<double>& cost, double upper, int steps) {
  const std::size_t n = 2 * pieces;
  if (pieces < 2) {
    return 0;
  }
  std::vector<double> price(n, 0);
  double best = 0;
  double step = 1;
  std::vector<double> key(n);
  std::vector<std::size_t> parent(n);
  std::vector<char> in_tree(n);
  std::vector<int> degree(n);
  const auto edge = [&](std::size_t a, std::size_t b) {
    return cost[a * n + b] + price[a] + price[b];
  };
  for (int round = 0; round < steps; ++round) {
    std::fill(degree.begin(), degree.end(), 0);
    std::fill(in_tree.begin(), in_tree.end(), 0);
    // Prim's tree of all ends but 0; the piece of an end joins with it, whatever its price. End 0
    // has the forced edge to end 1, and its cheapest join.
    double total = 0;
    std::fill(key.begin(), key.end(), std::numeric_limits<double>::infinity());
    std::size_t at = 1;
    in_tree[1] = 1;
    const auto relax = [&](std::size_t from) {
      for (std::size_t to = 1; to < n; ++to) {
        if (!in_tree[to] && to != (from ^ 1)) {
          const double c = edge(from, to);
          if (c < key[to]) {
            key[to] = c;
            parent[to] = from;
          }
        }
      }
    };
    relax(at);
    for (std::size_t added = 2; added < n;) {
      std::size_t next = 0;
      for (std::size_t to = 1; to < n; ++to) {
        if (!in_tree[to] && (next == 0 || key[to] < key[next])) {
          next = to;
        }
      }
      in_tree[next] = 1;
      total += key[next];
      ++degree[next];
      ++degree[parent[next]];
      ++added;
      relax(next);
      const std::size_t mate = next ^ 1;
      if (mate != 0 && !in_tree[mate]) {
        in_tree[mate] = 1;
        total += price[next] + price[mate];
        ++degree[next];
        ++degree[mate];
        ++added;
        relax(mate);
      }
    }
    total += price[0] + price[1];
    ++degree[0];
    ++degree[1];
    std::size_t cheapest = 2;
    for (std::size_t to = 2; to < n; ++to) {
      cheapest = edge(0, to) < edge(0, cheapest) ? to : cheapest;
    }
    total += edge(0, cheapest);
    ++degree[0];
    ++degree[cheapest];
    const double bound = total - 2 * std::accumulate(price.begin(), price.end(), 0.0);
    best = std::max(best, bound);
    double square = 0;
    for (std::size_t i = 0; i < n; ++i) {
      square += double((degree[i] - 2) * (degree[i] - 2));
    }
    if (square == 0) {
      break;
    }
    const double by = step * std::max(upper - bound, 1e-6) / square;
    for (std::size_t i = 0; i < n; ++i) {
      price[i] += by * (degree[i] - 2);
    }
    step *= 0.98;
  }
  return best;
}
}  // namespace altiplan::kit
