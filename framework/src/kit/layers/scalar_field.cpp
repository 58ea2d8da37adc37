// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/layers/scalar_field.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace altiplan::kit {

ScalarField::ScalarField(std::array<double, 2> origin, std::array<double, 2> step, int columns,
                         int rows, std::vector<float> values, double elsewhere)
    : origin_(origin),
      step_(step),
      counts_{columns, rows},
      values_(std::move(values)),
      elsewhere_(elsewhere),
      minimum_(elsewhere) {
  // A path may pass a column beyond the posts.
  for (const std::size_t axis : {0U, 1U}) {
    minima_[axis].assign(std::size_t(counts_[axis]), elsewhere);
  }
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      if (const double value = post(i, j); !std::isnan(value)) {
        minimum_ = std::min(minimum_, value);
        minima_[0][std::size_t(i)] = std::min(minima_[0][std::size_t(i)], value);
        minima_[1][std::size_t(j)] = std::min(minima_[1][std::size_t(j)], value);
      }
    }
  }
  for (const std::size_t axis : {0U, 1U}) {
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
    if (!(middle[axis] >= 0 && middle[axis] <= counts_[axis] - 1)) {
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

inline bool ScalarField::are_in_one_cell(const std::array<double, 2>& a,
                                         const std::array<double, 2>& b) const {
  return std::min({a[0], a[1], b[0], b[1]}) >= 0 && std::max(a[0], b[0]) < counts_[0] &&
         std::max(a[1], b[1]) < counts_[1] && int(a[0]) == int(b[0]) && int(a[1]) == int(b[1]);
}

double ScalarField::mean(const Vec3& a, const Vec3& b) const {
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
  for (const std::size_t axis : {0U, 1U}) {
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
