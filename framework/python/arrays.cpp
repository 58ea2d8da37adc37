// SPDX-License-Identifier: Apache-2.0
#include "python/arrays.hpp"

namespace altiplan::python {
namespace {

std::string shape_text(const py::array& array) {
  return py::str(py::tuple(array.attr("shape"))).cast<std::string>();
}

std::string expected(const std::string& name, py::ssize_t columns) {
  return name + ": expected numbers of shape (n, " + std::to_string(columns) + ")";
}

/// numpy's own message for ragged lists does not say what is expected.
py::array as_array(const py::object& given, const std::string& wanted) {
  try {
    return py::module_::import("numpy").attr("asarray")(given);
  } catch (py::error_already_set& error) {
    if (!error.matches(PyExc_ValueError)) {
      throw;
    }
  }
  throw py::value_error(wanted + ", found rows of different lengths");
}
}  // namespace

Rows fresh_rows(py::ssize_t count, py::ssize_t columns) {
  return Rows(std::vector<py::ssize_t>{count, columns});
}

Rows rows_of(const py::object& given, py::ssize_t columns, const std::string& name) {
  const std::string wanted = expected(name, columns);
  const py::array array = as_array(given, wanted);
  if (array.ndim() == 1 && array.size() == 0) {  // an empty list has no second axis
    return fresh_rows(0, columns);
  }
  const char kind = array.dtype().kind();
  if (kind != 'f' && kind != 'i' && kind != 'u') {
    throw py::type_error(wanted + ", found " + py::str(array.attr("dtype")).cast<std::string>() +
                         " of shape " + shape_text(array));
  }
  if (array.ndim() != 2 || array.shape(1) != columns) {
    throw py::value_error(wanted + ", found shape " + shape_text(array));
  }
  auto rows = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(array);
  if (!rows) {
    throw py::error_already_set();
  }
  return rows;
}

Vec3 point_at(const Rows& rows, py::ssize_t i, const std::string& name) {
  constexpr double kFarthest = 1e8;  // metres
  const double* row = rows.data() + i * rows.shape(1);
  Vec3 point(row[0], row[1], row[2]);
  if (is_finite(point) && point.cwiseAbs().maxCoeff() > kFarthest) {
    throw py::value_error(name + ": point " + std::to_string(i) +
                          " lies beyond 1e8 m, farther away than anything flies");
  }
  return point;
}

py::array view_of(const double* first, py::ssize_t count, py::ssize_t columns,
                  const py::handle& owner) {
  constexpr py::ssize_t kBytes = sizeof(double);
  py::array view(py::dtype::of<double>(), {count, columns}, {columns * kBytes, kBytes}, first,
                 owner);
  view.attr("setflags")(py::arg("write") = false);
  return view;
}
}  // namespace altiplan::python
