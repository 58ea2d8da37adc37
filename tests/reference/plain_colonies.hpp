// SPDX-License-Identifier: Apache-2.0
// The two ant colonies as textbooks have them, plain and slow: every place evaporates in every
// iteration, powers are those of the library, and nothing is remembered. For open cells alone, ends
// on centres.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "altiplan/random.hpp"
#include "altiplan/route.hpp"

namespace altiplan::reference {

struct PlainColony {
  using Place = std::array<int, 2>;
  using Way = std::vector<Place>;

  std::vector<std::string> rows;  ///< '#' closed, from the south
  double cell = 10;
  Place start{};
  Place goal{};
  int ants = 20;
  int iterations = 20;
  double q = 2000;
  double tau_0 = 2;
  double alpha = 6;
  double beta = 3;
  double rho = 0.6;
  static constexpr double kMin = 1e-50;  ///< that evaporation leaves, so that no power is 0
  RandomStream random;

  std::size_t best_alive = 0;  ///< ants that have arrived in the last iteration
  double best_length = kInfinity;
  Way best;

  virtual ~PlainColony() = default;
  virtual void begin() = 0;
  /// Where the ant goes; its own cell where it is stuck.
  virtual Place choose(const Way& way, RandomStream& stream) const = 0;
  virtual void improve(Way&) const {}
  virtual void evaporate() = 0;
  virtual void lay(const Way& way, double amount) = 0;

  int columns() const { return int(rows[0].size()); }
  int height() const { return int(rows.size()); }
  bool inside(const Place& p) const {
    return p[0] >= 0 && p[1] >= 0 && p[0] < columns() && p[1] < height();
  }
  bool open(const Place& p) const {
    return inside(p) && rows[std::size_t(p[1])][std::size_t(p[0])] != '#';
  }
  std::size_t number(const Place& p) const { return std::size_t(p[1] * columns() + p[0]); }
  double metres(const Place& a, const Place& b) const {
    return cell * std::hypot(a[0] - b[0], a[1] - b[1]);
  }
  double metres(const Way& way) const {
    double sum = 0;
    for (std::size_t n = 1; n < way.size(); ++n) {
      sum += metres(way[n - 1], way[n]);
    }
    return sum;
  }
  static bool was_at(const Way& way, const Place& p) {
    return std::find(way.begin(), way.end(), p) != way.end();
  }

  /// Whether the straight leg meets open cells alone: every cell that it comes within half a cell
  /// of on both axes.
  bool sees(const Place& a, const Place& b) const {
    for (int y = std::min(a[1], b[1]); y <= std::max(a[1], b[1]); ++y) {
      for (int x = std::min(a[0], b[0]); x <= std::max(a[0], b[0]); ++x) {
        // Twice the distance of its centre from the line, against what the cell reaches.
        const int dx = b[0] - a[0];
        const int dy = b[1] - a[1];
        const bool met =
            2 * std::abs(dx * (y - a[1]) - dy * (x - a[0])) <= std::abs(dx) + std::abs(dy);
        if (met && !open({x, y})) {
          return false;
        }
      }
    }
    return true;
  }

  template <class Weight>
  static std::size_t roulette(std::size_t count, const Weight& weight, RandomStream& stream) {
    double sum = 0;
    for (std::size_t n = 0; n < count; ++n) {
      sum += weight(n);
    }
    const double drawn = stream.uniform() * sum;
    double up_to = 0;
    for (std::size_t n = 0; n < count; ++n) {
      up_to += weight(n);
      if (up_to > drawn) {
        return n;
      }
    }
    return count - 1;
  }

  void run() {
    begin();
    const double longest = 3 * cell * (columns() + height());
    for (int iteration = 0; iteration < iterations; ++iteration) {
      std::vector<Way> arrived;
      for (int ant = 0; ant < ants; ++ant) {
        RandomStream stream =
            random.sub("ant", std::uint64_t(iteration) * std::uint64_t(ants) + std::uint64_t(ant));
        Way way = {start};
        bool alive = true;
        while (alive && way.back() != goal) {
          const Place next = choose(way, stream);
          alive = next != way.back();
          way.push_back(next);
          alive = alive && metres(way) <= longest;
        }
        if (alive) {
          improve(way);
          arrived.push_back(way);
          if (metres(way) < best_length - 1e-9) {
            best_length = metres(way);
            best = way;
          }
        }
      }
      best_alive = arrived.size();
      evaporate();
      for (const Way& way : arrived) {
        lay(way, q / metres(way));
      }
    }
  }
};

struct PlainLegColony : PlainColony {
  std::vector<std::array<double, 8>> tau;  ///< by cell and direction

