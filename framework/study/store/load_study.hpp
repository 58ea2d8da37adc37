// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "study/model/study_data.hpp"
#include "study/store/store.hpp"

namespace altiplan::study {

/// The study's file as of the creation of the store. Throws Error naming the store.
StudyFile study_file(const Store& store);

/// Throws Error if the stores belong to different studies.
StudyData load_study_data(const std::vector<std::string>& stores);
}  // namespace altiplan::study
