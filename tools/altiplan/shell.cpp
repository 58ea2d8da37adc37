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
  App* command =
      app.add_subcommand("completion", "print a script that completes commands in a shell");
  auto shell = std::make_shared<std::string>();
  command->add_option("shell", *shell, "bash, zsh or fish")
      ->required()
      ->check(Check::one_of({"bash", "zsh", "fish"}));
  set_example(*command, "source <(altiplan completion bash)");
  command->callback([&app, &action, shell] {
    action = [&app, shell] {
      std::cout << completion(*shell, app.texts());
      return kDone;
    };
  });
}

void add_man(App& app, Action& action) {
  App* command = app.add_subcommand("man", "print the manual page of a command");
  auto arguments = std::make_shared<ManArguments>();
  std::vector<std::string> names;
  for (const CommandText& each : app.texts()) {
    names.push_back(each.name);
  }
  Option* name = command->add_option("command", arguments->command, "default: the program")
                     ->check(Check::one_of(names));
  command->add_option("--to", arguments->folder, "write the pages of all commands into this folder")
      ->type_name("DIR")
      ->excludes(name);
  set_example(*command, "altiplan man run | man -l -");
  command->callback([&app, &action, arguments] {
    action = [&app, arguments] { return man(*arguments, app.texts()); };
  });
}
}  // namespace altiplan::cli
