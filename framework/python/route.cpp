// SPDX-License-Identifier: Apache-2.0
#include "altiplan/route.hpp"

#include <algorithm>
#include <cmath>

#include "altiplan/constraint.hpp"
#include "altiplan/leg_limits.hpp"
#include "python/arrays.hpp"
#include "python/records.hpp"

namespace altiplan::python {
namespace {

constexpr py::ssize_t kLegNumbers = 13;  ///< from, to, turn, radius, heading, drift, hold

Vec3 finite_point(const Rows& rows, py::ssize_t i, const std::string& name) {
  Vec3 point = point_at(rows, i, name);
  if (!is_finite(point)) {
    throw py::value_error(name + ": point " + std::to_string(i) + " is not finite");
  }
  return point;
}

std::shared_ptr<Route> route_of_points(const Typed<"ArrayLike">& points) {
  const Rows rows = rows_of(points, 3, "points");
  Polyline waypoints;
  for (py::ssize_t i = 0; i < rows.shape(0); ++i) {
    waypoints.push_back(finite_point(rows, i, "points"));
  }
  return std::make_shared<Route>(std::move(waypoints));
}

/// A view of the waypoints themselves: nothing changes a route.
Typed<"NDArray[float64]"> points_of(const py::object& self) {
  static_assert(sizeof(Vec3) == 3 * sizeof(double));
  const auto& route = self.cast<const Route&>();
  const double* first = route.empty() ? nullptr : route.front().data();
  return view_of(first, py::ssize_t(route.size()), 3, self);
}

Typed<"NDArray[float64]"> chords_of(const Route& route, double tolerance_m) {
  if (!(tolerance_m > 0)) {
    throw py::value_error("tolerance_m: expected a number above 0");
  }
  const Polyline chords = route.empty() ? Polyline() : route.chords(tolerance_m);
  Rows rows = fresh_rows(py::ssize_t(chords.size()), 3);
  for (std::size_t i = 0; i < chords.size(); ++i) {
    std::copy_n(chords[i].data(), 3, rows.mutable_data() + 3 * i);
  }
  return rows;
}

/// How pickle makes it again: from the exact legs, since numbers of result.json would be rounded by
/// their conversions.
py::tuple reduced(const py::object& self) {
  const auto& route = self.cast<const Route&>();
  Rows legs = fresh_rows(py::ssize_t(route.is_straight() ? 0 : route.leg_count()), kLegNumbers);
  double* to = legs.mutable_data();
  for (py::ssize_t i = 0; i < legs.shape(0); ++i) {
    const Leg leg = route.leg(std::size_t(i));
    to = std::copy_n(leg.from.data(), 3, to);
    to = std::copy_n(leg.to.data(), 3, to);
    for (const double number : {leg.turn, leg.radius, leg.heading}) {
      *to++ = number;
    }
    to = std::copy_n(leg.drift.data(), 3, to);
    *to++ = leg.hold_s;
  }
  const py::object make = py::module_::import("altiplan._values").attr("route_of_state");
  return py::make_tuple(make, py::make_tuple(points_of(self).attr("copy")(), legs));
}

std::shared_ptr<Route> route_of_state(const Typed<"ArrayLike">& points,
                                      const Typed<"ArrayLike">& exact_legs) {
  const Rows legs = rows_of(exact_legs, kLegNumbers, "legs");
  if (legs.shape(0) == 0) {
    return route_of_points(points);
  }
  auto route = std::make_shared<Route>();
  for (py::ssize_t i = 0; i < legs.shape(0); ++i) {
    const double* number = legs.data() + i * kLegNumbers;
    if (!std::all_of(number, number + kLegNumbers, [](double n) { return std::isfinite(n); })) {
      throw py::value_error("legs: a number is not finite");
    }
    Leg leg = Leg::straight(Vec3(number), Vec3(number + 3));
    leg.turn = number[6];
    leg.radius = number[7];
    leg.heading = number[8];
    leg.drift = Vec3(number + 9);
    leg.hold_s = number[12];
    if (leg.turns() && !(leg.radius > 0)) {
      throw py::value_error("legs: expected a radius above 0");
    }
    if (!is_well_formed(leg)) {
      throw py::value_error("legs: expected a wait above 0 s on a leg of no length, or none");
    }
    route->push_back(leg);
  }
  return route;
}

std::string text_of(const Route& route) {
  return "<altiplan.Route of " + std::to_string(route.size()) +
         (route.size() == 1 ? " waypoint, " : " waypoints, ") +
         std::to_string(std::llround(length(route))) + " m" +
         (route.is_straight() ? ">"
          : route.waits()     ? ", with waits>"
                              : ", with turns>");
}

/// numpy.asarray(route): numpy would else ask for one point at a time.
Typed<"NDArray[Any]"> as_array(const py::object& self, const Typed<"Any">& dtype) {
  const py::object points = points_of(self);
  return dtype.is_none() ? points : points.attr("astype")(dtype);
}
}  // namespace

void add_route(py::module_& module) {
  py::class_<Route, std::shared_ptr<Route>> route(
      module, "Route",
      "Waypoints joined by legs, in metres of the scenario's frame: x east, y north, z above sea\n"
      "level. Route(points) joins points of shape (n, 3) by straight legs; ValueError for another\n"
      "shape or numbers that are not finite, TypeError for what is no number. Nothing changes it.",
      py::is_final());
  add_constructor(route, &route_of_points, py::arg("points"));
  route.def_property_readonly("points", &points_of,
                              "NDArray[float64]: (n, 3), read-only view of the waypoints (m).");
  route.def("to_numpy", &points_of, "The same as `points`.");
  route.def("__array__", &as_array, py::arg("dtype") = py::none());
  route.def(
      "chords", &chords_of, py::arg("tolerance_m") = kChordTolerance,
      "(m, 3) float64: the waypoints, and the ends of chords that lie within this distance of\n"
      "the turns (m). Those within 0.01 m are the `route` of result.json.");
  route.def_property_readonly("legs", &legs_of, "list[Leg]: one fewer than waypoints.");
  route.def_property_readonly(
      "length_m", [](const Route& r) { return length(r); }, "float: sum of leg lengths (m).");
  route.def("__len__", &Route::size);
  route.def(
      "__getitem__", [](const py::object& self, const Typed<"Any">& index) -> Typed<"Any"> {
        return points_of(self).attr("__getitem__")(index);
      });
  route.def(
      "__iter__", [](const py::object& self) -> Typed<"Iterator[NDArray[float64]]"> {
        return py::iter(points_of(self));
      });
  route.def(
      "__eq__", [](const Route& a, const Route& b) { return a == b; }, py::is_operator());
  route.def("__repr__", &text_of);
  route.def("__reduce__", &reduced);
  module.def("route_of_state", &route_of_state, py::arg("points"), py::arg("legs"));
}
}  // namespace altiplan::python