  static Place offset(std::size_t k) {
    const int flat = int(k) < 4 ? int(k) : int(k) + 1;
    return {flat % 3 - 1, flat / 3 - 1};
  }
  static Place to(const Place& p, std::size_t k) {
    return {p[0] + offset(k)[0], p[1] + offset(k)[1]};
  }
  void begin() override {
    std::array<double, 8> initial;
    initial.fill(tau_0);
    tau.assign(std::size_t(columns() * height()), initial);
  }
  bool step_open(const Place& at, std::size_t k) const {
    const Place there = to(at, k);
    return open(there) && open({at[0], there[1]}) && open({there[0], at[1]});
  }
  Place choose(const Way& way, RandomStream& stream) const override {
    const Place at = way.back();
    double d_min = kInfinity;
    std::vector<std::size_t> allowed;
    for (std::size_t k = 0; k < 8; ++k) {
      if (step_open(at, k)) {
        d_min = std::min(d_min, metres(to(at, k), goal));
        if (!was_at(way, to(at, k))) {
          allowed.push_back(k);
        }
      }
    }
    if (allowed.empty()) {
      return at;
    }
    for (const std::size_t k : allowed) {
      if (to(at, k) == goal) {
        return goal;
      }
    }
    const auto weight = [&](std::size_t n) {
      const double eta = 1 / ((metres(to(at, allowed[n]), goal) - d_min + cell) / cell);
      return std::pow(tau[number(at)][allowed[n]], alpha) * std::pow(eta, beta);
    };
    return to(at, allowed[roulette(allowed.size(), weight, stream)]);
  }
  void evaporate() override {
    for (auto& place : tau) {
      for (double& amount : place) {
        amount = std::max((1 - rho) * amount, kMin);
      }
    }
  }
  void lay(const Way& way, double amount) override {
    for (std::size_t n = 1; n < way.size(); ++n) {
      for (std::size_t k = 0; k < 8; ++k) {
        if (to(way[n - 1], k) == way[n]) {
          tau[number(way[n - 1])][k] += amount;
        }
      }
    }
  }
};

struct PlainRegionColony : PlainColony {
  int reach = 3;    ///< l_c
  int spacing = 1;  ///< l_s
  double tilt = 0.5;
  int radius = 2;
  double decay = 0.5;
  std::vector<double> tau;  ///< by cell, with `radius` cells more around the map
  std::vector<Place> offsets;

  std::size_t padded(const Place& p) const {
    return std::size_t((p[1] + radius) * (columns() + 2 * radius) + p[0] + radius);
  }
  void begin() override {
    tau.assign(std::size_t((columns() + 2 * radius) * (height() + 2 * radius)), tau_0);
    offsets.clear();
    // From each corner toward the middle of each side.
    std::vector<int> along = {0};
    for (int from_corner = 0; from_corner < reach; from_corner += spacing + 1) {
      along.push_back(reach - from_corner);
      along.push_back(from_corner - reach);
    }
    for (int y = -reach; y <= reach; ++y) {
      for (int x = -reach; x <= reach; ++x) {
        const bool border = std::max(std::abs(x), std::abs(y)) == reach;
        const auto among = [&](int place) {
          return std::find(along.begin(), along.end(), place) != along.end();
        };
        if (border && among(x) && among(y)) {
          offsets.push_back({x, y});
        }
      }
    }
  }
  /// Eq. (10).
  double regional(const Place& p) const {
    double sum = 0;
    for (int y = -radius; y <= radius; ++y) {
      for (int x = -radius; x <= radius; ++x) {
        sum +=
            std::pow(decay, std::max(std::abs(x), std::abs(y))) * tau[padded({p[0] + x, p[1] + y})];
      }
    }
    return sum;
  }
  Place choose(const Way& way, RandomStream& stream) const override {
    const Place at = way.back();
    if (std::abs(goal[0] - at[0]) <= reach && std::abs(goal[1] - at[1]) <= reach &&
        sees(at, goal)) {
      return goal;
    }
    std::vector<Place> allowed;
    for (const Place& offset : offsets) {
      const Place there = {at[0] + offset[0], at[1] + offset[1]};
      if (inside(there) && sees(at, there) && !was_at(way, there)) {
        allowed.push_back(there);
      }
    }
    if (allowed.empty()) {
      return at;
    }
    std::stable_sort(allowed.begin(), allowed.end(), [&](const Place& one, const Place& other) {
      return metres(one, goal) < metres(other, goal) - 1e-9;
    });
    const double eta_max = 1 / metres(allowed.front(), goal);
    const double eta_min = 1 / metres(allowed.back(), goal);
    const auto stays_out = [&](const Place& p) {
      return 1 / metres(p, goal) < (eta_min + tilt * (eta_max - eta_min)) * (1 - 1e-9);
    };
    allowed.erase(std::remove_if(allowed.begin(), allowed.end(), stays_out), allowed.end());
    const auto weight = [&](std::size_t n) {
      return std::pow(regional(allowed[n]), alpha) / std::pow(metres(allowed[n], goal), beta);
    };
    return allowed[roulette(allowed.size(), weight, stream)];
  }
  /// Eq. (11).
  void improve(Way& way) const override {
    for (int v = 0; std::floor(10 * std::pow(0.8, v)) >= 4; ++v) {
      const auto stride = std::size_t(std::floor(10 * std::pow(0.8, v)));
      Way trimmed = {way.front()};
      for (std::size_t at = 0; at + 1 < way.size();) {
        const std::size_t ahead = std::min(at + stride, way.size() - 1);
        at = sees(way[at], way[ahead]) ? ahead : at + 1;
        trimmed.push_back(way[at]);
      }
      way = trimmed;
    }
  }
  void evaporate() override {
    for (double& amount : tau) {
      amount = std::max((1 - rho) * amount, kMin);
    }
  }
  /// On nodes resampled every l_c.
  void lay(const Way& way, double amount) override {
    for (std::size_t n = 1; n < way.size(); ++n) {
      const int dx = way[n][0] - way[n - 1][0];
      const int dy = way[n][1] - way[n - 1][1];
      const int most = std::max(std::abs(dx), std::abs(dy));
      const int parts = (most + reach - 1) / reach;
      for (int part = 0; part < parts; ++part) {
        const auto between = [&](int from, int length) {
          return int(std::floor(from + double(part) / parts * length + 0.5));
        };
        tau[padded({between(way[n - 1][0], dx), between(way[n - 1][1], dy)})] += amount;
      }
    }
    tau[padded(way.back())] += amount;
  }
};
}  // namespace altiplan::reference
