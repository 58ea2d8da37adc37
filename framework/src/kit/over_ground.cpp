// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/over_ground.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "altiplan/error.hpp"

namespace altiplan::kit {
namespace {

constexpr double kShortest = 0.1;  // metres

class OverGround {
 public:
  OverGround(const World& world, double above_m, double tolerance_m)
      : world_(world), above_m_(above_m), tolerance_m_(tolerance_m) {}

  Vec3 at(const Vec3& p) const {
    const std::optional<double> ground = world_.ground(p.x(), p.y());
    if (!ground) {
      throw Error("there is no ground below (" + std::to_string(p.x()) + ", " +
                  std::to_string(p.y()) + ")");
    }
    return {p.x(), p.y(), *ground + above_m_};
  }

  /// Adds the waypoints of a leg, but its first.
  void add(const Vec3& a, const Vec3& b, Polyline& to) const {
    const double length = (b - a).head<2>().norm();
    if (length < kShortest || keeps(a, b)) {
      to.push_back(b);
      return;
    }
    const Vec3 middle = at(farthest_off(a, b, length));
    add(a, middle, to);
    add(middle, b, to);
  }

 private:
  bool keeps(const Vec3& a, const Vec3& b) const {
    return world_.ground_gap(a, b) >= above_m_ - tolerance_m_ &&
           world_.ground_gap_max(a, b) <= above_m_ + tolerance_m_;
  }

  /// Of samples; the middle, where none of them is off.
  Vec3 farthest_off(const Vec3& a, const Vec3& b, double length) const {
    const int parts = std::clamp(int(length / std::max(1.0, above_m_ / 10)), 2, 4096);
    Vec3 worst = (a + b) / 2;
    double off = tolerance_m_;
    for (int k = 1; k < parts; ++k) {
      const Vec3 p = a + double(k) / parts * (b - a);
      if (const double there = std::abs(at(p).z() - p.z()); there > off) {
        off = there;
        worst = p;
      }
    }
    return worst;
  }

  const World& world_;
  double above_m_;
  double tolerance_m_;
};

/// Heights along a line that keep a tolerance and a slope at stations: in the middle between the
/// least and the greatest that do.
class Gentle {
 public:
  Gentle(const Polyline& line, const World& world, double above_m, double tolerance_m, double slope)
      : world_(world), above_m_(above_m), tolerance_m_(tolerance_m), slope_(slope) {
    const OverGround over(world, above_m, tolerance_m);
    for (std::size_t i = 0; i < line.size(); ++i) {
      const Vec3& from = line[i == 0 ? 0 : i - 1];
      const double length = (line[i] - from).head<2>().norm();
      const int parts = i == 0 ? 1 : std::max(1, int(std::ceil(length / kStation)));
      for (int k = 1; k <= parts; ++k) {
        stations_.push_back(over.at(from + double(k) / parts * (line[i] - from)));
      }
      corners_.push_back(stations_.size() - 1);
    }
    level();
  }

  Polyline route() const {
    Polyline route{stations_[0]};
    for (std::size_t i = 1; i < corners_.size(); ++i) {
      add(corners_[i - 1], corners_[i], route);
    }
    return route;
  }

 private:
  /// Metres; the ground between two stations is as uneven as that part of the tolerance.
  static constexpr double kStation = 5;
  static constexpr double kOfTolerance = 0.9;

  double rise(std::size_t i, std::size_t j) const {
    return slope_ * (stations_[j] - stations_[i]).head<2>().norm();
  }

  void level() {
    std::vector<double> low;
    for (const Vec3& p : stations_) {
      low.push_back(p.z() - kOfTolerance * tolerance_m_);
    }
    std::vector<double> high;
    for (const Vec3& p : stations_) {
      high.push_back(p.z() + kOfTolerance * tolerance_m_);
    }
    const auto narrow = [&](std::size_t i, std::size_t neighbour) {
      low[i] = std::max(low[i], low[neighbour] - rise(i, neighbour));
      high[i] = std::min(high[i], high[neighbour] + rise(i, neighbour));
    };
    for (std::size_t i = 1; i < stations_.size(); ++i) {
      narrow(i, i - 1);
    }
    for (std::size_t i = stations_.size() - 1; i-- > 0;) {
      narrow(i, i + 1);
    }
    for (std::size_t i = 0; i < stations_.size(); ++i) {
      Vec3& p = stations_[i];
      if (low[i] > high[i]) {
        char text[200];
        std::snprintf(text, sizeof text,
                      "the ground near (%.0f, %.0f) is too steep: with slopes of at most %.1f %% "
                      "the height above it is %.1f m off, more than %g m",
                      p.x(), p.y(), 100 * slope_,
                      (low[i] - high[i]) / 2 + kOfTolerance * tolerance_m_,
                      kOfTolerance * tolerance_m_);
        throw Error(text);
      }
      p.z() = (low[i] + high[i]) / 2;
    }
  }

  /// Adds the waypoints from one station to another, but its first.
  void add(std::size_t from, std::size_t to, Polyline& route) const {
    const Vec3& a = stations_[from];
    const Vec3& b = stations_[to];
    const bool keeps = world_.ground_gap(a, b) >= above_m_ - tolerance_m_ &&
                       world_.ground_gap_max(a, b) <= above_m_ + tolerance_m_;
    if (keeps) {
      route.push_back(b);
      return;
    }
    if (to <= from + 1) {
      char text[160];
      std::snprintf(text, sizeof text,
                    "the ground between (%.0f, %.0f) and (%.0f, %.0f) is too rough: %g m above it "
                    "cannot be kept within %g m",
                    a.x(), a.y(), b.x(), b.y(), above_m_, tolerance_m_);
      throw Error(text);
    }
    std::size_t worst = (from + to) / 2;
    double off = 0;
    for (std::size_t i = from + 1; i < to; ++i) {
      const double share = (stations_[i] - a).head<2>().norm() / (b - a).head<2>().norm();
      const double there = std::abs(a.z() + share * (b.z() - a.z()) - stations_[i].z());
      worst = there > off ? i : worst;
      off = std::max(off, there);
    }
    add(from, worst, route);
    add(worst, to, route);
  }

  const World& world_;
  double above_m_;
  double tolerance_m_;
  double slope_;
  Polyline stations_;
  std::vector<std::size_t> corners_;  ///< of the line, among the stations
};
}  // namespace

Polyline over_ground(const Polyline& line, const World& world, double above_m, double tolerance_m,
                     double slope) {
  return line.empty() ? line : Gentle(line, world, above_m, tolerance_m, slope).route();
}

Polyline over_ground(const Polyline& line, const World& world, double above_m, double tolerance_m) {
  const OverGround over(world, above_m, tolerance_m);
  Polyline high;
  for (const Vec3& p : line) {
    if (high.empty()) {
      high.push_back(over.at(p));
    } else {
      over.add(high.back(), over.at(p), high);
    }
  }
  return high;
}
}  // namespace altiplan::kit
