// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
class Validator;
}  // namespace CLI

/// \file The command line. Behind it is CLI11, whose headers one file includes: each that does
/// takes seconds to build.
namespace altiplan::cli {

/// Options that do not fit together; thrown by what `callback` is given.
struct UsageError {
  std::string message;
};

/// An option or a positional argument, for what describes the commands.
struct OptionText {
  std::vector<std::string> names;  ///< with dashes; of a positional argument its name
  bool is_positional = false;
  bool takes_value = false;
  std::string type;                ///< of the value: "FILE"
  std::vector<std::string> words;  ///< the only values, if they are few
  std::string sentence;
};

/// A command, or the program.
struct CommandText {
  std::string name;
  std::string sentence;
  std::string footer;
  std::vector<OptionText> options;
};

/// What an option's text must be.
class Check {
 public:
  /// `problem` returns what is wrong with a text, "" if nothing; `range` is for --help.
  explicit Check(const std::function<std::string(const std::string&)>& problem,
                 const std::string& range = "");
  static Check between(std::int64_t low, std::int64_t high);
  static Check one_of(const std::vector<std::string>& words);

 private:
  friend class Option;
  explicit Check(CLI::Validator validator);
  std::shared_ptr<CLI::Validator> validator_;
  std::vector<std::string> words_;
};

class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}
  Option* required();
  Option* check(const Check& check);
  Option* check(const std::function<std::string(const std::string&)>& problem) {
    return check(Check(problem));
  }
  Option* excludes(const Option* other);
  Option* needs(const Option* other);
  /// As many values each time.
  Option* expected(int count);
  Option* one_or_more();
  /// Of a repeated option all values count.
  Option* take_all();
  /// One value each time, so that a -- that follows is not taken for another.
  Option* one_at_a_time();
  /// The value where none follows, nor `--name=VALUE`: before another option, at the end, and
  /// before the name of a file, which is an argument of its own.
  Option* otherwise(const std::string& value);
  Option* capture_default_str();
  /// Not in --help.
  Option* hide();
  std::size_t count() const;
  std::string name() const;
  OptionText text() const;

 private:
  friend class App;
  CLI::Option* option_;
  std::vector<std::string> words_;
  std::string otherwise_;
};

class App {
 public:
  App(const std::string& description, const std::string& name);
  ~App();
  App(const App&) = delete;
  App& operator=(const App&) = delete;

  App* add_subcommand(const std::string& name, const std::string& description);
  /// For the types that command_line.cpp lists. After the names, and a blank, the type of the value
  /// for --help: "-o,--out FILE".
  template <class Value>
  Option* add_option(const std::string& names, Value& value, const std::string& description = "");
  /// `take` returns what is wrong with the text, "" if nothing. The name as above.
  Option* add_option_function(const std::string& name,
                              const std::function<std::string(const std::string&)>& take,
                              const std::string& description);
  Option* add_flag(const std::string& names, bool& value, const std::string& description);
  void footer(const std::string& text);
  /// Called when the subcommand has been parsed.
  void callback(const std::function<void()>& call);

  /// The program, then its commands in order; hidden options are left out.
  std::vector<CommandText> texts() const;

  /// Calls the subcommand's callback, or prints what is wrong, or what was asked for (--help), and
  /// returns the exit code.
  std::optional<int> parse(int argc, char** argv);

 private:
  explicit App(CLI::App* subcommand);
  Option* keep(CLI::Option* option, const std::string& names = "");
  /// The arguments, last first, with the value of Option::otherwise where it is left out.
  std::vector<std::string> completed(int argc, char** argv) const;
  CommandText text() const;

  std::unique_ptr<CLI::App> own_;
  CLI::App* app_;
  std::vector<std::unique_ptr<App>> subcommands_;
  std::vector<std::unique_ptr<Option>> options_;
};
}  // namespace altiplan::cli
