// SPDX-License-Identifier: Apache-2.0
#include "host/config/scenario_file.hpp"

#include <algorithm>
#include <cmath>

namespace altiplan::host {

void LayerEntry::describe(Fields& f) {
  f("id", id).doc("name of the layer in results and events; default: the plugin's name");
  f("known", known).doc("false: not in the planners' world until it comes into sensing range");
  f.plugin("environment", plugin, parameters).doc("a layer of the world").required();
}

void ConstraintEntry::describe(Fields& f) {
  f.plugin("constraint", plugin, parameters).doc("a constraint on routes and tracks").required();
}

void ObjectiveEntry::describe(Fields& f) {
  f.plugin("objective", plugin, parameters).doc("what routes minimise").required();
}

void MetricEntry::describe(Fields& f) {
  f("id", id).doc("name of the value in results; default: the objective's");
  f.plugin("objective", plugin, parameters)
      .doc("an objective that routes are measured by")
      .required();
}

void TaskEntry::describe(Fields& f) {
  f.plugin("task", plugin, parameters).doc("an area, a line or places").required();
}

void PointEntry::describe(Fields& f) { f.point(point).required(); }

namespace {
void describe_heading(Fields& f, std::optional<double>& heading_deg, const char* doc) {
  f("heading_deg", heading_deg).unit("deg").range(0, 360).doc(doc);
}
}  // namespace

void LoiterEntry::describe(Fields& f) {
  f("radius_m", radius_m).unit("m").greater_than(0).required().doc("radius of the circle");
  f("sense", left, {{"left", true}, {"right", false}}).doc("direction of the turns");
}

namespace {
void describe_course(Fields& f, double& course_deg, double& height_m, const char* height) {
  f("course_deg", course_deg)
      .unit("deg")
      .range(0, 360)
      .required()
      .doc("over the ground, clockwise from north");
  f("height_m", height_m).unit("m").range(0, 3000).required().doc(height);
}
void describe_slope(Fields& f, const char* name, double& angle_deg, const char* doc) {
  f(name, angle_deg).unit("deg").range(0.5, 45).doc(doc);
}
}  // namespace

void TakeOffEntry::describe(Fields& f) {
  describe_course(f, course_deg, height_m, "above the start, where the climb ends");
  describe_slope(f, "climb_deg", climb_deg, "angle of the climb, over the ground");
  f("level_m", level_m).unit("m").range(0, 1e5).doc("of a VTOL: level flight on the course");
  f.check((height_m > 0) != (level_m > 0), "expected height_m above 0, or level_m");
}

void LandingEntry::describe(Fields& f) {
  describe_course(f, course_deg, height_m, "above the goal, where the glide begins");
  describe_slope(f, "glide_deg", glide_deg, "angle of the glide, over the ground");
  f("level_m", level_m).unit("m").range(1, 1e5).doc("level flight on the course before the glide");
}

void StartEntry::describe(Fields& f) {
  f.point(point).required();
  describe_heading(f, heading_deg, "heading at the start, clockwise from north; default: any");
  f("loiter", loiter).doc("circle around the point, which the route leaves tangentially");
  f.check(!loiter || !heading_deg, "a route leaves a loiter circle anywhere: remove heading_deg");
  f("takeoff", takeoff)
      .doc("take-off of an aeroplane from the point, which is on the ground; of a VTOL in hover");
  f.check(!takeoff || (!loiter && !heading_deg),
          "a take-off has a course: remove loiter and heading_deg");
}

void GoalEntry::describe(Fields& f) {
  f.point(point).required();
  describe_heading(f, heading_deg, "heading on arrival, clockwise from north; default: any");
  f("tolerance_m", tolerance_m)
      .unit("m")
      .at_least(0)
      .doc("maximum distance of the last point from the goal");
  f("loiter", loiter).doc("circle around the point, which the route joins tangentially");
  f.check(!loiter || (!heading_deg && tolerance_m == 0),
          "a route joins a loiter circle anywhere: remove heading_deg and tolerance_m");
  f("landing", landing)
      .doc("landing of an aeroplane at the point, which is on the ground; of a VTOL in hover");
  f.check(!landing || (!loiter && !heading_deg),
          "a landing has a course: remove loiter and heading_deg");
}

void VolumeEntry::describe(Fields& f) {
  f("min_m", min_m).unit("m").doc("lower corner; default: that of the bounded layers' box");
  f("max_m", max_m).unit("m").doc("upper corner; default: that of the bounded layers' box");
  f.check(!min_m || !max_m || (min_m->array() <= max_m->array()).all(),
          "expected min_m below max_m on each axis");
  f("floor_m", floor_m).unit("m").doc("lower limit alone, where the layers bound the sides");
  f("ceiling_m", ceiling_m).unit("m").doc("upper limit alone");
  f("corridor_m", corridor_m)
      .unit("m")
      .greater_than(0)
      .doc("sides: so far from the rectangle around start, via points and goal");
  f.check(!min_m || !(floor_m || corridor_m), "expected min_m, or floor_m and corridor_m");
  f.check(!max_m || !(ceiling_m || corridor_m), "expected max_m, or ceiling_m and corridor_m");
  f.check(!floor_m || !ceiling_m || *floor_m <= *ceiling_m, "expected floor_m below ceiling_m");
}

void SpeedNearEntry::describe(Fields& f) {
  f("within_m", within_m)
      .unit("m")
      .greater_than(0)
      .required()
      .doc("distance to an obstacle's edge");
  f("speed_mps", speed_mps)
      .unit("m/s")
      .greater_than(0)
      .required()
      .doc("speed within this distance");
}

void WingEntry::describe(Fields& f) {
  f("airspeed_mps", airspeed_mps)
      .unit("m/s")
      .range(0.1, 1000)
      .required()
      .doc("airspeed, horizontal component");
  f("bank_deg", bank_deg)
      .unit("deg")
      .range(1, 85)
      .doc("maximum bank angle: the turn radius is airspeed² / (g tan bank)");
  f("climb_deg", climb_deg).unit("deg").range(0, 89).doc("maximum climb angle through the air");
  f("sink_deg", sink_deg).unit("deg").range(0, 89).doc("maximum descent angle through the air");
  f("roll_rate_dps", roll_rate_dps)
      .unit("deg/s")
      .range(1, 1000)
      .doc("maximum rate of the bank angle in flight");
}

void WindKindEntry::describe(Fields& f) {
  f("from_deg", from_deg)
      .unit("deg")
      .range(0, 360)
      .doc("direction from which the wind blows, clockwise from north");
  f("speed_mps", speed_mps).unit("m/s").range(0, 100).doc("wind speed");
  f("grid", grid)
      .doc(
          "alternatively: wind by cells, of a GRIB file or GeoTIFF: metres a second toward east "
          "and north");
  f("bands", bands)
      .at_least(1)
      .doc(
          "numbers of the file's bands toward east and north; default: those that GRIB names so, "
          "or the only two");
  f.check(bands.empty() || (bands.size() == 2 && !grid.text.empty()),
          "expected bands with grid, as two numbers");
  f.check(from_deg.has_value() == speed_mps.has_value(), "expected from_deg with speed_mps");
}

void WindLayerEntry::describe(Fields& f) {
  f("above_m", above_m)
      .unit("m")
      .required()
      .doc("lower border of the layer, above sea level; it reaches up to the next one's");
  WindKindEntry::describe(f);
  f.check(from_deg.has_value() != !grid.text.empty(), "expected from_deg and speed_mps, or grid");
}

void WindLayersEntry::describe(Fields& f) {
  WindKindEntry::describe(f);
  f("layers", layers).min_items(1).doc("alternatively: wind by layers of height, from the lowest");
  f.check(int(from_deg.has_value()) + int(!layers.empty()) + int(!grid.text.empty()) <= 1,
          "expected from_deg and speed_mps, or layers, or grid");
  for (std::size_t i = 1; i < layers.size(); ++i) {
    f.check(layers[i - 1].above_m < layers[i].above_m,
            "expected layers in ascending order of above_m");
  }
}

void WindHourEntry::describe(Fields& f) {
  f("from_time", from_time)
      .required()
      .doc("UTC, ISO 8601: from when on this wind blows, until the next one's");
  WindLayersEntry::describe(f);
  f.check(is_given(), "expected from_deg and speed_mps, or layers, or grid");
}

void WindEntry::describe(Fields& f) {
  WindLayersEntry::describe(f);
  f("hours", hours)
      .min_items(1)
      .doc("alternatively: winds one after another, the first from start_time or before");
  f.check(hours.empty() || !is_given(), "expected hours alone, or one wind");
}

void CylinderEntry::describe(Fields& f) {
  f("radius_m", radius_m).unit("m").range(1e-3, 1000).required().doc("radius");
  f("height_m", height_m).unit("m").range(1e-3, 1000).required().doc("height; it stands upright");
}

void CapsuleEntry::describe(Fields& f) {
  f("radius_m", radius_m).unit("m").range(1e-3, 1000).required().doc("radius");
  f("length_m", length_m)
      .unit("m")
      .range(2e-3, 1000)
      .required()
      .doc("length with both caps; it lies along the nose");
  f.check(length_m >= 2 * radius_m, "expected length_m of at least twice radius_m");
}

int BodyPartEntry::kinds() const {
  return int(box_m.has_value()) + int(cylinder.has_value()) + int(capsule.has_value()) +
         int(mesh.has_value());
}

namespace {
void describe_part(Fields& f, BodyPartEntry& part) {
  f("box_m", part.box_m)
      .unit("m")
      .range(1e-3, 1000)
      .doc("a box: length (along the nose), width, height");
  f("cylinder", part.cylinder).doc("alternatively: an upright cylinder");
  f("capsule", part.capsule).doc("alternatively: a cylinder along the nose with round caps");
  f("mesh", part.mesh)
      .doc(
          "alternatively: a closed mesh (.stl, .obj; x forward, y left, z up), of which the convex "
          "hull counts");
  f("scale", part.scale).range(1e-6, 1e6).doc("metres per unit of the mesh's file");
  f("offset_m", part.offset_m)
      .unit("m")
      .range(-1000, 1000)
      .doc(
          "centre of the part (of a mesh: its origin) from the reference point: forward, left, up");
  f.check(part.mesh || part.scale == 1, "scale is for a mesh");
}
}  // namespace

void BodyPartEntry::describe(Fields& f) {
  describe_part(f, *this);
  f.check(kinds() == 1, "expected one of box_m, cylinder, capsule, mesh");
}

void BodyEntry::describe(Fields& f) {
  describe_part(f, part);
  f("parts", parts).doc("alternatively: several parts");
  f("yaw", yaw, {{"along_route", Yaw::along_route}, {"fixed", Yaw::fixed}})
      .doc("where the nose points; of an aeroplane in wind along_route is into its airflow");
  f("fixed_deg", fixed_deg)
      .unit("deg")
      .range(0, 360)
      .doc("with yaw fixed: heading of the nose, clockwise from north");
  f("pitch", pitch, {{"level", Pitch::level}, {"along_route", Pitch::along_route}})
      .doc("level, or by the climb angle of each leg");
  f.check(part.kinds() + int(!parts.empty()) == 1,
          "expected one of box_m, cylinder, capsule, mesh, parts");
  f.check(parts.empty() || part.offset_m == Vec3(0, 0, 0),
          "offset_m moves a part: give it with each of the parts");
  f.check(yaw != Yaw::fixed || fixed_deg, "expected fixed_deg with yaw: fixed");
  f.check(yaw == Yaw::fixed || !fixed_deg, "expected yaw: fixed with fixed_deg");
}

namespace {
void describe_mass(Fields& f, double& mass_kg) {
  f("mass_kg", mass_kg).unit("kg").range(0.01, 1e5).required().doc("take-off mass");
}

void describe_efficiency(Fields& f, double& efficiency, const char* doc) {
  f("efficiency", efficiency).range(0.01, 1).doc(doc);
}

constexpr const char* kOfClimbs = "mechanical power of a climb by what the battery gives for it";

template <class Target>
FieldRef describe_power(Fields& f, const char* key, Target& power_w) {
  return f(key, power_w).unit("W").greater_than(0).at_most(1e7);
}
}  // namespace

void LiuEntry::describe(Fields& f) {
  describe_mass(f, mass_kg);
  f("k1", k1).greater_than(0).doc("of the induced power");
  f("k2", k2).unit("(kg/m)^0.5").greater_than(0).doc("of the induced power");
  f("c1", c1).unit("(m/kg)^0.5").greater_than(0).doc("of level flight, k1 / k2");
  f("c2", c2).unit("(m/kg)^0.5").at_least(0).doc("of the profile power");
  f("c4", c4).unit("kg/m").at_least(0).doc("of the drag");
  f("c5", c5).unit("kg/m").at_least(0).doc("of the lift of the body");
  f("tilt_deg", tilt_deg).unit("deg").range(0, 60).doc("tilt in level flight");
}

void RotorsEntry::describe(Fields& f) {
  describe_mass(f, mass_kg);
  f("disc_m2", disc_m2).unit("m2").greater_than(0).required().doc("area of all rotors");
  f("drag_m2", drag_m2).unit("m2").at_least(0).required().doc("drag coefficient times area");
  f("induced", induced).range(1, 2).doc("induced power by that of an ideal rotor");
  describe_efficiency(f, efficiency, "of motor, controller and propeller together");
  f("profile_w", profile_w).unit("W").at_least(0).doc("power that turns the blades");
}

void HoverEntry::describe(Fields& f) {
  describe_power(f, "power_w", power_w).required().doc("in hover; without cruise_w at every speed");
  describe_power(f, "cruise_w", cruise_w).doc("in level flight at cruise_mps");
  f("cruise_mps", cruise_mps)
      .unit("m/s")
      .greater_than(0)
      .doc("airspeed of cruise_w, to which the power changes linearly; beyond it is not known");
  describe_mass(f, mass_kg);
  describe_efficiency(f, efficiency, kOfClimbs);
  f.check(cruise_w.has_value() == cruise_mps.has_value(), "expected cruise_w with cruise_mps");
}

void AeroplaneEntry::describe(Fields& f) {
  describe_mass(f, mass_kg);
  f("wing_m2", wing_m2).unit("m2").greater_than(0).required().doc("area of the wing");
  f("cd0", cd0).greater_than(0).required().doc("minimum drag coefficient");
  f("k", k).greater_than(0).required().doc("drag coefficient by the square of the lift's");
  f("cl_min_drag", cl_of_min_drag).range(-2, 2).doc("lift coefficient of minimum drag");
  f("cl_max", cl_max).range(0.1, 5).doc("lift coefficient at which it stalls");
  describe_efficiency(f, efficiency, "of propeller, motor and controller together");
}

void LevelPowerEntry::describe(Fields& f) {
  f("airspeed_mps", airspeed_mps).unit("m/s").at_least(0).required().doc("airspeed");
  describe_power(f, "power_w", power_w).required().doc("at that speed");
}

void MeasuredEntry::describe(Fields& f) {
  f("level", level)
      .min_items(1)
      .required()
      .doc("by ascending airspeed; between them it is linear, beyond them not known");
  describe_mass(f, mass_kg);
  describe_efficiency(f, efficiency, kOfClimbs);
  for (std::size_t i = 1; i < level.size(); ++i) {
    f.check(level[i - 1].airspeed_mps < level[i].airspeed_mps,
            "expected level in ascending order of airspeed_mps");
  }
}

void EnergyEntry::describe(Fields& f) {
  f("capacity_wh", capacity_wh)
      .unit("Wh")
      .greater_than(0)
      .doc("of the battery: no route is accepted that takes more of it than may be used");
  f("usable", usable).range(0.01, 1).doc("share of the capacity that can be drawn (age, cold)");
  f("reserve", reserve).range(0, 0.99).doc("share of what can be drawn that a route leaves");
  f("multirotor", multirotor).doc("power by Liu, Sengupta and Kurek 2017");
  f("rotors", rotors).doc("alternatively: a multirotor's power by momentum theory");
  f("hover", hover).doc("alternatively: a multirotor's power as measured in hover");
  f("aeroplane", aeroplane).doc("alternatively: an aeroplane's power by its drag polar");
  f("measured", measured).doc("alternatively: power measured at several airspeeds");
  describe_power(f, "power_w", power_w).doc("alternatively: mean power in all flight");
  f.check(int(multirotor.has_value()) + int(rotors.has_value()) + int(hover.has_value()) +
                  int(aeroplane.has_value()) + int(measured.has_value()) +
                  int(power_w.has_value()) ==
              1,
          "expected one of multirotor, rotors, hover, aeroplane, measured, power_w");
}

bool VehicleEntry::has_wing() const {
  return wing || performance == Performance::arduplane || performance == Performance::px4_fw;
}

VehicleType VehicleEntry::flown_as() const {
  if (type != VehicleType::by_wing) {
    return type;
  }
  return has_wing() ? VehicleType::plane : VehicleType::copter;
}

namespace {
/// How fast it flies, climbs, speeds up.
void describe_performance(Fields& f, VehicleEntry& v) {
  f("performance", v.performance,
    {{"none", Performance::none},
     {"arducopter", Performance::arducopter},
     {"arduplane", Performance::arduplane},
     {"px4_mc", Performance::px4_mc},
     {"px4_fw", Performance::px4_fw}})
      .doc("an autopilot by whose default parameters it flies, but for what is given here");
  f("speed_mps", v.speed_mps)
      .unit("m/s")
      .greater_than(0)
      .doc("speed away from obstacles; default: the performance's, or 15");
  f("climb_mps", v.climb_mps)
      .unit("m/s")
      .range(0.01, 1000)
      .doc("greatest rate of climb; default: the performance's, or unlimited");
  f("sink_mps", v.sink_mps).unit("m/s").range(0.01, 1000).doc("greatest rate of descent; likewise");
  f("acceleration_mps2", v.acceleration_mps2)
      .unit("m/s2")
      .range(0.01, 1000)
      .doc(
          "along the route, from rest to rest; default: the performance's, or speeds change at "
          "once");
  f("jerk_mps3", v.jerk_mps3)
      .unit("m/s3")
      .range(0.01, 1e4)
      .doc("of changes of speed; default: the performance's, or unlimited");
  f("jerk_time_s", v.jerk_time_s)
      .unit("s")
      .range(0, 100)
      .doc("in which that jerk sets in and ends; default: the performance's, or 0");
  f("corner_radius_m", v.corner_radius_m)
      .unit("m")
      .range(0, 1e4)
      .doc(
          "passes waypoints on an arc that begins so far before them; default: the performance's, "
          "or it stops at each");
  f("energy", v.energy).doc("its power and its battery");
  const bool has_wing = v.has_wing();
  f.check(
      !has_wing || (!v.acceleration_mps2 && !v.jerk_mps3 && !v.jerk_time_s && !v.corner_radius_m),
      "an aeroplane keeps its airspeed: remove acceleration_mps2, jerk_mps3, jerk_time_s and "
      "corner_radius_m");
  const bool accelerates = v.acceleration_mps2 || v.performance != Performance::none;
  f.check(accelerates || (!v.jerk_mps3 && !v.jerk_time_s && !v.corner_radius_m),
          "expected acceleration_mps2 with jerk_mps3, jerk_time_s and corner_radius_m");
  f.check(!v.energy || !v.energy->aeroplane || has_wing, "expected wing with energy.aeroplane");
  const bool is_of_rotors =
      v.energy && (v.energy->multirotor || v.energy->rotors || v.energy->hover);
  f.check(!is_of_rotors || !has_wing,
          "expected energy.aeroplane, energy.measured or energy.power_w with a wing");
}
}  // namespace

void VehicleEntry::describe(Fields& f) {
  f("type", type,
    {{"by_wing", VehicleType::by_wing},
     {"copter", VehicleType::copter},
     {"plane", VehicleType::plane},
     {"vtol", VehicleType::vtol}})
      .doc(
          "how it takes off and lands in exported missions; by_wing: plane with a wing, else "
          "copter");
  f("radius_m", radius_m).unit("m").at_least(0).doc("radius of the vehicle's safety sphere");
  describe_performance(f, *this);
  f("sensing_m", sensing_m)
      .unit("m")
      .greater_than(0)
      .doc("range at which unknown obstacles are detected; default: unlimited");
  f("turns_on_the_spot", turns_on_the_spot)
      .doc(
          "true: may turn to any heading while it climbs or descends vertically; false: keeps its "
          "heading");
  f("body", body).doc("a body instead of the sphere: it is checked in its attitude along all legs");
  f.check(!body || radius_m == 0, "expected radius_m or body, not both");
  f("wing", wing).doc("an aeroplane: it turns by banking at a constant airspeed");
  const bool is_wing = has_wing();
  f.check(!is_wing || type != VehicleType::copter, "a copter has no wing: expected plane or vtol");
  f.check(!is_wing || !turns_on_the_spot, "an aeroplane cannot turn on the spot");
  f.check(!is_wing || speed_near.empty(), "an aeroplane has one airspeed: remove speed_near");
  const bool is_copter =
      performance == Performance::arducopter || performance == Performance::px4_mc;
  f.check(!wing || !is_copter, "a copter's performance has no wing: expected arduplane or px4_fw");
  f("speed_near", speed_near).doc("speed by distance to the nearest obstacle's edge");
  for (std::size_t i = 1; i < speed_near.size(); ++i) {
    f.check(speed_near[i - 1].within_m < speed_near[i].within_m,
            "expected speed_near in ascending order of within_m");
  }
}

void FrameEntry::describe(Fields& f) {
  f("crs", crs)
      .doc(
          "coordinate system to plan in, to which elevation models are warped: EPSG:32617, …; "
          "auto: a model's own if lengths are right in it, else local about its middle; local: "
          "conformal, true to scale about origin_lonlat, anywhere on the Earth");
  f("origin_lonlat", origin_lonlat)
      .unit("deg")
      .doc("longitude and latitude of the origin, if no layer is georeferenced");
  f.check(crs.empty() || (crs == "local") == origin_lonlat.has_value(),
          "expected crs or origin_lonlat, or crs: local with origin_lonlat");
  f.check(!origin_lonlat ||
              (std::abs((*origin_lonlat)[0]) <= 180 && std::abs((*origin_lonlat)[1]) <= 90),
          "expected origin_lonlat as longitude in [-180, 180], then latitude in [-90, 90]");
}

void MovingEntry::describe(Fields& f) {
  f("id", id).doc("name in results and events");
  f("known", known)
      .doc(
          "true: routes are planned and judged against it, in time; false: unknown until it comes "
          "into sensing range; omitted: known in flight, and routes are not judged against it");
  f.plugin("moving", shape, parameters).doc("a solid in straight-line motion").required();
}

void NearEntry::describe(Fields& f) {
  f.point(point).required();
  f("within_m", within_m).unit("m").greater_than(0).required().doc("distance to the point");
}

void AddEntry::describe(Fields& f) {
  f.plugin("environment", plugin, parameters).doc("the layer that appears").required();
}

void SetCellsEntry::describe(Fields& f) {
  f("layer", layer).required().doc("id of a layer that has cells");
  f("cells", cells).min_items(1).required().doc("cells as the layer's file counts them");
  f("blocked", blocked).doc("true: the cells become blocked; false: free");
}

void MoveEntry::describe(Fields& f) {
  f("layer", layer).required().doc("id of a built-in shape's layer");
  f("by_m", by_m).unit("m").required().doc("offset east, north, up");
}

void EventEntry::describe(Fields& f) {
  f("at_s", at_s).unit("s").at_least(0).doc("time since take-off");
  f("when_near", when_near).doc("alternatively: when the vehicle comes near a point");
  f("add", add).doc("a layer that appears");
  f("id", id).doc("name of the added layer; default: its plugin's name");
  f("known", known).doc("of the added layer: true if the vehicle knows of it at once");
  f("remove", remove).doc("id of the layer or moving obstacle to remove");
  f("move", move).doc("a layer that moves instantly");
  f("set_cells", set_cells).doc("cells that become blocked or free");
  f("move_goal", move_goal).doc("the new goal");
  f("visit", visit).doc("a target: the local planner flies near it, then back to the route");
  f.check(at_s.has_value() != when_near.has_value(), "expected either at_s or when_near");
  const int actions = int(add.has_value()) + int(remove.has_value()) + int(move.has_value()) +
                      int(set_cells.has_value()) + int(move_goal.has_value()) +
                      int(visit.has_value());
  f.check(actions == 1, "expected one of add, remove, move, set_cells, move_goal, visit");
  f.check(add || id.empty(), "id names an added layer: it is allowed only with add");
}

void ScenarioFile::describe(Fields& f) {
  f("altiplan", altiplan).range(kFileFormat, kFileFormat).required().doc("file format");
  f("name", name).doc("title in results");
  f("plugins", plugins).doc("additional folders of plugin libraries");
  f("frame", frame).doc("georeference of the world");
  f("environment", environment).doc("layers of the world, in order");
  f("volume", volume)
      .doc("volume that routes may use; default: the bounded layers' box; cut to the ground");
  f("vehicle", vehicle).doc("the vehicle");
  f("level_flight_at_m", level_flight_at_m).unit("m").doc("plan in the plane, at this height");
  f("start_time", start_time).doc("UTC, ISO 8601: 2026-05-01T10:00:00Z");
  f("mission", mission)
      .doc(
          "a ground station's file (.plan, .waypoints, .kml, .gpx): its first point is the start, "
          "its last the goal and the others via points, unless they are given here");
  f("wind", wind).doc("horizontal wind");
  f("task", task).doc("passes and stops that the route makes between start and goal");
  FieldRef first = f("start", start).doc("start of the route; with a task optional");
  f("via", via).doc("points to pass, in order");
  FieldRef last = f("goal", goal).doc("end of the route; with a task optional");
  if (!task) {
    first.required();
    last.required();
  }
  f.check(!task || via.empty(), "a task orders what is passed: expected task or via, not both");
  const bool has_runway = start.takeoff || goal.landing;
  f.check(!has_runway || (vehicle.has_wing() && !task && !level_flight_at_m),
          "takeoff and landing are an aeroplane's (vehicle.wing), without task and "
          "level_flight_at_m");
  const bool is_vtol = vehicle.type == VehicleType::vtol;
  f.check((!start.takeoff || is_vtol == (start.takeoff->height_m == 0)) &&
              (!goal.landing || is_vtol == (goal.landing->height_m == 0)),
          "of a VTOL, takeoff and landing have height_m: 0, of other aeroplanes more");
  f.check(std::none_of(via.begin(), via.end(),
                       [](const GoalEntry& point) { return point.landing.has_value(); }),
          "a landing ends the route: only the goal has one");
  f("moving", moving).doc("moving obstacles");
  const bool avoids = std::any_of(moving.begin(), moving.end(), [](const MovingEntry& obstacle) {
    return obstacle.known.value_or(false);
  });
  f.check(!avoids || !(vehicle.acceleration_mps2 || vehicle.performance != Performance::none) ||
              vehicle.has_wing(),
          "among moving obstacles with known: true routes are judged at speeds that change at "
          "once: remove vehicle.acceleration_mps2, or a copter's vehicle.performance");
  f.check(
      !avoids || vehicle.has_wing() || !wind.blows(),
      "among moving obstacles with known: true a copter's times count, and its flight keeps its "
      "speed over the ground, which routes in wind do not: remove wind");
  f("events", events).doc("changes during the flight");
  f("constraints", constraints).doc("constraints that apply to every pipeline");
  f("objective", objective)
      .doc("what routes minimise, unless the pipeline says so; default: length");
  f("metrics", metrics).doc("objectives that routes are measured by");
  f("reference", reference)
      .at_least(0)
      .doc(
          "published cost of the best route, by the objective: results have it, and studies the "
          "gap");
}
}  // namespace altiplan::host
