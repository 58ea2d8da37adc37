// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "altiplan/environment.hpp"
#include "altiplan/formats/airspace.hpp"
#include "altiplan/kit/layers/hours.hpp"
#include "altiplan/params.hpp"
#include "clip.hpp"
#include "ground_zones.hpp"

namespace altiplan::zones {

/// Published airspace as this layer has it.
struct PublishedRules {
  enum class Use { keep_out, skip };
  Use ask = Use::keep_out;
  Use inform = Use::skip;
  std::vector<std::string> permitted;  ///< zones, as they are called, that take a permission
  double qnh_hpa = 1013.25;

  void describe(Fields& f);
};

struct PublishedZone {
  std::string name;
  GroundPrism limits;
  kit::Hours::Times closed{};  ///< none: at all times
};

struct Published {
  std::vector<PublishedZone> zones;
  std::vector<std::string> notes;
  std::size_t inactive = 0;
  std::size_t two_readings = 0;  ///< polygons, see formats::has_two_readings
};

/// Corners of the zones that the rules do not skip; of all where they skip all.
std::vector<formats::Point2> corners_in_use(const formats::Airspace& airspace,
                                            const PublishedRules& rules);

/// Times at which a zone is closed, in seconds after the start; of one with hours those of 30 days,
/// and all after these.
kit::Hours::Times closed_times(const formats::Zone& zone, const Site& site);

/// The zones that are closed at some time of the flight; `in_time`: all that are closed at some
/// time, with their times. The site has a frame with a position.
Published published_zones(const formats::Airspace& airspace, const PublishedRules& rules,
                          const Site& site, double horizon_s, bool in_time, Clip* clip);
}  // namespace altiplan::zones
