// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "study/model/study_data.hpp"
#include "study/store/store.hpp"

namespace altiplan::study {

/// The history of a store's claims, for its study under "claims": those of the file are added with
/// the time (UTC) and the number of runs stored so far, unless they read as they did last. Throws
/// Error if the store is damaged.
std::string claim_history(const Store& store, const StudyFile& file, const std::string& time);

/// When each claim came into the study as it reads now, by its id; empty for a store of a former
/// version. Throws Error if the store is damaged.
std::map<std::string, ClaimStatement> claim_statements(const Store& store);
}  // namespace altiplan::study
