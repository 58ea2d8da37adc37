// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
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

/// What stands under a name. Throws MachineFault where the machine does not say: what it cannot
/// look at is not absent.
std::filesystem::file_status status_of(const std::filesystem::path& file);
std::filesystem::file_status link_status_of(const std::filesystem::path& file);
bool is_there(const std::filesystem::path& file);
bool is_folder(const std::filesystem::path& file);

/// Throws why a library cannot be used: a MachineFault where the errno is the machine's, so that it
/// is not attributed to the library, else a PluginError.
[[noreturn]] void fail_to_use(const std::string& why, int error);

/// "FILE: cannot be read: Input/output error"
std::string unreadable(const std::filesystem::path& file, int error);

/// 0, or the errno that keeps a regular file from being read to its end.
int reading_error(const std::filesystem::path& file);

/// The first of the files that cannot be read to its end, as `unreadable` has it; "" where all can.
std::string first_unreadable(const std::vector<std::filesystem::path>& files);
}  // namespace altiplan::host
