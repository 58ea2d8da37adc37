// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/first_route/first_route.hpp"
#include "host/gate/plan_report.hpp"

namespace altiplan::host {

/// Chooses the courses on which an aeroplane takes off and lands before its route is planned: of 36
/// the first, best into the wind, whose climb or approach passes as the autopilot flies it. A VTOL
/// does so in hover, at the height above the ground that its entries have.
class RunwayChoice {
 public:
  /// The world has the limits of the flight.
  RunwayChoice(const Mission& world, const RouteWish& wish, const FirstRoute& first,
               const GateOptions& gate)
      : world_(world), wish_(wish), first_(first), speed_mps_(first.speed_mps()), gate_(gate) {}

  /// `runway_deg` alone, if it is given. Of equally good ones the course nearest to `toward`.
  /// None, and a refusal, if none passes.
  std::optional<LandingEntry> landing(const Eigen::Vector2d& at, const Eigen::Vector2d& from,
                                      std::optional<double> runway_deg);
  std::optional<TakeOffEntry> takeoff(const Eigen::Vector2d& at, const Eigen::Vector2d& toward,
                                      std::optional<double> runway_deg);
  /// The least height above the ground, from that of the goal on, at which the circle around it
  /// passes.
  std::optional<double> circle(const Eigen::Vector2d& at, const Eigen::Vector2d& from);
  /// Why there was none: what is hit, and where.
  const std::string& refusal() const { return refusal_; }

 private:
  std::vector<double> courses(const Eigen::Vector2d& way, std::optional<double> runway_deg) const;
  /// Heights of the slopes' upper ends above the runway; of hover and circles above the point.
  std::vector<double> heights_above(const WishedPoint& point, double higher) const;
  LandingEntry landing_on(double course_deg, double height_m) const;
  TakeOffEntry takeoff_on(double course_deg, double height_m) const;
  /// True if the drawn line keeps what is demanded of the route.
  bool may_pass(const Polyline& line, const Runways& runways) const;
  bool climbs(const PlanReport& takeoff) const;
  /// Whichever way it turns to its line, the approach and the landing pass, and one of the turns.
  bool passes(const LandingEntry& landing, const Vec3& touch) const;
  PlanReport judged(const LandingEntry& landing, const Vec3& touch, double turn_deg) const;
  PlanReport judged(const TakeOffEntry& takeoff, const Vec3& start) const;
  PlanReport judged(const Polyline& items, int first, int last, const Vec3& home,
                    const GateOptions& gate) const;
  bool is_vtol() const { return wish_.is_vtol(); }
  void refuse(const char* what, const std::vector<double>& courses, const PlanReport& report);
  std::optional<Vec3> on_ground(const char* what, const Eigen::Vector2d& at);

  const Mission& world_;
  const RouteWish& wish_;
  const FirstRoute& first_;
  double speed_mps_;
  const GateOptions& gate_;
  std::string refusal_;
};
}  // namespace altiplan::host
