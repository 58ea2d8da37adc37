// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>

#include "host/import_export/export.hpp"

namespace altiplan::host {

/// Height of home above sea level, if known.
std::optional<double> home_altitude(const Mission& mission, const ExportOptions& options,
                                    const Vec3& start);

/// Throws Error if the options need something that the world does not have.
void expect_possible(const Mission& mission, const ExportOptions& options, const Vec3& start);

/// Converts local points to points of a file; without a georeference, only their heights.
class Placing {
 public:
  Placing(const Mission& mission, const ExportOptions& options, const Vec3& start);

  const formats::MissionPoint& home() const { return home_; }
  formats::MissionPoint operator()(const Vec3& p) const;
  std::string in_words() const;

 private:
  std::array<double, 2> lonlat(const Vec3& p) const;

  const World& world_;
  formats::AltitudeFrame frame_;
  formats::MissionPoint home_;
};
}  // namespace altiplan::host
