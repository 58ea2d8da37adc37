// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "altiplan/plugin_abi.hpp"

namespace altiplan::host {

/// A plugin library, or a file of plugins in Python, as described by its bytes; none of its code
/// has run.
struct Library {
  std::filesystem::path file;
  std::string build;              ///< GNU build id, else a hash of the file; hexadecimal
  std::string checksum;           ///< of the loaded bytes, as stated in the file; hexadecimal
  std::vector<Manifest> plugins;  ///< empty if refused before the manifest could be read
  std::string refused;            ///< the reason, naming both sides; "" if it may be loaded
  bool is_machine_fault = false;  ///< refused because the machine failed to read it
};
}  // namespace altiplan::host
