// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "study/model/study_data.hpp"
#include "study/store/store.hpp"

namespace altiplan::study {

/// The study's file as it was when the store was made. Throws Error naming the store.
StudyFile study_file(const Store& store);

/// Throws Error where the stores are not of one study.
StudyData load_study_data(const std::vector<std::string>& stores);
}  // namespace altiplan::study
