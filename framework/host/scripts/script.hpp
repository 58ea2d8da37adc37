// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "altiplan/params.hpp"
#include "host/base/json.hpp"
#include "host/base/plugin_file.hpp"

namespace altiplan::host {

/// True for a file of Python with a line that begins with `@altiplan.planner(`, or likewise with
/// smoother, environment, constraint or objective. Other files of Python may lie in the same
/// folder.
bool offers_scripts(const std::filesystem::path& file);
bool is_script(const std::filesystem::path& file);

/// Reads names and sentences from the text; none of its code runs. Never throws: errors are
/// reported in `refused`.
Library examine_script(const std::filesystem::path& file);

/// As load_library. The file runs in a process of its own, which tells its parameters.
std::vector<const PluginEntry*> load_script(const Library& library);

/// From now on a process of Python that its object no longer needs waits for the next object of
/// the same file, to the end of this program: for the many short-lived objects of a test.
void keep_script_processes();

/// A parameter as Python declares it, and its value.
struct ScriptField {
  using Value =
      std::variant<bool, std::int64_t, double, std::string, Path, std::array<double, 2>, Vec3,
                   std::vector<std::int64_t>, std::vector<double>, std::vector<std::string>,
                   std::optional<bool>, std::optional<std::int64_t>, std::optional<double>,
                   std::optional<std::string>, std::optional<Path>>;
  FieldSpec spec;  ///< the type is that of the value
  Value value;
};

/// The parameters of a plugin in Python. Throws PluginError for a declaration that is damaged.
class ScriptParams {
 public:
  ScriptParams() = default;
  explicit ScriptParams(const Json& declared);
  void describe(Fields& fields);

 private:
  std::vector<ScriptField> fields_;
};
}  // namespace altiplan::host
