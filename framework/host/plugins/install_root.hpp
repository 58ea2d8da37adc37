// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace altiplan::host {

/// The folder that this program's bin is in, in an installation as in a build; empty where the
/// system does not tell.
inline std::filesystem::path install_root() {
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  return program.parent_path().parent_path();
}
}  // namespace altiplan::host
