// SPDX-License-Identifier: Apache-2.0
#include "host/mission/coverage.hpp"

#include <algorithm>
#include <cmath>

#include "host/base/words.hpp"

namespace altiplan::host {
namespace {

bool is_within(const Frame& frame, double lon, double lat, const Box& area) {
  if (std::abs(lon) > 180 || std::abs(lat) > 90) {
    return false;
  }
  const auto [x, y] = frame.to_local(lon, lat);
  return x >= area.min.x() && x <= area.max.x() && y >= area.min.y() && y <= area.max.y();
}
}  // namespace

Box ground_area(const World& world) {
  Box area = Box::empty();
  for (const Layer& layer : world.layers()) {
    if (layer.environment->ground() != nullptr) {
      area = area.united(layer.environment->bounds());
    }
  }
  return area;
}

std::string beside(const Point& point, const Frame& frame, const std::string& what,
                   const Box& area) {
  const double lon = point.at[0];
  const double lat = point.at[1];
  const bool is_bounded = area.min.head<2>().allFinite() && area.max.head<2>().allFinite() &&
                          area.min.x() <= area.max.x() && area.min.y() <= area.max.y();
  if (point.form != Point::Form::lonlat || !frame.has_position() || !is_bounded ||
      is_within(frame, lon, lat, area)) {
    return "";
  }
  const std::string place = "longitude " + with_digits(lon, 8) + ", latitude " +
                            with_digits(lat, 8) + " is outside " + what;
  if (is_within(frame, lat, lon, area)) {
    return place + ", and [" + with_digits(lat, 8) + ", " + with_digits(lon, 8) +
           "] is inside: give longitude first";
  }
  const Box range = frame.degrees(area);
  return place + ", which covers longitude " + with_digits(range.min.x(), 7) + " to " +
         with_digits(range.max.x(), 7) + ", latitude " + with_digits(range.min.y(), 7) + " to " +
         with_digits(range.max.y(), 7);
}
}  // namespace altiplan::host
