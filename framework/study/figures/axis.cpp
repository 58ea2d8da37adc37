// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "study/figures/svg.hpp"
#include "study/figures/text.hpp"

namespace altiplan::study::report {
namespace {

constexpr double kLogarithmicFrom = 30;  // ratio of maximum to minimum
constexpr double kCharacter = 7.4;       // width in units of a figure
constexpr std::size_t kMaxTicks = 12;

constexpr double kMin = std::numeric_limits<double>::min();
constexpr double kGreatest = std::numeric_limits<double>::max();

/// 1, 2 or 5 times a power of ten, at least that long.
double round_step(double wanted) {
  const double power = std::pow(10, std::floor(std::log10(wanted)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (wanted <= factor * power * (1 + 1e-9)) {
      return factor * power;
    }
  }
  return 10 * power;
}
}  // namespace

Axis::Axis(double low, double high, bool logarithmic, double from, double to)
    : low_(low), high_(high), logarithmic_(logarithmic), from_(from), to_(to) {}

Axis Axis::around(const std::vector<double>& values, double from, double to) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const double value : values) {
    if (std::isfinite(value)) {
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  if (!(low <= high)) {
    return {0, 1, false, from, to};
  }
  if (low > 0 && high / low > kLogarithmicFrom) {
    const double margin = std::pow(high / low, 0.03);
    return {std::max(low / margin, kMin), std::min(high * margin, kGreatest), true, from, to};
  }
  const double min_margin = std::max(std::abs(low), std::abs(high)) * 1e-6;
  double margin = std::max((high - low) * 0.04, min_margin);
  margin = margin > 0 ? margin : 1;
  return {std::max(low - margin, -kGreatest), std::min(high + margin, kGreatest), false, from, to};
}

double Axis::operator()(double value) const {
  const auto place = [&](double v) { return logarithmic_ ? std::log(v) : v; };
  const double share = place(value) / 2 - place(low_) / 2;  // halves: no overflow
  const double whole = place(high_) / 2 - place(low_) / 2;
  return from_ + std::clamp(share / whole, 0.0, 1.0) * (to_ - from_);
}

std::vector<Axis::Tick> Axis::even_ticks() const {
  const double room = std::abs(to_ - from_);
  const double wanted = (high_ / 2 - low_ / 2) * 2 / std::clamp(room / 64, 2.0, double(kMaxTicks));
  if (!(wanted > 0) || !std::isfinite(wanted)) {
    return {};
  }
  const double step = round_step(wanted);
  std::vector<Tick> ticks;
  const double first = std::ceil(low_ / step);
  for (double n = first; n * step <= high_ && ticks.size() < 2 * kMaxTicks; ++n) {
    const double value = n * step;
    // As many digits as neighbouring ticks need to differ.
    const double size = std::max(std::abs(low_), std::abs(high_));
    const int digits = std::clamp(1 + int(std::ceil(std::log10(size / step))), 1, 12);
    std::string label = readable(value, digits + 1);
    if (label.find('.') != std::string::npos && label.find('e') == std::string::npos) {
      label.erase(label.find_last_not_of('0') + 1);
      label = label.ends_with('.') ? label.substr(0, label.size() - 1) : label;
    }
    ticks.push_back({value, label});
  }
  return ticks;
}

std::vector<Axis::Tick> Axis::logarithmic_ticks() const {
  const int first = int(std::floor(std::log10(low_)));
  const int last = int(std::ceil(std::log10(high_)));
  const bool few = last - first <= 3;
  std::vector<Tick> ticks;
  for (int power = first; power <= last; ++power) {
    for (const double factor : {1.0, 2.0, 5.0}) {
      const double value = factor * std::pow(10, power);
      if (value >= low_ && value <= high_ && (factor == 1 || few)) {
        ticks.push_back({value, readable(value, 1)});
      }
    }
  }
  return ticks;
}

std::vector<Axis::Tick> Axis::ticks() const {
  std::vector<Tick> ticks = all_ticks();
  double end = -std::numeric_limits<double>::infinity();
  for (Tick& tick : ticks) {
    const double half = double(characters(tick.label)) * kCharacter / 2;
    const double x = (*this)(tick.value);
    if (x - half < end + 6 || x - half < 0 || x + half > kFigureWidth) {
      tick.label.clear();
    } else {
      end = x + half;
    }
  }
  return ticks;
}

std::vector<Axis::Tick> Axis::ticks_upwards() const {
  constexpr double kLine = 14;
  std::vector<Tick> ticks = all_ticks();
  double last = std::numeric_limits<double>::infinity();
  for (Tick& tick : ticks) {
    const double y = (*this)(tick.value);
    if (std::abs(y - last) < kLine) {
      tick.label.clear();
    } else if (!tick.label.empty()) {
      last = y;
    }
  }
  return ticks;
}

std::string axis_label(const std::string& label, const Axis& axis) {
  return label + (axis.logarithmic() ? " (logarithmic)" : "");
}

void draw_bottom(Canvas& canvas, const Axis& axis, double top, double y, const std::string& label) {
  for (const Axis::Tick& tick : axis.ticks()) {
    canvas.line(axis(tick.value), top, axis(tick.value), y, "hair");
    if (!tick.label.empty()) {
      // Below what stands left of the corner, however near the first tick is to it.
      canvas.text(axis(tick.value), y + 20, tick.label, "quiet", Anchor::middle);
    }
  }
  const double from = axis(axis.low());
  const double to = axis(axis.high());
  canvas.line(from, y, to, y, "quiet_line");
  canvas.text((from + to) / 2, y + 37, label, "ink", Anchor::middle);
}

void draw_left(Canvas& canvas, const Axis& axis, double left, double right, double top,
               const std::string& label) {
  canvas.text(6, top - 14, label);
  for (const Axis::Tick& tick : axis.ticks_upwards()) {
    canvas.line(left, axis(tick.value), right, axis(tick.value), "hair");
    if (!tick.label.empty()) {
      canvas.text(left - 6, axis(tick.value) + 4, tick.label, "quiet", Anchor::end);
    }
  }
}

void draw_curve(Canvas& canvas, const std::vector<double>& x, const std::vector<double>& y,
                const Axis& along, const Axis& up, const std::string& paint) {
  std::string d;
  bool is_drawn = false;
  for (std::size_t i = 0; i < y.size(); ++i) {
    if (std::isfinite(y[i])) {
      d += (is_drawn ? "L" : "M") + pixels(along(x[i])) + " " + pixels(up(y[i]));
    }
    is_drawn = std::isfinite(y[i]);
  }
  if (!d.empty()) {
    canvas.path(d, paint);
  }
}

double draw_key(Canvas& canvas, double x, double y, std::size_t series, std::string_view words) {
  canvas.path("M" + pixels(x) + " " + pixels(y - 4) + "h26", series_line(series));
  canvas.text(x + 34, y, words);
  return y + 18;
}

void draw_shares(Canvas& canvas, double left, double right, double top, double bottom) {
  for (int share = 0; share <= 100; share += 25) {
    const double y = bottom - (bottom - top) * share / 100;
    canvas.line(left, y, right, y, share == 0 ? "quiet_line" : "hair");
    canvas.text(left - 6, y + 4, std::to_string(share) + (share == 100 ? " %" : ""), "quiet",
                Anchor::end);
  }
}
}  // namespace altiplan::study::report
