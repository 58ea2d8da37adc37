// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/plugin_abi.hpp"

/// \file The header that a plugin includes together with its interface (`altiplan/planner.hpp` …).
/// Its source file ends with one line:
///
///     ALTIPLAN_PLUGIN(Planner, "astar", AStar, Params, "A* on a lattice …")
///
/// the interface, the name in YAML, the class (constructible from its parameters; an environment,
/// an objective and a task from parameters and Site), the parameter struct (with `void
/// describe(altiplan::Fields&)`), and a sentence for `altiplan plugins`.

extern "C" {
extern const altiplan::PluginEntry* const __start_altiplan_entries
    __attribute__((visibility("hidden")));
extern const altiplan::PluginEntry* const __stop_altiplan_entries
    __attribute__((visibility("hidden")));

/// The library's plugins, for the host.
ALTIPLAN_API __attribute__((used)) inline const altiplan::PluginEntry* const* altiplan_plugins(
    std::size_t* count) {
  *count = static_cast<std::size_t>(&__stop_altiplan_entries - &__start_altiplan_entries);
  return &__start_altiplan_entries;
}
}

#define ALTIPLAN_JOIN_(a, b) a##b
#define ALTIPLAN_JOIN(a, b) ALTIPLAN_JOIN_(a, b)
#define ALTIPLAN_PLUGIN(Interface, plugin_name, Class, Params, plugin_sentence) \
  ALTIPLAN_PLUGIN_(Interface, plugin_name, Class, Params, plugin_sentence, __COUNTER__)
#define ALTIPLAN_PLUGIN_(Interface, plugin_name, Class, Params, plugin_sentence, n)            \
  namespace {                                                                                  \
  __attribute__((section("altiplan_manifest"),                                                 \
                 used)) constinit const ::altiplan::Manifest ALTIPLAN_JOIN(altiplan_manifest_, \
                                                                           n) =                \
      ::altiplan::make_manifest(::altiplan::detail::kKind<::altiplan::Interface>, plugin_name, \
                                plugin_sentence);                                              \
  constinit const ::altiplan::PluginEntry ALTIPLAN_JOIN(altiplan_entry_, n) =                  \
      ::altiplan::detail::make_entry<::altiplan::Interface, Class, Params>(plugin_name,        \
                                                                           plugin_sentence);   \
  __attribute__((section("altiplan_entries"), used))                                           \
  const ::altiplan::PluginEntry* const ALTIPLAN_JOIN(altiplan_entry_at_,                       \
                                                     n) = &ALTIPLAN_JOIN(altiplan_entry_, n);  \
  }
