// SPDX-License-Identifier: Apache-2.0
// Planners that forget a rule of the request each.
#include "sound_planner.hpp"

namespace {
using namespace altiplan;
using namespace altiplan::bad;

/// Each rule in turn is not told to the sound planner. Small cells turn and climb anyhow; large
/// ones make long legs.
template <void (*kForget)(Request&)>
PlanResult forgets(const Sound& sound, const Request& request) {
  Request told = request;
  kForget(told);
  return sound.plan(told, {{20, 20, 30}});
}
void climb(Request& r) { r.limits.max_climb = kPi / 2; }
void turn(Request& r) { r.limits.max_turn_horizontal = kPi; }
void turn_in_space(Request& r) { r.limits.max_turn_space = kPi; }
void turn_radius(Request& r) { r.limits.min_turn_radius = 0; }
void clearance(Request& r) { r.limits.min_clearance = r.vehicle.radius_m = 0; }
void shortest_leg(Request& r) { r.limits.min_leg = 0; }
void altitude(Request& r) { r.limits.altitude.clear(); }
void route_length(Request& r) { r.limits.max_route_length = kInfinity; }
void ground(Request& r) { r.limits.min_ground_clearance.reset(); }
void level(Request& r) { r.level_m.reset(); }
void heading(Request& r) { r.start.velocity = {0, 0, 0}; }
void rules(Request& r) { r.constraints.clear(); }
PlanResult forgets_longest_leg(const Sound& sound, const Request& request) {
  Request told = request;
  told.limits.max_leg = kInfinity;
  return sound.plan(told, {{260, 260, 60}});
}

}  // namespace

ALTIPLAN_PLUGIN(Planner, "forgets_climb", SpoiltPlanner<forgets<climb>>, NoParams,
                "knows no limit of climb")
ALTIPLAN_PLUGIN(Planner, "forgets_turn", SpoiltPlanner<forgets<turn>>, NoParams,
                "knows no limit of turns on the plane")
ALTIPLAN_PLUGIN(Planner, "forgets_turn_in_space", SpoiltPlanner<forgets<turn_in_space>>, NoParams,
                "knows no limit of turns in space")
ALTIPLAN_PLUGIN(Planner, "forgets_turn_radius", SpoiltPlanner<forgets<turn_radius>>, NoParams,
                "knows no least radius of turns")
ALTIPLAN_PLUGIN(Planner, "forgets_clearance", SpoiltPlanner<forgets<clearance>>, NoParams,
                "takes the vehicle for a point, and knows no clearance")
ALTIPLAN_PLUGIN(Planner, "forgets_longest_leg", SpoiltPlanner<forgets_longest_leg>, NoParams,
                "knows no longest leg")
ALTIPLAN_PLUGIN(Planner, "forgets_shortest_leg", SpoiltPlanner<forgets<shortest_leg>>, NoParams,
                "knows no shortest leg")
ALTIPLAN_PLUGIN(Planner, "forgets_altitude", SpoiltPlanner<forgets<altitude>>, NoParams,
                "knows no band of altitude")
ALTIPLAN_PLUGIN(Planner, "forgets_route_length", SpoiltPlanner<forgets<route_length>>, NoParams,
                "knows no longest route")
ALTIPLAN_PLUGIN(Planner, "forgets_ground", SpoiltPlanner<forgets<ground>>, NoParams,
                "knows no height above ground")
ALTIPLAN_PLUGIN(Planner, "forgets_level", SpoiltPlanner<forgets<level>>, NoParams,
                "leaves its level in level flight")
ALTIPLAN_PLUGIN(Planner, "forgets_heading", SpoiltPlanner<forgets<heading>>, NoParams,
                "does not look where the vehicle comes from")
ALTIPLAN_PLUGIN(Planner, "forgets_rules", SpoiltPlanner<forgets<rules>>, NoParams,
                "asks no constraint")
