// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "host/config/config.hpp"

namespace altiplan::tune {

/// The pipeline's text with keys set ("steps.0.with.weight_g=0.3"), as a file in `folder`: keeps
/// comments and layout, and adapts relative paths. If the text cannot be kept (values behind
/// aliases), the pipeline is rewritten without its comments.
std::string tuned_text(const host::Config& config, const std::vector<std::string>& assignments,
                       const std::filesystem::path& folder);
}  // namespace altiplan::tune
