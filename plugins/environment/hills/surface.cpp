// SPDX-License-Identifier: Apache-2.0
#include "surface.hpp"

#include <algorithm>
#include <cmath>
#include <queue>

namespace hills {
namespace {

using altiplan::kInfinity;
using altiplan::Vec3;

constexpr double square(double v) { return v * v; }

// (w² - 1) exp(-w² / 2), the second derivative of a bell: from -1 at its middle up to kMaxBend at
// w = √3, then down to 0.
double bell_bend(double w) { return (w * w - 1) * std::exp(-w * w / 2); }
const double kMaxBendAt = std::sqrt(3.0);
const double kMaxBend = bell_bend(kMaxBendAt);

/// The ground along a leg, over the fraction t of the leg: a sum of one-dimensional bells.
class Profile {
 public:
  Profile(const Vec3& a, const Vec3& b, double base, const std::vector<Peak>& peaks) : base_(base) {
    // So low on the leg that all of them together stay far below the tolerance.
    const double negligible = 1e-9 / double(peaks.size() + 1);
    bells_.reserve(peaks.size());
    for (const Peak& peak : peaks) {
      const double u = (a.x() - peak.x) / peak.sx;
      const double v = (a.y() - peak.y) / peak.sy;
      const double du = (b.x() - a.x()) / peak.sx;
      const double dv = (b.y() - a.y()) / peak.sy;
      const double steep = du * du + dv * dv;
      const double middle = -(u * du + v * dv) / steep;
      const double off = square(u + middle * du) + square(v + middle * dv);
      const double height = peak.height * std::exp(-off / 2);
      if (height > negligible) {
        bells_.push_back({height, middle, 1 / std::sqrt(steep)});
      }
    }
  }

  std::size_t size() const { return bells_.size(); }

  /// The ground at t. `factors` receives exp(-w² / 2) of each bell, w its widths away.
  double at(double t, double* factors) const {
    double sum = base_;
    for (const Bell& bell : bells_) {
      *factors = std::exp(-square((t - bell.middle) / bell.width) / 2);
      sum += bell.height * *factors++;
    }
    return sum;
  }

  /// Upper bound of sign × second derivative on [from, to], whose ends have these factors; never
  /// below 0.
  double bend(double sign, double from, double to, const double* at_from,
              const double* at_to) const {
    double bound = 0;
    for (const Bell& bell : bells_) {
      const double w0 = std::abs(from - bell.middle) / bell.width;
      const double w1 = std::abs(to - bell.middle) / bell.width;
      const double bend0 = (w0 * w0 - 1) * *at_from++;  // bell_bend(w0), without its exponential
      const double bend1 = (w1 * w1 - 1) * *at_to++;
      const bool over_middle = from < bell.middle && bell.middle < to;
      const double near = over_middle ? 0 : std::min(w0, w1);
      const double far = std::max(w0, w1);
      const double bend_near = over_middle ? -1 : w0 < w1 ? bend0 : bend1;
      const double bend_far = w0 < w1 ? bend1 : bend0;
      double maximum = 0;
      if (sign < 0) {
        maximum = -std::min(bend_near, bend_far);
      } else if (far < kMaxBendAt) {
        maximum = bend_far;
      } else {
        maximum = near > kMaxBendAt ? bend_near : kMaxBend;
      }
      bound += bell.height / square(bell.width) * maximum;
    }
    return std::max(bound, 0.0);
  }

 private:
  struct Bell {
    double height, middle, width;
  };
  double base_;
  std::vector<Bell> bells_;
};

/// Minimum over t in [0, 1] of max(line(t), sign (z(t) - ground(t))), by branch and bound: between
/// its ends a function falls below the chord by at most bend L² / 8.
struct Least {
  const Profile& profile;
  double sign;
  double z0, z1;        // the leg's heights
  double line0, line1;  // of the straight lower bound
  double enough;
  double too_low = -kInfinity;
  double best = kInfinity;
  std::vector<double> factors = {};  ///< of the profile's bells at the places in use

  static constexpr double kTolerance = 1e-7;

