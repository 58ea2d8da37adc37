// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stop_token>
#include <string>

#include "link/link.hpp"

namespace altiplan::link {

/// What a vehicle that flies to set-points does by itself when nothing reaches it any more.
struct Failsafe {
  std::string words;     ///< "it stops after 3 s and hovers (GUID_TIMEOUT 3, FS_GCS_ENABLE 0)"
  bool is_safe = false;  ///< it ends in a hold or a return
};

/// By the parameters of ArduPilot, or of PX4 from 1.14 on. What is not known is not safe.
Failsafe read_failsafe(Link& link, const Vehicle& vehicle, const std::stop_token& stop);
}  // namespace altiplan::link
