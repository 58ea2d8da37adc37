// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "altiplan/api_hash.hpp"
#include "altiplan/params.hpp"

namespace altiplan {

// Only declared here: a plugin includes no interface but the one that it implements.
class Environment;
class Constraint;
class Planner;
class LocalPlanner;
class Smoother;
class Tuner;
class Objective;
class Task;
struct Site;

/// Self-description of a library, read from its file before any of its code runs: plain data in the
/// ELF section `altiplan_manifest`, one record per plugin. The host compares it with its own and,
/// on a mismatch, refuses the library and prints both; compiler and optimisation are informative.
struct Manifest {
  static constexpr char kMagic[16] = "altiplan plugin";

  // These four have their place in every version of the API.
  char magic[16];
  std::uint32_t struct_size;
  std::uint16_t api_major;
  std::uint16_t api_minor;

  std::uint8_t cxx11_abi;
  std::uint8_t glibcxx_debug;
  std::uint8_t sanitizers;  ///< 1 address, 2 thread, 4 memory
  std::uint8_t optimised;
  char api_hash[20];  ///< ALTIPLAN_API_HASH: a change to anything that crosses changes it
  char compiler[64];
  char kind[24];
  char name[64];
  char sentence[256];
  char file[64];           ///< the source file, without its folder
  std::uint32_t checksum;  ///< checksum_of the record; detects a damaged file before it is trusted
};

/// FNV-1a of the bytes before the checksum.
constexpr std::uint32_t checksum_of(const Manifest& m) {
  const auto bytes = std::bit_cast<std::array<unsigned char, sizeof(Manifest)>>(m);
  std::uint32_t sum = 2166136261U;
  for (std::size_t i = 0; i < offsetof(Manifest, checksum); ++i) {
    sum = (sum ^ bytes[i]) * 16777619U;
  }
  return sum;
}

/// The manifest of a plugin with the settings of this compilation. Static, since those may differ
/// between two files of a plugin.
static consteval Manifest make_manifest(const char* kind, const char* name, const char* sentence,
                                        const char* file = __builtin_FILE()) {
  Manifest m{};
  const auto copy = [](char* to, std::size_t size, const char* from) {
    for (std::size_t i = 0; i + 1 < size && from[i] != '\0'; ++i) {
      to[i] = from[i];
    }
  };
  copy(m.magic, sizeof m.magic, Manifest::kMagic);
  m.struct_size = sizeof(Manifest);
  m.api_major = ALTIPLAN_API_MAJOR;
  m.api_minor = ALTIPLAN_API_MINOR;
#ifdef _GLIBCXX_USE_CXX11_ABI
  m.cxx11_abi = _GLIBCXX_USE_CXX11_ABI;
#endif
#ifdef _GLIBCXX_DEBUG
  m.glibcxx_debug = 1;
#endif
#if defined(__SANITIZE_ADDRESS__)
  m.sanitizers |= 1;
#endif
#if defined(__SANITIZE_THREAD__)
  m.sanitizers |= 2;
#endif
#if defined(__has_feature)
#if __has_feature(address_sanitizer)
  m.sanitizers |= 1;
#endif
#if __has_feature(thread_sanitizer)
  m.sanitizers |= 2;
#endif
#if __has_feature(memory_sanitizer)
  m.sanitizers |= 4;
#endif
#endif
#ifdef __OPTIMIZE__
  m.optimised = 1;
#endif
  copy(m.api_hash, sizeof m.api_hash, ALTIPLAN_API_HASH);
  copy(m.compiler, sizeof m.compiler, __VERSION__);
  copy(m.kind, sizeof m.kind, kind);
  copy(m.name, sizeof m.name, name);
  copy(m.sentence, sizeof m.sentence, sentence);
  for (const char* at = file; *at != '\0'; ++at) {
    file = *at == '/' ? at + 1 : file;
  }
  copy(m.file, sizeof m.file, file);
  m.checksum = checksum_of(m);
  return m;
}

/// Factories of a plugin; the one of its kind is set, the others are null. `describe` reads
/// parameters (null: defaults) and never throws; the factories throw Error.
struct PluginEntry {
  const char* kind;
  const char* name;
  const char* sentence;
  ParamReport (*describe)(const Value* parameters, const std::string& path);
  std::unique_ptr<Environment> (*environment)(const Value* parameters, const Site& site);
  std::unique_ptr<Constraint> (*constraint)(const Value* parameters, const Site& site);
  std::unique_ptr<Planner> (*planner)(const Value* parameters);
  std::unique_ptr<LocalPlanner> (*local_planner)(const Value* parameters);
  std::unique_ptr<Smoother> (*smoother)(const Value* parameters);
  std::unique_ptr<Tuner> (*tuner)(const Value* parameters);
  std::unique_ptr<Objective> (*objective)(const Value* parameters, const Site& site);
  std::unique_ptr<Task> (*task)(const Value* parameters, const Site& site);
};

/// The only symbol that a plugin library exports.
using PluginList = const PluginEntry* const* (*)(std::size_t* count);
inline constexpr const char* kPluginListSymbol = "altiplan_plugins";
/// For a plugin without parameters.
struct NoParams {
  void describe(Fields&) {}
};

namespace detail {

/// Constructs a plugin's object from its parameters, and the site if its constructor takes one;
/// exceptions that are not the framework's become PluginError.
template <class Interface, class Class, class Params, class... Site>
std::unique_ptr<Interface> make(const Value* parameters, const Site&... site) {
  try {
    Params params;
    ParamReport report = bind(params, parameters);
    if (!report.problems.empty()) {
      throw ConfigError(std::move(report.problems));
    }
    if constexpr (std::is_constructible_v<Class, const Params&, const Site&...>) {
      return std::make_unique<Class>(params, site...);
    } else {
      return std::make_unique<Class>(params);
    }
  } catch (const Error&) {
    throw;
  } catch (...) {
    attribute_to("");
  }
}

template <class Params>
ParamReport describe(const Value* parameters, const std::string& path) {
  Params params;
  return bind(params, parameters, path);
}

/// The name of an interface's kind.
template <class Interface>
inline constexpr const char* kKind = nullptr;
template <>
inline constexpr const char* kKind<Environment> = "environment";
template <>
inline constexpr const char* kKind<Constraint> = "constraint";
template <>
inline constexpr const char* kKind<Planner> = "planner";
template <>
inline constexpr const char* kKind<LocalPlanner> = "local_planner";
template <>
inline constexpr const char* kKind<Smoother> = "smoother";
template <>
inline constexpr const char* kKind<Tuner> = "tuner";
template <>
inline constexpr const char* kKind<Objective> = "objective";
template <>
inline constexpr const char* kKind<Task> = "task";

template <class Interface, class Class, class Params>
constexpr PluginEntry make_entry(const char* name, const char* sentence) {
  static_assert(
      requires { sizeof(Interface); },
      "include the header of the interface too, such as altiplan/planner.hpp");
  PluginEntry entry{};
  entry.kind = kKind<Interface>;
  entry.name = name;
  entry.sentence = sentence;
  entry.describe = &describe<Params>;
  if constexpr (std::is_same_v<Interface, Environment>) {
    entry.environment = &make<Interface, Class, Params, Site>;
  } else if constexpr (std::is_same_v<Interface, Constraint>) {
    entry.constraint = &make<Interface, Class, Params, Site>;
  } else if constexpr (std::is_same_v<Interface, Planner>) {
    entry.planner = &make<Interface, Class, Params>;
  } else if constexpr (std::is_same_v<Interface, LocalPlanner>) {
    entry.local_planner = &make<Interface, Class, Params>;
  } else if constexpr (std::is_same_v<Interface, Smoother>) {
    entry.smoother = &make<Interface, Class, Params>;
  } else if constexpr (std::is_same_v<Interface, Tuner>) {
    entry.tuner = &make<Interface, Class, Params>;
  } else if constexpr (std::is_same_v<Interface, Objective>) {
    entry.objective = &make<Interface, Class, Params, Site>;
  } else {
    entry.task = &make<Interface, Class, Params, Site>;
  }
  return entry;
}
}  // namespace detail
}  // namespace altiplan
