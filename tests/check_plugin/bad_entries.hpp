// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "misdeeds.hpp"

/// What goes wrong in the same way in a plugin of any kind: its entry, and its process. Templates
/// and lines that declare them are the same for all, so that each test is shown to fail for each
/// kind.
namespace altiplan::bad {

// Parameters that are not declared as they should be; Base holds those that are.

template <class Base>
struct Undescribed : Base {
  int size = 1;
  void describe(Fields& f) {
    Base::describe(f);
    f("size", size);
  }
};
template <class Base>
struct Misnamed : Base {
  int size = 1;
  void describe(Fields& f) {
    Base::describe(f);
    f("size__m", size).doc("of it");
  }
};
template <class Base>
struct OutOfBounds : Base {
  double size = 20;
  void describe(Fields& f) {
    Base::describe(f);
    f("size", size).range(1, 9).doc("of it");
  }
};
/// These are declared well; an entry of its own does something wrong with them.
template <class Base>
struct Bounded : Base {
  double size = 5;
  void describe(Fields& f) {
    Base::describe(f);
    f("size", size).range(1, 9).doc("of it");
  }
};

/// The entry of a plugin that reads no parameters, and so refuses none.
template <class Interface, class Class, class Params>
constexpr PluginEntry deaf_entry(const char* name, const char* sentence) {
  PluginEntry entry = detail::make_entry<Interface, Class, Params>(name, sentence);
  entry.describe = [](const Value*, const std::string& path) {
    return detail::describe<Params>(nullptr, path);
  };
  return entry;
}
template <class Interface, class Class, class Params>
constexpr PluginEntry throwing_entry(const char* name, const char* sentence) {
  PluginEntry entry = detail::make_entry<Interface, Class, Params>(name, sentence);
  entry.describe = [](const Value* value, const std::string& path) {
    if (value != nullptr && !value->entries.empty() && value->entries[0].key == "no_such_key") {
      throw std::runtime_error("no such key");
    }
    return detail::describe<Params>(value, path);
  };
  return entry;
}
/// One whose objects are made of any parameters.
template <class Interface, class Class, class Params>
constexpr PluginEntry careless_entry(const char* name, const char* sentence) {
  PluginEntry entry = detail::make_entry<Interface, Class, Params>(name, sentence);
  const auto make = [](const Value*, const auto&... site) -> std::unique_ptr<Interface> {
    if constexpr (std::is_constructible_v<Class, const Params&, decltype(site)...>) {
      return std::make_unique<Class>(Params(), site...);
    } else {
      return std::make_unique<Class>(Params());
    }
  };
  if constexpr (std::is_same_v<Interface, Environment>) {
    entry.environment = make;
  } else if constexpr (std::is_same_v<Interface, Constraint>) {
    entry.constraint = make;
  } else if constexpr (std::is_same_v<Interface, Planner>) {
    entry.planner = make;
  } else if constexpr (std::is_same_v<Interface, LocalPlanner>) {
    entry.local_planner = make;
  } else if constexpr (std::is_same_v<Interface, Smoother>) {
    entry.smoother = make;
  } else if constexpr (std::is_same_v<Interface, Objective>) {
    entry.objective = make;
  } else if constexpr (std::is_same_v<Interface, Task>) {
    entry.task = make;
  } else {
    entry.tuner = make;
  }
  return entry;
}
/// One that throws what is not the framework's where the parameters are wrong.
template <class Interface, class Class, class Params>
constexpr PluginEntry thrower_entry(const char* name, const char* sentence) {
  PluginEntry entry = detail::make_entry<Interface, Class, Params>(name, sentence);
  entry.smoother = [](const Value* value) {
    if (value != nullptr && !value->entries.empty()) {
      throw 42;
    }
    return detail::make<Interface, Class, Params>(value);
  };
  return entry;
}
/// One whose manifest alone has a sentence.
template <class Interface, class Class, class Params>
constexpr PluginEntry silent_entry(const char* name, const char*) {
  return detail::make_entry<Interface, Class, Params>(name, "");
}
}  // namespace altiplan::bad

/// ALTIPLAN_PLUGIN with an entry of its own: MAKER is one of the templates above.
#define ALTIPLAN_BAD_PLUGIN(Interface, plugin_name, maker, Class, Params, plugin_sentence) \
  ALTIPLAN_BAD_PLUGIN_(Interface, plugin_name, maker, Class, Params, plugin_sentence, __COUNTER__)
#define ALTIPLAN_BAD_PLUGIN_(Interface, plugin_name, maker, Class, Params, plugin_sentence, n)    \
  namespace {                                                                                     \
  __attribute__((section("altiplan_manifest"),                                                    \
                 used)) constinit const altiplan::Manifest ALTIPLAN_JOIN(bad_manifest_, n) =      \
      altiplan::make_manifest(altiplan::detail::kKind<altiplan::Interface>, plugin_name,          \
                              plugin_sentence);                                                   \
  constinit const altiplan::PluginEntry ALTIPLAN_JOIN(bad_entry_, n) =                            \
      altiplan::bad::maker<altiplan::Interface, Class, Params>(plugin_name, plugin_sentence);     \
  __attribute__((section("altiplan_entries"), used))                                              \
  const altiplan::PluginEntry* const ALTIPLAN_JOIN(bad_entry_at_, n) = &ALTIPLAN_JOIN(bad_entry_, \
                                                                                      n);         \
  }

/// What each kind has of bad entries. `Base`: parameters that Class is made of.
#define ALTIPLAN_BAD_ENTRIES(Interface, Class, Base)                                              \
  ALTIPLAN_BAD_PLUGIN(Interface, "says_nothing", silent_entry, Class, Base,                       \
                      "its entry has no sentence")                                                \
  ALTIPLAN_PLUGIN(Interface, "undescribed", Class, altiplan::bad::Undescribed<Base>,              \
                  "a parameter has no sentence")                                                  \
  ALTIPLAN_PLUGIN(Interface, "misnamed", Class, altiplan::bad::Misnamed<Base>,                    \
                  "a parameter is not named in snake_case")                                       \
  ALTIPLAN_PLUGIN(Interface, "out_of_bounds", Class, altiplan::bad::OutOfBounds<Base>,            \
                  "a default lies out of its own bounds")                                         \
  ALTIPLAN_BAD_PLUGIN(Interface, "deaf", deaf_entry, Class, altiplan::bad::Bounded<Base>,         \
                      "does not hold its parameters to their bounds")                             \
  ALTIPLAN_BAD_PLUGIN(Interface, "careless", careless_entry, Class, altiplan::bad::Bounded<Base>, \
                      "makes objects of any parameters")

/// What each kind has of plugins that do well, and do to their process what they should not.
#define ALTIPLAN_BAD_PROCESSES(Interface, Locale, Prints, Writes, Leaks, Differs, Params) \
  ALTIPLAN_PLUGIN(Interface, "changes_locale", Locale, Params, "changes the locale")      \
  ALTIPLAN_PLUGIN(Interface, "prints", Prints, Params, "writes to stdout")                \
  ALTIPLAN_PLUGIN(Interface, "writes_file", Writes, Params, "writes a file at home")      \
  ALTIPLAN_PLUGIN(Interface, "leaks", Leaks, Params, "keeps 5,000 bytes at each call")    \
  ALTIPLAN_PLUGIN(Interface, "depends_on_address", Differs, Params,                       \
                  "its answer depends on an address")
