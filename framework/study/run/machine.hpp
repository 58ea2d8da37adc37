// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "study/store/store.hpp"

namespace altiplan::study {

/// This machine, version and time; the fields of the command line are left empty.
StoredSession this_session();
}  // namespace altiplan::study
