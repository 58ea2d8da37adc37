// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "study/model/study_data.hpp"

namespace altiplan::study {

/// Writes the study as a database of OMPL's benchmarks, which Planner Arena reads
/// (docs/how-to/run-large-studies.md says what becomes what). A file of that name is replaced once
/// the new one is whole; one that is no database, or a store, is not. Throws Error naming the file.
void write_arena(const StudyData& data, const std::filesystem::path& file);
}  // namespace altiplan::study
