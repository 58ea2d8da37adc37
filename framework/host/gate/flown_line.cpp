// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <span>

#include "host/gate/plan_report.hpp"

namespace altiplan::host {
namespace {

/// Of strips that join end to end, those that are longest in plan.
std::span<const Strip> longest_chain(const std::vector<Strip>& strips) {
  std::span<const Strip> longest;
  double longest_m = -1;
  for (std::size_t begin = 0; begin < strips.size();) {
    double length = 0;
    std::size_t end = begin;
    do {
      length += (strips[end].to - strips[end].from).head<2>().norm();
      ++end;
    } while (end < strips.size() && strips[end].from.head<2>() == strips[end - 1].to.head<2>());
    if (length > longest_m) {
      longest_m = length;
      longest = std::span(strips).subspan(begin, end - begin);
    }
    begin = end;
  }
  return longest;
}
}  // namespace

Polyline flown_line(const FlownMission& flown) {
  Polyline line;
  const auto add = [&](const Vec3& p) {
    if (line.empty() || (line.back() - p).norm() > 1e-3) {
      line.push_back(p);
    }
  };
  for (const FlownPart& part : flown.parts) {
    for (const Strip& strip : longest_chain(part.strips)) {
      Vec3 from = strip.from;
      Vec3 to = strip.to;
      if (from.head<2>() == to.head<2>()) {  // straight up, or down
        to.z() = strip.to_high_m;
        if (!line.empty() &&
            std::abs(line.back().z() - to.z()) < std::abs(line.back().z() - from.z())) {
          std::swap(from, to);
        }
      } else {
        from.z() = (from.z() + strip.from_high_m) / 2;
        to.z() = (to.z() + strip.to_high_m) / 2;
      }
      add(from);
      add(to);
    }
  }
  return line;
}
}  // namespace altiplan::host
