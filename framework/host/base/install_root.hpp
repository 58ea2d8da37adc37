// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace altiplan::host {

/// The folder that contains this program's bin folder, in an installation or a build; empty if
/// unknown. Within Python, whose program lies elsewhere, the one that contains
/// lib/python3/dist-packages/altiplan, where the module lies.
std::filesystem::path install_root();
}  // namespace altiplan::host
