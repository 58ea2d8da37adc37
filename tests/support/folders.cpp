// SPDX-License-Identifier: Apache-2.0
#include "support/folders.hpp"

namespace altiplan::folders {

const std::filesystem::path& source() {
  static const std::filesystem::path kFolder = ALTIPLAN_SOURCE_DIR;
  return kFolder;
}

const std::filesystem::path& build() {
  static const std::filesystem::path kFolder = ALTIPLAN_BUILD_DIR;
  return kFolder;
}
}  // namespace altiplan::folders