  /// A place on the leg: the function's value there, and which of `factors` are its own.
  struct Place {
    double t, value;
    std::size_t number;
  };

  double line(double t) const { return line0 + t * (line1 - line0); }
  Place look(double t, std::size_t number) {
    factors.resize(std::max(factors.size(), (number + 1) * profile.size()));
    const double ground = profile.at(t, factors.data() + number * profile.size());
    const double value = sign * (z0 + t * (z1 - z0) - ground);
    best = std::min(best, std::max(line(t), value));
    return {t, value, number};
  }
  const double* factors_of(const Place& place) const {
    return factors.data() + place.number * profile.size();
  }

  double find() {
    factors.reserve(8 * profile.size());
    const Place first = look(0, 0);
    search(first, look(1, 1), 2);
    return best;
  }

  void search(const Place& from, const Place& to, std::size_t number) {
    if (best < too_low) {
      return;
    }
    const double length = to.t - from.t;
    const double bend = profile.bend(-sign, from.t, to.t, factors_of(from), factors_of(to));
    const double sag = bend * square(length) / 8;
    const double bound =
        std::max(std::min(line(from.t), line(to.t)), std::min(from.value, to.value) - sag);
    if (bound >= std::min(best - kTolerance, enough) || length < 1e-13) {
      return;
    }
    const Place middle = look((from.t + to.t) / 2, number);
    if (from.value < to.value) {
      search(from, middle, number + 1);
      search(middle, to, number + 1);
    } else {
      search(middle, to, number + 1);
      search(from, middle, number + 1);
    }
  }
};

constexpr double kNoLine = -1e300;

/// True if the leg is, as far as the ground is concerned, a point of the map.
bool is_vertical(const Vec3& a, const Vec3& b) {
  return std::hypot(b.x() - a.x(), b.y() - a.y()) < 1e-9;
}

/// Part of the plane, with an upper bound of the maximum in it.
struct Part {
  double x, y, half_x, half_y, bound;
  bool operator<(const Part& other) const { return bound < other.bound; }
};

/// An upper bound, within `relative` and `absolute`, of the maximum over a box. look(x, y, half_x,
/// half_y) gives {a value in that part, an upper bound for it}.
template <class Look>
double greatest(Part whole, double relative, double absolute, const Look& look) {
  double best = -kInfinity;
  std::priority_queue<Part> parts;
  const auto add = [&](Part part) {
    const auto [value, bound] = look(part.x, part.y, part.half_x, part.half_y);
    best = std::max(best, value);
    part.bound = bound;
    parts.push(part);
  };
  add(whole);
  while (parts.top().bound > best + std::max(absolute, relative * std::abs(best))) {
    const Part part = parts.top();
    parts.pop();
    const bool wide = part.half_x > part.half_y;
    const double half_x = wide ? part.half_x / 2 : part.half_x;
    const double half_y = wide ? part.half_y : part.half_y / 2;
    for (const double side : {-1.0, 1.0}) {
      add({part.x + (wide ? side * half_x : 0), part.y + (wide ? 0 : side * half_y), half_x, half_y,
           0});
    }
  }
  return std::max(best, parts.top().bound);
}
}  // namespace

double bells(const std::vector<Peak>& peaks, double x, double y) {
  double sum = 0;
  for (const Peak& peak : peaks) {
    sum += peak.height *
           std::exp(-square((x - peak.x) / peak.sx) / 2 - square((y - peak.y) / peak.sy) / 2);
  }
  return sum;
}

Surface::Surface(double base, double cap, std::vector<Peak> peaks)
    : base_(base), cap_(cap), peaks_(std::move(peaks)), top_(base) {
  for (const Peak& peak : peaks_) {
    top_ += std::max(peak.height, 0.0);
  }
  top_ = std::min(top_, cap_);
  max_slope_ = steepest();
}

Surface::Local Surface::local(double x, double y) const {
  Local at{base_, 0, 0};
  for (const Peak& peak : peaks_) {
    const double u = (x - peak.x) / peak.sx;
    const double v = (y - peak.y) / peak.sy;
    const double bell = peak.height * std::exp(-u * u / 2 - v * v / 2);
    at.sum += bell;
    at.dx -= bell * u / peak.sx;
    at.dy -= bell * v / peak.sy;
  }
  return at;
}

// Bound of the second derivative in any direction within r of (x, y). In the peak's own units it is
// at most max(1, |w² - 1|) exp(-w² / 2), which only falls with the distance w.
double Surface::bend(double x, double y, double r) const {
  double bound = 0;
  for (const Peak& peak : peaks_) {
    const double narrow = std::min(peak.sx, peak.sy);
    const double w = std::max(
        std::sqrt(square((x - peak.x) / peak.sx) + square((y - peak.y) / peak.sy)) - r / narrow,
        0.0);
    const double maximum = w > kMaxBendAt ? bell_bend(w) : std::max(std::exp(-w * w / 2), kMaxBend);
    bound += peak.height / square(narrow) * maximum;
  }
  return bound;
}

double Surface::max_slope(double x, double y, double r) const {
  const Local at = local(x, y);
  return std::min(max_slope_, std::hypot(at.dx, at.dy) + bend(x, y, r) * r);
}

double Surface::height_bound(double x0, double y0, double x1, double y1) const {
  const double half_x = (x1 - x0) / 2;
  const double half_y = (y1 - y0) / 2;
  const double x = x0 + half_x;
  const double y = y0 + half_y;
  const Local at = local(x, y);
  const double r = std::hypot(half_x, half_y);
  return std::min(top_, at.sum + std::abs(at.dx) * half_x + std::abs(at.dy) * half_y +
                            bend(x, y, r) * r * r / 2);
}

altiplan::kit::GroundPiece Surface::piece(double x0, double y0, double x1, double y1) const {
  const double x = (x0 + x1) / 2;
  const double y = (y0 + y1) / 2;
  const Local at = local(x, y);
  const double r = std::hypot(x1 - x0, y1 - y0) / 2;
  return {x, y, at.sum, at.dx, at.dy, r > 0 ? bend(x, y, r) * r * r / 2 : 0, cap_};
}

namespace {

/// Factors along one axis of a bell, over nodes and intervals. Its middle is m, its width s, and
/// u = (x - m) / s.
struct Factors {
  std::vector<double> node;     ///< exp(-u² / 2) at the nodes, all intervals' first ones first
  std::vector<double> maximum;  ///< maximum of it in each interval
  std::vector<double> bend;     ///< maximum of (1 - u²) exp(-u² / 2) / s² in each, or 0

