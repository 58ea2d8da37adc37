// SPDX-License-Identifier: Apache-2.0
#include "host/first_route/wish.hpp"

#include <algorithm>

#include "altiplan/error.hpp"
#include "altiplan/formats/iso_time.hpp"
#include "host/base/words.hpp"

namespace altiplan::host {
namespace {

/// What a point without a height keeps from the lower limit, if the upper one leaves room.
constexpr double kAboveMin = 10;

std::string metres(double value) { return with_digits(value, 6) + " m"; }

void expect_words(const RouteWish& wish) {
  if (wish.crs == "") {
    throw Error("--crs: expected EPSG:CODE, found nothing");
  }
  if (wish.planner == "") {
    throw Error("--planner: expected the name of a planner, found nothing");
  }
  if (wish.start_time && !formats::parse_iso_time(*wish.start_time)) {
    throw Error("--start-time: expected a time such as 2026-05-01T10:00:00Z, found '" +
                *wish.start_time + "'");
  }
}
}  // namespace

WishedHeights heights_of(const RouteWish& wish) {
  expect_words(wish);
  WishedHeights heights;
  heights.max_m = wish.max_above_ground_m;
  const double max = heights.max_m.value_or(1e9);
  heights.is_min_lowered = !wish.min_above_ground_m && max / 2 < heights.min_m;
  heights.min_m = wish.min_above_ground_m.value_or(std::min(heights.min_m, max / 2));
  if (heights.min_m >= max) {
    throw Error("--max-agl: " + metres(max) + " leaves no height above --min-agl, " +
                metres(heights.min_m) + ": raise it");
  }
  heights.ends_m = std::min(std::max(heights.ends_m, heights.min_m + kAboveMin + wish.kept_m),
                            (heights.min_m + max) / 2);
  for (const WishedPoint& point : wish.points) {
    const double height = point.above_ground_m.value_or(heights.ends_m);
    if (height < heights.min_m || height > max) {
      throw Error(point.option + ": " + metres(height) + " above ground is " +
                  (height < heights.min_m ? "below --min-agl, " + metres(heights.min_m)
                                          : "above --max-agl, " + metres(max)) +
                  ": change one of the two");
    }
  }
  return heights;
}
}  // namespace altiplan::host
