// SPDX-License-Identifier: Apache-2.0
#include "python/bindings.hpp"

PYBIND11_MODULE(_altiplan, module) {
  module.doc() = "The part of altiplan that is written in C++; import altiplan instead.";
  module.attr("__version__") = ALTIPLAN_VERSION;
  altiplan::python::add_errors();
  altiplan::python::add_records(module);
  altiplan::python::add_route(module);
  altiplan::python::add_result(module);
  altiplan::python::add_world(module);
}
