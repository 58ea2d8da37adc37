// SPDX-License-Identifier: Apache-2.0
#include "words.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace altiplan {

std::string fixed(double value, int digits) {
  char buffer[64];
  const bool spelled = std::abs(value) < 1e15;
  const int n = spelled ? std::snprintf(buffer, sizeof buffer, "%.*f", digits, value)
                        : std::snprintf(buffer, sizeof buffer, "%g", value);
  std::string text(buffer, static_cast<std::size_t>(n));
  std::replace(text.begin(), text.end(), ',', '.');  // a locale with a decimal comma
  return text;
}

std::string distance_text(double value) {
  if (value >= 1e-3) {
    return fixed(value, 6);
  }
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, "%.3g", value);
  std::string text(buffer);
  std::replace(text.begin(), text.end(), ',', '.');
  return text;
}

std::string place(const Vec3& p) {
  return "(" + fixed(p.x()) + ", " + fixed(p.y()) + ", " + fixed(p.z()) + ")";
}

Violation beyond(const char* rule, std::size_t at, double value, double limit, const char* unit,
                 const std::string& what, bool too_small) {
  int digits = 2;  // as many as distinguish the two
  while (digits < 9 && fixed(value, digits) == fixed(limit, digits)) {
    ++digits;
  }
  const std::string spelled = std::string(" ") + (unit == std::string("deg") ? "degrees" : unit);
  return {rule,
          at,
          value,
          limit,
          what + " is " + fixed(value, digits) + spelled + ", " + (too_small ? "below" : "above") +
              " the limit of " + fixed(limit, digits) + spelled,
          "",
          unit};
}
}  // namespace altiplan
