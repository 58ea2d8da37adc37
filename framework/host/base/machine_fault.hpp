// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "altiplan/error.hpp"

namespace altiplan::host {

/// The machine failed to provide a file, memory or a process: not the fault of the plugin or run
/// that asked for it, and possibly transient.
class MachineFault : public Error {
 public:
  using Error::Error;
};

/// True if an errno is the machine's fault and not the file's: EIO, EMFILE, ENOMEM …
bool is_machine_fault(int error);

/// Type of a file. Throws MachineFault if the machine cannot tell: a file that cannot be examined
/// is not absent.
std::filesystem::file_status status_of(const std::filesystem::path& file);
std::filesystem::file_status link_status_of(const std::filesystem::path& file);
bool is_there(const std::filesystem::path& file);
bool is_folder(const std::filesystem::path& file);

/// Throws the reason why a library cannot be used: a MachineFault if the errno is the machine's
/// fault, so that it is not attributed to the library, else a PluginError.
[[noreturn]] void fail_to_use(const std::string& why, int error);

/// "FILE: cannot be read: Input/output error"
std::string unreadable(const std::filesystem::path& file, int error);

/// The errno that prevents a regular file from being read to its end, else 0.
int reading_error(const std::filesystem::path& file);

/// The message of `unreadable` for the first file that cannot be read to its end; "" if all can.
std::string first_unreadable(const std::vector<std::filesystem::path>& files);
}  // namespace altiplan::host
