// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/layers/scalar_field.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace altiplan::kit {

ScalarField::ScalarField(const Posts& posts, std::vector<float> values, double elsewhere)
    : origin_(posts.origin),
      step_(posts.step),
      counts_(posts.counts),
      values_(std::move(values)),
      elsewhere_(elsewhere),
      minimum_(elsewhere) {
  // A path may pass a column beyond the posts.
  for (std::size_t axis = 0; axis < 3; ++axis) {
    minima_[axis].assign(std::size_t(counts_[axis]), elsewhere);
  }
  std::size_t at = 0;
  for (std::size_t k = 0; k < minima_[2].size(); ++k) {
    for (std::size_t j = 0; j < minima_[1].size(); ++j) {
      for (std::size_t i = 0; i < minima_[0].size(); ++i) {
        if (const double value = values_[at++]; !std::isnan(value)) {
          minimum_ = std::min(minimum_, value);
          minima_[0][i] = std::min(minima_[0][i], value);
          minima_[1][j] = std::min(minima_[1][j], value);
          minima_[2][k] = std::min(minima_[2][k], value);
        }
      }
    }
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<double>& crossed = crossed_[axis];
    crossed.assign(1, 0.0);
    for (std::size_t i = 1; i < minima_[axis].size(); ++i) {
      // Within a cell the minimum is at least what is interpolated between the least of posts;
      // a column without any value costs the infinite value of elsewhere, of which 0 is a bound.
      double& value = minima_[axis][i];
      value = std::isfinite(value) ? value : 0;
      double& before = minima_[axis][i - 1];
      before = std::isfinite(before) ? before : 0;
      crossed.push_back(crossed.back() + step_[axis] * (before + value) / 2);
    }
  }
}

namespace {
/// The lines between the cells of an axis that a leg crosses, by fraction of the leg.
class Lines {
 public:
  Lines(double from, double to, int count) : from_(from), along_(to - from) {
    const auto within = [&](double at) { return std::clamp(at, -1.0, double(count)); };
    const double begin = within(from);
    const double end = within(to);
    if (along_ > 0) {
      line_ = std::max(0, floor(begin) + 1);
      left_ = std::min(count - 1, ceil(end)) - line_ + 1;
    } else if (along_ < 0) {
      line_ = std::min(count - 1, ceil(begin) - 1);
      left_ = line_ - std::max(0, floor(end)) + 1;
    }
    find_next();
  }
  /// Infinite after the last one.
  double next() const { return next_; }
  void advance() {
    line_ += along_ > 0 ? 1 : -1;
    --left_;
    find_next();
  }

 private:
  // Those of the library are calls.
  static int floor(double at) { return int(at) - (int(at) > at ? 1 : 0); }
  static int ceil(double at) { return int(at) + (int(at) < at ? 1 : 0); }
  void find_next() { next_ = left_ > 0 ? (line_ - from_) / along_ : kInfinity; }

  double from_;
  double along_;
  double next_;
  int line_ = 0;
  int left_ = 0;
};
}  // namespace

inline double ScalarField::mean_within(const std::array<double, 2>& from,
                                       const std::array<double, 2>& to) const {
  const std::array<double, 2> middle{(from[0] + to[0]) / 2, (from[1] + to[1]) / 2};
  std::array<int, 2> cell{};
  for (const std::size_t axis : {0U, 1U}) {
    if (!is_on(axis, middle[axis])) {
      return elsewhere_;
    }
    cell[axis] = std::min(int(middle[axis]), counts_[axis] - 2);
  }
  const auto [i, j] = cell;
  const double sw = post(i, j);
  const double se = post(i + 1, j);
  const double nw = post(i, j + 1);
  const double ne = post(i + 1, j + 1);
  if (std::isnan(sw + se + nw + ne)) {
    return elsewhere_;
  }
  // The mean of u v along the piece is that of its middle and a twelfth of its rises.
  const double u = middle[0] - i;
  const double v = middle[1] - j;
  const double uv = u * v + (to[0] - from[0]) * (to[1] - from[1]) / 12;
  return std::max(0.0, sw + u * (se - sw) + v * (nw - sw) + uv * (sw - se - nw + ne));
}

double ScalarField::mean_within(const Vec3& from, const Vec3& to) const {
  const Vec3 middle = (from + to) / 2;
  std::array<int, 3> cell{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double at = middle[Eigen::Index(axis)];
    if (!is_on(axis, at)) {
      return elsewhere_;
    }
    cell[axis] = std::min(int(at), counts_[axis] - 2);
  }
  const std::size_t row = std::size_t(counts_[0]);
  const std::size_t level = row * std::size_t(counts_[1]);
  const float* corner =
      &values_[std::size_t(cell[2]) * level + std::size_t(cell[1]) * row + std::size_t(cell[0])];
  const auto at = [&](const Vec3& p) {
    const Vec3 part = p - Vec3(cell[0], cell[1], cell[2]);
    const auto along = [&](const float* west) {
      return west[0] + part.x() * (double(west[1]) - west[0]);
    };
    const auto across = [&](const float* south) {
      const double here = along(south);
      return here + part.y() * (along(south + row) - here);
    };
    const double low = across(corner);
    return low + part.z() * (across(corner + level) - low);
  };
  // Along a straight line it is a cubic, of which two samples give the mean (Gauss).
  const Vec3 off = std::sqrt(1.0 / 12) * (to - from);
  const double mean = (at(middle - off) + at(middle + off)) / 2;
  return std::isnan(mean) ? elsewhere_ : std::max(0.0, mean);
}

