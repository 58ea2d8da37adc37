// SPDX-License-Identifier: Apache-2.0
#include "host/config/scenario_file.hpp"

#include <cmath>

namespace altiplan::host {

void LayerEntry::describe(Fields& f) {
  f("id", id).doc("name of the layer in results and events; default: the plugin's name");
  f("known", known).doc("false: not in the planners' world until it comes into sensing range");
  f.plugin("environment", plugin, parameters).doc("a layer of the world").required();
}

void ConstraintEntry::describe(Fields& f) {
  f.plugin("constraint", plugin, parameters).doc("a rule for routes and tracks").required();
}

void PointEntry::describe(Fields& f) { f.point(point).required(); }

void GoalEntry::describe(Fields& f) {
  f.point(point).required();
  f("tolerance_m", tolerance_m)
      .unit("m")
      .at_least(0)
      .doc("the last point may lie this far from the goal");
}

void VolumeEntry::describe(Fields& f) {
  f("min_m", min_m).unit("m").doc("lower corner; default: that of the bounded layers");
  f("max_m", max_m).unit("m").doc("upper corner; default: that of the bounded layers");
  f.check(!min_m || !max_m || (min_m->array() <= max_m->array()).all(),
          "expected min_m below max_m on each axis");
}

void SpeedNearEntry::describe(Fields& f) {
  f("within_m", within_m)
      .unit("m")
      .greater_than(0)
      .required()
      .doc("distance to an obstacle's edge");
  f("speed_mps", speed_mps).unit("m/s").greater_than(0).required().doc("speed within it");
}

void VehicleEntry::describe(Fields& f) {
  f("radius_m", radius_m).unit("m").at_least(0).doc("radius of the sphere that must stay free");
  f("speed_mps", speed_mps).unit("m/s").greater_than(0).doc("speed away from obstacles");
  f("sensing_m", sensing_m)
      .unit("m")
      .greater_than(0)
      .doc("what is not known is seen within this distance; default: unlimited");
  f("turns_on_the_spot", turns_on_the_spot)
      .doc("turns to any heading where it climbs or sinks on the spot; else it keeps its heading");
  f("speed_near", speed_near).doc("speed by distance to the nearest obstacle's edge");
  for (std::size_t i = 1; i < speed_near.size(); ++i) {
    f.check(speed_near[i - 1].within_m < speed_near[i].within_m,
            "expected speed_near by ascending within_m");
  }
}

void FrameEntry::describe(Fields& f) {
  f("crs", crs)
      .doc("coordinate system to plan in (EPSG:32617, …); elevation models are warped to it");
  f("origin_lonlat", origin_lonlat)
      .unit("deg")
      .doc("longitude and latitude of the origin, where no layer brings a position");
  f.check(crs.empty() || !origin_lonlat, "expected crs or origin_lonlat, not both");
  f.check(!origin_lonlat ||
              (std::abs((*origin_lonlat)[0]) <= 180 && std::abs((*origin_lonlat)[1]) <= 90),
          "expected origin_lonlat as longitude in [-180, 180], then latitude in [-90, 90]");
}

void MovingEntry::describe(Fields& f) {
  f("id", id).doc("name in results and events");
  f("known", known).doc("false: met in flight");
  f.plugin("moving", shape, parameters).doc("a solid in straight motion").required();
}

void NearEntry::describe(Fields& f) {
  f.point(point).required();
  f("within_m", within_m).unit("m").greater_than(0).required().doc("distance to the point");
}

void AddEntry::describe(Fields& f) {
  f.plugin("environment", plugin, parameters).doc("the layer that appears").required();
}

void SetCellsEntry::describe(Fields& f) {
  f("layer", layer).required().doc("a layer with cells of its own");
  f("cells", cells).min_items(1).required().doc("cells as the layer's file counts them");
  f("blocked", blocked).doc("what they become");
}

void MoveEntry::describe(Fields& f) {
  f("layer", layer).required().doc("id of a built-in shape's layer");
  f("by_m", by_m).unit("m").required().doc("offset east, north, up");
}

void EventEntry::describe(Fields& f) {
  f("at_s", at_s).unit("s").at_least(0).doc("time since take-off");
  f("when_near", when_near).doc("or when the vehicle comes near a point");
  f("add", add).doc("a layer that appears");
  f("id", id).doc("name of the added layer; default: its plugin's name");
  f("known", known).doc("of the added layer: true when its appearance is told at once");
  f("remove", remove).doc("id of a layer that goes");
  f("move", move).doc("a layer that moves at once");
  f("set_cells", set_cells).doc("cells that become blocked or free");
  f("move_goal", move_goal).doc("where the goal is from now on");
  f.check(at_s.has_value() != when_near.has_value(), "expected either at_s or when_near");
  const int actions = int(add.has_value()) + int(remove.has_value()) + int(move.has_value()) +
                      int(set_cells.has_value()) + int(move_goal.has_value());
  f.check(actions == 1, "expected one of add, remove, move, set_cells, move_goal");
  f.check(add || id.empty(), "id names an added layer: it stands beside add alone");
}

void ScenarioFile::describe(Fields& f) {
  f("altiplan", altiplan).range(kFileFormat, kFileFormat).required().doc("file format");
  f("name", name).doc("title in results");
  f("plugins", plugins).doc("further folders of plugin libraries");
  f("frame", frame).doc("how the world is tied to the Earth");
  f("environment", environment).doc("layers of the world, in order");
  f("volume", volume).doc("where routes may go; default: the bounded layers' box");
  f("vehicle", vehicle).doc("the vehicle");
  f("level_flight_at_m", level_flight_at_m).unit("m").doc("a problem in the plane at this height");
  f("start_time", start_time).doc("UTC, ISO 8601: 2026-05-01T10:00:00Z");
  f("mission", mission)
      .doc(
          "a ground station's file (.plan, .waypoints, .kml, .gpx) whose first place is the start, "
          "whose last is the goal and whose others are via points, where they are not given here");
  f("start", start).required().doc("where the route begins");
  f("via", via).doc("points to pass, in order");
  f("goal", goal).required().doc("where it ends");
  f("moving", moving).doc("moving obstacles");
  f("events", events).doc("changes during the flight");
  f("constraints", constraints).doc("rules that hold for every pipeline");
}
}  // namespace altiplan::host
