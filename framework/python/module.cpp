// SPDX-License-Identifier: Apache-2.0
#include "altiplan_build.hpp"
#include "python/bindings.hpp"

namespace altiplan::python {
namespace {

PyObject* new_instance(PyTypeObject* type, PyObject* /*arguments*/, PyObject* /*named*/) {
  if (py::detail::all_type_info(type).empty()) {
    PyErr_Format(PyExc_TypeError, "cannot create '%s' instances", type->tp_name);
    return nullptr;
  }
  return py::detail::make_new_instance(type);
}

/// The base of all classes refuses to be made, as by Route.__base__(). That of pybind11 throws
/// through the interpreter, which ends the process.
void guard_base() {
  auto* base = reinterpret_cast<PyTypeObject*>(py::detail::get_internals().instance_base);
  base->tp_new = new_instance;
}
}  // namespace
}  // namespace altiplan::python

PYBIND11_MODULE(_altiplan, module) {
  module.doc() = "The part of altiplan that is written in C++; import altiplan instead.";
  module.attr("__version__") = ALTIPLAN_VERSION;
  altiplan::python::guard_base();
  altiplan::python::add_errors();
  altiplan::python::add_records(module);
  altiplan::python::add_route(module);
  altiplan::python::add_result(module);
  altiplan::python::add_world(module);
}
