// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <utility>

namespace altiplan::python {
namespace py = pybind11;

/// The same function with the class before its arguments.
template <class Result, class... Arguments>
auto with_class(Result (*make)(Arguments...)) {
  return [make](const py::object&, Arguments... arguments) {
    return make(std::forward<Arguments>(arguments)...);
  };
}

/// Lets `make` be the class's constructor. It makes the whole object in `__new__`: pybind11's own
/// leaves memory uninitialised until `__init__`, which `Class.__new__(Class)` does not call.
template <class Class, class Make, class... Arguments>
void add_constructor(Class& type, Make make, const Arguments&... arguments) {
  type.def(py::init(make), arguments...);  // for its text: an object that exists is left as it is
  type.def_static("__new__", with_class(make), py::arg("cls"), arguments...);
}

// Each adds its part to the module `altiplan._altiplan`. Nothing here takes an out-parameter or
// hands out memory without its owner.
void add_errors();
void add_records(py::module_& module);
void add_route(py::module_& module);
void add_result(py::module_& module);
void add_world(py::module_& module);
}  // namespace altiplan::python
