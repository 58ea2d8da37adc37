// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "altiplan/formats/polygon.hpp"
#include "altiplan/params.hpp"
#include "area.hpp"

namespace altiplan::cover {

struct AreaParams {
  std::string name;
  formats::Ring outline_m;
  std::vector<formats::Ring> holes_m;

  void describe(Fields& f) {
    f("name", name).doc("for messages; default: area and its number, from 0 on");
    f("outline_m", outline_m).unit("m").min_items(3).required().doc("corners, as the first area's");
    f("holes_m", holes_m).unit("m").doc("islands");
  }
};

struct Params {
  std::string name;
  formats::Ring outline_m{{0, 0}, {100, 0}, {100, 100}, {0, 100}};
  std::vector<formats::Ring> holes_m;
  std::vector<AreaParams> more_areas;
  double spacing_m = 3;
  bool closed = true;
  std::optional<double> capacity_s;
  double height_m = 0;
  std::optional<double> above_ground_m;
  double tolerance_m = 2;
  double clearance_m = 0;
  double beyond_m = 0;
  int attempts = 3;

  void describe(Fields& f) {
    f("outline_m", outline_m).unit("m").min_items(3).doc("corners [x, y], in either sense");
    f("holes_m", holes_m).unit("m").doc("islands, which are neither covered nor crossed");
    f("more_areas", more_areas).doc("areas beside that one, which are covered, too");
    f("name", name).doc("of the first area, for messages");
    f("spacing_m", spacing_m)
        .unit("m")
        .greater_than(0)
        .doc("distance of lines: each covers half of it to both sides, and around its ends");
    f("closed", closed).doc("true: without a goal the tour ends where it began");
    f("capacity_s", capacity_s)
        .unit("s")
        .greater_than(0)
        .doc("longest flight of a closed tour: several begin and end at one place; default: any");
    f.check(closed || !capacity_s, "capacity_s is for a closed tour");
    f("height_m", height_m)
        .unit("m")
        .doc("height of the passes above sea level; with level_flight_at_m that");
    f("above_ground_m", above_ground_m)
        .unit("m")
        .greater_than(0)
        .doc("height of the passes and joins above the ground instead");
    f("tolerance_m", tolerance_m)
        .unit("m")
        .greater_than(0)
        .doc("with above_ground_m: how far the height may be off it");
    f("clearance_m", clearance_m)
        .unit("m")
        .at_least(0)
        .doc("distance of the tour from islands, within which nothing is covered either");
    f("beyond_m", beyond_m)
        .unit("m")
        .at_least(0)
        .doc(
            "of an aeroplane: its rows go on by so much, beyond where their strips leave the "
            "outline; 0: they end at it");
    f("attempts", attempts).range(1, 1000).doc("patterns of lines that are tried");
  }
};

/// An area as the user gives it.
struct Given {
  std::string name;
  std::string key;  ///< of its parameters: "" or "more_areas"
  formats::Polygon polygon;
};

std::vector<Given> given_areas(const Params& params);
/// Throws ParameterError for an area that is none, or cannot be flown as one.
Area area_of(const Given& given, double clearance_m);
/// Throws ParameterError for areas that overlap by more than what rounding does.
void expect_apart(const std::vector<Given>& areas);
}  // namespace altiplan::cover
