// SPDX-License-Identifier: Apache-2.0
#include "command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <map>

#include "altiplan/error.hpp"
#include "altiplan_build.hpp"
#include "guarded.hpp"

namespace altiplan::cli {
namespace {

const std::map<std::string, std::string> kRenamedOptions{{"--patience", "--timeout"}};

/// "; did you mean 'run'?" of the nearest word, or of the only one that begins so; "" if there is
/// none.
std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates) {
  std::vector<std::string> longer;
  std::copy_if(candidates.begin(), candidates.end(), std::back_inserter(longer),
               [&](const std::string& each) { return word.size() > 1 && each.starts_with(word); });
  const std::string near = longer.size() == 1 ? longer.front() : nearest_name(word, candidates);
  return near.empty() ? "" : "; did you mean '" + near + "'?";
}

/// "-o,--out" of "-o,--out FILE".
std::string without_type(const std::string& names) { return names.substr(0, names.find(' ')); }

/// The options of the command that was called, with their dashes.
std::vector<std::string> options_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands()) {
    for (const CLI::Option* option : command->get_options()) {
      for (const std::string& name : option->get_lnames()) {
        names.push_back("--" + name);
      }
    }
  }
  return names;
}

/// Prints the reason.
int refuse(const CLI::App& app, const CLI::ParseError& error) {
  // CLI11 would only report a missing command.
  const std::vector<std::string> rest = app.remaining();
  if (error.get_name() == "RequiredError" && app.get_subcommands().empty() && !rest.empty()) {
    std::vector<std::string> commands;
    for (const CLI::App* command : app.get_subcommands(nullptr)) {
      commands.push_back(command->get_name());
    }
    std::cerr << "altiplan: unknown command '" << rest.front() << "'"
              << did_you_mean(rest.front(), commands) << " (altiplan --help lists the commands)\n";
    return kUsage;
  }
  const bool is_extra = dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr;
  for (const std::string& argument : app.remaining(true)) {
    const auto renamed = kRenamedOptions.find(argument.substr(0, argument.find('=')));
    if (renamed != kRenamedOptions.end()) {
      std::cerr << "altiplan: " << renamed->first << " is now " << renamed->second << '\n';
      return kUsage;
    }
    if (is_extra && argument.starts_with("--")) {
      const std::string name = argument.substr(0, argument.find('='));
      std::cerr << "altiplan: unknown option '" << name << "'"
                << did_you_mean(name, options_of(app)) << " (--help lists the options)\n";
      return kUsage;
    }
  }
  const int code = app.exit(error);
  return guarded("altiplan", [&] { return code == 0 ? kDone : kUsage; });
}
}  // namespace

Check::Check(CLI::Validator validator)
    : validator_(std::make_shared<CLI::Validator>(std::move(validator))) {}

Check::Check(const std::function<std::string(const std::string&)>& problem,
             const std::string& range)
    : Check(CLI::Validator([problem](std::string& text) { return problem(text); }, range)) {}

Check Check::between(std::int64_t low, std::int64_t high) { return Check(CLI::Range(low, high)); }

Check Check::one_of(const std::vector<std::string>& words) {
  std::string list;
  for (const std::string& word : words) {
    list += (list.empty() ? "" : ",") + word;
  }
  const auto problem = [words, list](const std::string& text) {
    return std::find(words.begin(), words.end(), text) != words.end()
               ? ""
               : "expected one of " + list + ", found '" + text + "'" + did_you_mean(text, words);
  };
  Check check(problem, "{" + list + "}");
  check.words_ = words;
  return check;
}

Option* Option::required() {
  option_->required();
  return this;
}

Option* Option::check(const Check& check) {
  option_->check(*check.validator_);
  words_ = check.words_;
  return this;
}

Option* Option::excludes(const Option* other) {
  option_->excludes(other->option_);
  return this;
}

Option* Option::needs(const Option* other) {
  option_->needs(other->option_);
  return this;
}

Option* Option::expected(int count) {
  option_->expected(count);
  return this;
}

Option* Option::one_or_more() {
  option_->expected(1, -1);
  return this;
}

Option* Option::take_all() {
  option_->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  return this;
}

Option* Option::one_at_a_time() {
  option_->expected(1)->allow_extra_args(false);
  return this;
}

Option* Option::otherwise(const std::string& value) {
  otherwise_ = value;
  return one_at_a_time();
}

Option* Option::capture_default_str() {
  option_->capture_default_str();
  return this;
}

Option* Option::hide() {
  option_->group("");
  return this;
}

std::size_t Option::count() const { return option_->count(); }

std::string Option::name() const { return option_->get_name(); }

