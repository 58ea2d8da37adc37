// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "study/store/store.hpp"

namespace altiplan::study {

/// This machine, this version and this time; what was asked for is not filled in.
StoredSession this_session();
}  // namespace altiplan::study
