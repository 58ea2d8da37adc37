// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

namespace altiplan::host {

/// Does something with a library in a child process, since a damaged one can end the process inside
/// dlopen. Throws PluginError with the text of what `use` throws; and, after `prefix`, with how the
/// child ended where that was not well, or that it was not done within 20 s. Throws MachineFault
/// where the machine has no child to give, or where that is what `use` met.
void in_child(const std::string& prefix, const std::function<void()>& use);
}  // namespace altiplan::host
