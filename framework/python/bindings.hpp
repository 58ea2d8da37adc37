// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

namespace altiplan::python {
namespace py = pybind11;

// Each adds its part to the module `altiplan._altiplan`. Nothing here takes an out-parameter or
// hands out memory without its owner.
void add_errors();
void add_records(py::module_& module);
void add_route(py::module_& module);
void add_result(py::module_& module);
void add_world(py::module_& module);
}  // namespace altiplan::python
