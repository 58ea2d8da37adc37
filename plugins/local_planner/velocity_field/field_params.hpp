// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

#include "altiplan/params.hpp"
#include "field.hpp"

namespace velocity_field {
using namespace altiplan;

enum class Variant { paper, robust };
enum class Toward { goal, route };
enum class Terrain { ignore, sections };

struct Params {
  Variant variant = Variant::paper;
  double pull_weight = 1;
  double edge_ratio = 0.05;
  double surface_ratio = 10;
  double ring_m = 2000;
  double guide_ratio = 1;
  double step_s = 1;
  AutoNumber min_turn_radius_m{500};
  std::optional<double> min_speed_mps;
  std::optional<double> max_bank_deg;
  double release_m = 100;
  Toward toward = Toward::goal;
  Terrain terrain = Terrain::ignore;
  double max_climb_deg = 15;
  double detour_m = 5000;
  AutoNumber section_cell_m;
  std::int64_t max_steps = 40000;

  void describe(Fields& f) {
    f("variant", variant, {{"paper", Variant::paper}, {"robust", Variant::robust}})
        .doc("paper: the method as published; robust: along a guide, never without an escape path");
    f("pull_weight", pull_weight).range(0, 1e9).doc("omega: speed toward the target");
    f("edge_ratio", edge_ratio)
        .greater_than(0)
        .at_most(1e9)
        .doc("alpha: push at the outer edge of a threat's ring, as a multiple of the pull");
    f("surface_ratio", surface_ratio)
        .greater_than(0)
        .at_most(1e9)
        .doc("beta: push at a threat's edge, as a multiple of the pull");
    f("ring_m", ring_m)
        .unit("m")
        .range(0.001, 1e9)
        .doc("Delta R: width of the ring around a threat in which it acts");
    f("guide_ratio", guide_ratio)
        .range(0, 1e9)
        .doc("epsilon: speed alongside a threat, toward the target, as a multiple of its push");
    f("step_s", step_s)
        .unit("s")
        .range(1e-3, 1e6)
        .doc("Delta T: duration of a step; never more than the host's");
    f("min_turn_radius_m", min_turn_radius_m)
        .unit("m")
        .range(1e-3, 1e9)
        .doc(
            "R_min: the heading changes by at most 2 asin(v Delta T / (2 R_min)) per step; auto: "
            "min_speed_mps^2 / (g tan(max_bank_deg))");
    f("min_speed_mps", min_speed_mps)
        .unit("m/s")
        .range(1e-3, 1e6)
        .doc("V_min, minimum level speed");
    f("max_bank_deg", max_bank_deg).unit("deg").range(0.1, 89).doc("gamma_max, maximum bank angle");
    describe_flight(f);
    f.check(edge_ratio < surface_ratio, "edge_ratio must be less than surface_ratio");
    f.check(variant == Variant::paper || toward == Toward::goal,
            "toward: route requires variant: paper; robust finds its own path to the goal");
    f.check(variant == Variant::paper || terrain == Terrain::ignore,
            "terrain: sections requires variant: paper; robust flies level and ignores ground");
    const bool by_bank = min_speed_mps && max_bank_deg;
    f.check(by_bank != min_turn_radius_m.value.has_value() &&
                min_speed_mps.has_value() == max_bank_deg.has_value(),
            "give min_turn_radius_m, or min_turn_radius_m: auto with min_speed_mps and "
            "max_bank_deg");
  }

  /// Attraction, visibility of the ground, and the end of a flight.
  void describe_flight(Fields& f) {
    f("release_m", release_m)
        .unit("m")
        .range(1e-3, 1e9)
        .doc("distance at which a virtual target counts as reached");
    f("toward", toward, {{"goal", Toward::goal}, {"route", Toward::route}})
        .doc(
            "source of the attraction: the goal, as published, or the point at which the flight "
            "rejoins the route");
    f("terrain", terrain, {{"ignore", Terrain::ignore}, {"sections", Terrain::sections}})
        .doc(
            "ignore: ground is ignored, as published; sections: fly around ground higher than "
            "the flight, or over it if there is no path around");
    f("max_climb_deg", max_climb_deg)
        .unit("deg")
        .range(0.1, 80)
        .doc("terrain: maximum climb and descent angle");
    f("detour_m", detour_m)
        .unit("m")
        .range(1, 1e9)
        .doc(
            "terrain: climb after flying around ground for this distance without getting closer "
            "by a tenth of it");
    f("section_cell_m", section_cell_m)
        .unit("m")
        .range(0.1, 1e6)
        .doc(
            "terrain: edge of the cells that sample the ground; auto: the volume's longer side "
            "/ 512");
    f("max_steps", max_steps)
        .range(1, 1'000'000)
        .doc("number of steps after which the pilot gives up");
  }

  Field field() const { return {pull_weight, edge_ratio, surface_ratio, ring_m, guide_ratio}; }
  /// R_min, by eq. (10) if it is not given.
  double min_radius() const {
    constexpr double kGravity = 9.80665;
    return min_turn_radius_m.value
               ? *min_turn_radius_m.value
               : *min_speed_mps * *min_speed_mps / (kGravity * std::tan(radians(*max_bank_deg)));
  }
};
}  // namespace velocity_field
