// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <iostream>

#include "commands.hpp"
#include "completion.hpp"
#include "host/base/output_file.hpp"

namespace altiplan::cli {
namespace {

namespace fs = std::filesystem;

struct ManArguments {
  std::string command = "altiplan";
  std::optional<std::string> folder;
};

std::string page_name(const std::string& command) {
  return (command == "altiplan" ? command : "altiplan-" + command) + ".1";
}

int man(const ManArguments& arguments, const std::vector<CommandText>& all) {
  if (!arguments.folder) {
    std::cout << manual_page(arguments.command, all);
    return kDone;
  }
  for (const CommandText& command : all) {
    host::write_file(fs::path(*arguments.folder) / page_name(command.name),
                     manual_page(command.name, all));
  }
  return kDone;
}
}  // namespace

void add_completion(App& app, Action& action) {
  const auto print = [&app](const std::string& shell) {
    std::cout << completion(shell, app.texts());
    return kDone;
  };
  auto [command, shell] = add_command<std::string>(
      app, action, "completion", "print a script that completes commands in a shell", print);
  command.add_option("shell", shell, "bash, zsh or fish")
      ->required()
      ->check(Check::one_of({"bash", "zsh", "fish"}));
  set_example(command, "source <(altiplan completion bash)");
}

void add_man(App& app, Action& action) {
  const auto print = [&app](const ManArguments& given) { return man(given, app.texts()); };
  auto [command, arguments] =
      add_command<ManArguments>(app, action, "man", "print the manual page of a command", print);
  std::vector<std::string> names;
  for (const CommandText& each : app.texts()) {
    names.push_back(each.name);
  }
  Option* name = command.add_option("command", arguments.command, "default: the program")
                     ->check(Check::one_of(names));
  command
      .add_option("--to DIR", arguments.folder, "write the pages of all commands into this folder")
      ->excludes(name);
  set_example(command, "altiplan man run | man -l -");
}
}  // namespace altiplan::cli
