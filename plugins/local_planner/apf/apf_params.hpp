// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/params.hpp"

namespace apf {
using namespace altiplan;

enum class Variant { plain, modified, improved };
enum class Side { field, predicted };

struct Params {
  Variant variant = Variant::improved;
  double influence_m = 3000;
  AutoNumber ground_influence_m;
  AutoNumber target_m;
  double attraction = 43;
  double repulsion = 5;
  AutoNumber length_unit_m;
  double goal_exponent = 2;
  bool turned_repulsion = true;
  double small_angle_deg = 10;
  bool stronger_goal = true;
  double goal_factor = 3;
  AutoNumber goal_zone_m;
  bool two_steps = true;
  AutoNumber step_far_m;
  AutoNumber step_near_m;
  double reaction_s = 10;
  bool turn_limit = true;
  double max_turn_deg = 30;
  Side side = Side::predicted;

  void describe(Fields& f) {
    f("variant", variant,
      {{"plain", Variant::plain}, {"modified", Variant::modified}, {"improved", Variant::improved}})
        .doc(
            "the bare field (plain), the repulsion that fades toward the goal (modified), or "
            "the four repairs (improved)");
    f("influence_m", influence_m)
        .unit("m")
        .range(0.001, 1e9)
        .doc("d_0: obstacles farther away have no effect; the host hands over within it");
    f("ground_influence_m", ground_influence_m)
        .unit("m")
        .range(0.001, 1e9)
        .doc("d_0 for ground, above the ground clearance; auto: a tenth of influence_m");
    f("target_m", target_m)
        .unit("m")
        .range(0.001, 1e9)
        .doc("a target farther away is moved in to this distance; auto: 2/3 of influence_m");
    f("attraction", attraction).range(0, 1e9).doc("k_a, for distances in length_unit_m");
    f("repulsion", repulsion).range(0, 1e9).doc("k_r, for distances in length_unit_m");
    f("length_unit_m", length_unit_m)
        .unit("m")
        .range(0.001, 1e9)
        .doc("unit of length of the gains; auto: a third of influence_m (1 km for 3 km)");
    f("goal_exponent", goal_exponent)
        .range(1, 8)
        .doc("m of the modified repulsion, scaled by (distance to goal / start to goal)^m");
    f("turned_repulsion", turned_repulsion)
        .doc("repair 1: rotate the repulsion of obstacles in front of the target by 45 degrees");
    f("small_angle_deg", small_angle_deg)
        .unit("deg")
        .range(0, 90)
        .doc("rotate if the bearings of obstacle and target differ by less than this");
    f("stronger_goal", stronger_goal).doc("repair 2: stronger attraction near the goal");
    f("goal_factor", goal_factor).range(1, 1e6).doc("factor of the attraction near the goal");
    f("goal_zone_m", goal_zone_m)
        .unit("m")
        .range(0.001, 1e9)
        .doc("distance that counts as near the goal; auto: influence_m");
    f("two_steps", two_steps)
        .doc("repair 3: use step_far_m while the nearest edge is more than reaction_s away");
    f("step_far_m", step_far_m)
        .unit("m")
        .range(0.001, 1e9)
        .doc(
            "L1; auto: influence_m / 6; never more than the distance flown in the host's time "
            "step");
    f("step_near_m", step_near_m).unit("m").range(0.001, 1e9).doc("L2; auto: influence_m / 30");
    f("reaction_s", reaction_s)
        .unit("s")
        .at_least(0)
        .doc("reaction time; lookahead for paths and moving obstacles");
    f("turn_limit", turn_limit).doc("repair 4: no turn above max_turn_deg, except for safety");
    f("max_turn_deg", max_turn_deg).unit("deg").range(1, 180).doc("alpha_2, per step, in 3-D");
    f("side", side, {{"field", Side::field}, {"predicted", Side::predicted}})
        .doc(
            "side on which to pass obstacles in front of the target: by the field's push alone, "
            "or the one predicted to reach the target sooner, kept until passed");
  }
};
}  // namespace apf
