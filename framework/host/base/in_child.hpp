// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

namespace altiplan::host {

/// Runs `use` in a child process, since a damaged library can end the process inside dlopen. Throws
/// PluginError with the message of the exception that `use` throws or, after `prefix`, with how the
/// child ended if it crashed, exited or exceeded 20 s. Throws MachineFault if the child process
/// cannot be created, or if `use` throws one.
void in_child(const std::string& prefix, const std::function<void()>& use);
}  // namespace altiplan::host
