// SPDX-License-Identifier: Apache-2.0
#include "altiplan/route.hpp"

namespace altiplan {

double length(const Route& route) {
  double sum = 0;
  for (std::size_t i = 1; i < route.size(); ++i) {
    sum += (route[i] - route[i - 1]).norm();
  }
  return sum;
}

Route without_repeats(const Route& route) {
  Route out;
  for (const Vec3& p : route) {
    if (out.empty() || p != out.back()) {
      out.push_back(p);
    }
  }
  return out;
}

double horizontal_turn(const Approach& before, const Vec3& here, const Vec3& next,
                       bool turns_on_the_spot) {
  const Vec3 heading = turns_on_the_spot ? Vec3(here - before.from) : before.heading_at(here);
  return turn_angle_horizontal(heading, next - here);
}

double corner_radius(const Approach& before, const Vec3& here, const Vec3& next,
                     bool turns_on_the_spot) {
  const Vec3 incoming = here - before.from;
  const bool turned_on_the_spot =
      !has_heading(incoming) &&
      horizontal_turn(before, here, next, turns_on_the_spot) > kAngleTolerance;
  return turned_on_the_spot ? 0 : fillet_radius(incoming, next - here);
}

std::optional<Approach> approach(const Route& route, std::size_t to,
                                 const std::optional<Approach>& before) {
  std::size_t last = to;  // last point that differs from point number `to`
  while (last > 0 && route[last] == route[to]) {
    --last;
  }
  if (route[last] == route[to]) {
    return before;
  }
  std::size_t leg = last;  // start of the last leg with a heading before that point
  while (leg > 0 && !has_heading(route[leg] - route[leg - 1])) {
    --leg;
  }
  if (leg > 0) {
    return Approach(route[last], route[leg] - route[leg - 1]);
  }
  return Approach(route[last], before ? before->heading_at(route.front()) : Vec3::Zero());
}
}  // namespace altiplan
