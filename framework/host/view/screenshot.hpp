// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>

namespace altiplan::host {

/// A Chromium: the program that ALTIPLAN_CHROMIUM names where that is set, else one on the PATH.
std::optional<std::filesystem::path> find_chromium();

/// The bytes of a PNG of the page, drawn without a screen. `query` is added to its address. Throws
/// Error where Chromium does not draw it in time.
std::string screenshot(const std::filesystem::path& chromium, const std::string& page,
                       const std::string& query,
                       std::chrono::milliseconds patience = std::chrono::seconds(60));
}  // namespace altiplan::host
