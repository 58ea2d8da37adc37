// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace altiplan::host {

/// The folder that contains this program's bin folder, in an installation or a build; empty if
/// unknown.
inline std::filesystem::path install_root() {
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  return program.parent_path().parent_path();
}
}  // namespace altiplan::host
