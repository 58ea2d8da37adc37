// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "study/model/study_data.hpp"

namespace altiplan::study {

/// True if the file is a database with the tables of an OMPL benchmark (Planner Arena).
bool is_arena(const std::filesystem::path& file);

/// Adds the runs of an OMPL benchmark database: its experiments as scenarios, its planners as
/// pipelines, of each of them the runs in their order as repetitions (docs/reference/report.md has
/// the mapping). Returns the traces of these runs, with what the database has of their progress.
/// Throws Error naming the file: damaged, without runs, or if there are runs already and no
/// experiment has the name of one of their scenarios.
std::function<std::string(const RunRow&)> add_arena(StudyData& data,
                                                    const std::filesystem::path& file);
}  // namespace altiplan::study
