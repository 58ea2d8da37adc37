// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "altiplan/api.hpp"
#include "altiplan/reason.hpp"

namespace altiplan {

/// A place in a file that the user wrote, or the command-line override that took its place.
struct Location {
  std::string file;
  int line = 0;  ///< from 1; 0 where only the file is known
  int column = 0;
  std::string override_text;  ///< "--set KEY=VALUE" where the value came from the command line

  /// "file:line:column", or the override.
  ALTIPLAN_API std::string text() const;
};

/// One thing that is wrong in a file: where, at which key ("steps.0.with.cell_m"), what was
/// expected.
struct Problem {
  Location where;
  std::string key;
  std::string message;

  ALTIPLAN_API std::string text() const;
};

/// Base of everything that the framework throws.
class ALTIPLAN_API Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  ~Error() override;
};

/// Files or parameters are wrong; holds every problem found, in file order.
class ALTIPLAN_API ConfigError : public Error {
 public:
  explicit ConfigError(std::vector<Problem> problems);
  ConfigError(Location where, std::string key, std::string message);
  ~ConfigError() override;
  const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

/// A parameter does not fit the problem at hand (a lattice larger than the memory allowed): thrown
/// by a plugin at run time, reported by the host at the parameter's place in the file, exit code 3.
class ALTIPLAN_API ParameterError : public Error {
 public:
  ParameterError(std::string key, const std::string& message)
      : Error(message), key_(std::move(key)) {}
  ~ParameterError() override;
  /// Name of the parameter within the plugin's own ("cell_m").
  const std::string& key() const { return key_; }

 private:
  std::string key_;
};

/// A plugin threw, violated the contract of its interface, or could not be loaded; the text names it.
class ALTIPLAN_API PluginError : public Error {
 public:
  explicit PluginError(const std::string& message, Reason reason = Reason::none)
      : Error(message), reason_(reason) {}
  ~PluginError() override;
  Reason reason() const { return reason_; }

 private:
  Reason reason_;
};

/// Within a `catch`: throws what was caught as a PluginError, "WHOthrew: …"; `who` ends with a
/// space or is empty.
[[noreturn]] ALTIPLAN_API void attribute_to(const std::string& who);

/// The time of a budget ended, or its stop was requested, while the framework worked for a planner:
/// whoever called the planner answers with `timed_out` or `cancelled`.
class ALTIPLAN_API BudgetSpent : public Error {
 public:
  BudgetSpent(const std::string& message, bool cancelled) : Error(message), cancelled_(cancelled) {}
  ~BudgetSpent() override;
  /// Whether the stop token, not the deadline, ended it.
  bool cancelled() const { return cancelled_; }

 private:
  bool cancelled_;
};

/// What a file says, as a message quotes it: in quotes, no longer than 60 characters, with '?' for
/// what is not printable ASCII.
ALTIPLAN_API std::string excerpt(std::string_view text);

/// The candidate nearest to `word` by edit distance, or "" when none is near.
ALTIPLAN_API std::string nearest_name(std::string_view word,
                                      const std::vector<std::string>& candidates);
}  // namespace altiplan
