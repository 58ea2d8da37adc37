// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/numpy.h>

#include <string>

#include "altiplan/geometry.hpp"
#include "python/bindings.hpp"

namespace altiplan::python {

using Rows = py::array_t<double, py::array::c_style>;

/// An array to be filled.
Rows fresh_rows(py::ssize_t count, py::ssize_t columns);

/// The array-like as float64 numbers of shape (n, columns), converted where needed. TypeError for
/// anything but numbers, ValueError naming the expected shape for any other shape.
Rows rows_of(const py::object& given, py::ssize_t columns, const std::string& name);

/// Row i of an array of points. Throws ValueError for one farther away than anything flies: queries
/// of the world would take forever. Numbers that are not finite are passed on.
Vec3 point_at(const Rows& rows, py::ssize_t i, const std::string& name);

/// A read-only view of `count` rows of memory that belongs to `owner`, which the view keeps alive.
py::array view_of(const double* first, py::ssize_t count, py::ssize_t columns,
                  const py::handle& owner);

/// Calls `each(i)` for each row without the interpreter's lock; Ctrl-C ends it.
template <class Each>
void for_each_row(py::ssize_t count, const Each& each) {
  constexpr py::ssize_t kRowsPerLook = 4096;
  const py::gil_scoped_release released;
  for (py::ssize_t i = 0; i < count; ++i) {
    each(i);
    if (i % kRowsPerLook == kRowsPerLook - 1) {
      const py::gil_scoped_acquire held;
      if (PyErr_CheckSignals() != 0) {
        throw py::error_already_set();
      }
    }
  }
}
}  // namespace altiplan::python
