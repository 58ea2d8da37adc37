// SPDX-License-Identifier: Apache-2.0
#include "guarded.hpp"

#include <exception>
#include <filesystem>
#include <iostream>

#include "altiplan/error.hpp"

namespace altiplan::cli {
namespace {

int code_of(const char* program, const std::function<int()>& action) {
  try {
    return action();
  } catch (const ConfigError& error) {
    for (const Problem& problem : error.problems()) {
      std::cerr << problem.text() << '\n';
    }
    return kBadFile;
  } catch (const PluginError& error) {
    std::cerr << program << ": " << error.what() << '\n';
    return kBadPlugin;
  } catch (const Error& error) {
    std::cerr << program << ": " << error.what() << '\n';
    return kBadFile;
  } catch (const std::filesystem::filesystem_error& error) {
    std::cerr << program << ": " << error.path1().string() << ": " << error.code().message()
              << '\n';
    return kBadFile;
  } catch (const std::exception& error) {
    std::cerr << program << ": internal error: " << error.what() << '\n';
    return kInternal;
  }
}
}  // namespace

int guarded(const char* program, const std::function<int()>& action) {
  const int code = code_of(program, action);
  std::cout.flush();
  if (!std::cout) {
    std::cerr << program << ": cannot write to stdout\n";
    return code == kDone ? kInternal : code;
  }
  return code;
}
}  // namespace altiplan::cli