  Factors(const Surface::Intervals& at, int pieces, double m, double s) {
    for (int n = 0; n <= pieces; ++n) {
      for (int k = 0; k < at.count; ++k) {
        const double x = at.first + k * at.step + (2.0 * n / pieces - 1) * at.half;
        node.push_back(std::exp(-square((x - m) / s) / 2));
      }
    }
    for (int k = 0; k < at.count; ++k) {
      const double away = std::max(std::abs(at.first + k * at.step - m) - at.half, 0.0) / s;
      maximum.push_back(std::exp(-square(away) / 2));
      bend.push_back(std::max(1 - square(away), 0.0) * maximum.back() / square(s));
    }
  }
};
}  // namespace

// A bell is the product of a factor along each axis, so that the ground at the nodes of a lattice,
// `pieces` to each box and axis, needs no exponential per node. Between the nodes a function rises
// above them by at most (maximum downward bend) L² / 8 along each axis. Narrow hills are bounded by
// the maximum of each bell instead.
std::vector<double> Surface::highest(const Intervals& east, const Intervals& north,
                                     double within) const {
  constexpr int kMaxPieces = 12;
  double sag = 0;  // for an undivided box
  for (const Peak& peak : peaks_) {
    sag += peak.height * (square(east.half / peak.sx) + square(north.half / peak.sy)) / 2;
  }
  const int pieces = int(std::clamp(std::ceil(std::sqrt(sag / within)), 1.0, double(kMaxPieces)));
  std::vector<Factors> x;
  std::vector<Factors> y;
  for (const Peak& peak : peaks_) {
    x.emplace_back(east, pieces, peak.x, peak.sx);
    y.emplace_back(north, pieces, peak.y, peak.sy);
  }
  const std::size_t columns = std::size_t(east.count);
  const double bend_x = square(2 * east.half / pieces) / 8;
  const double bend_y = square(2 * north.half / pieces) / 8;
  std::vector<double> result;
  std::vector<double> row((std::size_t(pieces) + 1) * columns);
  for (std::size_t j = 0; j < std::size_t(north.count); ++j) {
    std::vector<double> at_nodes(columns, -kInfinity);
    for (std::size_t n = 0; n <= std::size_t(pieces); ++n) {
      std::fill(row.begin(), row.end(), base_);
      for (std::size_t p = 0; p < peaks_.size(); ++p) {
        const double factor = peaks_[p].height * y[p].node[n * std::size_t(north.count) + j];
        for (std::size_t k = 0; k < row.size(); ++k) {
          row[k] += factor * x[p].node[k];
        }
      }
      for (std::size_t k = 0; k < row.size(); ++k) {
        at_nodes[k % columns] = std::max(at_nodes[k % columns], row[k]);
      }
    }
    std::vector<double> maximum(columns, base_);
    for (std::size_t p = 0; p < peaks_.size(); ++p) {
      const double factor = peaks_[p].height * y[p].maximum[j];
      const double factor_bend = peaks_[p].height * y[p].bend[j];
      for (std::size_t i = 0; i < columns; ++i) {
        maximum[i] += factor * x[p].maximum[i];
        at_nodes[i] += bend_x * factor * x[p].bend[i] + bend_y * factor_bend * x[p].maximum[i];
      }
    }
    for (std::size_t i = 0; i < columns; ++i) {
      result.push_back(std::min({top_, maximum[i], at_nodes[i]}));
    }
  }
  return result;
}

// A bell is steepest at one width from its middle: beyond ten widths from all of them the slope is
// negligible.
double Surface::steepest() const {
  constexpr double kWidths = 10;
  altiplan::Box box = altiplan::Box::empty();
  for (const Peak& peak : peaks_) {
    const Vec3 reach(kWidths * peak.sx, kWidths * peak.sy, 0);
    const Vec3 middle(peak.x, peak.y, 0);
    box = box.with(middle - reach).with(middle + reach);
  }
  if (peaks_.empty()) {
    return 0;
  }
  const auto look = [&](double x, double y, double half_x, double half_y) {
    const Local at = local(x, y);
    const double r = std::hypot(half_x, half_y);
    const double slope = std::hypot(at.dx, at.dy);
    const double max_bend = bend(x, y, r);
    const bool capped = at.sum - slope * r - max_bend * r * r / 2 >= cap_;
    return std::pair(at.sum < cap_ ? slope : 0.0, capped ? 0.0 : slope + max_bend * r);
  };
  const Vec3 middle = (box.min + box.max) / 2;
  const Vec3 half = (box.max - box.min) / 2;
  return greatest({middle.x(), middle.y(), half.x(), half.y(), 0}, 0.01, 1e-6, look);
}

double Surface::gap(const Vec3& a, const Vec3& b, double enough, double too_low) const {
  const double low = std::min(a.z(), b.z());
  if (is_vertical(a, b)) {
    return low - height(a.x(), a.y());
  }
  if (low - top_ >= enough) {
    return low - top_;
  }
  const Profile profile(a, b, base_, peaks_);
  return Least{profile, 1, a.z(), b.z(), a.z() - cap_, b.z() - cap_, enough, too_low}.find();
}

double Surface::gap_max(const Vec3& a, const Vec3& b) const {
  const double high = std::max(a.z(), b.z());
  if (is_vertical(a, b)) {
    return high - height(a.x(), a.y());
  }
  // z - min(cap, sum) = max(z - cap, z - sum), and the maximum of each may be taken alone.
  const Profile profile(a, b, base_, peaks_);
  const double below = Least{profile, -1, a.z(), b.z(), kNoLine, kNoLine, kInfinity}.find();
  return std::max(high - cap_, -below);
}
}  // namespace hills
