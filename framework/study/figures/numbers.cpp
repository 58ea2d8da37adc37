// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "study/figures/text.hpp"

namespace altiplan::study::report {
namespace {

constexpr std::string_view kDash = "–";

std::string to_text(double value, std::chars_format format, int precision) {
  char text[400];
  const auto done = std::to_chars(text, text + sizeof text, value, format, precision);
  return {text, done.ptr};
}

const std::map<std::string_view, std::string_view>& units() {
  static const std::map<std::string_view, std::string_view> kUnits{
      {"m", "m"}, {"s", "s"}, {"deg", "°"}, {"rad", "rad"}, {"mb", "MB"}, {"mps", "m/s"}};
  return kUnits;
}
/// The step id and "opened" of "steps.route.counters.opened"; nothing for other names.
std::optional<std::pair<std::string_view, std::string_view>> step_value(std::string_view metric) {
  constexpr std::string_view kSteps = "steps.";
  constexpr std::string_view kCounters = "counters.";
  const std::size_t dot = metric.find('.', kSteps.size());
  if (!metric.starts_with(kSteps) || dot == std::string_view::npos) {
    return std::nullopt;
  }
  std::string_view value = metric.substr(dot + 1);
  if (value.starts_with(kCounters)) {
    value.remove_prefix(kCounters.size());
  }
  return std::pair(metric.substr(kSteps.size(), dot - kSteps.size()), value);
}
}  // namespace

std::string exact(double value) {
  if (std::isnan(value)) {
    return "";
  }
  if (std::isinf(value)) {
    return value < 0 ? "-inf" : "inf";
  }
  char text[64];
  const auto done = std::to_chars(text, text + sizeof text, value + 0.0);
  return {text, done.ptr};
}

bool is_straight(std::string_view metric, double value) {
  constexpr double kStraight = 1e8;  // metres, farther than anything flies
  return metric.ends_with("radius_m") && std::isfinite(value) && std::abs(value) >= kStraight;
}

double without_noise(std::string_view metric, double value) {
  constexpr double kNoise = 1e-6;
  const std::string unit = metric_unit(metric);
  const bool is_geometry = unit == "m" || unit == "°" || unit == "rad" || unit == "m/s";
  return is_geometry && std::abs(value) < kNoise ? 0 : value;
}

std::string readable_value(std::string_view metric, double value, int digits) {
  return is_straight(metric, value) ? "straight" : readable(without_noise(metric, value), digits);
}

std::string percent(double share) {
  if (!std::isfinite(share)) {
    return std::string(kDash);
  }
  const std::string text = to_text(100 * share, std::chars_format::fixed, 1);
  return (text.ends_with(".0") ? text.substr(0, text.size() - 2) : text) + " %";
}

std::string p_text(double p) {
  if (!std::isfinite(p)) {
    return std::string(kDash);
  }
  if (p < 0.0001) {
    return "< 0.0001";
  }
  return to_text(p, std::chars_format::fixed, p < 0.001 ? 4 : p < 0.1 ? 3 : 2);
}

std::string p_equals(double p) {
  const std::string text = p_text(p);
  return text.starts_with('<') ? "p " + text : "p = " + text;
}

std::string metric_unit(std::string_view metric) {
  const std::size_t cut = metric.find_last_of("_.");
  if (cut == std::string_view::npos) {
    return "";
  }
  const auto unit = units().find(metric.substr(cut + 1));
  return unit == units().end() ? "" : std::string(unit->second);
}

std::string metric_title(std::string_view metric) {
  if (metric == "expanded") {
    return "Expansions";
  }
  if (const auto step = step_value(metric)) {
    return metric_title(step->second) + " of step " + printable(step->first);
  }
  std::string title = printable(metric);
  if (!metric_unit(metric).empty()) {
    title.resize(title.find_last_of("_."));
  }
  for (char& letter : title) {
    letter = letter == '_' || letter == '.' ? ' ' : letter;
  }
  if (!title.empty() && title[0] >= 'a' && title[0] <= 'z') {
    title[0] = char(title[0] - 'a' + 'A');
  }
  return title;
}

std::string metric_label(std::string_view metric) {
  const std::string unit = metric_unit(metric);
  return metric_title(metric) + (unit.empty() ? "" : ", " + unit);
}
}  // namespace altiplan::study::report
