// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "worlds.hpp"

namespace altiplan::conformance {
namespace {

/// Wider than the judge's tolerances: anything that fails here fails there.
constexpr double kMetres = 1e-5;
constexpr double kRadians = 1e-6;

double angle_between(const Vec3& a, const Vec3& b) {
  const double lengths = a.norm() * b.norm();
  return lengths == 0 ? 0 : std::acos(std::clamp(a.dot(b) / lengths, -1.0, 1.0));
}

bool is_upright(const Vec3& leg) { return std::hypot(leg.x(), leg.y()) < 1e-6; }

/// The corner at `here`, for a vehicle that comes from `before`; `heading` is that of the last leg
/// which was not vertical, zero where there was none.
std::string bend_problem(const Vec3& before, const Vec3& heading, const Vec3& here,
                         const Vec3& next, const Request& request) {
  const Limits& limits = request.limits;
  const Vec3 in = here - before;
  const Vec3 out = next - here;
  const Vec3 from = request.vehicle.turns_on_the_spot && is_upright(in) ? Vec3(0, 0, 0) : heading;
  const double level =
      is_upright(out) ? 0 : angle_between({from.x(), from.y(), 0}, {out.x(), out.y(), 0});
  if (level > limits.max_turn_horizontal + kRadians) {
    return "turns by " + text(degrees(level)) + " degrees at " + text(here);
  }
  if (angle_between(in, out) > limits.max_turn_space + kRadians) {
    return "turns by " + text(degrees(angle_between(in, out))) + " degrees in 3-D at " + text(here);
  }
  // Half of the shorter leg is the tangent of a circle over half of the turn.
  const double half_turn = std::tan(angle_between(in, out) / 2);
  double radius = half_turn > 0 ? std::min(in.norm(), out.norm()) / 2 / half_turn : kInfinity;
  if (is_upright(in) && level > kRadians) {
    radius = 0;
  }
  if (radius < limits.min_turn_radius * (1 - 1e-6)) {
    return "bends with a radius of " + text(radius) + " m at " + text(here);
  }
  return "";
}

/// A turn joins the legs before and after it without a corner, as seen from above.
std::string kink_problem(const Vec3& heading, const Leg& leg, const Request& request) {
  const Vec3 out = leg.rate(0);
  const double corner = angle_between({heading.x(), heading.y(), 0}, {out.x(), out.y(), 0});
  return request.limits.min_turn_radius > 0 && corner > kRadians
             ? "has a corner of " + text(degrees(corner)) + " degrees beside a turn at " +
                   text(leg.from)
             : "";
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
  const double gap = scene.ridge != nullptr ? p.z() - scene.ridge->height_at(p.x()) : kInfinity;
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

std::string leg_fault(const Leg& leg, const Scene& scene) {
  const Limits& limits = scene.request.limits;
  const Vec3& a = leg.from;
  const Vec3& b = leg.to;
  const double run = leg.length();
  if (leg.turns() && leg.radius < limits.min_turn_radius * (1 - 1e-6)) {
    return "turns with a radius of " + text(leg.radius) + " m from " + text(a);
  }
  if (run < limits.min_leg - kMetres || run > limits.max_leg + kMetres) {
    return "has a leg of " + text(run) + " m from " + text(a);
  }
  const double climb = run > 0 ? std::asin(std::min(1.0, std::abs(b.z() - a.z()) / run)) : 0;
  if (climb > (b.z() < a.z() ? limits.max_descent() : limits.max_climb) + kRadians) {
    return "climbs at " + text(degrees(climb)) + " degrees from " + text(a);
  }
  const int samples = int(std::clamp(run / scene.unit * 40, 2.0, 4000.0));
  for (int i = 0; i <= samples; ++i) {
    const Vec3 p = leg.at(double(i) / samples);
    if (std::string fault = point_fault(p, scene); !fault.empty()) {
      return fault;
    }
  }
  return "";
}

/// Of a level body that points along the route: its corners, and points between them.
std::string body_fault(const Vec3& heading, const Leg& leg, const Scene& scene) {
  const Body* body = scene.request.vehicle.body.get();
  if (body == nullptr || heading.isZero(0)) {
    return "";
  }
  const Vec3 forward = Vec3(heading.x(), heading.y(), 0).normalized();
  const Vec3 left(-forward.y(), forward.x(), 0);
  const int samples = int(std::clamp(leg.length() / scene.unit * 10, 2.0, 400.0));
  for (const BodyPart& part : body->parts) {
    for (const Vec3& corner : part.corners) {
      for (const Vec3& other : part.corners) {
        const Vec3 at = (corner + other) / 2;
        const Vec3 off = at.x() * forward + at.y() * left + Vec3(0, 0, at.z());
        for (int i = 0; i <= samples; ++i) {
          const Vec3 p = leg.at(double(i) / samples) + off;
          if (own_clearance(scene, p) < -kMetres) {
            return "has its body in a solid at " + text(p);
          }
        }
      }
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
  std::optional<Vec3> before;
  bool turning = false;
  Vec3 heading(0, 0, 0);
  const auto came = [&](const Vec3& from, const Vec3& to) {
    before = from;
    heading = is_upright(to - from) ? heading : Vec3(to - from);
  };
  if (!request.start.velocity.isZero(0)) {
    came(request.start.position - request.start.velocity, request.start.position);
  }
  double total = 0;
  for (std::size_t i = 0; i < route.leg_count(); ++i) {
    const Leg leg = route.leg(i);
    total += leg.length();
    std::string fault = leg_fault(leg, scene);
    if (fault.empty() && before && !turning && !leg.turns()) {
      fault = bend_problem(*before, heading, leg.from, leg.to, request);
    }
    if (fault.empty() && before && (turning || leg.turns()) && !is_upright(leg.rate(0))) {
      fault = kink_problem(heading, leg, request);
    }
    if (fault.empty() && !leg.turns()) {
      fault =
          body_fault(is_upright(leg.to - leg.from) ? heading : Vec3(leg.to - leg.from), leg, scene);
    }
    turning = leg.turns();
    if (!fault.empty()) {
      return fault;
    }
    came(leg.to - leg.rate(1), leg.to);
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