inline bool ScalarField::are_in_one_cell(const std::array<double, 2>& a,
                                         const std::array<double, 2>& b) const {
  return std::min({a[0], a[1], b[0], b[1]}) >= 0 && std::max(a[0], b[0]) < counts_[0] &&
         std::max(a[1], b[1]) < counts_[1] && int(a[0]) == int(b[0]) && int(a[1]) == int(b[1]);
}

double ScalarField::mean_in_plane(const Vec3& a, const Vec3& b) const {
  const std::array<double, 2> from = in_cells(a);
  const std::array<double, 2> to = in_cells(b);
  const auto at = [&](double t) {
    return std::array{from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1])};
  };
  if (are_in_one_cell(from, to)) {
    return mean_within(from, to);
  }
  std::array<Lines, 2> lines{Lines(from[0], to[0], counts_[0]), Lines(from[1], to[1], counts_[1])};
  double sum = 0;
  std::array<double, 2> here = from;
  for (double t = 0; t < 1;) {
    const std::size_t axis = lines[0].next() <= lines[1].next() ? 0 : 1;
    const double end = std::min(lines[axis].next(), 1.0);
    lines[axis].advance();
    if (end > t) {
      const std::array<double, 2> there = end < 1 ? at(end) : to;
      sum += (end - t) * mean_within(here, there);
      here = there;
      t = end;
    }
  }
  return sum;
}

double ScalarField::mean_in_space(const Vec3& a, const Vec3& b) const {
  const auto in_cells = [&](const Vec3& p) {
    return Vec3((p.x() - origin_[0]) / step_[0], (p.y() - origin_[1]) / step_[1],
                (p.z() - origin_[2]) / step_[2]);
  };
  const Vec3 from = in_cells(a);
  const Vec3 to = in_cells(b);
  std::array<Lines, 3> lines{Lines(from[0], to[0], counts_[0]), Lines(from[1], to[1], counts_[1]),
                             Lines(from[2], to[2], counts_[2])};
  double sum = 0;
  Vec3 here = from;
  for (double t = 0; t < 1;) {
    Lines& nearest =
        *std::min_element(lines.begin(), lines.end(),
                          [](const Lines& x, const Lines& y) { return x.next() < y.next(); });
    const double end = std::min(nearest.next(), 1.0);
    nearest.advance();
    if (end > t) {
      const Vec3 there = end < 1 ? Vec3(from + end * (to - from)) : to;
      sum += (end - t) * mean_within(here, there);
      here = there;
      t = end;
    }
  }
  return sum;
}

double ScalarField::minimum_up_to(std::size_t axis, double at) const {
  const std::vector<double>& minima = minima_[axis];
  const std::vector<double>& crossed = crossed_[axis];
  const double last = counts_[axis] - 1;
  const double beyond = std::isfinite(elsewhere_) ? elsewhere_ * step_[axis] : 0;
  if (at < 0) {
    return at * beyond;
  }
  if (at >= last) {
    return crossed.back() + (at - last) * beyond;
  }
  const std::size_t i = std::size_t(at);
  const double u = at - double(i);
  const double here = minima[i] + u * (minima[i + 1] - minima[i]);
  return crossed[i] + u * step_[axis] * (minima[i] + here) / 2;
}

double ScalarField::bound(const Vec3& a, const Vec3& b) const {
  double bound = (std::isfinite(minimum_) ? minimum_ : 0) * (b - a).norm();
  for (std::size_t axis = 0; axis < (is_flat() ? 2 : 3); ++axis) {
    const double from = (a[Eigen::Index(axis)] - origin_[axis]) / step_[axis];
    const double to = (b[Eigen::Index(axis)] - origin_[axis]) / step_[axis];
    bound = std::max(bound, std::abs(minimum_up_to(axis, to) - minimum_up_to(axis, from)));
  }
  return bound * (1 - 1e-12);  // of rounding
}

double FieldIntegral::do_cost(const Leg& leg, double, const Request&) const {
  constexpr double kTolerance = 1e-4;  // of chords, metres
  if (!leg.turns()) {
    return field_.integral(leg.from, leg.to);
  }
  const std::vector<Vec3> points = leg.chords(kTolerance);
  double sum = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    sum += field_.integral(points[i - 1], points[i]);
  }
  return sum;
}
}  // namespace altiplan::kit
