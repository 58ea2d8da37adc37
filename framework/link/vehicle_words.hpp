// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "link/telemetry_messages.hpp"

namespace altiplan::link {

inline constexpr std::uint8_t kGroundStation = 6;  ///< of MAV_TYPE
// Of MAV_AUTOPILOT:
inline constexpr std::uint8_t kArduPilot = 3;
inline constexpr std::uint8_t kNoAutopilot = 8;
inline constexpr std::uint8_t kPx4 = 12;
/// Of MAV_MODE_FLAG.
inline constexpr std::uint8_t kArmedFlag = 128;

/// True also of a VTOL, which flies missions as one.
bool is_fixed_wing(const Heartbeat& heartbeat);
/// "quadrotor", "fixed wing".
std::string type_in_words(const Heartbeat& heartbeat);
/// "ArduPilot".
std::string autopilot_in_words(const Heartbeat& heartbeat);
/// The autopilot's own name of the mode, or its number.
std::string mode_in_words(const Heartbeat& heartbeat);
}  // namespace altiplan::link
