// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "worlds.hpp"

namespace altiplan::conformance {
namespace {

/// Wider than the judge's tolerances: what fails here fails there.
constexpr double kMetres = 1e-5;
constexpr double kRadians = 1e-6;

double angle_between(const Vec3& a, const Vec3& b) {
  const double lengths = a.norm() * b.norm();
  return lengths == 0 ? 0 : std::acos(std::clamp(a.dot(b) / lengths, -1.0, 1.0));
}

std::string bend_problem(const Vec3& before, const Vec3& here, const Vec3& next,
                         const Limits& limits) {
  const Vec3 in = here - before;
  const Vec3 out = next - here;
  const double level = angle_between({in.x(), in.y(), 0}, {out.x(), out.y(), 0});
  if (level > limits.max_turn_horizontal + kRadians) {
    return "turns by " + text(degrees(level)) + " degrees at " + text(here);
  }
  if (angle_between(in, out) > limits.max_turn_space + kRadians) {
    return "turns by " + text(degrees(angle_between(in, out))) + " degrees in space at " +
           text(here);
  }
  const Vec3 across(in.y() * out.z() - in.z() * out.y(), in.z() * out.x() - in.x() * out.z(),
                    in.x() * out.y() - in.y() * out.x());
  const double area = across.norm();  // twice the triangle's
  const double radius =
      area > 0 ? in.norm() * out.norm() * (next - before).norm() / (2 * area) : kInfinity;
  if (radius < limits.min_turn_radius * (1 - 1e-6)) {
    return "bends with a radius of " + text(radius) + " m at " + text(here);
  }
  return "";
}

std::string point_fault(const Vec3& p, const Scene& scene) {
  const Request& request = scene.request;
  const double needed = std::max(request.limits.min_clearance, request.vehicle.radius_m);
  if (own_clearance(scene, p) < needed - kMetres) {
    return "comes to " + text(own_clearance(scene, p)) + " m of a solid at " + text(p) +
           ", where " + text(needed) + " m are needed";
  }
  if (!request.volume.contains(p, kMetres)) {
    return "leaves the volume at " + text(p);
  }
  if (request.level_m && std::abs(p.z() - *request.level_m) > kMetres) {
    return "leaves the level of flight at " + text(p);
  }
  const double gap = scene.ridge != nullptr ? p.z() - scene.ridge->height(p.x()) : kInfinity;
  if (gap < request.limits.min_ground_clearance.value_or(-kInfinity) - kMetres) {
    return "is " + text(gap) + " m above ground at " + text(p);
  }
  for (const AltitudeBand& band : request.limits.altitude) {
    const double height = band.datum == AltitudeBand::Datum::sea ? p.z() : gap;
    if (height < band.min - kMetres || (height > band.max + kMetres && height < kInfinity)) {
      return "leaves an altitude band at " + text(p);
    }
  }
  return "";
}

std::string leg_fault(const Vec3& a, const Vec3& b, const Scene& scene) {
  const Limits& limits = scene.request.limits;
  const double run = (b - a).norm();
  if (run < limits.min_leg - kMetres || run > limits.max_leg + kMetres) {
    return "has a leg of " + text(run) + " m from " + text(a);
  }
  const double climb = run > 0 ? std::asin(std::min(1.0, std::abs(b.z() - a.z()) / run)) : 0;
  if (climb > limits.max_climb + kRadians) {
    return "climbs at " + text(degrees(climb)) + " degrees from " + text(a);
  }
  const int samples = int(std::clamp(run / scene.unit * 40, 2.0, 4000.0));
  for (int i = 0; i <= samples; ++i) {
    const Vec3 p = i == samples ? b : Vec3(a + (b - a) * i / samples);
    if (std::string fault = point_fault(p, scene); !fault.empty()) {
      return fault;
    }
  }
  return "";
}
}  // namespace

std::string unsound(const Route& route, const Scene& scene) {
  const Request& request = scene.request;
  if (route.empty()) {
    return "has no point";
  }
  if (!std::all_of(route.begin(), route.end(), is_finite)) {
    return "has a coordinate that is not finite";
  }
  if (route.front() != request.start.position) {
    return "begins at " + text(route.front()) + ", not at the start";
  }
  if ((route.back() - request.goal.position).norm() > request.goal.tolerance_m + kMetres) {
    return "ends at " + text(route.back()) + ", outside the goal's tolerance";
  }
  std::optional<Vec3> before = request.before_start();
  double total = 0;
  for (std::size_t i = 0; i + 1 < route.size(); ++i) {
    total += (route[i + 1] - route[i]).norm();
    std::string fault = leg_fault(route[i], route[i + 1], scene);
    if (fault.empty() && before) {
      fault = bend_problem(*before, route[i], route[i + 1], request.limits);
    }
    if (!fault.empty()) {
      return fault;
    }
    before = route[i];
  }
  if (total > request.limits.max_route_length + kMetres) {
    return "is " + text(total) + " m long";
  }
  const CheckResult judged = check(route, request);
  return judged.ok()
             ? ""
             : "is refused by the judge, waypoint " + std::to_string(judged.violations.front().at) +
                   ": " + judged.violations.front().message;
}
}  // namespace altiplan::conformance
