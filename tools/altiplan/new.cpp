// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <map>

#include "altiplan/error.hpp"
#include "altiplan/formats/input_file.hpp"
#include "commands.hpp"
#include "host/base/built_in.hpp"
#include "host/base/install_root.hpp"
#include "host/base/output_file.hpp"
#include "host/base/unfinished.hpp"
#include "host/base/words.hpp"
#include "host/plugins/registry.hpp"

namespace altiplan::cli {
namespace {

namespace fs = std::filesystem;

struct NewArguments {
  std::string kind;
  std::string name;
  bool python = false;
};

constexpr std::string_view kKinds[] = {"constraint", "environment", "local_planner", "objective",
                                       "planner",    "smoother",    "task",          "tuner"};
constexpr std::string_view kKindsInPython[] = {"constraint", "environment", "objective", "planner",
                                               "smoother"};

/// The C++ keywords, each between spaces.
constexpr std::string_view kKeywords =
    " alignas alignof and and_eq asm auto bitand bitor bool break case catch char char16_t "
    "char32_t char8_t class co_await co_return co_yield compl concept const const_cast "
    "consteval constexpr constinit continue decltype default delete do double dynamic_cast else "
    "enum explicit export extern false float for friend goto if inline int long mutable "
    "namespace new noexcept not not_eq nullptr operator or or_eq private protected public "
    "register reinterpret_cast requires return short signed sizeof static static_assert "
    "static_cast struct switch template this thread_local throw true try typedef typeid "
    "typename union unsigned using virtual void volatile wchar_t while xor xor_eq ";

/// Words with another meaning where a file names a plugin.
constexpr std::string_view kOwnWords[] = {"id", "known", "null", "route"};

template <class Words>
bool contains(const Words& words, std::string_view word) {
  return std::find(std::begin(words), std::end(words), word) != std::end(words);
}

template <class Words>
std::string listed(const Words& words) {
  std::string text;
  for (const std::string_view word : words) {
    text += (text.empty() ? "" : ", ") + std::string(word);
  }
  return text;
}

/// A description of the plugin with that name; "" if the name is free. Kinds may share names, but
/// unique names keep files and messages clear.
std::string offered_by(const std::string& name) {
  const host::Registry registry(host::Registry::search_path({}));
  for (const host::Library& library : registry.libraries()) {
    for (const Manifest& plugin : library.plugins) {
      if (plugin.name == name) {
        return "the " + std::string(plugin.kind) + " of " + library.file.string();
      }
    }
  }
  for (const std::string_view kind : kKinds) {
    if (contains(registry.names(kind), name)) {
      return "a " + std::string(kind) + " of altiplan, not built yet";
    }
  }
  for (const PluginEntry& entry : host::built_in_plugins()) {
    if (entry.name == name) {
      return "a built-in " + std::string(entry.kind);
    }
  }
  return "";
}

/// The error message for the kind or the name; "" if both are valid.
std::string usage_problem(const NewArguments& arguments) {
  const std::string found = ", found '" + arguments.name + "'";
  if (!contains(kKinds, arguments.kind)) {
    return "KIND: expected one of " + listed(kKinds) + ", found '" + arguments.kind + "'";
  }
  if (arguments.python && !contains(kKindsInPython, arguments.kind)) {
    return "--python: a " + arguments.kind + " is not written in Python; expected one of " +
           listed(kKindsInPython);
  }
  if (!host::is_snake_case(arguments.name)) {
    return "NAME: expected lower-case letters, digits and '_', the first a letter" + found;
  }
  if (arguments.name.size() >= sizeof(Manifest::name)) {
    return "NAME: expected at most " + std::to_string(sizeof(Manifest::name) - 1) + " letters" +
           found;
  }
  if (kKeywords.find(" " + arguments.name + " ") != std::string_view::npos) {
    return "NAME: '" + arguments.name + "' is a C++ keyword";
  }
  if (contains(kOwnWords, arguments.name)) {
    return "NAME: '" + arguments.name +
           "' has another meaning in altiplan's files: choose another name";
  }
  if (arguments.name.ends_with("_test")) {
    return "NAME: expected a name that does not end in _test, which marks test sources" + found;
  }
  const std::string offered = offered_by(arguments.name);
  return offered.empty() ? "" : "NAME: '" + arguments.name + "' is taken by " + offered;
}

using Files = std::map<fs::path, std::string>;

/// Adds the files below the folder by their relative paths; replaces those of the same path.
void add_files(const fs::path& folder, Files& files) {
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) {
      files[entry.path().lexically_relative(folder)] = formats::read_file(entry.path().string());
    }
  }
}

