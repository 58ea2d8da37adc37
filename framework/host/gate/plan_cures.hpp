// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/gate/band_judge.hpp"
#include "host/gate/cure.hpp"
#include "host/gate/plan_report.hpp"

namespace altiplan::host {

/// What cures the findings of a mission, in words, and the mission so cured.
class PlanCures {
 public:
  /// A way of the flight, from and to which command.
  struct Way {
    std::size_t before;
    std::size_t command;
    bool is_return;
  };

  PlanCures(const formats::MissionFile& plan, const World& world, const FlightOptions& flight,
            const std::vector<formats::Autopilot>& autopilots, const BandJudge& judge, Fly fly);

  /// `ways`: of each finding, if it is of one; `flown`: the mission as it is.
  void add_to(PlanReport& report, const std::vector<std::optional<Way>>& ways,
              const std::vector<FlownMission>& flown) const;

  /// The mission changed until it is valid; none where that fails.
  std::optional<formats::MissionFile> cured() const;

 private:
  std::string in_words(const Cure& cure, const PlanReport& report) const;
  std::string in_words(const AboveHome& change, const PlanReport& report) const;
  /// Of what is wrong with an aeroplane's landing, where its height alone is; "" where it is not.
  std::string cure_of_landing(const Finding& finding, const PlanReport& report) const;
  /// By how much each is to be raised.
  std::vector<std::pair<std::size_t, double>> landings_off_ground() const;
  /// True if what a command does is not valid, or an autopilot objects to it.
  bool fails_at(const formats::MissionFile& plan, std::size_t command) const;
  /// "return higher: RTL_ALT_M 120", the minimum with which a return of the mission is valid.
  std::string cure_by_height(std::size_t command) const;

  const formats::MissionFile& plan_;
  const World& world_;
  const FlightOptions& flight_;
  const std::vector<formats::Autopilot>& autopilots_;
  const BandJudge& judge_;
  Fly fly_;
};
}  // namespace altiplan::host
