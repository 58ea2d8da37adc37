// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "altiplan/error.hpp"
#include "host/base/words.hpp"
#include "host/gate/plan_report.hpp"

namespace altiplan::host {
namespace {

/// ", 20 to 80 m above home", of the strips beside the ends on the ground.
std::string heights_of(const FlownMission& flown, const formats::MissionFile& plan) {
  double low = kInfinity;
  double high = -kInfinity;
  for (const FlownPart& part : flown.parts) {
    for (const Strip& strip : part.strips) {
      if (part.ground == FlownPart::Ground::kept_off) {
        low = std::min({low, strip.from.z(), strip.to.z()});
      }
      high = std::max({high, strip.from_high_m, strip.to_high_m});
    }
  }
  if (!std::isfinite(low) || !plan.home) {
    return "";
  }
  const double home = plan.home->altitude_m;
  return ", " + with_decimals(low - home, 0) + " to " + with_decimals(high - home, 0) +
         " m above home";
}

/// Metres along straight lines from item to item, in plan.
double drawn_length(const formats::MissionFile& plan) {
  const formats::MissionPoint& first = plan.items.front().at;
  const Frame frame = Frame::local({first.lon, first.lat});
  double length = 0;
  auto before = frame.to_local(first.lon, first.lat);
  for (const formats::MissionItem& item : plan.items) {
    const auto here = frame.to_local(item.at.lon, item.at.lat);
    length += std::hypot(here[0] - before[0], here[1] - before[1]);
    before = here;
  }
  return length;
}
}  // namespace

std::vector<std::string> flight_facts(const formats::MissionFile& plan, const Mission* world,
                                      const GateOptions& options) {
  if (plan.items.empty() || plan.commands.empty()) {
    return {};
  }
  std::vector<std::string> facts{"length " + with_decimals(drawn_length(plan) / 1000, 3) + " km"};
  try {
    for (const FlownMission& flown : flights_of(plan, world, options)) {
      const std::string who = flown.autopilot.name() + ": ";
      if (!flown.parts.empty()) {
        facts.push_back("flown by " + who + time_in_words(flown.time) + heights_of(flown, plan) +
                        (world == nullptr ? ", as if over level ground (--terrain DEM)" : ""));
      }
      for (const Remark& remark : flown.remarks) {
        if (remark.weight != Remark::Weight::note) {
          facts.push_back(who + name_of_command(plan.commands[remark.command]) + " " +
                          remark.message);
        }
      }
    }
  } catch (const Error& error) {
    facts.emplace_back(std::string("cannot be flown: ") + error.what());
  }
  return facts;
}
}  // namespace altiplan::host
