// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "study/model/study_data.hpp"

namespace altiplan::study {

/// Writes the study as an OMPL benchmark database for Planner Arena (docs/study-machines.md has the
/// mapping). An existing file is replaced once the new one is complete, unless it is a store or not
/// a database. Throws Error naming the file.
void write_arena(const StudyData& data, const std::filesystem::path& file);
}  // namespace altiplan::study
