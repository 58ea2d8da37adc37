// SPDX-License-Identifier: Apache-2.0
#include "python/records.hpp"

#include <cmath>
#include <utility>

#include "host/result/legs_json.hpp"
#include "python/arrays.hpp"

namespace altiplan::python {
namespace {

std::string dumped(const Json& json) { return host::json_text(json); }

void add_metrics(py::module_& module) {
  auto metrics = record_class<Metrics>(
      module, "Metrics", "Measures of a route or a track; None where one does not apply.",
      {{"length_m", "Optional[float]", "sum of leg lengths (m)"},
       {"waypoints", "Optional[int]", "number of points"},
       {"max_turn_deg", "Optional[float]", "largest turn at a waypoint, seen from above (degrees)"},
       {"max_climb_deg", "Optional[float]", "steepest leg, up or down (degrees)"},
       {"min_radius_m", "Optional[float]", "smallest turn radius (m)"},
       {"min_clearance_m", "Optional[float]",
        "minimum distance to an obstacle, in any direction (m)"},
       {"min_ground_clearance_m", "Optional[float]", "minimum height above the ground (m)"},
       {"smoothness_rad", "Optional[float]", "sum of turns and changes of climb (radians)"},
       {"duration_s", "Optional[float]", "flying time by the vehicle's speed model (s)"},
       {"time_s", "Optional[float]", "flying time with accelerations and stops (s)"},
       {"energy_wh", "Optional[float]", "energy of that flight (Wh)"},
       {"plan_time_s", "Optional[float]",
        "search time of all plan attempts (s); of a whole run only"},
       {"smooth_time_s", "Optional[float]", "time of all smoothing (s); of a whole run only"},
       {"expanded", "Optional[int]", "sum over all plan attempts; of a whole run only"}});
  add_text(metrics, "Metrics");
}

py::object place_of(const Violation& violation) {
  const std::size_t at = violation.json.at("at");
  if (violation.route == nullptr || at >= violation.route->size()) {
    return py::none();
  }
  return py::array_t<double>(py::ssize_t(3), violation.route->at(at).data());
}

void add_check(py::module_& module) {
  auto violation = record_class<Violation>(
      module, "Violation", "What a route violates at one place.",
      {{"constraint", "str", "name of the constraint"},
       {"at", "int", "index of the waypoint, or of the leg's first waypoint"},
       {"value", "Optional[float]", "in `unit`"},
       {"limit", "Optional[float]", "in `unit`"},
       {"unit", "str", "'m', 'deg', 'm/s'; '' where value and limit are no figures"},
       {"layer", "str", "id of the layer that it concerns, '' if of none"},
       {"message", "str", "a sentence with the place"}});
  violation.def_property_readonly(
      "place", &place_of,
      "Optional[NDArray[float64]]: (3,), the waypoint `at` (m); None of a track's.");
  add_text(violation, "Violation");
  auto check =
      record_class<Check>(module, "Check", "The judge's verdict on a route; true if it is ok.",
                          {{"ok", "bool", "True if nothing is violated"}});
  check.def_property_readonly(
      "violations",
      [](const Check& c) {
        py::list list;
        for (const Json& one : c.json.at("violations")) {
          list.append(Violation{{one}, c.route});
        }
        return list;
      },
      "list[Violation]: one for each place.");
  add_text(check, "Check");
  check.def("__bool__", [](const Check& c) { return c.json.at("ok").get<bool>(); });
}

void add_leg(py::module_& module) {
  auto leg = record_class<LegRecord>(
      module, "Leg", "What joins two waypoints; the turn's attributes are None of a straight leg.",
      {{"kind", "str", "'straight', 'arc' or 'trochoid'"},
       {"end", "list[float]", "[x, y, z] in metres of the scenario's frame"},
       {"turn_deg", "Optional[float]", "degrees through the air, positive to the left"},
       {"radius_m", "Optional[float]", "metres through the air"},
       {"heading_deg", "Optional[float]",
        "at the beginning, through the air, degrees clockwise from north"},
       {"drift_m", "Optional[list[float]]", "[east, north] of the air during the leg (m)"},
       {"hold_s", "Optional[float]", "time that the vehicle waits, None of a leg without a wait"}});
  add_text(leg, "Leg");
}

void add_flight(py::module_& module) {
  auto flight = record_class<Flight>(
      module, "Flight", "The flight of a run, simulated or with a vehicle.",
      {{"status", "str", "'solved' if it arrived"},
       {"reason", "Optional[str]", "its machine-readable cause, or None"},
       {"message", "str", "a sentence"},
       {"link", "Optional[str]", "address of the vehicle, None if simulated"},
       {"counters", "dict[str, int]", "the pilot's counters"},
       {"collisions", "int", "number of contacts with obstacles"},
       {"min_separation_m", "Optional[float]",
        "minimum distance from any surface (m), negative inside"},
       {"reached", "bool", "True if it reached the goal"},
       {"cross_track_max_m", "Optional[float]", "largest horizontal distance from the route (m)"},
       {"cross_track_p999_m", "Optional[float]", "the distance exceeded for 0.1 % of the time (m)"},
       {"height_error_max_m", "Optional[float]", "largest height difference from the route (m)"},
       {"handovers", "list[dict[str, Any]]", "at_s, to, why"},
       {"replans", "list[dict[str, Any]]",
        "at_s, step, status, reason, message, time_s, counters"}});
  add_text(flight, "Flight");
  flight.def_property_readonly(
      "metrics", [](const Flight& f) { return record_or_none<Metrics>(f.json.at("metrics")); },
      "Metrics: those of the track.");
  flight.def_property_readonly(
      "check", [](const Flight& f) { return check_or_none(f.json.at("check"), nullptr); },
      "Check: that of the track.");
  flight.def_property_readonly(
      "track", [](const Flight& f) { return to_array(f.json.at("track"), 4); },
      "NDArray[float64]: (n, 4), read-only: seconds, then metres of the scenario's frame.");
}
}  // namespace

py::object to_python(const Json& json) {
  return py::module_::import("json").attr("loads")(dumped(json));
}

py::object to_array(const Json& json, std::size_t columns) {
  if (json.is_null()) {
    return py::none();
  }
  Rows rows = fresh_rows(py::ssize_t(json.size()), py::ssize_t(columns));
  double* to = rows.mutable_data();
  for (const Json& row : json) {
    for (std::size_t i = 0; i < columns; ++i) {
      *to++ = row.at(i).is_number() ? row.at(i).get<double>() : std::nan("");
    }
  }
  rows.attr("setflags")(py::arg("write") = false);
  return rows;
}

std::string record_text(const std::string& name, const Json& json) {
  constexpr std::size_t kLong = 80;
  std::string text;
  for (const auto& [key, value] : json.items()) {
    const std::string one = py::repr(to_python(value)).cast<std::string>();
    text += (text.empty() ? "" : ", ") + key + "=" + (one.size() > kLong ? "…" : one);
  }
  return name + "(" + text + ")";
}

py::object check_or_none(const Json& json, std::shared_ptr<const Route> route) {
  return json.is_null() ? py::none() : py::cast(Check{{json}, std::move(route)});
}

py::list legs_of(const Route& route) { return list_of<LegRecord>(host::legs_json(route)); }

void add_records(py::module_& module) {
  add_metrics(module);
  add_check(module);
  add_leg(module);
  add_flight(module);
}
}  // namespace altiplan::python