void replace_all(std::string& text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at)) {
    text.replace(at, what.size(), by);
    at += by.size();
  }
}

/// The project's files: the shared templates and those of the kind. `X.part` is not itself a file
/// of the project: its text replaces @X@ in the others.
Files project(const NewArguments& arguments) {
  const fs::path templates = host::install_root() / "share/altiplan/templates";
  Files all;
  add_files(templates / "shared", all);
  add_files(templates / arguments.kind, all);
  std::vector<std::pair<std::string, std::string>> values;
  for (const auto& [path, text] : all) {
    if (path.extension() == ".part") {
      values.emplace_back("@" + path.stem().string() + "@", text.substr(0, text.rfind('\n')));
    }
  }
  values.emplace_back("@kind@", arguments.kind);
  values.emplace_back("@name@", arguments.name);  // last: parts contain them too
  Files files;
  for (const auto& [path, text] : all) {
    if (path.extension() == ".part") {
      continue;
    }
    std::string name = path.string();
    std::string filled = text;
    for (const auto& [what, by] : values) {
      replace_all(name, what, by);
      replace_all(filled, what, by);
    }
    files[name] = filled;
  }
  return files;
}

/// A plugin in Python is one file, in the current folder.
int new_script(const NewArguments& arguments) {
  const fs::path file = arguments.name + ".py";
  if (fs::exists(fs::symlink_status(file))) {
    throw Error("'" + file.string() + "' exists and is not overwritten: choose another name");
  }
  const fs::path templates = host::install_root() / "share/altiplan/templates";
  std::string text = formats::read_file((templates / "python" / (arguments.kind + ".py")).string());
  replace_all(text, "@name@", arguments.name);
  host::write_file(file, text);
  std::cout << file.string() << " holds the " << arguments.kind << " '" << arguments.name
            << "': altiplan check-plugin " << file.string()
            << " checks it, and --plugin-path . finds it\n";
  return kDone;
}

int new_project(const NewArguments& arguments) {
  const std::string problem = usage_problem(arguments);
  if (!problem.empty()) {
    std::cerr << "altiplan: new: " << problem << '\n';
    return kUsage;
  }
  if (arguments.python) {
    return new_script(arguments);
  }
  const Files files = project(arguments);
  const fs::path folder = arguments.name;
  const auto lock = host::uninterrupted();
  std::error_code error;
  if (!fs::create_directory(folder, error)) {
    throw Error(fs::exists(fs::symlink_status(folder))
                    ? "'" + folder.string() + "' exists and is not overwritten: choose another name"
                    : "cannot create the folder '" + folder.string() + "': " + error.message());
  }
  try {
    for (const auto& [path, text] : files) {
      fs::create_directories((folder / path).parent_path());
      host::write_file(folder / path, text);
    }
  } catch (...) {
    fs::remove_all(folder, error);
    throw;
  }
  std::cout << arguments.name << "/README.md describes how to build, test, run and compare this "
            << arguments.kind << "\n";
  return kDone;
}
}  // namespace

void add_new(App& app, Action& action) {
  auto [command, arguments] = add_command<NewArguments>(
      app, action, "new", "create a complete out-of-tree plugin project in ./NAME", new_project);
  command
      .add_option(
          "kind", arguments.kind,
          "kind: constraint, environment, local_planner, objective, planner, smoother, task or "
          "tuner")
      ->required();
  command.add_option("name", arguments.name, "name of the plugin and of its folder, in snake_case")
      ->required();
  command.add_flag("--python", arguments.python,
                   "write a constraint, environment, objective, planner or smoother in Python: the "
                   "file NAME.py, "
                   "which needs no build");
  set_example(command, "altiplan new planner my_planner");
}
}  // namespace altiplan::cli
