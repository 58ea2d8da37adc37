// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "altiplan/error.hpp"

namespace altiplan::host {

/// The machine did not give a file, memory or a process that it should have: that says nothing
/// about the plugin or the run that had asked, and may pass.
class MachineFault : public Error {
 public:
  using Error::Error;
};

/// Whether an errno is the machine's and not the file's: EIO, EMFILE, ENOMEM …
bool is_machine_fault(int error);

/// Whether a message, of the dynamic loader for one, holds the words of such an errno.
bool names_machine_fault(std::string_view message);

/// Throws why a library cannot be used: a MachineFault where that is the machine's, so that it is
/// not attributed to the library, else a PluginError.
[[noreturn]] void fail_to_use(const std::string& why);

/// "FILE: cannot be read: Input/output error"
std::string unreadable(const std::filesystem::path& file, int error);

/// The first of the files that cannot be read to its end, as `unreadable` has it; "" where all can.
std::string first_unreadable(const std::vector<std::filesystem::path>& files);
}  // namespace altiplan::host
