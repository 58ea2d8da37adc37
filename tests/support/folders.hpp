// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace altiplan::folders {

/// Folders of this checkout and of this build. Functions, not macros on every command line, so that
/// the compiler's cache serves a checkout anywhere.
const std::filesystem::path& source();
const std::filesystem::path& build();
}  // namespace altiplan::folders
