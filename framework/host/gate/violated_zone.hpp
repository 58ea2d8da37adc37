// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <vector>

#include "altiplan/drawing.hpp"
#include "host/gate/band_judge.hpp"
#include "host/gate/plan_report.hpp"

namespace altiplan::host {

/// Says which zone of a layer is violated: the only place that does.
class ZoneNames {
 public:
  explicit ZoneNames(const World& world) : world_(world) {}
  void add_to(Finding& finding);
  /// Sets what the judge finds worst on the parts, with its zone or void.
  void add_worst(const std::vector<FlownPart>& parts, const BandJudge& judge, Finding& finding);

 private:
  const World& world_;
  std::map<std::string, std::optional<Drawing>> drawings_;  ///< by layer: each takes long
};
/// Tells a void of the elevation model from ground.
void name_void(Finding& finding, const World& world);
bool is_ground_layer(const std::string& id, const World& world);
}  // namespace altiplan::host
