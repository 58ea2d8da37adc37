// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <variant>

#include "link/command_messages.hpp"
#include "link/mission_messages.hpp"
#include "link/telemetry_messages.hpp"

namespace altiplan::link {

/// Every message that the link knows. A further one is declared once, as a struct, and named here.
using Message = std::variant<
    Heartbeat, SysStatus, SystemTime, Ping, SetMode, ParamRequestRead, ParamRequestList, ParamValue,
    ParamSet, GpsRawInt, Attitude, LocalPositionNed, GlobalPositionInt, MissionWritePartialList,
    MissionRequest, MissionSetCurrent, MissionCurrent, MissionRequestList, MissionCount,
    MissionClearAll, MissionItemReached, MissionAck, MissionRequestInt, MissionItemInt, VfrHud,
    CommandInt, CommandLong, CommandAck, SetPositionTargetLocalNed, SetPositionTargetGlobalInt,
    Timesync, TerrainRequest, TerrainData, TerrainCheck, TerrainReport, AutopilotVersion, Wind,
    WindCov, HomePosition, ExtendedSysState, Statustext>;

/// The layout of a message, by number; null where the link does not know it.
const Layout* find_layout(std::uint32_t id);
const Layout& layout_of(const Message& message);

/// All bytes of the payload, zeros at its end included.
std::string payload_of(const Message& message);
/// None where the link does not know the number.
std::optional<Message> decode(std::uint32_t id, std::string_view payload);

/// Text of a field of characters, which ends before the first zero.
template <std::size_t N>
std::string text_of(const std::array<char, N>& field) {
  const std::string all(field.data(), N);
  return all.substr(0, all.find('\0'));
}
}  // namespace altiplan::link
