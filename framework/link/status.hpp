// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <stop_token>

#include "altiplan/formats/mission_file.hpp"
#include "link/link.hpp"

namespace altiplan::link {

/// What a vehicle reported of itself.
struct Status {
  Vehicle vehicle;
  std::optional<GlobalPositionInt> position;
  std::optional<SysStatus> system;
  std::optional<MissionCurrent> current;
  std::optional<std::size_t> mission_items;
};

/// Asks for it all, once a second, and listens until all has come or the time is over.
Status read_status(Link& link, const Vehicle& vehicle, Time timeout, const std::stop_token& stop);

/// Home as the vehicle reports it; none if it does not in time.
std::optional<formats::MissionPoint> read_home(Link& link, const Vehicle& vehicle, Time timeout,
                                               const std::stop_token& stop);

/// A line each: the vehicle, its mode, position, battery and mission.
std::string in_words(const Status& status);
}  // namespace altiplan::link
