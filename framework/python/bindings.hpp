// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace altiplan::python {
namespace py = pybind11;

/// The text of a type in Python, as an argument of a template.
template <std::size_t kSize>
struct TypeText {
  constexpr TypeText(const char (&literal)[kSize]) { std::copy_n(literal, kSize, text); }
  char text[kSize]{};
};

/// An object of Python's that signatures, and so the stub _altiplan.pyi, give this type:
/// Typed<"ArrayLike">. Nothing checks it.
template <TypeText kType>
class Typed : public py::object {
 public:
  using py::object::object;
  Typed(py::object any) : py::object(std::move(any)) {}
  // NOLINTNEXTLINE(readability-identifier-naming): pybind11 calls it
  static bool check_(py::handle any) { return any.ptr() != nullptr; }
};
}  // namespace altiplan::python

namespace pybind11::detail {
template <altiplan::python::TypeText kType>
struct handle_type_name<altiplan::python::Typed<kType>> {
  // NOLINTNEXTLINE(readability-identifier-naming): pybind11 reads it
  static constexpr auto name = const_name(kType.text);
};
}  // namespace pybind11::detail

namespace altiplan::python {
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
