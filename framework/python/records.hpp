// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <memory>
#include <string>

#include "altiplan/route.hpp"
#include "host/result/result_json.hpp"
#include "python/bindings.hpp"

namespace altiplan::python {

using host::Json;

/// A part of a result: its attributes are the keys of result.json, and nothing can be set.
struct Record {
  Json json;
};
struct Metrics : Record {};
/// With the judged route, in which it has its place; null where a track was judged.
struct Violation : Record {
  std::shared_ptr<const Route> route{};
};
struct Check : Record {
  std::shared_ptr<const Route> route{};
};
struct Flight : Record {};
struct LegRecord : Record {};
/// One attempt of a step, with its route; null where it has none.
struct Step : Record {
  std::shared_ptr<const Route> route;
};

/// Lists, dicts, texts and numbers; invalid UTF-8 is replaced.
py::object to_python(const Json& json);
/// A read-only array of shape (n, columns) of a list of lists; null becomes nan.
py::object to_array(const Json& json, std::size_t columns);
/// "Metrics(length_m=28029.1, …)"; long values are left out.
std::string record_text(const std::string& name, const Json& json);

/// Null becomes None.
template <class T>
py::object record_or_none(const Json& json) {
  return json.is_null() ? py::none() : py::cast(T{{json}});
}

template <class T>
py::list list_of(const Json& json) {
  py::list list;
  for (const Json& one : json) {
    list.append(T{{one}});
  }
  return list;
}

/// The verdict on a route; None of null.
py::object check_or_none(const Json& json, std::shared_ptr<const Route> route);

/// The legs of a route, as in result.json.
py::list legs_of(const Route& route);

/// A key of a record that is an attribute. Docstrings of attributes are "TYPE: text", with the type
/// as Python writes it; the stub _altiplan.pyi is made of them.
struct Key {
  const char* name;
  const char* type;
  const char* text;
};
using Keys = std::initializer_list<Key>;

/// Adds an attribute for each key; a key that is missing is None.
template <class Class>
void add_keys(Class& type, const Keys& keys) {
  for (const Key& key : keys) {
    type.def_property_readonly(
        key.name,
        [name = std::string(key.name)](const typename Class::type& record) {
          return to_python(record.json.value(name, Json()));
        },
        (std::string(key.type) + ": " + key.text).c_str());
  }
}

/// Prints all keys.
template <class Class>
void add_text(Class& type, const std::string& name) {
  type.def("__repr__",
           [name](const typename Class::type& record) { return record_text(name, record.json); });
}

/// A class without a constructor, equal by value, with the keys as attributes.
template <class T>
auto record_class(py::module_& module, const char* name, const char* doc, const Keys& keys) {
  py::class_<T, std::shared_ptr<T>> type(module, name, doc, py::is_final());
  // pybind11's own would make an object of uninitialised memory.
  type.def_static("__new__", [text = std::string(name)](const py::args&, const py::kwargs&) {
    throw py::type_error(text + " has no constructor: it is part of what altiplan gives");
  });
  add_keys(type, keys);
  type.def(
      "to_dict", [](const T& record) -> Typed<"dict[str, Any]"> { return to_python(record.json); },
      "All of it as a dict, as in result.json.");
  type.def(
      "__eq__", [](const T& a, const T& b) { return a.json == b.json; }, py::is_operator());
  return type;
}
}  // namespace altiplan::python
