// SPDX-License-Identifier: Apache-2.0
#include "altiplan/error.hpp"

#include <utility>

#include "python/bindings.hpp"

namespace altiplan::python {
namespace {

/// Messages may quote files and plugins: invalid UTF-8 is replaced.
py::object text_of(const std::string& text) {
  return py::reinterpret_steal<py::object>(
      PyUnicode_DecodeUTF8(text.data(), py::ssize_t(text.size()), "replace"));
}

py::object text_or_none(const std::string& text) {
  return text.empty() ? py::none() : text_of(text);
}

py::object number_or_none(int number) {
  return number > 0 ? py::object(py::int_(number)) : py::none();
}

py::dict where_of(const Problem& problem) {
  py::dict found;
  found["file"] = text_or_none(problem.where.file);
  found["line"] = number_or_none(problem.where.line);
  found["column"] = number_or_none(problem.where.column);
  found["key"] = text_or_none(problem.key);
  return found;
}

/// The class is Python's own, so that its attributes and its pickling are plain Python.
void raise(const Error& error, const py::dict& where, const py::list& problems) {
  const py::object type = py::module_::import("altiplan._error").attr("Error");
  const py::object raised = type(text_of(error.what()), **where, py::arg("problems") = problems);
  PyErr_SetObject(type.ptr(), raised.ptr());
}

void translate(const Error& error) {
  py::dict where;
  py::list problems;
  if (const auto* config = dynamic_cast<const ConfigError*>(&error)) {
    for (const Problem& problem : config->problems()) {
      py::dict one = where_of(problem);
      if (problems.empty()) {
        where = one.attr("copy")();
      }
      one["message"] = text_of(problem.message);
      problems.append(one);
    }
  } else if (const auto* parameter = dynamic_cast<const ParameterError*>(&error)) {
    where["key"] = text_or_none(parameter->key());
  } else if (const auto* plugin = dynamic_cast<const PluginError*>(&error)) {
    where["reason"] = text_or_none(name(plugin->reason()));
  }
  raise(error, where, problems);
}
}  // namespace

void add_errors() {
  py::register_local_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) {
        std::rethrow_exception(std::move(thrown));
      }
    } catch (const Error& error) {
      try {
        translate(error);
      } catch (py::error_already_set& other) {  // such as no memory
        other.restore();
      }
    }
  });
}
}  // namespace altiplan::python