OptionText Option::text() const {
  OptionText text;
  text.is_positional = option_->get_positional();
  for (const std::string& name : option_->get_snames()) {
    text.names.push_back("-" + name);
  }
  for (const std::string& name : option_->get_lnames()) {
    text.names.push_back("--" + name);
  }
  if (text.is_positional) {
    text.names = {option_->get_name(true)};
  }
  text.takes_value = option_->get_items_expected_max() > 0;
  text.type = text.takes_value ? option_->get_type_name() : "";
  text.words = words_;
  text.sentence = option_->get_description();
  return text;
}

App::App(const std::string& description, const std::string& name)
    : own_(std::make_unique<CLI::App>(description, name)), app_(own_.get()) {
  app_->set_version_flag("--version", ALTIPLAN_VERSION);
  app_->require_subcommand(1);
  app_->fallthrough();
}

App::App(CLI::App* subcommand) : app_(subcommand) {}

App::~App() = default;

Option* App::keep(CLI::Option* option, const std::string& names) {
  if (const std::size_t space = names.find(' '); space != names.npos) {
    option->type_name(names.substr(space + 1));
  }
  return options_.emplace_back(std::make_unique<Option>(option)).get();
}

App* App::add_subcommand(const std::string& name, const std::string& description) {
  CLI::App* added = app_->add_subcommand(name, description);
  return subcommands_.emplace_back(new App(added)).get();
}

template <class Value>
Option* App::add_option(const std::string& names, Value& value, const std::string& description) {
  return keep(app_->add_option(without_type(names), value, description), names);
}

#define ALTIPLAN_OPTION(...) \
  template Option* App::add_option(const std::string&, __VA_ARGS__&, const std::string&)
ALTIPLAN_OPTION(std::string);
ALTIPLAN_OPTION(std::optional<std::string>);
ALTIPLAN_OPTION(std::vector<std::string>);
ALTIPLAN_OPTION(std::filesystem::path);
ALTIPLAN_OPTION(std::optional<std::filesystem::path>);
ALTIPLAN_OPTION(std::vector<std::filesystem::path>);
ALTIPLAN_OPTION(double);
ALTIPLAN_OPTION(std::optional<double>);
ALTIPLAN_OPTION(std::vector<double>);
ALTIPLAN_OPTION(int);
ALTIPLAN_OPTION(std::optional<int>);
ALTIPLAN_OPTION(std::int64_t);
ALTIPLAN_OPTION(std::optional<std::int64_t>);
ALTIPLAN_OPTION(std::size_t);
ALTIPLAN_OPTION(std::optional<std::size_t>);
#undef ALTIPLAN_OPTION

Option* App::add_option_function(const std::string& name,
                                 const std::function<std::string(const std::string&)>& take,
                                 const std::string& description) {
  const std::function<void(const std::string&)> call = [name = without_type(name),
                                                        take](const std::string& text) {
    if (const std::string problem = take(text); !problem.empty()) {
      throw CLI::ValidationError(name, problem);
    }
  };
  return keep(app_->add_option_function(without_type(name), call, description), name);
}

Option* App::add_flag(const std::string& names, bool& value, const std::string& description) {
  return keep(app_->add_flag(names, value, description));
}

CommandText App::text() const {
  CommandText text{app_->get_name(), app_->get_description(), app_->get_footer(), {}};
  for (const auto& option : options_) {
    text.options.push_back(option->text());
  }
  text.options.push_back({{"-h", "--help"}, false, false, "", {}, "print the help"});
  if (own_) {
    text.options.push_back({{"--version"}, false, false, "", {}, "print the version"});
  }
  return text;
}

std::vector<CommandText> App::texts() const {
  std::vector<CommandText> all{text()};
  for (const auto& subcommand : subcommands_) {
    all.push_back(subcommand->text());
  }
  return all;
}

void App::footer(const std::string& text) { app_->footer(text); }

void App::callback(const std::function<void()>& call) {
  app_->callback([call] {
    try {
      call();
    } catch (const UsageError& error) {
      throw CLI::ValidationError(error.message);
    }
  });
}

std::vector<std::string> App::completed(int argc, char** argv) const {
  std::map<std::string, std::string> otherwise;
  for (const auto& subcommand : subcommands_) {
    for (const auto& option : subcommand->options_) {
      if (!option->otherwise_.empty()) {
        otherwise.emplace(option->name(), option->otherwise_);
      }
    }
  }
  std::vector<std::string> arguments;
  for (int n = argc - 1; n > 0; --n) {
    const auto found = otherwise.find(argv[n]);
    std::error_code ignored;
    if (found != otherwise.end() && (arguments.empty() || arguments.back().starts_with("-") ||
                                     std::filesystem::is_regular_file(arguments.back(), ignored))) {
      arguments.push_back(found->first + "=" + found->second);
    } else {
      arguments.emplace_back(argv[n]);
    }
  }
  return arguments;
}

std::optional<int> App::parse(int argc, char** argv) {
  try {
    app_->parse(completed(argc, argv));
    return std::nullopt;
  } catch (const CLI::ParseError& error) {
    return refuse(*app_, error);
  }
}
}  // namespace altiplan::cli
