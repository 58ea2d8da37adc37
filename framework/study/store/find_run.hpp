// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "study/store/store.hpp"

namespace altiplan::study {

/// The run with this id, name or key prefix, with its result and trace. Throws Error if there is
/// none, or more than one.
StoredRun find_run(const Store& store, const std::string& named);
}  // namespace altiplan::study
